//! Robots beyond the paper's: motors between two bodies push both alike, segments add up, and robots of three and six
//! rods have the symmetries of their rods.

mod common;

use auxetica::config::Source;
use auxetica::engine::{Model, ReadBody, SteadyOptions, SteadySolver, System, rotation};
use common::model;
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::path::Path;

/// Position [m] and frame of a body's centre.
type Pose = (Vector3<f64>, Matrix3<f64>);

/// A shipped robot with changes.
fn robot(file: &str, overrides: &[&str]) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenarios")
        .join(file);
    let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
    let source = Source::load(&path, &overrides).unwrap_or_else(|e| panic!("{e}"));
    Model::build(&source, None).unwrap_or_else(|e| panic!("{e}"))
}

fn pose(model: &Model, body: &str) -> Pose {
    let id = model.system.find(body).expect("the robot has this body");
    let body = model.system.body(id);
    (body.position(0), body.director(0))
}

/// Poses of some bodies at every dwell.
fn states(model: &mut Model, bodies: &[&str]) -> Vec<Vec<Pose>> {
    let mut solver = SteadySolver::new(&mut model.system, SteadyOptions::default())
        .unwrap_or_else(|e| panic!("{e}"));
    let times: Vec<f64> = model.dwells.iter().map(|dwell| dwell.time).collect();
    let mut states = Vec::new();
    for time in times {
        solver
            .advance(&mut model.system, time)
            .unwrap_or_else(|e| panic!("{}: {e}", model.title));
        states.push(bodies.iter().map(|body| pose(model, body)).collect());
    }
    states
}

/// Angle [rad] of the axis from upright.
fn tilt(pose: &Pose) -> f64 {
    pose.1[(2, 0)].hypot(pose.1[(2, 1)]).atan2(pose.1[(2, 2)])
}

/// Force [N] and moment [N m] about the origin of all bodies.
fn resultants(system: &System) -> (Vector3<f64>, Vector3<f64>) {
    let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
    for id in system.ids() {
        let body = system.body(*id);
        for i in 0..body.nodes() {
            force += body.force(i);
            moment += body.position(i).cross(&body.force(i));
        }
        for e in 0..body.directors() {
            moment += body.director(e).tr_mul(&body.torque(e));
        }
    }
    (force, moment)
}

#[test]
fn a_motor_between_free_bodies_turns_both_and_pushes_both_alike() {
    let mut model = model(
        r#"(
            title: "a motor in free fall",
            cylinders: [
                (name: "arm", centre: (0.03, 0, 0.1), axis: (0.3, 0, 1), radius: 0.02, thickness: 0.04, mass: 0.05),
                (name: "base", centre: (0, 0, 0), radius: 0.05, thickness: 0.01, mass: 0.3),
            ],
            joints: [(between: ("arm", "base"), apply: SpringDamper(
                stiffness: 2e3, damping: 1, rotational_stiffness: 1, rotational_damping: 2e-3,
                twist: Ramp(to: 1.2, over: 0.2),
            ))],
            solver: Dynamic(duration: 1),
        )"#,
    );
    let [arm, base] = ["arm", "base"].map(|body| pose(&model, body).1);
    let system = &mut model.system;
    let (mut largest, mut off) = (0.0_f64, 0.0_f64);
    for _ in 0..20_000 {
        system.step(2e-5).unwrap_or_else(|e| panic!("{e}"));
        system.evaluate();
        let (force, moment) = resultants(system);
        for id in system.ids() {
            let body = system.body(*id);
            largest = largest.max(body.torque(0).norm() + 0.1 * body.force(0).norm());
        }
        off = off.max(moment.norm() + 0.1 * force.norm());
    }
    // the damper's force acts at both bodies' own points, a hair's breadth apart
    println!("torques up to {largest:.2e} N m, resultants up to {off:.1e}");
    assert!(
        largest > 1e-3 && off < 1e-8 * largest,
        "{off:e} of {largest:e}"
    );
    // at rest the arm has turned about its own axis against the base, and the base against it
    let [arm_now, base_now] = ["arm", "base"].map(|body| pose(&model, body).1);
    let relative = rotation::between(&(arm * base.transpose()), &(arm_now * base_now.transpose()));
    println!("relative turn {:?}", relative.as_slice());
    assert!((relative - Vector3::z() * 1.2).norm() < 1e-3, "{relative}");
    assert!(rotation::between(&base, &base_now).norm() > 0.01);
}

#[test]
fn a_motor_on_a_body_acts_as_one_on_the_ground() {
    let lone = |boundary: &str, joints: &str| {
        let mut model = model(&format!(
            r#"(
                title: "one rod on a plate",
                rods: [(
                    name: "rod", at: {{"only": (0.02, 0.01, 0)}}, length: 0.1, elements: 10, radius: 0.0127,
                    density: 1050, material: Rigidities(shear: 100, axial: 150, bending: 0.02, twist: 0.014),
                )],
                cylinders: [(name: "plate", centre: (0, 0, -0.01), radius: 0.05, thickness: 0.02, mass: 0.1)],
                laws: [(apply: Auxetic(handedness: Right))],
                forcing: [(on: "rod", apply: EndForce(force: (0.05, 0, 0)))],
                boundary: [
                    (on: "plate", apply: Clamp()),
                    (on: "rod", apply: Hold(end: Tip, rotation: [X, Y, Z])),
                    {boundary}
                ],
                joints: [{joints}],
                solver: Steady(at: [1]),
            )"#
        ));
        common::steady(&mut model, 1.0);
        common::tip(&model, "only")
    };
    let ground = lone(
        r#"(on: "rod", apply: MotorAngle(angle: Ramp(to: 1.5, over: 1)))"#,
        "",
    );
    let plate = |stiffness: f64| {
        let joint = format!(
            r#"(between: ("only.start", "plate"), apply: SpringDamper(
                stiffness: {stiffness}, rotational_stiffness: {stiffness}, twist: Ramp(to: 1.5, over: 1),
            ))"#
        );
        (lone("", &joint) - ground).norm()
    };
    // what is left goes with the joint's compliance
    let apart = [1e4, 1e6].map(plate);
    println!("tips apart by {apart:?} m");
    assert!(apart[0] < 1e-5 && apart[1] < apart[0] / 90.0, "{apart:?}");
}

#[test]
fn two_segments_add_up() {
    let mut two = robot("hsa_robot_two_segments.ron", &[]);
    let [platform, top] = ["platform", "top"].map(|body| pose(&two, body).0.z);
    // elongation; north twice; north and south; north and east; twist one way and the other
    let found = states(&mut two, &["platform", "top"]);
    let mut one = robot("hsa_robot.ron", &[]);
    let single = states(&mut one, &["platform"]);

    let rises = [found[0][0].0.z - platform, found[0][1].0.z - top];
    let alone = single[0][0].0.z - platform;
    println!("elongation: {rises:?} m, {alone} m of one segment");
    assert!((rises[0] - alone).abs() < 1e-9);
    // The motors' joints yield, too: 24 cells of rod and one joint in series below, two joints above [rad/(N m)].
    let (rod, joint) = (24.0 * 0.004 / 0.014, 1.0 / 20.0);
    let share = (rod + joint) / (rod + 2.0 * joint);
    let upper = (rises[1] - rises[0]) / alone;
    assert!((upper - share).abs() < 1e-4, "{upper}, not {share}");
    assert!(tilt(&found[0][1]) < 1e-9);

    let bend = tilt(&single[1][0]);
    let tilts: Vec<f64> = found.iter().map(|s| tilt(&s[1])).collect();
    println!("tilts of the top {tilts:?}, of one segment's platform {bend}");
    assert!(
        (tilts[1] / bend - 1.0 - share).abs() < 2e-3,
        "the same way: twice"
    );
    assert!(tilts[2] < 1e-2 * bend, "opposite ways: upright");
    assert!(
        tilts[3] > bend && tilts[3] < 2.0 * bend,
        "across: in between"
    );
    // the lower segment doesn't know of the upper, which weighs nothing here
    for state in &found[1..4] {
        assert!((state[0].0 - single[1][0].0).norm() < 1e-6);
    }
}

#[test]
fn three_rods_bend_alike_every_120_degrees() {
    let mut three = robot("hsa_robot_three_rods.ron", &[]);
    let found = states(&mut three, &["platform"]);
    let third = Rotation3::from_axis_angle(&Vector3::z_axis(), 120.0_f64.to_radians());
    // seven azimuths, the last again the first, on two circles
    for circle in found.chunks(7) {
        for (from, to) in [(0, 2), (2, 4), (4, 6), (1, 3), (3, 5)] {
            let (position, frame) = &circle[from][0];
            let apart = (third * position - circle[to][0].0).norm();
            let turned = frame * third.transpose().matrix();
            // the platform's own frame starts unturned in every sample
            let turned = third.matrix() * turned;
            let angle = rotation::between(&turned, &circle[to][0].1).norm();
            assert!(
                apart < 1e-9 && angle < 1e-7,
                "{from} to {to}: {apart:e} m, {angle:e} rad"
            );
        }
    }
    let lean = |k: usize| tilt(&found[k][0]);
    println!("tilts {:?}", (0..14).map(lean).collect::<Vec<_>>());
    assert!(lean(7) > 2.0 * lean(0));
}

#[test]
fn six_rods_move_as_their_symmetry_has_it() {
    let mut six = robot("hsa_robot_six_rods.ron", &[]);
    let rest = pose(&six, "platform");
    let found = states(&mut six, &["platform"]);
    let [long, north, south, west, east, clockwise, counter] =
        [0, 1, 2, 3, 4, 5, 6].map(|k| &found[k][0]);
    for (name, state) in six.dwells.iter().zip(&found) {
        let turn = rotation::between(&rest.1, &state[0].1);
        println!(
            "{:22} {:?} {:?}",
            name.name,
            state[0].0.as_slice(),
            turn.as_slice()
        );
    }
    // elongation: straight up, no turn
    assert!(long.0.xy().norm() < 1e-10 && rotation::between(&rest.1, &long.1).norm() < 1e-8);
    assert!(long.0.z - rest.0.z > 0.01);
    // opposite bends and opposite twists mirror each other
    for (a, b) in [(north, south), (east, west)] {
        assert!((tilt(a) - tilt(b)).abs() < 1e-8 && tilt(a) > 0.1);
        assert!((a.0.xy() + b.0.xy()).norm() < 1e-3, "{} {}", a.0, b.0);
    }
    let twist = |pose: &Pose| rotation::between(&rest.1, &pose.1).z;
    assert!((twist(clockwise) + twist(counter)).abs() < 1e-8 && twist(counter).abs() > 0.1);
}
