//! Derivatives of steady states by implicit differentiation are those of whole new solutions, for every kind of number
//! that a scenario holds; what has no derivative is refused.

mod common;

use auxetica::config::Source;
use auxetica::engine::{Model, ReadBody, Sensitivities, SteadyOptions, SteadySolver};
use common::derivatives::{by_differences, hold, two_rods};

/// What twists and bends the robot, in gravity.
const ROBOT: &str = r#"
    laws: [
        (on: "right", apply: Auxetic(handedness: Right, factor: 0.01, averaging: Mean)),
        (on: "left", apply: Auxetic(handedness: Left, factor: 0.01, averaging: Mean)),
    ],
    boundary: [
        (on: "right", apply: MotorAngle(angle: Ramp(to: 1.2, over: 1), cell: Half)),
        (on: "left", apply: MotorAngle(angle: Ramp(to: -0.7, over: 1))),
    ],
    forcing: [(apply: Gravity(g: (0.5, 0, -9.81))), (on: "platform", apply: EndForce(force: (0.1, 0, 0)))],
    joints: [(between: ("hsa", "platform"), apply: SpringDamper(stiffness: 2e4, rotational_stiffness: 3))],
    markers: [(name: "platform", on: "platform", offset: (0.01, 0, 0.011)), (name: "ring", on: "left", along: 0.5)],
    solver: Steady(tolerance: 1e-11),
"#;

/// A number of every kind.
const PATHS: [&str; 15] = [
    "rods[0].material.bending",
    "rods[0].material.axial",
    "rods[0].material.twist",
    "rods[0].length",
    "rods[0].radius",
    "rods[0].at[\"left\"][1]",
    "laws[*].apply.factor",
    "laws[0].apply.factor",
    "boundary[0].apply.angle.to",
    "boundary[1].apply.angle.to",
    "joints[0].apply.stiffness",
    "joints[0].apply.rotational_stiffness",
    "cylinders[0].mass",
    "forcing[0].apply.g[2]",
    "markers[0].offset[0]",
];

/// Poses of both markers, section force and couple in a middle, and the motor's couple.
fn outputs(model: &Model) -> Vec<f64> {
    let mut values = Vec::new();
    for marker in &model.markers {
        let (point, frame) = model.marker_pose(marker).unwrap();
        values.extend(point.iter().chain(frame.iter()));
    }
    let right = model.system.body(model.system.find("right").unwrap());
    let left = model.system.body(model.system.find("left").unwrap());
    values.extend(left.stress(3).iter());
    values.extend(left.couple(3).iter());
    values.extend(right.couple(0).iter());
    values.push(left.torque(0).z);
    values
}

fn source(sets: &[String]) -> Source {
    two_rods(ROBOT, sets)
}

fn settled(source: &Source) -> (Model, SteadySolver) {
    let mut model = Model::build(source, None).unwrap_or_else(|e| panic!("{e}"));
    let options = model.solver.steady_options();
    let mut solver = SteadySolver::new(&mut model.system, options).unwrap();
    solver.advance(&mut model.system, 1.0).unwrap();
    model.system.evaluate();
    (model, solver)
}

#[test]
fn derivatives_are_those_of_whole_new_solutions() {
    let source = source(&[]);
    let (mut model, mut solver) = settled(&source);
    let mut sensitivities =
        Sensitivities::new(&source, None, &PATHS).unwrap_or_else(|e| panic!("{e}"));
    let before = model.system.save();
    let found = sensitivities
        .at(&mut solver, &mut model.system, &outputs)
        .unwrap();
    assert_eq!(model.system.save(), before);
    for (column, path) in PATHS.iter().enumerate() {
        let value: f64 = source.values(path).unwrap()[0].parse().unwrap();
        let step = if value == 0.0 {
            1e-5
        } else {
            2e-4 * value.abs()
        };
        let wanted = by_differences(value, step, |value| {
            let set = format!("{path}={value}");
            outputs(&settled(&self::source(&[set])).0)
        });
        let kinds = [0..3, 3..12, 12..15, 15..24, 24..27, 27..30, 30..33, 33..34];
        let found: Vec<f64> = found.column(column).iter().copied().collect();
        // what a marker's offset doesn't move is rounding
        hold(path, &kinds, &found, &wanted, (1e-5, 1e-9));
    }
}

#[test]
fn following_a_trajectory_gives_the_same_derivatives_as_a_fresh_start() {
    let source = source(&[]);
    let paths = ["rods[0].material.bending", "laws[*].apply.factor"];
    let mut sensitivities = Sensitivities::new(&source, None, &paths).unwrap();
    let (mut model, mut solver) = settled(&source);
    let wanted = sensitivities
        .at(&mut solver, &mut model.system, &outputs)
        .unwrap();
    for time in [0.3, 0.6, 1.0] {
        solver.advance(&mut model.system, time).unwrap();
        let found = sensitivities
            .at(&mut solver, &mut model.system, &outputs)
            .unwrap();
        let off = (&found - &wanted).amax() / wanted.amax();
        assert_eq!(off < 1e-7, time > 0.9, "{time}: {off:e}");
    }
}

#[test]
fn what_has_no_derivative_is_refused() {
    for (path, words) in [
        ("rods[0].elements", "can't be varied"),
        ("rods[0].name", "is no number but `\"hsa\"`"),
        ("rods[0].lenght", "gives no value at `rods[0].lenght`"),
        (
            "boundary[*].apply.angle.to",
            "means different numbers, 1.2 and -0.7",
        ),
        ("rods[2].length", "has no [2]"),
        ("markers[0].along", "gives no value"),
    ] {
        let refused = Sensitivities::new(&source(&[]), None, &[path]);
        let message = refused.err().expect(path).to_string();
        println!("{message}\n");
        assert!(message.contains(words), "{path}: {message}");
    }
    let along = source(&["markers[1].along=0".into()]);
    let refused = Sensitivities::new(&along, None, &["markers[1].along"]);
    let message = refused.err().expect("less than 0 is refused").to_string();
    assert!(message.contains("-0.0001 is refused"), "{message}");
}

#[test]
fn a_singular_state_has_no_derivatives() {
    // nothing holds the platform
    let free = source(&["joints=[]".into(), "forcing=[]".into()]);
    let mut model = Model::build(&free, None).unwrap_or_else(|e| panic!("{e}"));
    let mut solver = SteadySolver::new(&mut model.system, SteadyOptions::default()).unwrap();
    let mut sensitivities = Sensitivities::new(&free, None, &["rods[0].length"]).unwrap();
    let refused = sensitivities.at(&mut solver, &mut model.system, &outputs);
    let message = refused.unwrap_err().to_string();
    assert!(message.contains("singular"), "{message}");
}
