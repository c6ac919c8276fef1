//! The unknowns of a steady state: six a station, three of position and three of rotation.

use crate::bodies::Bodies;
use crate::group::Group;
use crate::rotation;
use crate::system::System;
use nalgebra::{Matrix6, Vector3, Vector6};
use std::ops::Range;

/// Unknowns a station: displacement over the length scale, and material rotation vector.
pub(crate) const PER_STATION: usize = 6;

/// Numbers all stations of a system and scales their unknowns.
#[derive(Clone)]
pub(crate) struct Unknowns {
    /// First station of each group.
    offsets: Vec<usize>,
    /// Number of stations.
    pub(crate) stations: usize,
    /// Stations without a frame: the last of every rod.
    frameless: Vec<usize>,
    /// Length \[m\] that makes displacements and forces comparable with rotations and torques: of a mean element.
    pub(crate) scale: f64,
    /// Elements of the longest rod, at least 1.
    pub(crate) longest: f64,
}

/// How many stations before and after one the loads depend on it.
#[derive(Clone, Copy)]
pub(crate) struct Reach {
    before: usize,
    after: usize,
}

impl Reach {
    /// As far as either.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            before: self.before.max(other.before),
            after: self.after.max(other.after),
        }
    }

    /// Those of a body's `nodes` stations that station `i` is felt at.
    pub(crate) fn around(self, i: usize, nodes: usize) -> Range<usize> {
        i.saturating_sub(self.before)..(i + self.after + 1).min(nodes)
    }

    /// Distance of stations that no load depends on two of.
    pub(crate) fn spacing(self) -> usize {
        self.before + 1 + self.after
    }
}

impl Unknowns {
    pub(crate) fn of(system: &System) -> Self {
        let mut offsets = Vec::new();
        let mut stations = 0;
        let mut frameless = Vec::new();
        let (mut length, mut elements, mut longest) = (0.0, 0usize, 1);
        for group in &system.groups {
            offsets.push(stations);
            for layout in group.bodies.layouts() {
                longest = longest.max(layout.elements);
                if layout.is_rod() {
                    frameless.push(stations + layout.first + layout.elements);
                }
                for k in layout.element_stations() {
                    length += group.bodies.reference_length[k];
                    elements += 1;
                }
            }
            stations += group.bodies.stations();
        }
        Self {
            offsets,
            stations,
            frameless,
            scale: if elements > 0 {
                length / elements as f64
            } else {
                1.0
            },
            longest: longest as f64,
        }
    }

    /// Global number of a group's station.
    pub(crate) fn global(&self, group: usize, station: usize) -> usize {
        self.offsets[group] + station
    }

    /// Whether a global station has a frame.
    pub(crate) fn has_frame(&self, station: usize) -> bool {
        self.frameless.binary_search(&station).is_err()
    }

    /// Group and station in it of a global station.
    pub(crate) fn locate(&self, station: usize) -> (usize, usize) {
        let group = self.offsets.partition_point(|first| *first <= station) - 1;
        (group, station - self.offsets[group])
    }

    /// Present loads, scaled: force times length, and torque.
    pub(crate) fn read_loads(&self, groups: &[Group], loads: &mut [f64]) {
        for (group, first) in groups.iter().zip(&self.offsets) {
            let count = group.bodies.stations();
            let loads = loads.as_chunks_mut::<PER_STATION>().0[*first..][..count].iter_mut();
            let [x, y, z] = group.bodies.force.slices(0..count);
            let [a, b, c] = group.bodies.torque.slices(0..count);
            // of one length each, so that nothing is checked station by station
            for (k, load) in loads.enumerate() {
                let force = [x[k], y[k], z[k]].map(|f| f * self.scale);
                *load = [force[0], force[1], force[2], a[k], b[k], c[k]];
            }
        }
    }

    /// Inertia of every unknown at the present dilatations, scaled: mass times length squared, and moment of inertia.
    pub(crate) fn read_inertia(&self, groups: &[Group], inertia: &mut [f64]) {
        let bodies = groups.iter().map(|g| &g.bodies);
        let stations = bodies.flat_map(|b| (0..b.stations()).map(move |k| (b, k)));
        for ((b, k), inertia) in stations.zip(inertia.chunks_exact_mut(PER_STATION)) {
            inertia[..3].fill(b.mass[k] * self.scale.powi(2));
            inertia[3..].copy_from_slice((b.inertia.get(k) / b.dilatation[k]).as_slice());
        }
    }

    /// How far the loads on a body change when one of its stations moves, and when it turns, over all bodies.
    pub(crate) fn reach(&self, system: &mut System) -> [Reach; 2] {
        let shift = Vector6::new(3e-3, -2e-3, 1e-3, 0.0, 0.0, 0.0);
        let turn = Vector6::new(0.0, 0.0, 0.0, 2e-3, 3e-3, -4e-3);
        [shift, turn].map(|by| self.reach_of(system, by))
    }

    fn reach_of(&self, system: &mut System, by: Vector6<f64>) -> Reach {
        let now = crate::inputs::Moment {
            time: system.time,
            inputs: &system.inputs,
        };
        let mut reach = Reach {
            before: 1,
            after: 1,
        };
        for group in &mut system.groups {
            let start = group.bodies.state.clone();
            self.crumple(&mut group.bodies);
            let crumpled = group.bodies.state.clone();
            group.loads(&now);
            let base = (group.bodies.force.clone(), group.bodies.torque.clone());
            for sample in 0..3 {
                // both ways, since a law may act one way only
                for by in [by, -by] {
                    let moved = |l: &crate::bodies::Layout| l.elements * sample / 2;
                    for b in 0..group.bodies.layouts().len() {
                        let layout = &group.bodies.layouts()[b];
                        let station = layout.first + moved(layout);
                        self.displace(&mut group.bodies, station, &by);
                    }
                    group.loads(&now);
                    let Bodies { force, torque, .. } = &group.bodies;
                    for layout in group.bodies.layouts() {
                        for i in 0..layout.nodes() {
                            let k = layout.first + i;
                            if force.get(k) != base.0.get(k) || torque.get(k) != base.1.get(k) {
                                reach.before = reach.before.max(moved(layout).saturating_sub(i));
                                reach.after = reach.after.max(i.saturating_sub(moved(layout)));
                            }
                        }
                    }
                    group.bodies.state.clone_from(&crumpled);
                }
            }
            group.bodies.state.clone_from(&start);
        }
        reach
    }

    /// Bends, twists, shears and stretches every rod a little and irregularly: in a straight rod at rest the loads
    /// that are products of strains don't show what they depend on.
    fn crumple(&self, bodies: &mut Bodies) {
        for k in 0..bodies.stations() {
            let by = Vector6::from_fn(|j, _| 1e-4 * ((PER_STATION * k + j) as f64).sin());
            self.displace(bodies, k, &by);
        }
    }

    /// Moves one station by its six scaled unknowns.
    pub(crate) fn displace(&self, bodies: &mut Bodies, k: usize, by: &Vector6<f64>) {
        let shift: Vector3<f64> = by.fixed_rows::<3>(0) * self.scale;
        bodies.state.position.add(k, shift);
        let frame = bodies.state.director.get(k);
        let turn = by.fixed_rows::<3>(3).into_owned();
        bodies
            .state
            .director
            .set(k, rotation::turned(&frame, &turn));
    }

    /// Moves all stations.
    pub(crate) fn displace_all(&self, groups: &mut [Group], by: &[f64]) {
        for (group, first) in groups.iter_mut().zip(&self.offsets) {
            for k in 0..group.bodies.stations() {
                let at = (first + k) * PER_STATION;
                let by = Vector6::from_column_slice(&by[at..at + 6]);
                self.displace(&mut group.bodies, k, &by);
            }
        }
    }
}

/// Which combinations of a station's unknowns are free: the projection that the boundary conditions make of rates.
#[derive(Clone)]
pub(crate) struct Freedom {
    /// One projection a station.
    pub(crate) free: Vec<Matrix6<f64>>,
    /// Stations of which nothing is held.
    all: Vec<bool>,
}

impl Freedom {
    /// Asks every boundary condition by giving unit rates to all stations, one unknown at a time.
    pub(crate) fn of(system: &mut System, unknowns: &Unknowns) -> Result<Self, String> {
        let none = probe(system, unknowns, None);
        let mut free = vec![Matrix6::zeros(); unknowns.stations];
        for j in 0..PER_STATION {
            let rates = probe(system, unknowns, Some(j));
            for ((matrix, rate), still) in free.iter_mut().zip(rates).zip(&none) {
                matrix.set_column(j, &(rate - still));
            }
        }
        let mut first = 0;
        for layout in system.groups.iter().flat_map(|g| g.bodies.layouts()) {
            for i in 0..layout.nodes() {
                let p = &mut free[first + i];
                if i >= layout.directors() {
                    // a rod's last station has a node but no element
                    p.fixed_view_mut::<3, 6>(3, 0).fill(0.0);
                }
                let off = (*p * *p - *p).amax();
                if off.is_nan() || off > 1e-9 {
                    return Err(format!(
                        "the boundary conditions on `{}` at node {i} aren't a projection of the rates, so a steady \
                         state can't be sought; what is not held must be left as it is",
                        layout.name
                    ));
                }
            }
            first += layout.nodes();
        }
        let all = free.iter().map(|p| *p == Matrix6::identity()).collect();
        Ok(Self { free, all })
    }

    /// Whether nothing of a station is held.
    pub(crate) fn is_all(&self, station: usize) -> bool {
        self.all[station]
    }

    /// Leaves of each station's six what is free.
    pub(crate) fn project(&self, values: &mut [f64]) {
        for (station, values) in values.chunks_exact_mut(PER_STATION).enumerate() {
            if !self.all[station] {
                let free = self.free[station] * Vector6::from_column_slice(values);
                values.copy_from_slice(free.as_slice());
            }
        }
    }
}

/// Rates of every station after the boundary conditions had unit rates (or none) before them.
fn probe(system: &mut System, unknowns: &Unknowns, unit: Option<usize>) -> Vec<Vector6<f64>> {
    let now = crate::inputs::Moment {
        time: system.time,
        inputs: &system.inputs,
    };
    let mut rates = Vec::with_capacity(unknowns.stations);
    for group in &mut system.groups {
        let given = unit.map_or(Vector6::zeros(), |j| Vector6::ith(j, 1.0));
        for k in 0..group.bodies.stations() {
            let state = &mut group.bodies.state;
            state.velocity.set(k, given.fixed_rows::<3>(0).into());
            state.omega.set(k, given.fixed_rows::<3>(3).into());
        }
        group.set_rates(&now);
        for k in 0..group.bodies.stations() {
            let state = &group.bodies.state;
            let (v, w) = (state.velocity.get(k), state.omega.get(k));
            rates.push(Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z));
        }
        group.bodies.state.stop();
    }
    rates
}
