//! Random wishes, drawn as the authors of the paper drew theirs.

use crate::rods::Wish;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;

/// Draws wishes that balanced rods can follow: bend x evenly, then bend y, twist and elongation evenly within what is
/// left. The published random samples are those of seed 101: the authors drew from NumPy's
/// `default_rng(101)`, five numbers a sample; `tests/actuation_sequences.rs` compares all.
pub struct RandomWishes(Pcg64);

impl RandomWishes {
    /// The generator that NumPy's `default_rng(seed)` is: PCG XSL RR 128/64, seeded through its `SeedSequence`.
    pub fn new(seed: u64) -> Self {
        let [a, b, c, d] = spread(seed);
        let join = |high: u64, low: u64| u128::from(high) << 64 | u128::from(low);
        Self(Pcg64::new(join(a, b), join(c, d)))
    }

    /// Even in 0..1, with the 53 bits of an `f64`.
    fn even(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * 2.0_f64.powi(-53)
    }
}

impl Iterator for RandomWishes {
    type Item = Wish;

    fn next(&mut self) -> Option<Wish> {
        let x = self.even() - 0.5;
        let y = self.even() * (0.5 - x.abs());
        let signs = self.0.next_u64();
        let sign = |bit: u32| if signs >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let twist = self.even() * (0.5 - x.abs() - y);
        let left = 0.5 - x.abs() - y - twist;
        let elongation = 0.5 + (2.0 * self.even() - 1.0) * left;
        Some(Wish::new(x, sign(31) * y, sign(63) * twist, elongation))
    }
}

/// Four well mixed numbers from a seed, as NumPy's `SeedSequence(seed).generate_state(4, uint64)` makes them (after
/// M. E. O'Neill's `seed_seq`, <https://www.pcg-random.org/posts/developing-a-seed_seq-alternative.html>).
fn spread(seed: u64) -> [u64; 4] {
    fn hasher(mut by: u32, factor: u32) -> impl FnMut(u32) -> u32 {
        move |value| {
            let mixed = value ^ by;
            by = by.wrapping_mul(factor);
            let mixed = mixed.wrapping_mul(by);
            mixed ^ mixed >> 16
        }
    }
    let mut hash = hasher(0x43b0_d7e5, 0x931e_8875);
    let mut pool = [seed as u32, (seed >> 32) as u32, 0, 0].map(&mut hash);
    for from in 0..4 {
        for to in (0..4).filter(|to| *to != from) {
            let left = pool[to].wrapping_mul(0xca01_f9dd);
            let mixed = left.wrapping_sub(hash(pool[from]).wrapping_mul(0x4973_f715));
            pool[to] = mixed ^ mixed >> 16;
        }
    }
    let mut hash = hasher(0x8b51_f9dd, 0x58f3_8ded);
    let mut word = |k: usize| u64::from(hash(pool[k % 4]));
    std::array::from_fn(|k| word(2 * k) | word(2 * k + 1) << 32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_are_spread_as_numpy_does() {
        // numpy.random.SeedSequence(seed).generate_state(4, numpy.uint64), NumPy 2
        for (seed, published) in [
            (
                101,
                [
                    0x0e56_276f_f69a_5c37,
                    0xd0fc_d50a_729e_7773,
                    0xec4b_6972_6aa2_5aaf,
                    0x29a6_c780_3fa5_8ba8,
                ],
            ),
            (
                (1 << 40) + 7,
                [
                    0x0d86_72e1_0e3d_1a15,
                    0x9aef_4ada_4ecf_a161,
                    0x999c_1c3b_83db_a903,
                    0x4089_27dc_0dc8_a316,
                ],
            ),
        ] {
            assert_eq!(spread(seed), published);
        }
    }

    #[test]
    fn the_first_wish_of_seed_101_is_the_authors() {
        // q_p_ss of sample 0 in their random actuation specs, over 4 times 179.9 degrees
        let wish = RandomWishes::new(101).next().expect("there is no end");
        let u = 4.0 * 179.9_f64.to_radians();
        let published = [
            5.57049740399255,
            -0.25490040652697754,
            0.26861581002038104,
            6.203316080245396,
        ];
        for (ours, theirs) in wish.iter().zip(published) {
            assert!((ours * u - theirs).abs() < 1e-14, "{ours} {theirs}");
        }
    }
}
