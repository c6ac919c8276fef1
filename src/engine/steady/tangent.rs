//! Derivatives of all loads with respect to all unknowns, by differences: no plugin is asked for any.
//!
//! Loads on a station depend on the stations near it on the same body, so stations far enough apart are moved at once
//! (colouring); joints are differentiated one by one. How far the dependence reaches is tested, not assumed.

use super::unknowns::{Freedom, PER_STATION, Unknowns};
use crate::inputs::Moment;
use crate::system::System;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{Argsort, Pair, SparseColMat, SymbolicSparseColMat};
use nalgebra::{Matrix6, Vector6};

/// Step of the central differences, in the unknowns' own unit. Forward ones would be too coarse for slender stiff rods:
/// their error, of the axial rigidity times the step, exceeds the bending stiffness.
const DIFFERENCE: f64 = 1e-5;

/// A 6x6 block of the matrix, by stations.
struct Block {
    row: usize,
    column: usize,
    /// Blocks of one body that are filled at once have the same colour.
    colour: usize,
}

/// The sparse tangent matrix: pattern, values, and how to fill and factorise it.
pub(super) struct Tangent {
    colours: usize,
    /// Bodies' blocks, then `joints`' blocks.
    blocks: Vec<Block>,
    of_bodies: usize,
    /// Stations that each joint depends and acts on.
    joints: Vec<Vec<usize>>,
    values: Vec<Matrix6<f64>>,
    symbolic: SymbolicSparseColMat<usize>,
    order: Argsort<usize>,
    factors: SymbolicLu<usize>,
    forth: Vec<f64>,
    back: Vec<f64>,
}

impl Tangent {
    /// The pattern for loads that depend on `reach` neighbours to each side.
    pub(super) fn new(system: &System, unknowns: &Unknowns, reach: usize) -> Result<Self, String> {
        let colours = 2 * reach + 1;
        let mut blocks = Vec::new();
        let mut first = 0;
        for layout in system.groups.iter().flat_map(|g| g.bodies.layouts()) {
            for i in 0..layout.nodes() {
                let rows = i.saturating_sub(reach)..(i + reach + 1).min(layout.nodes());
                blocks.extend(rows.map(|row| Block {
                    row: first + row,
                    column: first + i,
                    colour: i % colours,
                }));
            }
            first += layout.nodes();
        }
        let of_bodies = blocks.len();
        let joints = joint_stations(system, unknowns);
        for stations in &joints {
            for column in stations {
                blocks.extend(stations.iter().map(|row| Block {
                    row: *row,
                    column: *column,
                    colour: 0,
                }));
            }
        }
        let mut entries = Vec::with_capacity(blocks.len() * 36);
        for block in &blocks {
            for j in 0..PER_STATION {
                for i in 0..PER_STATION {
                    entries.push(Pair::new(
                        block.row * PER_STATION + i,
                        block.column * PER_STATION + j,
                    ));
                }
            }
        }
        let size = unknowns.stations * PER_STATION;
        let words = |e: &dyn std::fmt::Debug| format!("the tangent matrix can't be set up: {e:?}");
        let (symbolic, order) = SymbolicSparseColMat::try_new_from_indices(size, size, &entries)
            .map_err(|e| words(&e))?;
        let factors = SymbolicLu::try_new(symbolic.as_ref()).map_err(|e| words(&e))?;
        Ok(Self {
            colours,
            of_bodies,
            joints,
            values: vec![Matrix6::zeros(); blocks.len()],
            blocks,
            symbolic,
            order,
            factors,
            forth: vec![0.0; size],
            back: vec![0.0; size],
        })
    }

    /// Differentiates at the present state.
    pub(super) fn fill(&mut self, system: &mut System, unknowns: &Unknowns) {
        self.fill_bodies(system, unknowns);
        self.fill_joints(system, unknowns);
    }

    fn fill_bodies(&mut self, system: &mut System, unknowns: &Unknowns) {
        let System {
            groups,
            inputs,
            time,
            ..
        } = system;
        let now = Moment {
            time: *time,
            inputs,
        };
        for colour in 0..self.colours {
            for j in 0..PER_STATION {
                for (sign, loads) in [(1.0, &mut self.forth), (-1.0, &mut self.back)] {
                    let by = Vector6::ith(j, sign * DIFFERENCE);
                    for group in groups.iter_mut() {
                        let start = group.bodies.state.clone();
                        for b in 0..group.bodies.layouts().len() {
                            let layout = &group.bodies.layouts()[b];
                            let (first, nodes) = (layout.first, layout.nodes());
                            for i in (colour..nodes).step_by(self.colours) {
                                unknowns.displace(&mut group.bodies, first + i, &by);
                            }
                        }
                        group.loads(&now);
                        group.bodies.state = start;
                    }
                    unknowns.read_loads(groups, loads);
                }
                let blocks = self.blocks[..self.of_bodies].iter().zip(&mut self.values);
                for (block, value) in blocks.filter(|(block, _)| block.colour == colour) {
                    let at = block.row * PER_STATION;
                    for i in 0..PER_STATION {
                        let change = self.forth[at + i] - self.back[at + i];
                        value[(i, j)] = change / (2.0 * DIFFERENCE);
                    }
                }
            }
        }
    }

    fn fill_joints(&mut self, system: &mut System, unknowns: &Unknowns) {
        let System {
            groups,
            joints,
            inputs,
            time,
            ..
        } = system;
        let now = Moment {
            time: *time,
            inputs,
        };
        let mut block = self.of_bodies;
        for (joint, stations) in joints.iter().zip(&self.joints) {
            let loads = |groups: &[crate::group::Group]| -> Vec<Vector6<f64>> {
                let mut loads = vec![Vector6::zeros(); stations.len()];
                for side in joint.applied(groups, &now) {
                    let place = |k: usize| {
                        let station = unknowns.global(side.group, k);
                        stations.iter().position(|s| *s == station)
                    };
                    if let (Some(node), Some(element)) = (place(side.node), place(side.element)) {
                        let mut force = loads[node].fixed_rows_mut::<3>(0);
                        force += side.force * unknowns.scale;
                        let mut torque = loads[element].fixed_rows_mut::<3>(3);
                        torque += side.torque;
                    }
                }
                loads
            };
            for column in stations {
                let (group, k) = unknowns.locate(*column);
                let (position, frame) = {
                    let state = &groups[group].bodies.state;
                    (state.position.get(k), state.director.get(k))
                };
                for j in 0..PER_STATION {
                    let [forth, back] = [1.0, -1.0].map(|sign| {
                        let by = Vector6::ith(j, sign * DIFFERENCE);
                        unknowns.displace(&mut groups[group].bodies, k, &by);
                        let loads = loads(groups);
                        let state = &mut groups[group].bodies.state;
                        state.position.set(k, position);
                        state.director.set(k, frame);
                        loads
                    });
                    for (row, (forth, back)) in forth.iter().zip(&back).enumerate() {
                        let slope = (forth - back) / (2.0 * DIFFERENCE);
                        self.values[block + row].set_column(j, &slope);
                    }
                }
                block += stations.len();
            }
        }
    }

    /// The largest entry in the columns of some stations.
    pub(super) fn largest(&self, stations: &[usize]) -> f64 {
        let blocks = self.blocks.iter().zip(&self.values);
        blocks
            .filter(|(block, _)| stations.contains(&block.column))
            .fold(0.0, |largest, (_, value)| value.amax().max(largest))
    }

    /// A station whose loads' derivatives aren't finite numbers.
    pub(super) fn not_finite(&self) -> Option<usize> {
        let mut blocks = self.blocks.iter().zip(&self.values);
        let bad = blocks.find(|(_, value)| !value.iter().all(|v| v.is_finite()));
        bad.map(|(block, _)| block.row)
    }

    /// `(P J + s (I - P)) x`, P the projection on what is free.
    pub(super) fn times(&self, freedom: &Freedom, x: &[f64], s: f64) -> Vec<f64> {
        let at = |station: usize| {
            Vector6::from_column_slice(&x[station * PER_STATION..(station + 1) * PER_STATION])
        };
        let free = &freedom.free;
        let held = |(station, free): (usize, &Matrix6<f64>)| (at(station) - free * at(station)) * s;
        let mut product: Vec<Vector6<f64>> = free.iter().enumerate().map(held).collect();
        for (block, value) in self.blocks.iter().zip(&self.values) {
            product[block.row] += free[block.row] * (value * at(block.column));
        }
        product.iter().flat_map(|v| v.iter().copied()).collect()
    }

    /// Factors of `P J + (I - P)`, P the projection on what is free: free rows ask for equilibrium, held rows for a
    /// given displacement.
    pub(super) fn factorise(&self, freedom: &Freedom) -> Result<Lu<usize, f64>, String> {
        let mut values = Vec::with_capacity(self.blocks.len() * 36);
        for (at, (block, value)) in self.blocks.iter().zip(&self.values).enumerate() {
            let free = &freedom.free[block.row];
            let mut projected = free * value;
            if at < self.of_bodies && block.row == block.column {
                projected += Matrix6::identity() - free;
            }
            values.extend_from_slice(projected.as_slice());
        }
        let matrix = SparseColMat::new_from_argsort(self.symbolic.clone(), &self.order, &values)
            .map_err(|e| format!("the tangent matrix can't be assembled: {e:?}"))?;
        Lu::try_new_with_symbolic(self.factors.clone(), matrix.as_ref())
            .map_err(|e| format!("the tangent matrix can't be factorised: {e:?}"))
    }
}

/// Solves in place; `false` if the result isn't finite (a singular matrix).
pub(super) fn solve(factors: &Lu<usize, f64>, side: &mut [f64]) -> bool {
    let size = side.len();
    factors.solve_in_place(faer::MatMut::from_column_major_slice_mut(side, size, 1));
    side.iter().all(|v| v.is_finite())
}

fn joint_stations(system: &System, unknowns: &Unknowns) -> Vec<Vec<usize>> {
    let now = Moment {
        time: system.time,
        inputs: &system.inputs,
    };
    let stations = |joint: &crate::connection::Connection| {
        let mut stations: Vec<usize> = joint
            .applied(&system.groups, &now)
            .iter()
            .flat_map(|s| [s.node, s.element].map(|k| unknowns.global(s.group, k)))
            .collect();
        stations.sort_unstable();
        stations.dedup();
        stations
    };
    system.joints.iter().map(stations).collect()
}
