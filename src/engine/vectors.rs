//! Numbers, 3-vectors and 3x3 matrices, one a station: flat arrays that are read one by one or eight stations at once.
//!
//! Arrays begin with one entry before the first station and end with some after the last, so that blocks of stations
//! and their neighbours can be read everywhere.

use crate::lanes::{LANES, Lanes, MatrixLanes, VectorLanes};
use nalgebra::{Matrix3, Vector3};
use std::ops::{Index, IndexMut, Range};

/// Numbers, one a station.
#[derive(Clone, Debug, Default)]
pub struct Scalars {
    /// A zero, the numbers, and the last of them again up to the end of the block after theirs.
    padded: Vec<f64>,
    len: usize,
}

impl Scalars {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Appends a number.
    pub fn push(&mut self, value: f64) {
        self.len += 1;
        let blocks = self.len.div_ceil(LANES) + 1;
        self.padded.resize(1 + blocks * LANES, 0.0);
        self.padded[self.len..].fill(value);
    }

    /// The numbers.
    #[inline]
    pub fn as_slice(&self) -> &[f64] {
        self.padded.get(1..=self.len).unwrap_or_default()
    }

    /// The numbers.
    #[inline]
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        self.padded.get_mut(1..=self.len).unwrap_or_default()
    }

    /// Becomes the same as `other`, without allocating if it has its size.
    pub fn copy_from(&mut self, other: &Self) {
        self.padded.clone_from(&other.padded);
        self.len = other.len;
    }

    #[inline(always)]
    fn block(&self, at: usize) -> Lanes {
        *self.padded[at..]
            .first_chunk()
            .expect("arrays end after their last block")
    }

    /// Stations `k..k + LANES`.
    #[inline(always)]
    pub(crate) fn lanes(&self, k: usize) -> Lanes {
        self.block(k + 1)
    }

    /// The stations before those of [`Scalars::lanes`].
    #[inline(always)]
    pub(crate) fn before(&self, k: usize) -> Lanes {
        self.block(k)
    }

    /// The stations after those of [`Scalars::lanes`].
    #[inline(always)]
    pub(crate) fn after(&self, k: usize) -> Lanes {
        self.block(k + 2)
    }

    /// Replaces stations `k..k + LANES`.
    #[inline(always)]
    pub(crate) fn set_lanes(&mut self, k: usize, lanes: &Lanes) {
        let block = self.padded[k + 1..].first_chunk_mut();
        *block.expect("arrays end after their last block") = *lanes;
    }
}

impl PartialEq for Scalars {
    fn eq(&self, other: &Self) -> bool {
        self.as_slice() == other.as_slice()
    }
}

impl Index<usize> for Scalars {
    type Output = f64;
    #[inline]
    fn index(&self, i: usize) -> &f64 {
        &self.padded[i + 1]
    }
}

impl IndexMut<usize> for Scalars {
    #[inline]
    fn index_mut(&mut self, i: usize) -> &mut f64 {
        &mut self.padded[i + 1]
    }
}

/// 3-vectors, one a station.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vectors {
    components: [Scalars; 3],
}

impl Vectors {
    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.components[0].len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.components[0].is_empty()
    }

    /// Vector `i`.
    #[inline]
    pub fn get(&self, i: usize) -> Vector3<f64> {
        let [x, y, z] = &self.components;
        Vector3::new(x[i], y[i], z[i])
    }

    /// Replaces vector `i`.
    #[inline]
    pub fn set(&mut self, i: usize, v: Vector3<f64>) {
        let [x, y, z] = &mut self.components;
        (x[i], y[i], z[i]) = (v.x, v.y, v.z);
    }

    /// Adds `v` to vector `i`.
    #[inline]
    pub fn add(&mut self, i: usize, v: Vector3<f64>) {
        self.set(i, self.get(i) + v);
    }

    /// Appends a vector.
    pub fn push(&mut self, v: Vector3<f64>) {
        for (component, value) in self.components.iter_mut().zip(v.iter()) {
            component.push(*value);
        }
    }

    /// Sets every vector to zero.
    pub fn clear_to_zero(&mut self) {
        for component in &mut self.components {
            component.as_mut_slice().fill(0.0);
        }
    }

    /// Becomes the same as `other`, without allocating if it has its size.
    pub fn copy_from(&mut self, other: &Self) {
        for (own, others) in self.components.iter_mut().zip(&other.components) {
            own.copy_from(others);
        }
    }

    /// The components of the vectors `range`, each one slice.
    #[inline]
    pub fn slices(&self, range: Range<usize>) -> [&[f64]; 3] {
        self.components
            .each_ref()
            .map(|c| &c.as_slice()[range.clone()])
    }

    /// The components of the vectors `range`, each one slice.
    #[inline]
    pub fn slices_mut(&mut self, range: Range<usize>) -> [&mut [f64]; 3] {
        self.components
            .each_mut()
            .map(|c| &mut c.as_mut_slice()[range.clone()])
    }

    /// Whether every number is finite. A sum is enough: an infinity or a NaN survives it.
    pub fn all_finite(&self) -> bool {
        let sum = |c: &Scalars| c.as_slice().iter().map(|v| v * 0.0).sum::<f64>();
        self.components.iter().map(sum).sum::<f64>() == 0.0
    }

    /// Stations `k..k + LANES`.
    #[inline(always)]
    pub(crate) fn lanes(&self, k: usize) -> VectorLanes {
        let [x, y, z] = &self.components;
        VectorLanes([x.lanes(k), y.lanes(k), z.lanes(k)])
    }

    /// The stations before those of [`Vectors::lanes`].
    #[inline(always)]
    pub(crate) fn before(&self, k: usize) -> VectorLanes {
        let [x, y, z] = &self.components;
        VectorLanes([x.before(k), y.before(k), z.before(k)])
    }

    /// The stations after those of [`Vectors::lanes`].
    #[inline(always)]
    pub(crate) fn after(&self, k: usize) -> VectorLanes {
        let [x, y, z] = &self.components;
        VectorLanes([x.after(k), y.after(k), z.after(k)])
    }

    /// Replaces stations `k..k + LANES`.
    #[inline(always)]
    pub(crate) fn set_lanes(&mut self, k: usize, lanes: &VectorLanes) {
        let [x, y, z] = &mut self.components;
        x.set_lanes(k, &lanes.0[0]);
        y.set_lanes(k, &lanes.0[1]);
        z.set_lanes(k, &lanes.0[2]);
    }
}

/// 3x3 matrices, one a station. Directors: row `j` is director `d_j` in the world frame, so a matrix takes world
/// components to material ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matrices {
    rows: [Vectors; 3],
}

impl Matrices {
    /// Matrix `i`.
    #[inline]
    pub fn get(&self, i: usize) -> Matrix3<f64> {
        let [a, b, c] = &self.rows;
        Matrix3::from_rows(&[
            a.get(i).transpose(),
            b.get(i).transpose(),
            c.get(i).transpose(),
        ])
    }

    /// Replaces matrix `i`.
    #[inline]
    pub fn set(&mut self, i: usize, m: Matrix3<f64>) {
        for (j, row) in self.rows.iter_mut().enumerate() {
            row.set(i, m.row(j).transpose());
        }
    }

    /// Becomes the same as `other`, without allocating if it has its size.
    pub fn copy_from(&mut self, other: &Self) {
        for (own, others) in self.rows.iter_mut().zip(&other.rows) {
            own.copy_from(others);
        }
    }

    /// Appends a matrix.
    pub fn push(&mut self, m: Matrix3<f64>) {
        for (j, row) in self.rows.iter_mut().enumerate() {
            row.push(m.row(j).transpose());
        }
    }

    /// Stations `k..k + LANES`.
    #[inline(always)]
    pub(crate) fn lanes(&self, k: usize) -> MatrixLanes {
        let [a, b, c] = &self.rows;
        MatrixLanes([a.lanes(k), b.lanes(k), c.lanes(k)])
    }

    /// The stations before those of [`Matrices::lanes`].
    #[inline(always)]
    pub(crate) fn before(&self, k: usize) -> MatrixLanes {
        let [a, b, c] = &self.rows;
        MatrixLanes([a.before(k), b.before(k), c.before(k)])
    }

    /// Replaces stations `k..k + LANES`.
    #[inline(always)]
    pub(crate) fn set_lanes(&mut self, k: usize, lanes: &MatrixLanes) {
        let [a, b, c] = &mut self.rows;
        a.set_lanes(k, &lanes.0[0]);
        b.set_lanes(k, &lanes.0[1]);
        c.set_lanes(k, &lanes.0[2]);
    }
}
