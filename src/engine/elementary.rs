//! Functions that loops over arrays are compiled to vector instructions with; those of the library take one number at a
//! time.

use crate::rotation::polynomial;

/// 1/1!, 1/2!, 1/3!, ...
const fn inverse_factorials<const N: usize>() -> [f64; N] {
    let mut c = [1.0; N];
    let mut n = 1;
    while n < N {
        c[n] = c[n - 1] / (n + 1) as f64;
        n += 1;
    }
    c
}

/// The exponential series up to the power `N`: rounded but once where it is near 1.
#[inline(always)]
fn series<const N: usize>(x: f64) -> f64 {
    1.0 + x * polynomial(&const { inverse_factorials::<N>() }, x)
}

/// Adding it rounds to a whole number, which the last bits then hold.
const ROUND: f64 = 1.5 * (1_u64 << 52) as f64;
/// ln 2 in two parts, the first with few enough digits that whole multiples of it are exact.
const LN_2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];

/// The exponential function, to two units in the last place. Arguments below -708 count as that, above 709 as that.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    let x = if x < -708.0 { -708.0 } else { x };
    let x = if x > 709.0 { 709.0 } else { x };
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let whole = shifted - ROUND;
    let rest = (x - whole * LN_2[0]) - whole * LN_2[1];
    let power_of_two = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    series::<13>(rest) * power_of_two
}

/// Up to where a shorter series is exact to rounding.
const SMALL: f64 = 1.0 / 64.0;

/// The exponential functions of several numbers, to two units in the last place.
#[allow(clippy::needless_range_loop)] // iterators needn't be inlined, which vectors need
#[inline(always)]
pub fn exp_of_each<const N: usize>(exponents: &[f64; N]) -> [f64; N] {
    let mut far = 0.0;
    for l in 0..N {
        far = if exponents[l].abs() <= SMALL {
            far
        } else {
            1.0
        };
    }
    let mut values = [0.0; N];
    if far == 0.0 {
        for l in 0..N {
            values[l] = series::<6>(exponents[l]);
        }
    } else {
        for l in 0..N {
            values[l] = exp(exponents[l]);
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::{exp, exp_of_each};

    #[test]
    fn small_arguments_agree_with_the_library_to_rounding() {
        for i in -2000..2000 {
            let x = f64::from(i) * 1e-5;
            for (ours, library) in exp_of_each(&[x, -0.3 * x])
                .iter()
                .zip([x.exp(), (-0.3 * x).exp()])
            {
                let off = ((ours - library) / library).abs();
                assert!(off <= f64::EPSILON, "{x}: {off:.1e}");
            }
        }
        assert!(exp_of_each(&[f64::NAN])[0].is_nan());
    }

    #[test]
    fn exp_agrees_with_the_library_to_rounding() {
        for i in -70_800..70_900 {
            let x = f64::from(i) * 0.01;
            let (ours, library) = (exp(x), x.exp());
            let off = ((ours - library) / library).abs();
            assert!(off <= 2.0 * f64::EPSILON, "{x}: {off:.1e}");
        }
        assert!((exp(0.0) - 1.0).abs() < f64::MIN_POSITIVE);
        assert!(exp(f64::NEG_INFINITY) < 1e-300 && exp(f64::NAN).is_nan());
    }
}
