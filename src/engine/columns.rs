//! Arrays as passes go over them: block after block of as many stations as are computed together.

use crate::number::Lanes;
use crate::triple::{Rows, Triple, triple};
use pulp::bytemuck::{cast_slice, cast_slice_mut};

/// How far passes go.
#[derive(Clone, Copy)]
pub(crate) struct Extent<L: Lanes> {
    token: L::Token,
    /// Blocks that take in all stations and one after them.
    pub(crate) count: usize,
}

impl<L: Lanes> Extent<L> {
    #[inline(always)]
    pub(crate) fn new(token: L::Token, stations: usize) -> Self {
        let count = stations / L::COUNT + 1;
        Self { token, count }
    }

    /// One block more.
    #[inline(always)]
    pub(crate) fn and_next(self) -> Self {
        let count = self.count + 1;
        Self { count, ..self }
    }

    /// Zero everywhere.
    #[inline(always)]
    pub(crate) fn zero(self) -> L {
        L::zero(self.token)
    }
}

/// Numbers by blocks.
#[derive(Clone, Copy)]
pub(crate) struct Column<'a, L: Lanes> {
    token: L::Token,
    blocks: &'a [L::Stored],
}

impl<'a, L: Lanes> Column<'a, L> {
    /// Blocks of an array from its first number on.
    #[inline(always)]
    pub(crate) fn new(Extent { token, count }: Extent<L>, numbers: &'a [f64]) -> Self {
        let blocks = &cast_slice(&numbers[..count * L::COUNT])[..count];
        Self { token, blocks }
    }

    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> L {
        L::load(self.token, &self.blocks[b])
    }
}

/// Numbers by blocks, to be changed.
pub(crate) struct ColumnMut<'a, L: Lanes> {
    token: L::Token,
    blocks: &'a mut [L::Stored],
}

impl<'a, L: Lanes> ColumnMut<'a, L> {
    /// Blocks of an array from its first number on.
    #[inline(always)]
    pub(crate) fn new(Extent { token, count }: Extent<L>, numbers: &'a mut [f64]) -> Self {
        let blocks = &mut cast_slice_mut(&mut numbers[..count * L::COUNT])[..count];
        Self { token, blocks }
    }

    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> L {
        L::load(self.token, &self.blocks[b])
    }

    /// The stations after those of block `b`.
    #[inline(always)]
    pub(crate) fn after(&self, b: usize) -> L {
        let pair: &[f64] = cast_slice(&self.blocks[b..b + 2]);
        L::load(self.token, &cast_slice(&pair[1..=L::COUNT])[0])
    }

    /// Replaces block `b`.
    #[inline(always)]
    pub(crate) fn set(&mut self, b: usize, numbers: L) {
        self.blocks[b] = numbers.store();
    }
}

/// Vectors by blocks.
#[derive(Clone, Copy)]
pub(crate) struct Columns<'a, L: Lanes>(pub(crate) [Column<'a, L>; 3]);

impl<L: Lanes> Columns<'_, L> {
    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> Triple<L> {
        let [x, y, z] = &self.0;
        triple(x.at(b), y.at(b), z.at(b))
    }
}

/// Vectors by blocks, to be changed.
pub(crate) struct ColumnsMut<'a, L: Lanes>(pub(crate) [ColumnMut<'a, L>; 3]);

impl<L: Lanes> ColumnsMut<'_, L> {
    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> Triple<L> {
        let [x, y, z] = &self.0;
        triple(x.at(b), y.at(b), z.at(b))
    }

    /// The stations after those of block `b`.
    #[inline(always)]
    pub(crate) fn after(&self, b: usize) -> Triple<L> {
        let [x, y, z] = &self.0;
        triple(x.after(b), y.after(b), z.after(b))
    }

    /// Replaces block `b`.
    #[inline(always)]
    pub(crate) fn set(&mut self, b: usize, v: Triple<L>) {
        let [x, y, z] = &mut self.0;
        x.set(b, v.x);
        y.set(b, v.y);
        z.set(b, v.z);
    }
}

/// Matrices by blocks.
#[derive(Clone, Copy)]
pub(crate) struct RowColumns<'a, L: Lanes>(pub(crate) [Columns<'a, L>; 3]);

impl<L: Lanes> RowColumns<'_, L> {
    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> Rows<L> {
        let [first, second, third] = &self.0;
        Rows([first.at(b), second.at(b), third.at(b)])
    }
}

/// Matrices by blocks, to be changed.
pub(crate) struct RowColumnsMut<'a, L: Lanes>(pub(crate) [ColumnsMut<'a, L>; 3]);

impl<L: Lanes> RowColumnsMut<'_, L> {
    /// Block `b`.
    #[inline(always)]
    pub(crate) fn at(&self, b: usize) -> Rows<L> {
        let [first, second, third] = &self.0;
        Rows([first.at(b), second.at(b), third.at(b)])
    }

    /// Replaces block `b`.
    #[inline(always)]
    pub(crate) fn set(&mut self, b: usize, m: &Rows<L>) {
        let ([first, second, third], rows) = (&mut self.0, &m.0);
        first.set(b, rows[0]);
        second.set(b, rows[1]);
        third.set(b, rows[2]);
    }
}
