//! LU factors of sparse matrices whose entries are 6x6 blocks, one row and one column of blocks a station.
//!
//! Stations are eliminated by least degree: a rod from its ends inwards, what joints gather (platforms) last, so a rod
//! costs time in proportion to its elements and any topology of joints works. Rows are exchanged within a block only:
//! the order is found once for a pattern, and every block can be a pivot because it is what holds its station while the
//! stations after it are held.

use nalgebra::{Matrix6, Vector6};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A block's edge.
const SIZE: usize = 6;

/// A station that a pivot is coupled with and that is eliminated after it.
struct Neighbour {
    station: usize,
    /// Block in the pivot's row.
    across: usize,
    /// Block in the pivot's column.
    down: usize,
}

/// Pattern, blocks and, once factorised, factors `(D + L) (I + U)`, with `D` the pivots.
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
    /// Exchanges of rows within each pivot.
    exchanges: Vec<[u8; SIZE]>,
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
            exchanges: vec![[0; SIZE]; stations],
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
        let mut updates = self.updates.iter();
        for (turn, pivot) in self.order.iter().enumerate() {
            let neighbours = &self.neighbours[self.starts[turn]..self.starts[turn + 1]];
            let mut factors = self.blocks[*pivot];
            self.exchanges[*pivot] = lu(&mut factors);
            self.blocks[*pivot] = factors;
            for n in neighbours {
                solve_block(
                    &factors,
                    &self.exchanges[*pivot],
                    &mut self.blocks[n.across],
                );
            }
            for row in neighbours {
                let left = self.blocks[row.down];
                for (column, update) in neighbours.iter().zip(&mut updates) {
                    let right = self.blocks[column.across];
                    subtract_product(&mut self.blocks[*update], &left, &right);
                }
            }
        }
    }

    /// Solves in place with the factors; `false` if the result isn't finite (a singular matrix).
    pub(super) fn solve(&self, side: &mut [f64]) -> bool {
        let at = |station: usize| station * SIZE..(station + 1) * SIZE;
        for (turn, pivot) in self.order.iter().enumerate() {
            let mut own = Vector6::from_column_slice(&side[at(*pivot)]);
            solve_column(&self.blocks[*pivot], &self.exchanges[*pivot], &mut own);
            side[at(*pivot)].copy_from_slice(own.as_slice());
            for n in &self.neighbours[self.starts[turn]..self.starts[turn + 1]] {
                subtract_column(&mut side[at(n.station)], &self.blocks[n.down], &own);
            }
        }
        for (turn, pivot) in self.order.iter().enumerate().rev() {
            for n in &self.neighbours[self.starts[turn]..self.starts[turn + 1]] {
                let other = Vector6::from_column_slice(&side[at(n.station)]);
                subtract_column(&mut side[at(*pivot)], &self.blocks[n.across], &other);
            }
        }
        side.iter().all(|v| v.is_finite())
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

/// LU factors in place, with unit lower diagonal; returns which row each row was exchanged with.
fn lu(a: &mut Matrix6<f64>) -> [u8; SIZE] {
    let mut exchanges = [0; SIZE];
    for j in 0..SIZE {
        let mut best = j;
        for i in j + 1..SIZE {
            if a[(i, j)].abs() > a[(best, j)].abs() {
                best = i;
            }
        }
        exchanges[j] = best as u8;
        a.swap_rows(j, best);
        let inverse = 1.0 / a[(j, j)];
        for i in j + 1..SIZE {
            a[(i, j)] *= inverse;
        }
        for k in j + 1..SIZE {
            let factor = a[(j, k)];
            for i in j + 1..SIZE {
                a[(i, k)] -= a[(i, j)] * factor;
            }
        }
    }
    exchanges
}

/// Solves for one column with the factors of [`lu`].
#[inline]
fn solve_column(lu: &Matrix6<f64>, exchanges: &[u8; SIZE], x: &mut Vector6<f64>) {
    for (j, other) in exchanges.iter().enumerate() {
        x.swap_rows(j, usize::from(*other));
    }
    for j in 0..SIZE {
        for i in j + 1..SIZE {
            x[i] -= lu[(i, j)] * x[j];
        }
    }
    for j in (0..SIZE).rev() {
        x[j] /= lu[(j, j)];
        for i in 0..j {
            x[i] -= lu[(i, j)] * x[j];
        }
    }
}

/// Solves for the columns of a block.
fn solve_block(lu: &Matrix6<f64>, exchanges: &[u8; SIZE], block: &mut Matrix6<f64>) {
    // transposed, so that the inner loops run over all columns at once
    let mut x = block.transpose();
    for (j, other) in exchanges.iter().enumerate() {
        x.swap_columns(j, usize::from(*other));
    }
    let subtract = |x: &mut Matrix6<f64>, i: usize, j: usize| {
        let factor = lu[(i, j)];
        for c in 0..SIZE {
            x[(c, i)] -= factor * x[(c, j)];
        }
    };
    for j in 0..SIZE {
        for i in j + 1..SIZE {
            subtract(&mut x, i, j);
        }
    }
    for j in (0..SIZE).rev() {
        let inverse = 1.0 / lu[(j, j)];
        for c in 0..SIZE {
            x[(c, j)] *= inverse;
        }
        for i in 0..j {
            subtract(&mut x, i, j);
        }
    }
    *block = x.transpose();
}

/// `c -= a b`.
#[inline]
fn subtract_product(c: &mut Matrix6<f64>, a: &Matrix6<f64>, b: &Matrix6<f64>) {
    for j in 0..SIZE {
        for k in 0..SIZE {
            let factor = b[(k, j)];
            for i in 0..SIZE {
                c[(i, j)] -= a[(i, k)] * factor;
            }
        }
    }
}

/// `y -= a x`.
#[inline]
fn subtract_column(y: &mut [f64], a: &Matrix6<f64>, x: &Vector6<f64>) {
    for j in 0..SIZE {
        for (i, y) in y.iter_mut().enumerate() {
            *y -= a[(i, j)] * x[j];
        }
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
