//! What formulas are written in: a number, or those of several stations that are computed together.

use pulp::bytemuck::{Pod, cast_slice, cast_slice_mut};
use std::ops::{Add, Div, Mul, Sub};

/// A number, or one of each of several stations.
pub(crate) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
{
    /// A number that is the same everywhere.
    fn constant(self, value: f64) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        value
    }
}

/// Numbers of neighbouring stations: as many as the machine takes at once.
pub(crate) trait Lanes: Number {
    /// What shows that the machine has the instructions.
    type Token: Copy;
    /// How they lie in memory.
    type Stored: Pod;
    /// Some of the stations.
    type Mask: Copy;

    /// How many stations.
    const COUNT: usize = size_of::<Self::Stored>() / size_of::<f64>();

    /// Zero everywhere.
    fn zero(token: Self::Token) -> Self;
    /// Reads them.
    fn load(token: Self::Token, stored: &Self::Stored) -> Self;
    /// As they are written.
    fn store(self) -> Self::Stored;
    /// See [`Lanes::Token`].
    fn token(self) -> Self::Token;

    /// The square roots.
    fn sqrt(self) -> Self;
    /// Where they don't exceed others, both being numbers.
    fn at_most(self, others: Self) -> Self::Mask;
    /// Where they are zero.
    fn is_zero(self) -> Self::Mask;
    /// These where the mask holds, else others.
    fn select(self, mask: Self::Mask, others: Self) -> Self;
    /// Where one of two masks holds or the other.
    fn either(self, one: Self::Mask, other: Self::Mask) -> Self::Mask;
    /// Where both masks hold.
    fn both(self, one: Self::Mask, other: Self::Mask) -> Self::Mask;
    /// Whether the mask holds everywhere.
    fn everywhere(self, mask: Self::Mask) -> bool;
    /// Moved on by a station, the last to the first.
    fn rotated(self) -> Self;
    /// These but for the first station, which has that of others.
    fn with_first_of(self, others: Self) -> Self;

    /// The number of one station.
    fn lane(self, l: usize) -> f64 {
        cast_slice(&[self.store()])[l]
    }

    /// These with another number of one station.
    fn with_lane(self, l: usize, value: f64) -> Self {
        let mut stored = [self.store()];
        cast_slice_mut(&mut stored)[l] = value;
        Self::load(self.token(), &stored[0])
    }
}
