//! Functions that loops over arrays are compiled to vector instructions with; those of the library take one number at a
//! time.

use crate::rotation::polynomial;

/// 1/n!.
const INVERSE_FACTORIALS: [f64; 14] = {
    let mut c = [1.0; 14];
    let mut n = 1;
    while n < c.len() {
        c[n] = c[n - 1] / n as f64;
        n += 1;
    }
    c
};
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
    polynomial(&INVERSE_FACTORIALS, rest) * power_of_two
}

#[cfg(test)]
mod tests {
    use super::exp;

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
