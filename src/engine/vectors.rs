//! Numbers, 3-vectors and 3x3 matrices, one a station: flat arrays that are read one by one or eight stations at once.
//!
//! Arrays begin with an entry or more before the first station and end with some after the last, so that blocks of
//! stations and their neighbours can be read everywhere.

use crate::columns::{Column, ColumnMut, Columns, ColumnsMut, Extent, RowColumns, RowColumnsMut};
use crate::number::Lanes;
use nalgebra::{Matrix3, Vector3};
use std::ops::{Index, IndexMut, Range};

/// Numbers, one a station.
#[derive(Debug, Default)]
pub struct Scalars {
    /// At least a zero, the numbers, and the last of them again up to the end of the block after the one that holds the
    /// station after theirs.
    padded: Vec<f64>,
    /// Where the first number is: at the start of a cache line, since blocks across two of them are slow.
    first: usize,
    len: usize,
}

/// Numbers in a cache line, and in the longest blocks.
const LANES: usize = 8;
/// Bytes of a cache line.
const LINE: usize = LANES * size_of::<f64>();

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
        let blocks = (self.len + 1) / LANES + 2;
        // An odd number of lines, lest arrays that are allocated one after the other share their places in the cache.
        let lines = (1 + blocks) | 1;
        self.padded.resize(lines * LANES, 0.0);
        self.align();
        self.len += 1;
        self.padded[self.first + self.len - 1..].fill(value);
    }

    /// Moves all to where the first number begins a cache line.
    fn align(&mut self) {
        let first = 1 + self.padded[1..].as_ptr().align_offset(LINE).min(LANES - 1);
        self.padded
            .copy_within(self.first..self.first + self.len, first);
        self.padded[..first].fill(0.0);
        self.first = first;
        if let Some(last) = self.as_slice().last().copied() {
            self.padded[first + self.len..].fill(last);
        }
    }

    /// The numbers.
    #[inline]
    pub fn as_slice(&self) -> &[f64] {
        let range = self.first..self.first + self.len;
        self.padded.get(range).unwrap_or_default()
    }

    /// The numbers.
    #[inline]
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        let range = self.first..self.first + self.len;
        self.padded.get_mut(range).unwrap_or_default()
    }

    /// Becomes the same as `other`, without allocating if it has its size.
    pub fn copy_from(&mut self, other: &Self) {
        if self.len != other.len {
            *self = other.clone();
        }
        let used = self.padded.len().saturating_sub(LANES);
        self.padded[self.first..][..used].copy_from_slice(&other.padded[other.first..][..used]);
    }

    /// The blocks.
    #[inline(always)]
    pub(crate) fn blocks<L: Lanes>(&self, all: Extent<L>) -> Column<'_, L> {
        Column::new(all, &self.padded[self.first..])
    }

    /// The stations before those of [`Scalars::blocks`].
    #[inline(always)]
    pub(crate) fn before<L: Lanes>(&self, all: Extent<L>) -> Column<'_, L> {
        Column::new(all, &self.padded[self.first - 1..])
    }

    /// The stations after those of [`Scalars::blocks`].
    #[inline(always)]
    pub(crate) fn after<L: Lanes>(&self, all: Extent<L>) -> Column<'_, L> {
        Column::new(all, &self.padded[self.first + 1..])
    }

    /// The blocks, to be changed.
    #[inline(always)]
    pub(crate) fn blocks_mut<L: Lanes>(&mut self, all: Extent<L>) -> ColumnMut<'_, L> {
        ColumnMut::new(all, &mut self.padded[self.first..])
    }

    /// The stations before those of [`Scalars::blocks`], to be changed.
    #[inline(always)]
    pub(crate) fn before_mut<L: Lanes>(&mut self, all: Extent<L>) -> ColumnMut<'_, L> {
        ColumnMut::new(all, &mut self.padded[self.first - 1..])
    }
}

impl Clone for Scalars {
    fn clone(&self) -> Self {
        let mut clone = Self {
            padded: self.padded.clone(),
            first: self.first,
            len: self.len,
        };
        if !clone.is_empty() {
            clone.align();
        }
        clone
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
        &self.padded[self.first + i]
    }
}

impl IndexMut<usize> for Scalars {
    #[inline]
    fn index_mut(&mut self, i: usize) -> &mut f64 {
        &mut self.padded[self.first + i]
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

    /// Multiplies every vector.
    pub fn scale(&mut self, by: f64) {
        for component in &mut self.components {
            component.as_mut_slice().iter_mut().for_each(|v| *v *= by);
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
        let [x, y, z] = &self.components;
        [
            &x.as_slice()[range.clone()],
            &y.as_slice()[range.clone()],
            &z.as_slice()[range],
        ]
    }

    /// The components of the vectors `range`, each one slice.
    #[inline]
    pub fn slices_mut(&mut self, range: Range<usize>) -> [&mut [f64]; 3] {
        let [x, y, z] = &mut self.components;
        [
            &mut x.as_mut_slice()[range.clone()],
            &mut y.as_mut_slice()[range.clone()],
            &mut z.as_mut_slice()[range],
        ]
    }

    /// Whether every number is finite. A sum is enough: an infinity or a NaN survives it.
    pub fn all_finite(&self) -> bool {
        let sum = |c: &Scalars| c.as_slice().iter().map(|v| v * 0.0).sum::<f64>();
        self.components.iter().map(sum).sum::<f64>() == 0.0
    }

    /// The blocks.
    #[inline(always)]
    pub(crate) fn blocks<L: Lanes>(&self, all: Extent<L>) -> Columns<'_, L> {
        let [x, y, z] = &self.components;
        Columns([x.blocks(all), y.blocks(all), z.blocks(all)])
    }

    /// The stations before those of [`Vectors::blocks`].
    #[inline(always)]
    pub(crate) fn before<L: Lanes>(&self, all: Extent<L>) -> Columns<'_, L> {
        let [x, y, z] = &self.components;
        Columns([x.before(all), y.before(all), z.before(all)])
    }

    /// The stations after those of [`Vectors::blocks`].
    #[inline(always)]
    pub(crate) fn after<L: Lanes>(&self, all: Extent<L>) -> Columns<'_, L> {
        let [x, y, z] = &self.components;
        Columns([x.after(all), y.after(all), z.after(all)])
    }

    /// The blocks, to be changed.
    #[inline(always)]
    pub(crate) fn blocks_mut<L: Lanes>(&mut self, all: Extent<L>) -> ColumnsMut<'_, L> {
        let [x, y, z] = &mut self.components;
        ColumnsMut([x.blocks_mut(all), y.blocks_mut(all), z.blocks_mut(all)])
    }

    /// The stations before those of [`Vectors::blocks`], to be changed.
    #[inline(always)]
    pub(crate) fn before_mut<L: Lanes>(&mut self, all: Extent<L>) -> ColumnsMut<'_, L> {
        let [x, y, z] = &mut self.components;
        ColumnsMut([x.before_mut(all), y.before_mut(all), z.before_mut(all)])
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
    #[inline(always)]
    pub fn get(&self, i: usize) -> Matrix3<f64> {
        let [a, b, c] = &self.rows;
        let (a, b, c) = (a.get(i), b.get(i), c.get(i));
        Matrix3::new(a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z)
    }

    /// Replaces matrix `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, m: Matrix3<f64>) {
        let [a, b, c] = &mut self.rows;
        a.set(i, Vector3::new(m.m11, m.m12, m.m13));
        b.set(i, Vector3::new(m.m21, m.m22, m.m23));
        c.set(i, Vector3::new(m.m31, m.m32, m.m33));
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

    /// The blocks.
    #[inline(always)]
    pub(crate) fn blocks<L: Lanes>(&self, all: Extent<L>) -> RowColumns<'_, L> {
        let [a, b, c] = &self.rows;
        RowColumns([a.blocks(all), b.blocks(all), c.blocks(all)])
    }

    /// The stations before those of [`Matrices::blocks`].
    #[inline(always)]
    pub(crate) fn before<L: Lanes>(&self, all: Extent<L>) -> RowColumns<'_, L> {
        let [a, b, c] = &self.rows;
        RowColumns([a.before(all), b.before(all), c.before(all)])
    }

    /// The blocks, to be changed.
    #[inline(always)]
    pub(crate) fn blocks_mut<L: Lanes>(&mut self, all: Extent<L>) -> RowColumnsMut<'_, L> {
        let [a, b, c] = &mut self.rows;
        RowColumnsMut([a.blocks_mut(all), b.blocks_mut(all), c.blocks_mut(all)])
    }
}
