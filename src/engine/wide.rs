//! Lanes for the machine's vectors.

use crate::number::{Lanes, Number};
use pulp::{Arch, Simd, WithSimd};
use std::ops::{Add, Div, Mul, Sub};

/// Work on all stations, whatever the lanes.
pub(crate) trait OverLanes {
    type Output;
    fn over<L: Lanes>(self, token: L::Token) -> Self::Output;
}

/// Does the work with the lanes of `arch`.
pub(crate) fn dispatch<W: OverLanes>(arch: Arch, work: W) -> W::Output {
    arch.dispatch(Dispatched(work))
}

struct Dispatched<W>(W);

impl<W: OverLanes> WithSimd for Dispatched<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        if S::IS_SCALAR
            && let Some(baseline) = pulp::x86::V1::try_new()
        {
            return self.0.over::<crate::pair::Pair>(baseline);
        }
        self.0.over::<Wide<S>>(simd)
    }
}

/// As many numbers as a vector of the machine holds.
#[derive(Clone, Copy)]
pub(crate) struct Wide<S: Simd> {
    simd: S,
    lanes: S::f64s,
}

impl<S: Simd> Wide<S> {
    #[inline(always)]
    fn with(self, lanes: S::f64s) -> Self {
        Self { lanes, ..self }
    }
}

macro_rules! operator {
    ($operator:ident, $name:ident, $of_lanes:ident) => {
        impl<S: Simd> $operator for Wide<S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, o: Self) -> Self {
                self.with(self.simd.$of_lanes(self.lanes, o.lanes))
            }
        }
    };
}
operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Mul<f64> for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * self.constant(factor)
    }
}

impl<S: Simd> Number for Wide<S> {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        self.with(self.simd.splat_f64s(value))
    }
}

impl<S: Simd> Lanes for Wide<S> {
    type Token = S;
    type Stored = S::f64s;
    type Mask = S::m64s;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        let lanes = simd.splat_f64s(0.0);
        Self { simd, lanes }
    }

    #[inline(always)]
    fn load(simd: S, stored: &S::f64s) -> Self {
        let lanes = *stored;
        Self { simd, lanes }
    }

    #[inline(always)]
    fn store(self) -> S::f64s {
        self.lanes
    }

    #[inline(always)]
    fn token(self) -> S {
        self.simd
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self.simd.sqrt_f64s(self.lanes))
    }

    #[inline(always)]
    fn at_most(self, others: Self) -> S::m64s {
        self.simd.less_than_or_equal_f64s(self.lanes, others.lanes)
    }

    #[inline(always)]
    fn is_zero(self) -> S::m64s {
        self.simd.equal_f64s(self.lanes, self.simd.splat_f64s(0.0))
    }

    #[inline(always)]
    fn select(self, mask: S::m64s, others: Self) -> Self {
        self.with(self.simd.select_f64s(mask, self.lanes, others.lanes))
    }

    #[inline(always)]
    fn either(self, one: S::m64s, other: S::m64s) -> S::m64s {
        self.simd.or_m64s(one, other)
    }

    #[inline(always)]
    fn both(self, one: S::m64s, other: S::m64s) -> S::m64s {
        self.simd.and_m64s(one, other)
    }

    #[inline(always)]
    fn everywhere(self, mask: S::m64s) -> bool {
        self.simd.first_true_m64s(self.simd.not_m64s(mask)) == S::F64_LANES
    }

    #[inline(always)]
    fn rotated(self) -> Self {
        self.with(self.simd.rotate_right_f64s(self.lanes, 1))
    }

    #[inline(always)]
    fn with_first_of(self, others: Self) -> Self {
        others.select(self.simd.mask_between_m64s(0, 1).mask(), self)
    }
}
