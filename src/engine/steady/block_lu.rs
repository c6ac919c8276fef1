//! LU factors of sparse matrices whose entries are 6x6 blocks, one row and one column of blocks a station.
//!
//! Stations are eliminated by least degree: a rod from its ends inwards, what joints gather (platforms) last, so a rod
//! costs time in proportion to its elements and any topology of joints works. Columns are exchanged within a pivot only:
//! the order is found once for a pattern, and every block can be a pivot because it is what holds its station while the
//! stations after it are held.

use nalgebra::Matrix6;
use pulp::{Arch, Simd, WithSimd};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A block's edge.
const SIZE: usize = 6;

/// A column of a block.
type Column = [f64; SIZE];

/// A station that a pivot is coupled with and that is eliminated after it.
struct Neighbour {
    station: usize,
    /// Block in the pivot's row.
    across: usize,
    /// Block in the pivot's column.
    down: usize,
}

/// Pattern, blocks and, once factorised, factors `(D + L) (I + U)`, with the inverses of the pivots `D`: a product takes
/// less time than a substitution, whose steps wait for each other.
pub(super) struct BlockLu {
    /// Stations in the order of their elimination.
    order: Vec<usize>,
    /// Where each pivot's neighbours start, and where the last one's end.
    starts: Vec<usize>,
    neighbours: Vec<Neighbour>,
    /// Blocks that each pivot changes: rows by columns of its neighbours, pivot after pivot.
    updates: Vec<usize>,
    /// The diagonal, station by station, then the others.
    blocks: Vec<Matrix6<f64>>,
}

impl BlockLu {
    /// A matrix of zeros with blocks at these `(row, column)` and wherever elimination fills one in.
    pub(super) fn new(stations: usize, pattern: impl Iterator<Item = (usize, usize)>) -> Self {
        let mut near = vec![Vec::new(); stations];
        for (row, column) in pattern {
            if row != column {
                near[row].push(column);
                near[column].push(row);
            }
        }
        for near in &mut near {
            near.sort_unstable();
            near.dedup();
        }
        let (order, later) = eliminate(near);
        let mut lu = Self {
            order,
            starts: vec![0],
            neighbours: Vec::new(),
            updates: Vec::new(),
            blocks: Vec::new(),
        };
        for later in &later {
            for &station in later {
                let across = stations + 2 * lu.neighbours.len();
                lu.neighbours.push(Neighbour {
                    station,
                    across,
                    down: across + 1,
                });
            }
            lu.starts.push(lu.neighbours.len());
        }
        lu.blocks = vec![Matrix6::zeros(); stations + 2 * lu.neighbours.len()];
        let turns = lu.turns();
        for later in &later {
            for row in later {
                for column in later {
                    let slot = lu.slot(&turns, *row, *column);
                    lu.updates.push(slot);
                }
            }
        }
        lu
    }

    /// When each station is eliminated.
    fn turns(&self) -> Vec<usize> {
        let mut turns = vec![0; self.order.len()];
        for (turn, station) in self.order.iter().enumerate() {
            turns[*station] = turn;
        }
        turns
    }

    /// Where the block of a row and a column of the pattern is kept.
    fn slot(&self, turns: &[usize], row: usize, column: usize) -> usize {
        if row == column {
            return row;
        }
        let first = turns[row].min(turns[column]);
        let later = if turns[row] == first { column } else { row };
        let neighbours = &self.neighbours[self.starts[first]..self.starts[first + 1]];
        let at = neighbours.partition_point(|n| n.station < later);
        if later == column {
            neighbours[at].across
        } else {
            neighbours[at].down
        }
    }

    /// Where blocks of the pattern are kept, for [`BlockLu::blocks_mut`].
    pub(super) fn slots(&self, pattern: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
        let turns = self.turns();
        pattern.map(|(r, c)| self.slot(&turns, r, c)).collect()
    }

    /// The blocks, to be filled with a matrix before [`BlockLu::factorise`] overwrites it.
    pub(super) fn blocks_mut(&mut self) -> &mut [Matrix6<f64>] {
        &mut self.blocks
    }

    /// Replaces the matrix by its factors. A singular one gives factors that aren't finite.
    pub(super) fn factorise(&mut self) {
        let mut blocks = std::mem::take(&mut self.blocks);
        let mut updates = self.updates.iter();
        for (pivot, neighbours) in self.pivots() {
            let inverse = inverse(blocks[pivot].data.0);
            blocks[pivot].data.0 = inverse;
            for n in neighbours {
                for column in &mut blocks[n.across].data.0 {
                    *column = product(&inverse, column);
                }
            }
            for row in neighbours {
                let left = blocks[row.down].data.0;
                for (column, update) in neighbours.iter().zip(&mut updates) {
                    let right = blocks[column.across].data.0;
                    for (c, b) in blocks[*update].data.0.iter_mut().zip(&right) {
                        subtract(c, &product(&left, b));
                    }
                }
            }
        }
        self.blocks = blocks;
    }

    /// Solves in place with the factors; `false` if the result isn't finite (a singular matrix).
    pub(super) fn solve(&self, side: &mut [f64]) -> bool {
        Arch::new().dispatch(Solve(self, side.as_chunks_mut().0));
        side.iter().all(|v| v.is_finite())
    }

    /// The pivots in the order of their elimination, and their neighbours.
    #[inline(always)]
    fn pivots(&self) -> impl DoubleEndedIterator<Item = (usize, &[Neighbour])> {
        let ranges = self.starts.windows(2).map(|w| &self.neighbours[w[0]..w[1]]);
        self.order.iter().copied().zip(ranges)
    }
}

/// [`BlockLu::solve`], compiled for the machine's vectors.
struct Solve<'a>(&'a BlockLu, &'a mut [Column]);

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(lu, side) = self;
        for (pivot, neighbours) in lu.pivots() {
            let own = product(&lu.blocks[pivot].data.0, &side[pivot]);
            side[pivot] = own;
            for n in neighbours {
                let down = product(&lu.blocks[n.down].data.0, &own);
                subtract(&mut side[n.station], &down);
            }
        }
        for (pivot, neighbours) in lu.pivots().rev() {
            let mut own = side[pivot];
            for n in neighbours {
                let across = product(&lu.blocks[n.across].data.0, &side[n.station]);
                subtract(&mut own, &across);
            }
            side[pivot] = own;
        }
    }
}

/// Order of elimination by least degree, and the stations that each one is coupled with when it is eliminated.
fn eliminate(mut near: Vec<Vec<usize>>) -> (Vec<usize>, Vec<Vec<usize>>) {
    let degrees = near.iter().enumerate();
    let mut queue: BinaryHeap<_> = degrees.map(|(s, near)| Reverse((near.len(), s))).collect();
    let (mut order, mut later) = (Vec::new(), Vec::new());
    let mut gone = vec![false; near.len()];
    while let Some(Reverse((degree, station))) = queue.pop() {
        if gone[station] || degree != near[station].len() {
            continue; // another entry has its present degree
        }
        gone[station] = true;
        let own = std::mem::take(&mut near[station]);
        for &other in &own {
            let theirs = &mut near[other];
            let degree = theirs.len();
            theirs.extend(&own);
            theirs.sort_unstable();
            theirs.dedup();
            theirs.retain(|s| *s != other && *s != station);
            if theirs.len() != degree {
                queue.push(Reverse((theirs.len(), other)));
            }
        }
        order.push(station);
        later.push(own);
    }
    (order, later)
}

/// Inverse of a block, column by column (Gauss-Jordan). A singular one gives what isn't finite.
#[inline(always)]
fn inverse(mut a: [Column; SIZE]) -> [Column; SIZE] {
    let mut b = Matrix6::identity().data.0;
    for k in 0..SIZE {
        let mut best = k;
        for j in k + 1..SIZE {
            if a[j][k].abs() > a[best][k].abs() {
                best = j;
            }
        }
        let pivot = 1.0 / a[best][k];
        for side in [&mut a, &mut b] {
            side.swap(k, best);
            side[k] = side[k].map(|v| v * pivot);
        }
        let pivots = (a[k], b[k]);
        for j in (0..SIZE).filter(|j| *j != k) {
            let factor = a[j][k];
            subtract(&mut a[j], &pivots.0.map(|v| v * factor));
            subtract(&mut b[j], &pivots.1.map(|v| v * factor));
        }
    }
    b
}

/// A block times a column.
#[inline(always)]
fn product(a: &[Column; SIZE], x: &Column) -> Column {
    let mut y = [0.0; SIZE];
    for (a, x) in a.iter().zip(x) {
        for i in 0..SIZE {
            y[i] += a[i] * x;
        }
    }
    y
}

/// `y -= x`.
#[inline(always)]
fn subtract(y: &mut Column, x: &Column) {
    for i in 0..SIZE {
        y[i] -= x[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// Two chains of reach two whose ends meet at one station, a closed loop, and an isolated station.
    fn pattern() -> Vec<(usize, usize)> {
        let mut pairs: Vec<(usize, usize)> = Vec::new();
        for chain in [0..7_usize, 7..13] {
            for a in chain.clone() {
                pairs.extend(chain.clone().filter(|b| b.abs_diff(a) <= 2).map(|b| (a, b)));
            }
        }
        pairs.push((13, 13));
        for meets in [[6, 13], [12, 13], [0, 7], [14, 14]] {
            pairs.extend([(meets[0], meets[1]), (meets[1], meets[0])]);
        }
        pairs
    }

    #[test]
    fn solutions_are_those_of_the_dense_matrix() {
        let (stations, pattern) = (15, pattern());
        let mut lu = BlockLu::new(stations, pattern.iter().copied());
        let slots = lu.slots(pattern.iter().copied());
        let size = stations * SIZE;
        let mut dense = DMatrix::<f64>::zeros(size, size);
        for (at, ((row, column), slot)) in pattern.iter().zip(&slots).enumerate() {
            // no entry of a diagonal block is large where it would do without exchanges
            let block = Matrix6::from_fn(|i, j| {
                let seed = (at * 36 + i * 6 + j) as f64;
                let large = row == column && (i + 3) % SIZE == j;
                (seed * 12.9898).sin() + if large { 9.0 } else { 0.0 }
            });
            lu.blocks_mut()[*slot] += block;
            let mut view = dense.fixed_view_mut::<6, 6>(row * SIZE, column * SIZE);
            view += block;
        }
        let side = DVector::from_fn(size, |i, _| (i as f64).cos());
        lu.factorise();
        let mut x = side.clone();
        assert!(lu.solve(x.as_mut_slice()));
        let left = (&dense * &x - &side).amax();
        assert!(left < 1e-11, "{left:e}");
    }

    #[test]
    fn a_rod_fills_in_nothing_beyond_its_band() {
        let reach = 2;
        let pairs =
            |n: usize| (0..n).flat_map(move |a| (a..n.min(a + reach + 1)).map(move |b| (a, b)));
        for stations in [100, 1000] {
            let lu = BlockLu::new(stations, pairs(stations));
            assert_eq!(lu.neighbours.len(), reach * stations - 3);
        }
    }

    #[test]
    fn a_singular_matrix_is_told() {
        let mut lu = BlockLu::new(1, std::iter::once((0, 0)));
        lu.factorise();
        assert!(!lu.solve(&mut [1.0; SIZE]));
    }
}
