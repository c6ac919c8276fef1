//! The largest stable time step, found on the step itself: boundary conditions, joints, damping and the order of all
//! that included, whatever the plugins.

use crate::rotation;
use crate::system::{Saved, System};
use nalgebra::Vector3;

/// Steps that a perturbation is followed for.
const STEPS: usize = 300;
/// Growth a step beyond which a time step counts as unstable. Physical instabilities grow far slower than this.
const GROWTH: f64 = 1.01;
/// Size of the perturbation, in element lengths and radians.
const SIZE: f64 = 1e-7;

/// Mean growth a step of a small perturbation of the present state under time steps of `dt` \[s\], about the motion
/// that the state would make. Above 1 by more than a percent: unstable. The system is left as it was.
pub fn growth(system: &mut System, dt: f64) -> f64 {
    follow(system, dt).map_or(f64::INFINITY, |(growth, _)| growth)
}

/// Mean growth a step, and the perturbation after the last, whose shape is that of the fastest growing mode; nothing
/// if it blows up at once.
pub(crate) fn follow(system: &mut System, dt: f64) -> Option<(f64, Vec<f64>)> {
    let start = system.save();
    let scale = mean_element_length(system);
    if system.step(dt).is_err() {
        system.restore(&start);
        return None;
    }
    let end = system.save();
    let mut perturbation = seed(system.stations() * 12);
    let mut logarithm = 0.0;
    let mut counted = 0;
    for step in 0..STEPS {
        system.restore(&start);
        displace(system, &perturbation, scale, dt);
        if system.step(dt).is_err() {
            system.restore(&start);
            return None;
        }
        perturbation = difference(system, &end, scale, dt);
        let norm = perturbation.iter().map(|v| v * v).sum::<f64>().sqrt();
        if norm == 0.0 {
            // everything is held or damped at once
            system.restore(&start);
            return Some((0.0, perturbation));
        }
        if step >= STEPS / 2 {
            logarithm += (norm / SIZE).ln();
            counted += 1;
        }
        perturbation.iter_mut().for_each(|v| *v *= SIZE / norm);
    }
    system.restore(&start);
    Some(((logarithm / f64::from(counted)).exp(), perturbation))
}

/// Whether time steps of `dt` \[s\] are stable about the present state.
pub fn is_stable(system: &mut System, dt: f64) -> bool {
    growth(system, dt) < GROWTH
}

/// The largest stable time step \[s\] about the present state, to 1 %, sought from `guess` \[s\].
pub fn limit(system: &mut System, guess: f64) -> f64 {
    let (mut stable, mut unstable) = if is_stable(system, guess) {
        let mut stable = guess;
        while is_stable(system, 2.0 * stable) && stable < 1e6 * guess {
            stable *= 2.0;
        }
        (stable, 2.0 * stable)
    } else {
        let mut unstable = guess;
        while !is_stable(system, unstable / 2.0) && unstable > 1e-9 * guess {
            unstable /= 2.0;
        }
        (unstable / 2.0, unstable)
    };
    while unstable / stable > 1.01 {
        let middle = (stable * unstable).sqrt();
        if is_stable(system, middle) {
            stable = middle;
        } else {
            unstable = middle;
        }
    }
    stable
}

/// A time step \[s\] of the right magnitude: the time that stretch waves take through the shortest element.
pub fn wave_time(system: &System) -> f64 {
    let mut time = f64::INFINITY;
    for group in &system.groups {
        let b = &group.bodies;
        for k in b.layouts().iter().flat_map(|l| l.element_stations()) {
            let stiffness = b.built_shear_stretch.get(k).amax() / b.reference_length[k];
            time = time.min((b.mass[k].min(b.mass[k + 1]) / stiffness).sqrt());
        }
    }
    if time.is_finite() { time } else { 1e-3 }
}

pub(crate) fn mean_element_length(system: &System) -> f64 {
    let lengths = system.groups.iter().flat_map(|g| {
        let b = &g.bodies;
        let stations = b.layouts().iter().flat_map(|l| l.element_stations());
        stations.map(|k| b.reference_length[k])
    });
    let (sum, count) = lengths.fold((0.0, 0.0), |(s, n), l| (s + l, n + 1.0));
    if count > 0.0 { sum / count } else { 1.0 }
}

/// Numbers without structure and the same each time: any eigenvector has a share in them.
pub(crate) fn seed(n: usize) -> Vec<f64> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let draw = |_| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let mut numbers: Vec<f64> = (0..n).map(draw).collect();
    let norm = numbers.iter().map(|v| v * v).sum::<f64>().sqrt();
    numbers.iter_mut().for_each(|v| *v *= SIZE / norm);
    numbers
}

/// Adds a perturbation, 12 numbers a station: displacement, velocity, rotation, angular velocity; lengths are in
/// `scale` and rates are times `dt`.
pub(crate) fn displace(system: &mut System, by: &[f64], scale: f64, dt: f64) {
    let mut rest = by.chunks_exact(3).map(Vector3::from_column_slice);
    for group in &mut system.groups {
        let state = &mut group.bodies.state;
        for k in 0..state.position.len() {
            let mut next = || rest.next().unwrap_or_else(Vector3::zeros);
            state.position.add(k, next() * scale);
            state.velocity.add(k, next() * (scale / dt));
            let turned = rotation::turned(&state.director.get(k), &next());
            state.director.set(k, turned);
            state.omega.add(k, next() / dt);
        }
    }
}

/// The present state less another, as [`displace`] takes it.
fn difference(system: &System, from: &Saved, scale: f64, dt: f64) -> Vec<f64> {
    let mut numbers = Vec::with_capacity(system.stations() * 12);
    for (group, from) in system.groups.iter().zip(from.states()) {
        let to = &group.bodies.state;
        for k in 0..to.position.len() {
            let parts = [
                (to.position.get(k) - from.position.get(k)) / scale,
                (to.velocity.get(k) - from.velocity.get(k)) * (dt / scale),
                rotation::between(&from.director.get(k), &to.director.get(k)),
                (to.omega.get(k) - from.omega.get(k)) * dt,
            ];
            numbers.extend(parts.iter().flat_map(|p| p.iter()));
        }
    }
    numbers
}
