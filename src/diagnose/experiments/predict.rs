//! What a model predicts for an experiment.

use super::menu::{Plan, Setup};
use crate::compare::{CompareError, markers, motor_inputs, pose, seen};
use crate::config::Source;
use crate::engine::scenario::Scenario;
use crate::engine::{Model, RunError, SteadySolver};
use crate::identify::Variant;
use crate::recordings::Pose;
use nalgebra::{UnitQuaternion, Vector3};

/// Smallest share of the way that is solved at once; a state that is harder to find makes no good experiment.
const SMALLEST: f64 = 1.0 / 16.0;
/// Steps that a model which remembers takes from one point of the way to the next.
const STEPS: usize = 20;

/// How far the platform moves in an experiment, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// Of the marker [m].
    pub position: Vector3<f64>,
    /// Rotation vector [rad].
    pub rotation: Vector3<f64>,
}

/// How far the platform moves in an experiment.
///
/// # Errors
/// If the scenario can't be built or has no steady state on the way.
pub fn predict(source: &Source, plan: &Plan) -> Result<Shift, CompareError> {
    let still = UnitQuaternion::identity();
    let [before, after] = match plan.setup {
        Setup::AsItIs => {
            let mut poses = poses(source, plan, &[plan.before, plan.at], &still)?.into_iter();
            [(); 2].map(|()| poses.next().expect("one at each time"))
        }
        Setup::Turned(by) => {
            let turn = UnitQuaternion::from_scaled_axis(by);
            let turned = turned(source, &turn)?;
            [
                poses(source, plan, &[plan.at], &still)?[0],
                poses(&turned, plan, &[plan.at], &turn)?[0],
            ]
        }
        Setup::Loaded(force) => {
            let loaded = loaded(source, force)?;
            [
                poses(source, plan, &[plan.at], &still)?[0],
                poses(&loaded, plan, &[plan.at], &still)?[0],
            ]
        }
    };
    Ok(Shift {
        position: after.translation.vector - before.translation.vector,
        rotation: (after.rotation * before.rotation.inverse()).scaled_axis(),
    })
}

/// The platform's pose at some times [s], in rising order, in the frame of a base that is turned.
fn poses(
    source: &Source,
    plan: &Plan,
    times: &[f64],
    turn: &UnitQuaternion<f64>,
) -> Result<Vec<Pose>, CompareError> {
    let (way, angles): (Vec<f64>, Vec<[f64; 4]>) = plan.way.iter().copied().unzip();
    let inputs = motor_inputs(&way, &angles).map_err(CompareError::Unfit)?;
    let mut model = Model::build(source, Some(inputs))?;
    let [platform, _] = markers(&model)?;
    // motion capture counts from the base, however that is turned
    let capture = seen(&std::mem::take(&mut model.capture));
    let mut options = model.solver.steady_options();
    options.smallest_increment = options.smallest_increment.max(SMALLEST);
    let mut solver = SteadySolver::new(&mut model.system, options).map_err(RunError::from)?;
    let mut stops = Vec::new();
    if model.system.remembers() {
        for pair in way.windows(2) {
            let step = (pair[1] - pair[0]) / STEPS as f64;
            stops.extend((0..STEPS).map(|k| pair[0] + step * k as f64));
        }
    }
    let mut found = Vec::new();
    for time in times {
        let passed = stops.partition_point(|stop| stop < time);
        for stop in stops.drain(..passed).chain([*time]) {
            let advanced = solver.advance(&mut model.system, stop);
            advanced.map_err(RunError::from)?;
        }
        let mut seen_from_base = pose(&model, &platform, None);
        seen_from_base.append_rotation_mut(&turn.inverse());
        found.push(capture * seen_from_base);
    }
    Ok(found)
}

/// The scenario with a force on the body that carries the platform's marker.
fn loaded(source: &Source, force: Vector3<f64>) -> Result<Source, CompareError> {
    let scenario: Scenario<'_> = source.parse()?;
    let marker = scenario.markers.iter().find(|m| m.name == "platform");
    let on = marker.map_or("platform", |marker| &marker.on);
    let force = written(&force);
    let entry = format!("(on: {on:?}, apply: EndForce(force: {force}))");
    Ok(Variant::new("loaded")
        .append("forcing", entry)
        .apply(source, &[])?)
}

/// The scenario with its robot turned about the origin of the base, and everything that is not the robot left alone.
fn turned(source: &Source, turn: &UnitQuaternion<f64>) -> Result<Source, CompareError> {
    let scenario: Scenario<'_> = source.parse()?;
    let go = |v: Vector3<f64>| written(&(turn * v));
    let mut sets = Vec::new();
    for (g, group) in scenario.rods.iter().enumerate() {
        sets.push(format!(
            "rods[{g}].direction={}",
            go(Vector3::from(*group.direction))
        ));
        sets.push(format!("rods[{g}].normal={}", go(group.normal())));
        let at = group.at.iter();
        let at: Vec<_> = at
            .map(|(name, p)| format!("{name:?}: {}", go(Vector3::from(**p))))
            .collect();
        if !at.is_empty() {
            sets.push(format!("rods[{g}].at={{{}}}", at.join(", ")));
        }
    }
    for (c, cylinder) in scenario.cylinders.iter().enumerate() {
        sets.push(format!(
            "cylinders[{c}].centre={}",
            go(Vector3::from(*cylinder.centre))
        ));
        sets.push(format!(
            "cylinders[{c}].axis={}",
            go(Vector3::from(*cylinder.axis))
        ));
        sets.push(format!("cylinders[{c}].normal={}", go(cylinder.normal())));
    }
    Ok(source.with(&sets)?)
}

fn written(v: &Vector3<f64>) -> String {
    format!("({:?}, {:?}, {:?})", v.x, v.y, v.z)
}
