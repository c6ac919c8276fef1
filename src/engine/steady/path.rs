//! Poses of a system, and the way from one equilibrium to the next.

use super::unknowns::{PER_STATION, Unknowns};
use crate::bodies::State;
use crate::rotation;
use crate::system::System;
use nalgebra::Matrix3;

/// Positions, frames and walls of all groups.
#[derive(Clone)]
pub(super) struct Poses(Vec<(State, Vec<[Matrix3<f64>; 2]>)>);

impl Poses {
    /// The present ones.
    pub(super) fn of(system: &System) -> Self {
        let group = |g: &crate::group::Group| (g.bodies.state.clone(), g.bodies.walls.clone());
        Self(system.groups.iter().map(group).collect())
    }

    /// Moves a system there; what its laws remember stays.
    pub(super) fn set(&self, system: &mut System) {
        for (group, (state, walls)) in system.groups.iter_mut().zip(&self.0) {
            group.bodies.state.pose_as(state);
            group.bodies.walls.clone_from(walls);
        }
    }

    /// Displacements, scaled, that lead from here to `other`.
    pub(super) fn moves(&self, other: &Self, scale: f64) -> Vec<f64> {
        let mut moves = Vec::new();
        for ((from, _), (to, _)) in self.0.iter().zip(&other.0) {
            for k in 0..from.position.len() {
                let shift = (to.position.get(k) - from.position.get(k)) / scale;
                let turn = rotation::between(&from.director.get(k), &to.director.get(k));
                moves.extend(shift.iter().chain(turn.iter()));
            }
        }
        moves
    }

    /// Walls here and in `other`.
    fn walls<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = [&'a Matrix3<f64>; 2]> {
        let groups = self.0.iter().zip(&other.0);
        let bodies = groups.flat_map(|((_, from), (_, to))| from.iter().zip(to));
        bodies.flat_map(|(from, to)| from.iter().zip(to).map(|(from, to)| [from, to]))
    }
}

/// Puts what is held where boundary values of the present time have it, at rest.
pub(super) fn hold(system: &mut System) {
    system.apply_boundaries();
    for group in &mut system.groups {
        group.bodies.state.stop();
    }
}

/// Where boundary values of `time` \[s\] put what is held; all else stays.
pub(super) fn held_at(system: &mut System, time: f64) -> Poses {
    let before = Poses::of(system);
    let now = std::mem::replace(&mut system.time, time);
    hold(system);
    let after = Poses::of(system);
    system.time = now;
    before.set(system);
    after
}

/// Largest rotation \[rad\] of a held frame or wall from now to `time` \[s\].
pub(super) fn largest_turn(system: &mut System, time: f64, unknowns: &Unknowns) -> f64 {
    let (before, after) = (Poses::of(system), held_at(system, time));
    let walls = before
        .walls(&after)
        .map(|[b, a]| rotation::between(b, a).amax());
    let moves = before.moves(&after, unknowns.scale);
    let frames = moves.chunks_exact(PER_STATION).flat_map(|s| &s[3..]);
    walls.chain(frames.map(|v| v.abs())).fold(0.0, f64::max)
}

/// The way from one equilibrium to the next: what is held moves, and what was out of balance fades.
pub(super) struct Path {
    before: Poses,
    target: Poses,
    /// Displacements of held stations.
    pub(super) moves: Vec<f64>,
    /// Loads out of balance at its start.
    pub(super) imbalance: Vec<f64>,
}

impl Path {
    /// From the present poses to what is held at `target`.
    pub(super) fn new(
        system: &System,
        target: Poses,
        imbalance: Vec<f64>,
        unknowns: &Unknowns,
    ) -> Self {
        let before = Poses::of(system);
        Self {
            moves: before.moves(&target, unknowns.scale),
            before,
            target,
            imbalance,
        }
    }

    /// Turns walls a share of the way. They are no unknowns, so this is all of their motion.
    pub(super) fn turn_walls(&self, system: &mut System, share: f64) {
        let mut pairs = self.before.walls(&self.target);
        for walls in system.groups.iter_mut().flat_map(|g| &mut g.bodies.walls) {
            for (wall, [from, to]) in walls.iter_mut().zip(&mut pairs) {
                *wall = rotation::turned(from, &(rotation::between(from, to) * share));
            }
        }
    }
}
