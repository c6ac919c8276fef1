//! Blocks of eight stations, and the vectors and matrices of one of them.
//!
//! A loop over the lanes of a block with plain numbers in it is what the compiler makes vector instructions of, provided
//! that nothing in it stays a call. Hence these two types: what nalgebra offers needn't be inlined.

use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, Mul, Sub};

/// Stations in a block.
pub(crate) const LANES: usize = 8;

/// A number of each station of a block.
pub(crate) type Lanes = [f64; LANES];

/// Zero for each station.
pub(crate) const ZERO: Lanes = [0.0; LANES];

/// Neighbouring blocks.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    pub(crate) start: usize,
    pub(crate) count: usize,
}

impl Span {
    /// These and the block after them.
    #[inline(always)]
    pub(crate) fn and_next(self) -> Self {
        let count = self.count + 1;
        Self { count, ..self }
    }
}

/// Three numbers.
#[derive(Clone, Copy)]
pub(crate) struct Triple {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) z: f64,
}

#[inline(always)]
pub(crate) fn triple(x: f64, y: f64, z: f64) -> Triple {
    Triple { x, y, z }
}

impl Triple {
    #[inline(always)]
    pub(crate) fn dot(self, o: Self) -> f64 {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    #[inline(always)]
    pub(crate) fn squared(self) -> f64 {
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

    /// This where `exists`, else zero.
    #[inline(always)]
    pub(crate) fn only_if(self, exists: bool) -> Self {
        let keep = |v| if exists { v } else { 0.0 };
        triple(keep(self.x), keep(self.y), keep(self.z))
    }
}

impl Add for Triple {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        triple(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl Sub for Triple {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        triple(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl Mul<f64> for Triple {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
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
pub(crate) struct Rows(pub(crate) [Triple; 3]);

impl Rows {
    /// The matrix times a vector.
    #[inline(always)]
    pub(crate) fn times(&self, v: Triple) -> Triple {
        let [a, b, c] = self.0;
        triple(a.dot(v), b.dot(v), c.dot(v))
    }

    /// The transposed matrix times a vector.
    #[inline(always)]
    pub(crate) fn transposed_times(&self, v: Triple) -> Triple {
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

/// A vector of each station of a block, where it is stored: a copy of many blocks would be a call.
#[derive(Clone, Copy)]
pub(crate) struct VectorLanes<'a>([&'a Lanes; 3]);

impl VectorLanes<'_> {
    /// Vector of lane `l`.
    #[inline(always)]
    pub(crate) fn get(self, l: usize) -> Triple {
        let [x, y, z] = self.0;
        triple(x[l], y[l], z[l])
    }
}

/// A matrix of each station of a block, where it is stored.
#[derive(Clone, Copy)]
pub(crate) struct MatrixLanes<'a>([VectorLanes<'a>; 3]);

impl MatrixLanes<'_> {
    /// Matrix of lane `l`.
    #[inline(always)]
    pub(crate) fn get(self, l: usize) -> Rows {
        let [a, b, c] = self.0;
        Rows([a.get(l), b.get(l), c.get(l)])
    }
}

/// A vector of each station of a block, computed.
pub(crate) struct Vector([Lanes; 3]);

impl Vector {
    pub(crate) const ZERO: Self = Self([ZERO; 3]);

    /// Replaces the vector of lane `l`.
    #[inline(always)]
    pub(crate) fn set(&mut self, l: usize, v: Triple) {
        let [x, y, z] = &mut self.0;
        (x[l], y[l], z[l]) = (v.x, v.y, v.z);
    }
}

/// A matrix of each station of a block, computed.
pub(crate) struct Matrix([Vector; 3]);

impl Matrix {
    pub(crate) const ZERO: Self = Self([Vector::ZERO; 3]);

    /// Replaces the matrix of lane `l`.
    #[inline(always)]
    pub(crate) fn set(&mut self, l: usize, m: &Rows) {
        let ([a, b, c], rows) = (&mut self.0, m.0);
        a.set(l, rows[0]);
        b.set(l, rows[1]);
        c.set(l, rows[2]);
    }
}

/// Vectors by blocks.
#[derive(Clone, Copy)]
pub(crate) struct VectorBlocks<'a>(pub(crate) [&'a [Lanes]; 3]);

impl<'a> VectorBlocks<'a> {
    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> VectorLanes<'a> {
        let [x, y, z] = self.0;
        VectorLanes([&x[b], &y[b], &z[b]])
    }
}

/// The stations after those of block `b`.
#[inline(always)]
fn after(blocks: &[Lanes], b: usize) -> &Lanes {
    let pair = blocks[b..b + 2].as_flattened();
    pair[1..].first_chunk().expect("two blocks hold one more")
}

/// Vectors by blocks, to be changed.
pub(crate) struct VectorBlocksMut<'a>(pub(crate) [&'a mut [Lanes]; 3]);

impl VectorBlocksMut<'_> {
    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> VectorLanes<'_> {
        let [x, y, z] = &self.0;
        VectorLanes([&x[b], &y[b], &z[b]])
    }

    /// The stations after those of block `b`.
    #[inline(always)]
    pub(crate) fn after(&self, b: usize) -> VectorLanes<'_> {
        let [x, y, z] = &self.0;
        VectorLanes([after(x, b), after(y, b), after(z, b)])
    }

    /// Replaces block `b`.
    #[inline(always)]
    pub(crate) fn set(&mut self, b: usize, v: &Vector) {
        let ([x, y, z], [new_x, new_y, new_z]) = (&mut self.0, &v.0);
        x[b] = *new_x;
        y[b] = *new_y;
        z[b] = *new_z;
    }
}

/// Matrices by blocks.
#[derive(Clone, Copy)]
pub(crate) struct MatrixBlocks<'a>(pub(crate) [VectorBlocks<'a>; 3]);

impl<'a> MatrixBlocks<'a> {
    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> MatrixLanes<'a> {
        let [x, y, z] = &self.0;
        MatrixLanes([x.at(b), y.at(b), z.at(b)])
    }
}

/// Matrices by blocks, to be changed.
pub(crate) struct MatrixBlocksMut<'a>(pub(crate) [VectorBlocksMut<'a>; 3]);

impl MatrixBlocksMut<'_> {
    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> MatrixLanes<'_> {
        let [x, y, z] = &self.0;
        MatrixLanes([x.at(b), y.at(b), z.at(b)])
    }

    /// Replaces block `b`.
    #[inline(always)]
    pub(crate) fn set(&mut self, b: usize, m: &Matrix) {
        let ([x, y, z], [new_x, new_y, new_z]) = (&mut self.0, &m.0);
        x.set(b, new_x);
        y.set(b, new_y);
        z.set(b, new_z);
    }
}
