//! Derivatives of all loads with respect to all unknowns, by differences: no plugin is asked for any.
//!
//! Loads on a station depend on the stations near it on the same body, so stations far enough apart are moved at once
//! (colouring); joints are differentiated one by one. How far the dependence reaches is tested, not assumed.

use super::block_lu::BlockLu;
use super::unknowns::{Freedom, PER_STATION, Reach, Unknowns};
use crate::bodies::State;
use crate::group::Group;
use crate::inputs::Moment;
use crate::rotation;
use crate::system::System;
use crate::triple::Rows;
use nalgebra::{Matrix6, Vector3, Vector6};
use std::ops::Range;

/// Step of the central differences, in the unknowns' own unit. Forward ones would be too coarse for slender stiff rods:
/// their error, of the axial rigidity times the step, exceeds the bending stiffness.
const DIFFERENCE: f64 = 1e-5;
/// Forth and back.
const STEPS: [f64; 2] = [DIFFERENCE, -DIFFERENCE];

/// A 6x6 block of the matrix, by stations, and its place in the factors.
struct Block {
    row: usize,
    column: usize,
    slot: usize,
}

/// The unknowns of a station that are of position, and of rotation.
const KINDS: [Range<usize>; 2] = [0..3, 3..PER_STATION];

/// Stations of bodies that are moved, or turned, at once.
struct Colour {
    unknowns: Range<usize>,
    /// Groups and stations in them.
    stations: Vec<(usize, usize)>,
    /// Blocks of these columns.
    blocks: Vec<usize>,
}

/// A station that a joint depends and acts on.
struct Joined {
    station: usize,
    /// Those that the joint depends on.
    unknowns: Range<usize>,
}

/// The sparse tangent matrix: pattern, values, and how to fill and factorise it.
pub(crate) struct Tangent {
    colours: Vec<Colour>,
    /// Column by column: blocks of bodies, then those of joints.
    blocks: Vec<Block>,
    values: Vec<Matrix6<f64>>,
    /// Blocks of bodies.
    bodies: usize,
    joints: Vec<Vec<Joined>>,
    factors: BlockLu,
    /// States that are differentiated at, one a group.
    start: Vec<State>,
    /// Loads after moves forth and back.
    loads: [Vec<f64>; 2],
}

/// How far stations are moved.
struct Nudge {
    /// Length of a unit \[m\].
    scale: f64,
    /// Change of a station's rates for a unit change of its pose \[1/s\].
    rate: f64,
    /// Rotations of frames by each of [`STEPS`] about each director.
    turns: [[Rows; 3]; 2],
}

impl Nudge {
    fn new(scale: f64, rate: f64) -> Self {
        let turn = |by: f64| {
            [Vector3::x(), Vector3::y(), Vector3::z()]
                .map(|axis| Rows::from(&rotation::exp(&(axis * -by))))
        };
        Self {
            scale,
            rate,
            turns: STEPS.map(turn),
        }
    }

    /// Moves unknown `j` of a station by one of [`STEPS`] from where it was at the start.
    #[inline]
    fn set(&self, state: &mut State, start: &State, k: usize, (j, way): (usize, usize)) {
        let by = Vector3::ith(j % 3, STEPS[way]);
        if j < 3 {
            let shift = by * self.scale;
            state.position.set(k, start.position.get(k) + shift);
            if self.rate != 0.0 {
                let rate = start.velocity.get(k) + shift * self.rate;
                state.velocity.set(k, rate);
            }
        } else {
            let frame = Rows::from(&start.director.get(k));
            let turned = self.turns[way][j - 3].product(&frame);
            state.director.set(k, turned.into());
            if self.rate != 0.0 {
                state.omega.set(k, start.omega.get(k) + by * self.rate);
            }
        }
    }
}

/// Moves unknown `j` of a station back to where it was at the start.
#[inline]
fn reset(state: &mut State, start: &State, k: usize, j: usize) {
    if j < 3 {
        state.position.set(k, start.position.get(k));
        state.velocity.set(k, start.velocity.get(k));
    } else {
        state.director.set(k, start.director.get(k));
        state.omega.set(k, start.omega.get(k));
    }
}

impl Tangent {
    /// The pattern for loads that positions and frames have this reach for.
    pub(crate) fn new(system: &System, unknowns: &Unknowns, reach: [Reach; 2]) -> Self {
        let bodies = || {
            let groups = system.groups.iter().enumerate();
            groups.flat_map(|(g, group)| group.bodies.layouts().iter().map(move |l| (g, l)))
        };
        let either = reach[0].or(reach[1]);
        let mut pattern = Vec::new();
        // where a column's blocks start, and in which row
        let mut columns = Vec::new();
        for (g, layout) in bodies() {
            let first = unknowns.global(g, layout.first);
            for i in 0..layout.nodes() {
                let rows = either.around(i, layout.nodes());
                columns.push((pattern.len(), rows.start));
                pattern.extend(rows.map(|row| (first + row, first + i)));
            }
        }
        let mut colours = Vec::new();
        for (kind, reach) in KINDS.into_iter().zip(reach) {
            for colour in 0..reach.spacing() {
                let (mut stations, mut blocks) = (Vec::new(), Vec::new());
                for (g, layout) in bodies() {
                    for i in (colour..layout.nodes()).step_by(reach.spacing()) {
                        let (block, first_row) = columns[unknowns.global(g, layout.first + i)];
                        let rows = reach.around(i, layout.nodes());
                        blocks.extend(rows.map(|row| block + row - first_row));
                        stations.push((g, layout.first + i));
                    }
                }
                colours.push(Colour {
                    unknowns: kind.clone(),
                    stations,
                    blocks,
                });
            }
        }
        let bodies = pattern.len();
        let joints = joined(system, unknowns);
        for joined in &joints {
            for column in joined {
                pattern.extend(joined.iter().map(|row| (row.station, column.station)));
            }
        }
        let factors = BlockLu::new(unknowns.stations, pattern.iter().copied());
        let slots = factors.slots(pattern.iter().copied());
        let blocks = pattern.into_iter().zip(slots);
        let size = unknowns.stations * PER_STATION;
        Self {
            colours,
            values: vec![Matrix6::zeros(); blocks.len()],
            blocks: blocks
                .map(|((row, column), slot)| Block { row, column, slot })
                .collect(),
            bodies,
            joints,
            factors,
            start: system
                .groups
                .iter()
                .map(|g| g.bodies.state.clone())
                .collect(),
            loads: [vec![0.0; size], vec![0.0; size]],
        }
    }

    /// Evaluations of all bodies' loads that [`Tangent::fill`] takes.
    pub(crate) fn evaluations(&self) -> usize {
        let one_way: usize = self.colours.iter().map(|c| c.unknowns.len()).sum();
        2 * one_way
    }

    /// Differentiates what `loads` finds of a group, and joints, at the present state. A station's rates change by `rate`
    /// \[1/s\] times the change of its pose: 0 for loads at rest.
    pub(crate) fn fill(
        &mut self,
        system: &mut System,
        unknowns: &Unknowns,
        loads: impl Fn(&mut Group, &Moment<'_>) + Send + Sync,
        rate: f64,
    ) {
        for (start, group) in self.start.iter_mut().zip(&system.groups) {
            start.pose_as(&group.bodies.state);
        }
        let nudge = Nudge::new(unknowns.scale, rate);
        self.fill_bodies(system, unknowns, loads, &nudge);
        self.fill_joints(system, unknowns, &nudge);
    }

    fn fill_bodies(
        &mut self,
        system: &mut System,
        unknowns: &Unknowns,
        find_loads: impl Fn(&mut Group, &Moment<'_>) + Send + Sync,
        nudge: &Nudge,
    ) {
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
        let start = &self.start;
        for colour in &self.colours {
            for j in colour.unknowns.clone() {
                for (way, loads) in self.loads.iter_mut().enumerate() {
                    for &(g, k) in &colour.stations {
                        nudge.set(&mut groups[g].bodies.state, &start[g], k, (j, way));
                    }
                    crate::group::each(groups, |group| find_loads(group, &now));
                    unknowns.read_loads(groups, loads);
                }
                for &(g, k) in &colour.stations {
                    reset(&mut groups[g].bodies.state, &start[g], k, j);
                }
                let [forth, back] = self.loads.each_ref().map(|l| l.as_chunks().0);
                for block in &colour.blocks {
                    let row = self.blocks[*block].row;
                    let [forth, back] = [forth, back].map(|loads| Vector6::from(loads[row]));
                    let slope = (forth - back) * (0.5 / DIFFERENCE);
                    self.values[*block].set_column(j, &slope);
                }
            }
        }
    }

    fn fill_joints(&mut self, system: &mut System, unknowns: &Unknowns, nudge: &Nudge) {
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
        let mut first = self.bodies;
        self.values[first..].fill(Matrix6::zeros());
        for (joint, joined) in joints.iter().zip(&self.joints) {
            for column in joined {
                let (g, k) = unknowns.locate(column.station);
                let values = &mut self.values[first..first + joined.len()];
                for j in column.unknowns.clone() {
                    for (way, step) in STEPS.into_iter().enumerate() {
                        nudge.set(&mut groups[g].bodies.state, &self.start[g], k, (j, way));
                        let share = 0.5 / step;
                        for side in joint.applied(groups, &now) {
                            let row = |k: usize| {
                                let station = unknowns.global(side.group, k);
                                joined.iter().position(|j| j.station == station)
                            };
                            if let (Some(node), Some(element)) = (row(side.node), row(side.element))
                            {
                                let mut force = values[node].fixed_view_mut::<3, 1>(0, j);
                                force += side.force * (unknowns.scale * share);
                                let mut torque = values[element].fixed_view_mut::<3, 1>(3, j);
                                torque += side.torque * share;
                            }
                        }
                    }
                    reset(&mut groups[g].bodies.state, &self.start[g], k, j);
                }
                first += joined.len();
            }
        }
    }

    /// Takes `inertia` times the acceleration from the loads: one number an unknown, times `rate` \[1/s2\].
    pub(crate) fn subtract_inertia(&mut self, inertia: &[f64], rate: f64) {
        for (block, value) in self.blocks.iter().zip(&mut self.values).take(self.bodies) {
            if block.row == block.column {
                for i in 0..PER_STATION {
                    value[(i, i)] -= inertia[block.row * PER_STATION + i] * rate;
                }
            }
        }
    }

    /// The largest entry in the columns of some stations.
    pub(crate) fn largest(&self, stations: &[usize]) -> f64 {
        let blocks = self.blocks.iter().zip(&self.values);
        blocks
            .filter(|(block, _)| stations.contains(&block.column))
            .fold(0.0, |largest, (_, value)| value.amax().max(largest))
    }

    /// A station whose loads' derivatives aren't finite numbers.
    pub(crate) fn not_finite(&self) -> Option<usize> {
        // a sum is enough, column by column: an infinity or a NaN survives it
        let zeros = |value: &Matrix6<f64>| {
            let sum = |sum: Vector6<f64>, column| sum + column * 0.0;
            value.column_iter().fold(Vector6::zeros(), sum)
        };
        let mut blocks = self.blocks.iter().zip(&self.values);
        let bad = blocks.find(|(_, value)| zeros(value) != Vector6::zeros());
        bad.map(|(block, _)| block.row)
    }

    /// `(P J + s (I - P)) x`, P the projection on what is free.
    pub(crate) fn times(&self, freedom: &Freedom, x: &[f64], s: f64) -> Vec<f64> {
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

    /// Factorises `P J + (I - P)`, P the projection on what is free: free rows ask for equilibrium, held rows for a
    /// given displacement.
    pub(crate) fn factorise(&mut self, freedom: &Freedom) {
        let matrix = self.factors.blocks_mut();
        matrix.fill(Matrix6::zeros());
        for (station, free) in freedom.free.iter().enumerate() {
            if !freedom.is_all(station) {
                matrix[station] = Matrix6::identity() - free;
            }
        }
        for (block, value) in self.blocks.iter().zip(&self.values) {
            if freedom.is_all(block.row) {
                matrix[block.slot] += value;
            } else {
                matrix[block.slot] += freedom.free[block.row] * value;
            }
        }
        self.factors.factorise();
    }

    /// Solves in place with the last factors; `false` if the result isn't finite (a singular matrix).
    pub(crate) fn solve(&self, side: &mut [f64]) -> bool {
        self.factors.solve(side)
    }
}

/// What each joint depends and acts on: positions of nodes, frames of elements.
fn joined(system: &System, unknowns: &Unknowns) -> Vec<Vec<Joined>> {
    let now = Moment {
        time: system.time,
        inputs: &system.inputs,
    };
    let joined = |joint: &crate::connection::Connection| {
        let mut joined: Vec<Joined> = Vec::new();
        for side in joint.applied(&system.groups, &now) {
            for (k, kind) in [side.node, side.element].into_iter().zip(KINDS) {
                let station = unknowns.global(side.group, k);
                match joined.iter_mut().find(|j| j.station == station) {
                    Some(other) => other.unknowns = 0..PER_STATION,
                    None => joined.push(Joined {
                        station,
                        unknowns: kind,
                    }),
                }
            }
        }
        joined
    };
    system.joints.iter().map(joined).collect()
}
