//! Lanes for x86-64 without any vectors but those that every such machine has.

use crate::number::{Lanes, Number};
use pulp::x86::V1;
use std::arch::x86_64::__m128d;
use std::ops::{Add, Div, Mul, Sub};

/// Two numbers.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    baseline: V1,
    lanes: __m128d,
}

impl Pair {
    #[inline(always)]
    fn with(self, lanes: __m128d) -> Self {
        Self { lanes, ..self }
    }
}

macro_rules! operator {
    ($operator:ident, $name:ident, $of_lanes:ident) => {
        impl $operator for Pair {
            type Output = Self;
            #[inline(always)]
            fn $name(self, o: Self) -> Self {
                self.with(self.baseline.sse2.$of_lanes(self.lanes, o.lanes))
            }
        }
    };
}
operator!(Add, add, _mm_add_pd);
operator!(Sub, sub, _mm_sub_pd);
operator!(Mul, mul, _mm_mul_pd);
operator!(Div, div, _mm_div_pd);

impl Mul<f64> for Pair {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * self.constant(factor)
    }
}

impl Number for Pair {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        self.with(self.baseline.sse2._mm_set1_pd(value))
    }
}

impl Lanes for Pair {
    type Token = V1;
    type Stored = [f64; 2];
    type Mask = __m128d;

    #[inline(always)]
    fn zero(baseline: V1) -> Self {
        let lanes = baseline.sse2._mm_setzero_pd();
        Self { baseline, lanes }
    }

    #[inline(always)]
    fn load(baseline: V1, stored: &[f64; 2]) -> Self {
        let lanes = pulp::cast(*stored);
        Self { baseline, lanes }
    }

    #[inline(always)]
    fn store(self) -> [f64; 2] {
        pulp::cast(self.lanes)
    }

    #[inline(always)]
    fn token(self) -> V1 {
        self.baseline
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self.baseline.sse2._mm_sqrt_pd(self.lanes))
    }

    #[inline(always)]
    fn at_most(self, others: Self) -> __m128d {
        self.baseline.sse2._mm_cmple_pd(self.lanes, others.lanes)
    }

    #[inline(always)]
    fn is_zero(self) -> __m128d {
        let sse2 = self.baseline.sse2;
        sse2._mm_cmpeq_pd(self.lanes, sse2._mm_set1_pd(0.0))
    }

    #[inline(always)]
    fn select(self, mask: __m128d, others: Self) -> Self {
        let sse2 = self.baseline.sse2;
        let (these, those) = (
            sse2._mm_and_pd(mask, self.lanes),
            sse2._mm_andnot_pd(mask, others.lanes),
        );
        self.with(sse2._mm_or_pd(these, those))
    }

    #[inline(always)]
    fn either(self, one: __m128d, other: __m128d) -> __m128d {
        self.baseline.sse2._mm_or_pd(one, other)
    }

    #[inline(always)]
    fn both(self, one: __m128d, other: __m128d) -> __m128d {
        self.baseline.sse2._mm_and_pd(one, other)
    }

    #[inline(always)]
    fn everywhere(self, mask: __m128d) -> bool {
        self.baseline.sse2._mm_movemask_pd(mask) == 0b11
    }

    #[inline(always)]
    fn rotated(self) -> Self {
        let lanes = self.lanes;
        self.with(self.baseline.sse2._mm_shuffle_pd::<0b01>(lanes, lanes))
    }

    #[inline(always)]
    fn with_first_of(self, others: Self) -> Self {
        self.with(self.baseline.sse2._mm_move_sd(self.lanes, others.lanes))
    }
}
