//! A system in motion from one end of a time step to the other.

use super::scheme::Scheme;
use crate::bodies::State;
use crate::group::Group;
use crate::rotation;
use crate::steady::unknowns::{Freedom, PER_STATION, Unknowns};
use crate::system::System;
use nalgebra::Vector3;

/// Where a step began, and accelerations at both of its ends.
pub(super) struct Motion {
    pub(super) scheme: Scheme,
    pub(super) unknowns: Unknowns,
    pub(super) freedom: Freedom,
    /// Poses and rates at the start of the step, group by group.
    pub(super) start: Vec<State>,
    before: Accelerations,
    after: Accelerations,
    /// Inertia of every unknown.
    pub(super) inertia: Vec<f64>,
    /// Loads less inertia in free directions.
    pub(super) residual: Vec<f64>,
    /// Displacements of all stations.
    pub(super) change: Vec<f64>,
}

/// Accelerations of every unknown \[1/s2\].
struct Accelerations {
    /// The scheme's own, which its rates follow.
    scheme: Vec<f64>,
    /// Those of the equations of motion.
    truly: Vec<f64>,
}

impl Accelerations {
    fn zeros(size: usize) -> Self {
        Self {
            scheme: vec![0.0; size],
            truly: vec![0.0; size],
        }
    }
}

impl Motion {
    /// A system that moves on from its present state and rates.
    pub(super) fn new(
        system: &mut System,
        scheme: Scheme,
        unknowns: Unknowns,
        freedom: Freedom,
    ) -> Self {
        let size = unknowns.stations * PER_STATION;
        let mut motion = Self {
            scheme,
            unknowns,
            freedom,
            start: vec![State::default(); system.groups.len()],
            before: Accelerations::zeros(size),
            after: Accelerations::zeros(size),
            inertia: vec![0.0; size],
            residual: vec![0.0; size],
            change: vec![0.0; size],
        };
        motion.find_residual(system);
        let first = motion.residual.iter().zip(&motion.inertia);
        motion.before.truly = first.map(|(l, i)| l / i).collect();
        motion.freedom.project(&mut motion.before.truly);
        motion.before.scheme.clone_from(&motion.before.truly);
        motion
    }

    /// Takes all rates from a system. Accelerations go with them: where something stiff is hardly out of balance they are
    /// so large that a long step would be thrown far off.
    pub(super) fn stop(&mut self, system: &mut System) {
        for group in &mut system.groups {
            group.bodies.state.stop();
        }
        self.before.truly.fill(0.0);
        self.before.scheme.fill(0.0);
    }

    /// Another system with the same unknowns that moves on from its own present state and rates.
    pub(super) fn of(&self, system: &mut System) -> Self {
        let (unknowns, freedom) = (self.unknowns.clone(), self.freedom.clone());
        Self::new(system, self.scheme, unknowns, freedom)
    }

    /// Begins a step at the present state.
    pub(super) fn begin(&mut self, system: &System) {
        for (start, group) in self.start.iter_mut().zip(&system.groups) {
            start.copy_from(&group.bodies.state);
        }
    }

    /// Moves what is free as far as its rates and accelerations take it.
    pub(super) fn predict(&mut self, system: &mut System, h: f64) {
        let scale = self.unknowns.scale;
        let states = system.groups.iter().map(|g| &g.bodies.state);
        let stations = states.flat_map(|s| (0..s.position.len()).map(move |k| (s, k)));
        let parts = (self.change.chunks_exact_mut(PER_STATION))
            .zip(self.before.scheme.chunks_exact(PER_STATION));
        for ((state, k), (change, acceleration)) in stations.zip(parts) {
            let (velocity, omega) = (state.velocity.get(k) / scale, state.omega.get(k));
            for (i, rate) in velocity.iter().chain(omega.iter()).enumerate() {
                change[i] = h * (rate + h / 2.0 * acceleration[i]);
            }
        }
        self.freedom.project(&mut self.change);
        self.unknowns.displace_all(&mut system.groups, &self.change);
    }

    /// Rates and accelerations at the end of a step of `h` that has led to the present poses.
    pub(super) fn follow(&mut self, system: &mut System, h: f64) {
        let scale = self.unknowns.scale;
        let mut stations = (self.before.scheme.chunks_exact(PER_STATION))
            .zip(self.before.truly.chunks_exact(PER_STATION))
            .zip(self.after.scheme.chunks_exact_mut(PER_STATION))
            .zip(self.after.truly.chunks_exact_mut(PER_STATION));
        for (group, start) in system.groups.iter_mut().zip(&self.start) {
            let state = &mut group.bodies.state;
            for k in 0..state.position.len() {
                let Some((((before, truly_before), after), truly)) = stations.next() else {
                    return;
                };
                let shift = (state.position.get(k) - start.position.get(k)) / scale;
                let turn = rotation::between(&start.director.get(k), &state.director.get(k));
                let (velocity, omega) = (start.velocity.get(k) / scale, start.omega.get(k));
                let motion = shift.iter().chain(turn.iter());
                let rates = velocity.iter().chain(omega.iter());
                let mut now = [0.0; PER_STATION];
                for (i, (motion, rate)) in motion.zip(rates).enumerate() {
                    let scheme = &self.scheme;
                    after[i] = scheme.acceleration(h, *motion, *rate, before[i]);
                    truly[i] = scheme.true_acceleration(truly_before[i], before[i], after[i]);
                    now[i] = scheme.rate(h, *rate, before[i], after[i]);
                }
                let [x, y, z, turning @ ..] = now;
                state.velocity.set(k, Vector3::new(x, y, z) * scale);
                state.omega.set(k, turning.into());
            }
        }
        self.freedom.project(&mut self.after.scheme);
        self.freedom.project(&mut self.after.truly);
        system.set_rates();
    }

    /// Finds loads less inertia.
    pub(super) fn find_residual(&mut self, system: &mut System) {
        system.evaluate_by(Group::loads_in_motion);
        self.unknowns.read_loads(&system.groups, &mut self.residual);
        self.unknowns
            .read_inertia(&system.groups, &mut self.inertia);
        let parts = self.inertia.iter().zip(&self.after.truly);
        for (load, (inertia, acceleration)) in self.residual.iter_mut().zip(parts) {
            *load -= inertia * acceleration;
        }
        self.freedom.project(&mut self.residual);
    }

    /// The largest rate: rotations \[rad/s\], and displacements in lengths of the longest rod a second.
    pub(super) fn largest_rate(&self, system: &System) -> f64 {
        let states = system.groups.iter().map(|g| &g.bodies.state);
        let stations = states.flat_map(|s| (0..s.position.len()).map(move |k| (s, k)));
        let rate = |(s, k): (&State, usize)| {
            let shift = s.velocity.get(k).amax() / (self.unknowns.scale * self.unknowns.longest);
            shift.max(s.omega.get(k).amax())
        };
        stations.map(rate).fold(0.0, f64::max)
    }

    /// Ends a step: the next one begins with its accelerations.
    pub(super) fn end(&mut self) {
        std::mem::swap(&mut self.before, &mut self.after);
    }
}
