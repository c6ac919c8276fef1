//! Vectors and matrices of numbers, or of several stations' numbers at once.
//!
//! Everything that lanes go through must be inlined to be made of vector instructions, and can't be a closure then.
//! What nalgebra offers needn't be.

use crate::number::{Lanes, Number};
use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, Mul, Sub};

/// Three numbers.
#[derive(Clone, Copy)]
pub(crate) struct Triple<T = f64> {
    pub(crate) x: T,
    pub(crate) y: T,
    pub(crate) z: T,
}

#[inline(always)]
pub(crate) fn triple<T>(x: T, y: T, z: T) -> Triple<T> {
    Triple { x, y, z }
}

impl<T: Number> Triple<T> {
    #[inline(always)]
    pub(crate) fn dot(self, o: Self) -> T {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    #[inline(always)]
    pub(crate) fn squared(self) -> T {
        self.dot(self)
    }

    #[inline(always)]
    pub(crate) fn cross(self, o: Self) -> Self {
        triple(
            self.y * o.z - self.z * o.y,
            self.z * o.x - self.x * o.z,
            self.x * o.y - self.y * o.x,
        )
    }

    /// Component by component.
    #[inline(always)]
    pub(crate) fn times(self, o: Self) -> Self {
        triple(self.x * o.x, self.y * o.y, self.z * o.z)
    }

    /// Every component multiplied.
    #[inline(always)]
    pub(crate) fn scaled(self, factor: f64) -> Self {
        self * self.x.constant(factor)
    }
}

impl<L: Lanes> Triple<L> {
    /// Zero where the mask holds, else this.
    #[inline(always)]
    pub(crate) fn zero_where(self, mask: L::Mask) -> Self {
        let zero = self.x.constant(0.0);
        triple(zero, zero, zero).select(mask, self)
    }

    /// This where the mask holds, else others.
    #[inline(always)]
    pub(crate) fn select(self, mask: L::Mask, others: Self) -> Self {
        triple(
            self.x.select(mask, others.x),
            self.y.select(mask, others.y),
            self.z.select(mask, others.z),
        )
    }

    /// See [`Lanes::rotated`].
    #[inline(always)]
    pub(crate) fn rotated(self) -> Self {
        triple(self.x.rotated(), self.y.rotated(), self.z.rotated())
    }

    /// See [`Lanes::with_first_of`].
    #[inline(always)]
    pub(crate) fn with_first_of(self, o: Self) -> Self {
        triple(
            self.x.with_first_of(o.x),
            self.y.with_first_of(o.y),
            self.z.with_first_of(o.z),
        )
    }

    /// The vector of one station.
    pub(crate) fn lane(self, l: usize) -> Vector3<f64> {
        Vector3::new(self.x.lane(l), self.y.lane(l), self.z.lane(l))
    }

    /// These with another vector of one station.
    pub(crate) fn with_lane(self, l: usize, v: Vector3<f64>) -> Self {
        triple(
            self.x.with_lane(l, v.x),
            self.y.with_lane(l, v.y),
            self.z.with_lane(l, v.z),
        )
    }
}

impl<T: Number> Add for Triple<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        triple(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl<T: Number> Sub for Triple<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        triple(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl<T: Number> Mul<T> for Triple<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        triple(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl From<&Vector3<f64>> for Triple {
    #[inline(always)]
    fn from(v: &Vector3<f64>) -> Self {
        triple(v[0], v[1], v[2])
    }
}

impl From<Triple> for Vector3<f64> {
    #[inline(always)]
    fn from(v: Triple) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

/// Three rows.
#[derive(Clone, Copy)]
pub(crate) struct Rows<T = f64>(pub(crate) [Triple<T>; 3]);

impl<T: Number> Rows<T> {
    /// The matrix times a vector.
    #[inline(always)]
    pub(crate) fn times(&self, v: Triple<T>) -> Triple<T> {
        let [a, b, c] = self.0;
        triple(a.dot(v), b.dot(v), c.dot(v))
    }

    /// The transposed matrix times a vector.
    #[inline(always)]
    pub(crate) fn transposed_times(&self, v: Triple<T>) -> Triple<T> {
        let [a, b, c] = self.0;
        a * v.x + b * v.y + c * v.z
    }

    /// The product with another matrix.
    #[inline(always)]
    pub(crate) fn product(&self, o: &Self) -> Self {
        let [a, b, c] = self.0;
        Self([
            o.transposed_times(a),
            o.transposed_times(b),
            o.transposed_times(c),
        ])
    }

    /// The product with another matrix, transposed.
    #[inline(always)]
    pub(crate) fn product_transposed(&self, o: &Self) -> Self {
        let [a, b, c] = self.0;
        Self([o.times(a), o.times(b), o.times(c)])
    }
}

impl<L: Lanes> Rows<L> {
    /// This where the mask holds, else others.
    #[inline(always)]
    pub(crate) fn select(&self, mask: L::Mask, others: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, others.0);
        Self([a.select(mask, x), b.select(mask, y), c.select(mask, z)])
    }

    /// The matrix of one station.
    pub(crate) fn lane(&self, l: usize) -> Matrix3<f64> {
        Matrix3::from_rows(&self.0.map(|row| row.lane(l).transpose()))
    }
}

impl From<&Matrix3<f64>> for Rows {
    #[inline(always)]
    fn from(m: &Matrix3<f64>) -> Self {
        Self([
            triple(m.m11, m.m12, m.m13),
            triple(m.m21, m.m22, m.m23),
            triple(m.m31, m.m32, m.m33),
        ])
    }
}

impl From<Rows> for Matrix3<f64> {
    #[inline(always)]
    fn from(Rows([a, b, c]): Rows) -> Self {
        Self::new(a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z)
    }
}
