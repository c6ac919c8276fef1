//! Steady states by Newton's method on all bodies at once, followed through time.
//!
//! A steady state at a time is an equilibrium under that time's loads and boundary values. It is reached from the
//! present one by continuation: boundary values move, and what was out of balance fades, in as few increments as
//! Newton's method converges for. Equilibria needn't be unique; this follows the branch that it stands on.

mod diagnosis;
mod tangent;
mod unknowns;

use crate::rotation;
use crate::system::System;
use nalgebra::Matrix3;
use tangent::{Tangent, solve};
use unknowns::{Freedom, PER_STATION, Unknowns};

/// How steady states are sought.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyOptions {
    /// Last Newton correction that is accepted: rotations \[rad\], and displacements in element lengths.
    pub tolerance: f64,
    /// Newton iterations an increment may take.
    pub iterations: usize,
    /// Smallest increment before giving up, as a fraction of the way.
    pub smallest_increment: f64,
}

impl Default for SteadyOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            iterations: 25,
            smallest_increment: 1e-4,
        }
    }
}

/// What it took to find a steady state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteadyReport {
    /// Newton iterations.
    pub iterations: usize,
    /// Increments of the continuation.
    pub increments: usize,
    /// Largest force \[N\] left out of balance (torques are divided by the mean element length).
    pub residual: f64,
}

/// No steady state was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("no steady state was found at t = {time} s: {reason}")]
pub struct NotSteady {
    /// Time \[s\].
    pub time: f64,
    /// Why, and what to try.
    pub reason: String,
}

/// Largest rotation \[rad\] of boundary values in one increment of time.
const LARGEST_TURN: f64 = 1.0;
/// Factor by which each correction must at least shrink.
const CONTRACTION: f64 = 0.5;
/// Corrections below this stay on the branch, whatever their ratio: a law's kink may cost one that doesn't shrink.
const HARMLESS: f64 = 0.02;

/// Newton iterations up to which the next increment may be twice as large.
const EASY: usize = 5;
/// Share of an increment by which the path's tangent is found.
const DIFFERENCE: f64 = 1e-4;

/// Finds and follows steady states of one system.
pub struct SteadySolver {
    options: SteadyOptions,
    unknowns: Unknowns,
    freedom: Freedom,
    tangent: Tangent,
}

/// Positions, frames and walls of all groups.
type Poses = Vec<(crate::bodies::State, Vec<[Matrix3<f64>; 2]>)>;

/// The way from one equilibrium to the next: what is held moves, and what was out of balance fades.
struct Path {
    before: Poses,
    target: Poses,
    /// Displacements of held stations.
    moves: Vec<f64>,
    imbalance: Vec<f64>,
}

impl Path {
    /// Turns walls a share of the way. They are no unknowns, so this is all of their motion.
    fn turn_walls(&self, system: &mut System, share: f64) {
        let groups = system.groups.iter_mut();
        for (group, ((_, from), (_, to))) in groups.zip(self.before.iter().zip(&self.target)) {
            for (walls, (from, to)) in group.bodies.walls.iter_mut().zip(from.iter().zip(to)) {
                for end in 0..walls.len() {
                    let turn = rotation::between(&from[end], &to[end]) * share;
                    walls[end] = rotation::turned(&from[end], &turn);
                }
            }
        }
    }
}

impl SteadySolver {
    /// Prepares for a system; its rates are set to zero.
    pub fn new(system: &mut System, options: SteadyOptions) -> Result<Self, NotSteady> {
        let time = system.time;
        let fail = |reason| NotSteady { time, reason };
        let unknowns = Unknowns::of(system);
        let freedom = Freedom::of(system, &unknowns).map_err(fail)?;
        let reach = unknowns.reach(system);
        let tangent = Tangent::new(system, &unknowns, reach).map_err(fail)?;
        Ok(Self {
            options,
            unknowns,
            freedom,
            tangent,
        })
    }

    /// Moves the system to its steady state at `time` \[s\], from its present state. On failure the system is left
    /// where it was.
    pub fn advance(&mut self, system: &mut System, time: f64) -> Result<SteadyReport, NotSteady> {
        let mut report = SteadyReport::default();
        let start = self.poses(system);
        let start_time = system.time;
        loop {
            let from = system.time;
            let mut to = time;
            let mut whole = true;
            while self.largest_turn(system, to) > LARGEST_TURN
                && (to - from).abs() > 1e-6 * (time - start_time).abs()
            {
                to = from + (to - from) / 2.0;
                whole = false;
            }
            if let Err(e) = self.increments(system, to, &mut report) {
                self.set_poses(system, &start);
                system.time = start_time;
                return Err(e);
            }
            if whole {
                return Ok(report);
            }
        }
    }

    /// From the present state to `time` by growing or shrinking increments of boundary values and imbalance.
    fn increments(
        &mut self,
        system: &mut System,
        time: f64,
        report: &mut SteadyReport,
    ) -> Result<(), NotSteady> {
        let before = self.poses(system);
        system.time = time;
        self.set_boundaries(system);
        let target = self.poses(system);
        self.set_poses(system, &before);
        let imbalance = self.imbalance(system);
        let moves = self.moves(&before, &target);
        let path = Path {
            before,
            target,
            moves,
            imbalance,
        };
        let (mut done, mut increment) = (0.0, 1.0_f64);
        while done < 1.0 {
            let good = self.poses(system);
            let to = (done + increment).min(1.0);
            match self.newton(system, &path, done, to) {
                Ok(iterations) => {
                    report.iterations += iterations;
                    report.increments += 1;
                    done = to;
                    if iterations <= EASY {
                        increment *= 2.0;
                    }
                }
                Err(reason) => {
                    self.set_poses(system, &good);
                    increment /= 2.0;
                    if increment < self.options.smallest_increment {
                        let reason = self.unheld(system).unwrap_or(reason);
                        return Err(NotSteady { time, reason });
                    }
                }
            }
        }
        report.residual = self.residual(system);
        Ok(())
    }

    /// Newton's method from the equilibrium at the share `from` of the path to the one at `to`.
    fn newton(
        &mut self,
        system: &mut System,
        path: &Path,
        from: f64,
        to: f64,
    ) -> Result<usize, String> {
        let mut last = f64::INFINITY;
        for iteration in 1..=self.options.iterations {
            // The first step follows the tangent of the path; it takes held stations and walls there.
            let ahead = if iteration == 1 { to - from } else { 0.0 };
            let mut loads = self.imbalance(system);
            if !loads.iter().all(|v| v.is_finite()) {
                return Err(diagnosis::not_finite(system));
            }
            if ahead > 0.0 {
                path.turn_walls(system, from + DIFFERENCE * ahead);
                for (load, moved) in loads.iter_mut().zip(self.imbalance(system)) {
                    *load += (moved - *load) / DIFFERENCE;
                }
                path.turn_walls(system, from);
            }
            self.tangent.fill(system, &self.unknowns);
            if let Some(station) = self.tangent.not_finite() {
                return Err(diagnosis::no_derivative(system, &self.unknowns, station));
            }
            let factors = self.tangent.factorise(&self.freedom)?;
            path.turn_walls(system, to);
            let mut change: Vec<f64> = (0..loads.len())
                .map(|i| ahead * path.moves[i] + (1.0 - to) * path.imbalance[i] - loads[i])
                .collect();
            if !solve(&factors, &mut change) {
                return Err("the tangent matrix is singular: something can move without resistance; hold it with \
                            a boundary condition or a joint"
                    .into());
            }
            let largest = change.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            // Corrections that don't shrink fast may end on another branch than the one that is followed.
            if !largest.is_finite() || (largest > CONTRACTION * last && largest > HARMLESS) {
                break;
            }
            last = largest;
            self.unknowns.displace_all(&mut system.groups, &change);
            if largest < self.options.tolerance {
                return Ok(iteration);
            }
        }
        Err("Newton's method didn't converge, however small the increment; follow the load from a smaller one \
             (ramps, closer times), or settle with the dynamic solver"
            .into())
    }

    /// Bodies that nothing holds, in words.
    fn unheld(&mut self, system: &mut System) -> Option<String> {
        self.tangent.fill(system, &self.unknowns);
        diagnosis::unheld(system, &self.unknowns, &self.freedom, &self.tangent)
    }

    /// Loads in free directions, as the right-hand side takes them.
    fn imbalance(&self, system: &mut System) -> Vec<f64> {
        system.evaluate();
        let mut loads = vec![0.0; self.unknowns.stations * PER_STATION];
        self.unknowns.read_loads(&system.groups, &mut loads);
        for (load, free) in loads.chunks_exact_mut(PER_STATION).zip(&self.freedom.free) {
            let projected = free * nalgebra::Vector6::from_column_slice(load);
            load.copy_from_slice(projected.as_slice());
        }
        loads
    }

    fn residual(&self, system: &mut System) -> f64 {
        let loads = self.imbalance(system);
        loads.iter().fold(0.0_f64, |m, v| m.max(v.abs())) / self.unknowns.scale
    }

    fn set_boundaries(&self, system: &mut System) {
        system.apply_boundaries();
        for group in &mut system.groups {
            group.bodies.state.velocity.clear_to_zero();
            group.bodies.state.omega.clear_to_zero();
        }
    }

    /// Largest rotation \[rad\] of a held frame or wall from now to `time`.
    fn largest_turn(&self, system: &mut System, time: f64) -> f64 {
        let before = self.poses(system);
        let now = std::mem::replace(&mut system.time, time);
        self.set_boundaries(system);
        let after = self.poses(system);
        system.time = now;
        self.set_poses(system, &before);
        let walls = before
            .iter()
            .zip(&after)
            .flat_map(|(b, a)| b.1.iter().zip(&a.1));
        let walls =
            walls.flat_map(|(b, a)| [0, 1].map(|end| rotation::between(&b[end], &a[end]).amax()));
        let frames = self.moves(&before, &after);
        let frames = frames
            .chunks_exact(PER_STATION)
            .flat_map(|s| s[3..].to_vec());
        walls.chain(frames).fold(0.0, |m, v| m.max(v.abs()))
    }

    /// Displacements, scaled, that take one set of poses to another.
    fn moves(&self, from: &Poses, to: &Poses) -> Vec<f64> {
        let mut moves = Vec::with_capacity(self.unknowns.stations * PER_STATION);
        for ((from, _), (to, _)) in from.iter().zip(to) {
            for k in 0..from.position.len() {
                let shift = (to.position.get(k) - from.position.get(k)) / self.unknowns.scale;
                let turn = rotation::between(&from.director.get(k), &to.director.get(k));
                moves.extend(shift.iter().chain(turn.iter()));
            }
        }
        moves
    }

    fn poses(&self, system: &System) -> Poses {
        let group = |g: &crate::group::Group| (g.bodies.state.clone(), g.bodies.walls.clone());
        system.groups.iter().map(group).collect()
    }

    fn set_poses(&self, system: &mut System, poses: &Poses) {
        for (group, (state, walls)) in system.groups.iter_mut().zip(poses) {
            group.bodies.state.clone_from(state);
            group.bodies.walls.clone_from(walls);
        }
    }
}
