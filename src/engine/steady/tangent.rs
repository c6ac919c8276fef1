//! Derivatives of all loads with respect to all unknowns, by differences: no plugin is asked for any.
//!
//! Loads on a station depend on the stations near it on the same body, so stations far enough apart are moved at once
//! (colouring); joints are differentiated one by one. How far the dependence reaches is tested, not assumed.

use super::block_lu::BlockLu;
use super::unknowns::{Freedom, PER_STATION, Unknowns};
use crate::group::Group;
use crate::inputs::Moment;
use crate::rotation;
use crate::system::System;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// Step of the central differences, in the unknowns' own unit. Forward ones would be too coarse for slender stiff rods:
/// their error, of the axial rigidity times the step, exceeds the bending stiffness.
const DIFFERENCE: f64 = 1e-5;

/// A 6x6 block of the matrix, by stations, and its place in the factors.
struct Block {
    row: usize,
    column: usize,
    slot: usize,
}

/// Stations of bodies that are moved at once.
struct Colour {
    /// Groups and stations in them.
    stations: Vec<(usize, usize)>,
    /// Blocks of these columns.
    blocks: std::ops::Range<usize>,
}

/// The sparse tangent matrix: pattern, values, and how to fill and factorise it.
pub(crate) struct Tangent {
    colours: Vec<Colour>,
    /// Bodies' blocks colour by colour, then joints' blocks column by column.
    blocks: Vec<Block>,
    values: Vec<Matrix6<f64>>,
    /// Stations that each joint depends and acts on.
    joints: Vec<Vec<usize>>,
    factors: BlockLu,
    forth: Vec<f64>,
    back: Vec<f64>,
}

/// One station before it was moved.
struct Place {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    frame: Matrix3<f64>,
    omega: Vector3<f64>,
}

/// How far stations are moved.
struct Nudge {
    /// Length of a unit \[m\].
    scale: f64,
    /// Change of a station's rates for a unit change of its pose \[1/s\].
    rate: f64,
    /// Rotations by [`DIFFERENCE`].
    turns: [Matrix3<f64>; 3],
}

impl Place {
    /// Moves a station by one of its unknowns and returns where it was.
    fn moved(group: &mut Group, k: usize, (j, sign): (usize, f64), nudge: &Nudge) -> Self {
        let state = &mut group.bodies.state;
        let place = Self {
            position: state.position.get(k),
            velocity: state.velocity.get(k),
            frame: state.director.get(k),
            omega: state.omega.get(k),
        };
        let by = Vector3::ith(j % 3, sign * DIFFERENCE);
        if j < 3 {
            let shift = by * nudge.scale;
            state.position.set(k, place.position + shift);
            state.velocity.set(k, place.velocity + shift * nudge.rate);
        } else {
            let turn = &nudge.turns[j - 3];
            let frame = if sign > 0.0 {
                turn * place.frame
            } else {
                turn.tr_mul(&place.frame)
            };
            state.director.set(k, frame);
            state.omega.set(k, place.omega + by * nudge.rate);
        }
        place
    }

    fn restore(&self, group: &mut Group, k: usize) {
        let state = &mut group.bodies.state;
        state.position.set(k, self.position);
        state.velocity.set(k, self.velocity);
        state.director.set(k, self.frame);
        state.omega.set(k, self.omega);
    }
}

impl Tangent {
    /// The pattern for loads that depend on `reach` neighbours to each side.
    pub(crate) fn new(system: &System, unknowns: &Unknowns, reach: usize) -> Self {
        let spacing = 2 * reach + 1;
        let mut colours = Vec::new();
        let mut pattern = Vec::new();
        for colour in 0..spacing {
            let (mut stations, first) = (Vec::new(), pattern.len());
            for (g, group) in system.groups.iter().enumerate() {
                for layout in group.bodies.layouts() {
                    for i in (colour..layout.nodes()).step_by(spacing) {
                        let column = unknowns.global(g, layout.first + i);
                        let rows = i.saturating_sub(reach)..(i + reach + 1).min(layout.nodes());
                        pattern.extend(rows.map(|row| (column - i + row, column)));
                        stations.push((g, layout.first + i));
                    }
                }
            }
            colours.push(Colour {
                stations,
                blocks: first..pattern.len(),
            });
        }
        let joints = joint_stations(system, unknowns);
        for stations in &joints {
            for column in stations {
                pattern.extend(stations.iter().map(|row| (*row, *column)));
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
            joints,
            factors,
            forth: vec![0.0; size],
            back: vec![0.0; size],
        }
    }

    /// Evaluations of all bodies' loads that [`Tangent::fill`] takes.
    pub(crate) fn evaluations(&self) -> usize {
        2 * PER_STATION * self.colours.len()
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
        let nudge = Nudge {
            scale: unknowns.scale,
            rate,
            turns: [Vector3::x(), Vector3::y(), Vector3::z()]
                .map(|axis| rotation::turned(&Matrix3::identity(), &(axis * DIFFERENCE))),
        };
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
        let mut places = Vec::new();
        for colour in &self.colours {
            for j in 0..PER_STATION {
                for (sign, loads) in [(1.0, &mut self.forth), (-1.0, &mut self.back)] {
                    places.clear();
                    let stations = colour.stations.iter();
                    places.extend(
                        stations.map(|(g, k)| Place::moved(&mut groups[*g], *k, (j, sign), nudge)),
                    );
                    crate::group::each(groups, |group| find_loads(group, &now));
                    for (place, (g, k)) in places.iter().zip(&colour.stations) {
                        place.restore(&mut groups[*g], *k);
                    }
                    unknowns.read_loads(groups, loads);
                }
                let blocks = colour.blocks.clone();
                for (block, value) in self.blocks[blocks.clone()]
                    .iter()
                    .zip(&mut self.values[blocks])
                {
                    let at = block.row * PER_STATION;
                    for i in 0..PER_STATION {
                        let change = self.forth[at + i] - self.back[at + i];
                        value[(i, j)] = change / (2.0 * DIFFERENCE);
                    }
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
        let mut first = self.colours.last().map_or(0, |c| c.blocks.end);
        self.values[first..].fill(Matrix6::zeros());
        for (joint, stations) in joints.iter().zip(&self.joints) {
            for column in stations {
                let (g, k) = unknowns.locate(*column);
                let values = &mut self.values[first..first + stations.len()];
                for j in 0..PER_STATION {
                    for sign in [1.0, -1.0] {
                        let place = Place::moved(&mut groups[g], k, (j, sign), nudge);
                        let share = sign / (2.0 * DIFFERENCE);
                        for side in joint.applied(groups, &now) {
                            let row = |k: usize| {
                                let station = unknowns.global(side.group, k);
                                stations.iter().position(|s| *s == station)
                            };
                            if let (Some(node), Some(element)) = (row(side.node), row(side.element))
                            {
                                let mut force = values[node].fixed_view_mut::<3, 1>(0, j);
                                force += side.force * (unknowns.scale * share);
                                let mut torque = values[element].fixed_view_mut::<3, 1>(3, j);
                                torque += side.torque * share;
                            }
                        }
                        place.restore(&mut groups[g], k);
                    }
                }
                first += stations.len();
            }
        }
    }

    /// Takes `inertia` times the acceleration from the loads: one number an unknown, times `rate` \[1/s2\].
    pub(crate) fn subtract_inertia(&mut self, inertia: &[f64], rate: f64) {
        let bodies = self.colours.last().map_or(0, |c| c.blocks.end);
        for (block, value) in self.blocks.iter().zip(&mut self.values).take(bodies) {
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
        let mut blocks = self.blocks.iter().zip(&self.values);
        let bad = blocks.find(|(_, value)| !value.iter().all(|v| v.is_finite()));
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
