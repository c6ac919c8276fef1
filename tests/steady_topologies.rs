//! Steady states of whatever joints connect, in work per element that doesn't grow with the elements of a rod.

mod common;

use auxetica::engine::{Model, SteadyOptions, SteadyReport, SteadySolver};
use common::{model, tip};
use nalgebra::Vector3;

fn settled(text: &str, time: f64) -> (Model, SteadyReport) {
    let mut model = model(text);
    let mut solver = SteadySolver::new(&mut model.system, SteadyOptions::default()).unwrap();
    let report = solver.advance(&mut model.system, time).unwrap();
    println!("{}: {report:?}", model.title);
    assert!(report.residual < 1e-6, "{report:?}");
    (model, report)
}

/// Rods that stand on a circle, by their names and the height of their starts.
fn standing(prefix: &str, height: f64) -> String {
    let rod = |(name, x, y): (&str, f64, f64)| format!("\"{prefix}_{name}\": ({x}, {y}, {height})");
    [
        ("1", 0.02, 0.0),
        ("2", 0.0, 0.02),
        ("3", -0.02, 0.0),
        ("4", 0.0, -0.02),
    ]
    .map(rod)
    .join(", ")
}

#[test]
fn two_platforms_in_series_stand_on_eight_rods() {
    let rods = |name: &str, height: f64| {
        format!(
            r#"(name: "{name}", at: {{{}}}, length: 0.06, elements: 8, radius: 0.01, density: 1000,
                material: Rigidities(shear: 100, axial: 150, bending: 0.02, twist: 0.01))"#,
            standing(name, height)
        )
    };
    let (model, _) = settled(
        &format!(
            r#"(
                title: "two platforms in series",
                rods: [{}, {}],
                cylinders: [
                    (name: "middle", centre: (0, 0, 0.0625), radius: 0.04, thickness: 0.005, mass: 0.05),
                    (name: "top", centre: (0, 0, 0.1275), radius: 0.04, thickness: 0.005, mass: 0.05),
                ],
                boundary: [(on: "lower", apply: Clamp())],
                forcing: [(on: "top", apply: EndForce(force: (1, 0, 0)))],
                joints: [
                    (between: ("lower", "middle"), apply: SpringDamper(stiffness: 2e4, rotational_stiffness: 3)),
                    (between: ("upper", "top"), apply: SpringDamper(stiffness: 2e4, rotational_stiffness: 3)),
                    (between: ("upper_1.start", "middle"), apply: SpringDamper(stiffness: 2e4, rotational_stiffness: 3)),
                    (between: ("upper_2.start", "middle"), apply: SpringDamper(stiffness: 2e4, rotational_stiffness: 3)),
                    (between: ("upper_3.start", "middle"), apply: SpringDamper(stiffness: 2e4, rotational_stiffness: 3)),
                    (between: ("upper_4.start", "middle"), apply: SpringDamper(stiffness: 2e4, rotational_stiffness: 3)),
                ],
                solver: Steady(),
            )"#,
            rods("lower", 0.0),
            rods("upper", 0.065)
        ),
        0.0,
    );
    let [middle, top] = ["middle", "top"].map(|name| tip(&model, name));
    assert!(middle.x > 1e-4 && top.x > 2.0 * middle.x, "{middle} {top}");
    assert!(
        middle.y.abs() < 1e-9 && top.y.abs() < 1e-9,
        "{middle} {top}"
    );
}

/// A beam as one rod, and as two that are joined in its middle.
#[test]
fn a_rod_joined_to_a_rod_bends_like_one() {
    let beam = |rods: &str, joints: &str, tip_of: &str| {
        let (model, _) = settled(
            &format!(
                r#"(
                    title: "a beam of {tip_of}",
                    rods: [{rods}],
                    boundary: [(on: "a", apply: Clamp(cell: Half))],
                    forcing: [(on: "{tip_of}", apply: EndForce(force: (0, 0, -0.02)))],
                    joints: [{joints}],
                    solver: Steady(),
                )"#
            ),
            0.0,
        );
        tip(&model, tip_of).z
    };
    let rod = |name: &str, start: f64, length: f64, elements: usize| {
        format!(
            r#"(name: "{name}s", at: {{"{name}": ({start}, 0, 0)}}, direction: (1, 0, 0), length: {length},
                elements: {elements}, radius: 0.005, density: 1000, material: Moduli(youngs: 1e7, shear: 4e6))"#
        )
    };
    let one = beam(&rod("a", 0.0, 0.2, 80), "", "a");
    let two = beam(
        &[rod("a", 0.0, 0.1, 40), rod("b", 0.1, 0.1, 40)].join(", "),
        r#"(between: ("a", "b.start"), apply: SpringDamper(stiffness: 1e6, rotational_stiffness: 1e4))"#,
        "b",
    );
    println!("tip {one} as one rod, {two} as two");
    // the joint is stiff, but it takes the place of a cell that bends: one of 80, in the middle
    assert!((two / one - 1.0).abs() < 0.01, "{one} {two}");
}

#[test]
fn a_closed_loop_of_four_rods_and_four_corners() {
    let corners = [(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1)];
    let mut rods = Vec::new();
    let mut cylinders = Vec::new();
    let mut joints = Vec::new();
    for (i, (x, y)) in corners.into_iter().enumerate() {
        let (to_x, to_y) = corners[(i + 1) % 4];
        let along = Vector3::new(to_x - x, to_y - y, 0.0) * 10.0;
        let start = Vector3::new(x, y, 0.0) + along * 0.01;
        rods.push(format!(
            r#"(name: "side_{i}_group", at: {{"side_{i}": ({}, {}, 0)}}, direction: ({}, {}, 0), normal: (0, 0, 1),
                length: 0.08, elements: 10, radius: 0.002, density: 1000, material: Moduli(youngs: 1e7, shear: 4e6))"#,
            start.x, start.y, along.x, along.y
        ));
        cylinders.push(format!(
            r#"(name: "corner_{i}", centre: ({x}, {y}, 0), radius: 0.01, thickness: 0.01, density: 1000)"#
        ));
        let stiff = "SpringDamper(stiffness: 1e5, rotational_stiffness: 10)";
        joints.push(format!(
            r#"(between: ("side_{i}.start", "corner_{i}"), apply: {stiff})"#
        ));
        joints.push(format!(
            r#"(between: ("side_{i}", "corner_{}"), apply: {stiff})"#,
            (i + 1) % 4
        ));
    }
    let (model, _) = settled(
        &format!(
            r#"(
                title: "a closed loop", rods: [{}], cylinders: [{}], joints: [{}],
                boundary: [(on: "corner_0", apply: Clamp())],
                forcing: [(on: "corner_2", apply: EndForce(force: (0, 0.005, -0.005)))],
                solver: Steady(),
            )"#,
            rods.join(", "),
            cylinders.join(", "),
            joints.join(", ")
        ),
        0.0,
    );
    let [one, two, three] = [1, 2, 3].map(|i| tip(&model, &format!("corner_{i}")));
    assert!(
        two.z < 2.0 * one.z && one.z < -1e-5 && three.z < -1e-5,
        "{one} {two} {three}"
    );
}

#[test]
fn work_on_a_rod_does_not_grow_with_its_elements() {
    let work = [100, 1000, 10_000].map(|elements| {
        let (model, report) = settled(
            &format!(
                r#"(
                    title: "{elements} elements",
                    rods: [(
                        name: "rod", direction: (1, 0, 0), length: 1, elements: {elements}, radius: 0.01, density: 1000,
                        material: Moduli(youngs: 1e7, shear: 4e6),
                    )],
                    boundary: [(apply: Clamp(cell: Half))],
                    forcing: [(apply: EndForce(force: (0, 0, -0.02)))],
                    solver: Steady(tolerance: 1e-6),
                )"#
            ),
            0.0,
        );
        (tip(&model, "rod").z, report)
    });
    for (z, report) in &work[1..] {
        assert!((z / work[0].0 - 1.0).abs() < 1e-4, "{work:?}");
        assert!(
            report.factorisations <= work[0].1.factorisations,
            "{work:?}"
        );
    }
}
