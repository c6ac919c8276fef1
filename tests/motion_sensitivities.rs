//! Derivatives of a motion are those of whole new motions, for every kind of number that a scenario holds.

mod common;

use auxetica::config::Source;
use auxetica::engine::{ImplicitSolver, Model, MotionSensitivities, ReadBody};
use common::derivatives::{by_differences, hold, two_rods};

/// The robot is twisted fast, swings in gravity and remembers.
const ROBOT: &str = r#"
    laws: [
        (on: "right", apply: Auxetic(handedness: Right, factor: 0.01, averaging: Mean)),
        (on: "left", apply: Auxetic(handedness: Left, factor: 0.01, averaging: Mean)),
        (apply: Creep(share: 0.2, time: 0.05)),
    ],
    boundary: [
        (on: "right", apply: MotorAngle(angle: Ramp(to: 1.2, over: 0.1), cell: Half)),
        (on: "left", apply: MotorAngle(angle: Ramp(to: -0.7, over: 0.1))),
    ],
    forcing: [(apply: Gravity(g: (0.5, 0, -9.81)))],
    joints: [(between: ("hsa", "platform"), apply: SpringDamper(stiffness: 2e4, damping: 1, rotational_stiffness: 3))],
    markers: [(name: "platform", on: "platform", offset: (0.01, 0, 0.011))],
    solver: Implicit(dt: 0.004, duration: 0.16, tolerance: 1e-10),
"#;

/// A number of every kind.
const PATHS: [&str; 13] = [
    "rods[0].material.bending",
    "rods[0].material.twist",
    "rods[0].length",
    "rods[0].density",
    "rods[0].at[\"left\"][1]",
    "laws[*].apply.factor",
    "laws[2].apply.share",
    "laws[2].apply.time",
    "boundary[0].apply.angle.to",
    "joints[0].apply.rotational_stiffness",
    "cylinders[0].mass",
    "forcing[0].apply.g[2]",
    "joints[0].apply.damping",
];

const STEP: f64 = 0.004;

/// Pose and velocity of the platform, section force and couple in a middle.
fn outputs(model: &Model) -> Vec<f64> {
    let (point, frame) = model.marker_pose(&model.markers[0]).unwrap();
    let body = |name| model.system.body(model.system.find(name).unwrap());
    let (left, platform) = (body("left"), body("platform"));
    let mut values: Vec<f64> = point.iter().chain(frame.iter()).copied().collect();
    values.extend(platform.velocity(0).iter());
    values.extend(left.stress(3).iter());
    values.extend(left.couple(3).iter());
    values
}

fn source(sets: &[String]) -> Source {
    two_rods(ROBOT, sets)
}

fn begun(source: &Source) -> (Model, ImplicitSolver) {
    let mut model = Model::build(source, None).unwrap_or_else(|e| panic!("{e}"));
    let options = model.solver.implicit_options();
    let solver = ImplicitSolver::new(&mut model.system, options).unwrap();
    (model, solver)
}

/// Outputs after so many steps.
fn moved(source: &Source, steps: usize) -> Vec<f64> {
    let (mut model, mut solver) = begun(source);
    for step in 1..=steps {
        let time = step as f64 * STEP;
        solver.advance(&mut model.system, time).unwrap();
    }
    model.system.evaluate();
    outputs(&model)
}

#[test]
fn derivatives_are_those_of_whole_new_motions() {
    are_right(&[], &PATHS, 1e-5);
}

#[test]
fn with_damping_derivatives_are_those_of_whole_new_motions_too() {
    let damping = "damping=[(apply: LinearDamping(translational: (2, 2, 2), rotational: (1e-3, 1e-3, 1e-3)))]";
    are_right(&[damping.into()], &["rods[0].material.bending"], 2e-5);
    // what the coefficient itself does is small beside the rounding of rates that it is known by
    let coefficient = "damping[0].apply.translational[2]";
    are_right(&[damping.into()], &[coefficient], 5e-3);
}

/// Derivatives are off by no more than this of what they are, while motors turn and later.
fn are_right(sets: &[String], paths: &[&str], most: f64) {
    let source = source(sets);
    let (mut model, mut solver) = begun(&source);
    let mut sensitivities = MotionSensitivities::new(&solver, &source, None, paths)
        .unwrap_or_else(|problems| panic!("{problems}"));
    let mut step = 0;
    for steps in [12, 40] {
        while step < steps {
            step += 1;
            let time = step as f64 * STEP;
            sensitivities
                .advance(&mut solver, &mut model.system, time)
                .unwrap();
        }
        let found = sensitivities.of(&outputs);
        for (column, path) in paths.iter().enumerate() {
            let value: f64 = source.values(path).unwrap()[0].parse().unwrap();
            let wanted = by_differences(value, 3e-3 * value.abs(), |value| {
                let set = format!("{path}={value}");
                moved(&self::source(&[sets, &[set]].concat()), steps)
            });
            let kinds = [0..3, 3..12, 12..15, 15..18, 18..21];
            let found: Vec<f64> = found.column(column).iter().copied().collect();
            let what = format!("{steps} steps, {path}");
            hold(&what, &kinds, &found, &wanted, (most, 0.0));
        }
    }
}
