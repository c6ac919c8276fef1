//! What a rod is made of counts where it should: elements of their own, hollow sections, intrinsic strains, rigid
//! ends, hinges of rods and rigid bodies.

mod common;

use approx::assert_relative_eq;
use auxetica::engine::{
    End, LawView, Moment, Place, ReadBody, RodLaw, Section, SteadyOptions, SteadySolver,
};
use common::{model, nodes, steady, tip};
use nalgebra::Vector3;

#[test]
fn elements_of_their_own_stiffness_stretch_in_series() {
    let mut model = model(
        r#"(
            title: "two halves",
            rods: [(
                name: "rod", length: 1, elements: 4, radius: 0.01, density: 1000,
                material: Rigidities(shear: 100, axial: [100, 100, 400, 400], bending: 1, twist: 1),
            )],
            boundary: [(apply: Clamp())],
            forcing: [(apply: EndForce(force: (0, 0, 10)))],
            solver: Steady(),
        )"#,
    );
    steady(&mut model, 0.0);
    let z: Vec<f64> = nodes(&model, "rod").iter().map(|r| r.z).collect();
    // F = S (e - 1) / e, so e = 1 / (1 - F / S)
    for (e, rigidity) in [(0, 100.0), (3, 400.0)] {
        let stretch = (z[e + 1] - z[e]) / 0.25;
        assert_relative_eq!(stretch, 1.0 / (1.0 - 10.0 / rigidity), epsilon = 1e-9);
    }
}

#[test]
fn a_hollow_section_weighs_and_bends_as_a_tube() {
    let tube = Section {
        outside: 0.0127,
        inside: 0.01027,
    };
    // E A of the paper's rod (section II-E): 1753.5 N at E = 10 MPa
    let (shear_stretch, _) = tube.rigidities(1e7, 6e5);
    assert_relative_eq!(shear_stretch.z, 1753.5, epsilon = 0.05);
    // and its shear rigidity at the text's G = 0.6 MPa: 101.5 N
    assert_relative_eq!(shear_stretch.x, 101.5, epsilon = 0.05);
    let model = model(
        r#"(
            title: "tube",
            rods: [(
                name: "rod", length: 0.1, elements: 7, radius: 0.0127, wall: 0.00243, density: 1050,
                material: Moduli(youngs: 1e7, shear: 6e5),
            )],
            solver: Steady(),
        )"#,
    );
    let body = model.system.body(model.system.ids()[0]);
    let mass: f64 = (0..body.nodes()).map(|i| body.mass(i)).sum();
    assert_relative_eq!(mass, 1050.0 * 0.1 * tube.area(), epsilon = 1e-12);
    let bending = 1e7 * std::f64::consts::FRAC_PI_4 * (0.0127_f64.powi(4) - 0.01027_f64.powi(4));
    assert_relative_eq!(body.built_bend_twist(3).x, bending, epsilon = 1e-12);
}

#[test]
fn an_intrinsically_curved_rod_rests_on_its_circle() {
    let (curvature, n) = (2.0, 50);
    let mut model = model(&format!(
        r#"(
            title: "arc",
            rods: [(
                name: "rod", length: 1, elements: {n}, radius: 0.01, density: 1000,
                material: Rigidities(shear: 100, axial: 100, bending: 0.01, twist: 0.01),
                rest_curvature: (0, {curvature}, 0),
            )],
            boundary: [(apply: Clamp())],
            solver: Steady(),
        )"#
    ));
    steady(&mut model, 0.0);
    // Element e is turned by e times the angle of a cell; its first element is held straight.
    let angle = curvature / f64::from(n);
    let (mut x, mut z) = (0.0, 0.0);
    for e in 0..n {
        x += (f64::from(e) * angle).sin() / f64::from(n);
        z += (f64::from(e) * angle).cos() / f64::from(n);
    }
    let tip = tip(&model, "rod");
    assert_relative_eq!(tip.x, x, epsilon = 1e-9);
    assert_relative_eq!(tip.z, z, epsilon = 1e-9);
}

#[test]
fn a_force_on_a_rigid_end_bends_the_rod_by_its_lever() {
    let with = |cap: f64, torque: f64| {
        let mut model = model(&format!(
            r#"(
                title: "lever",
                rods: [(
                    name: "rod", length: 0.1, elements: 10, radius: 0.01, density: 1000,
                    material: Rigidities(shear: 100, axial: 100, bending: 0.01, twist: 0.01),
                    caps: (tip: {cap}),
                )],
                boundary: [(apply: Clamp())],
                forcing: [
                    (apply: EndForce(force: (1e-3, 0, 0))),
                    (apply: EndTorque(torque: (0, {torque}, 0))),
                ],
                solver: Steady(),
            )"#
        ));
        steady(&mut model, 0.0);
        let id = model.system.ids()[0];
        (
            tip(&model, "rod"),
            model.system.site(id, Place::End(End::Tip)).position,
        )
    };
    let (tip, end) = with(0.02, 0.0);
    let (same, _) = with(0.0, 0.02 * 1e-3);
    // The lever shortens with the cosine of the tip's angle, which is 1e-3 rad here.
    assert_relative_eq!(tip.x, same.x, epsilon = 1e-9);
    assert_relative_eq!((end - tip).norm(), 0.02, epsilon = 1e-12);
}

#[test]
fn gravity_pulls_with_the_whole_weight_and_at_the_middle_of_rigid_ends() {
    let mut model = model(
        r#"(
            title: "hanging sideways",
            rods: [(
                name: "rod", direction: (1, 0, 0), length: 0.1, elements: 10, radius: 0.01, density: 1000,
                material: Rigidities(shear: 1e3, axial: 1e3, bending: 10, twist: 10),
                caps: (tip: 0.05),
            )],
            boundary: [(apply: Clamp())],
            forcing: [(apply: Gravity(g: (0, 0, -10)))],
            solver: Steady(),
        )"#,
    );
    steady(&mut model, 0.0);
    let body = model.system.body(model.system.ids()[0]);
    let weight = |length: f64| 1000.0 * std::f64::consts::PI * 1e-4 * length * 10.0;
    // The cell at x = 0.05 carries the couple of what lies beyond: 50 mm of rod and the end, about its own middle.
    let couple = weight(0.05) * 0.025 + weight(0.05) * (0.05 + 0.025);
    assert_relative_eq!(body.couple(5).norm(), couple, max_relative = 1e-3);
}

/// Curls a rod by intrinsic curvature, where the file has none.
struct Curl(f64);

impl RodLaw for Curl {
    fn rest(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        for v in rod.cells() {
            rod.set_rest_kappa(v, Vector3::y() * self.0);
        }
    }
}

#[test]
fn a_law_sets_rest_strains_as_a_scenario_does() {
    let rod = |curvature: f64| {
        model(&format!(
            r#"(
                title: "curl",
                rods: [(
                    name: "rod", length: 1, elements: 8, radius: 0.01, density: 1000,
                    material: Rigidities(shear: 100, axial: 100, bending: 0.01, twist: 0.01),
                    rest_curvature: (0, {curvature}, 0),
                )],
                boundary: [(apply: Clamp())],
                solver: Steady(),
            )"#
        ))
    };
    let (mut built, mut ruled) = (rod(1.5), rod(0.0));
    let id = ruled.system.ids()[0];
    let law = Box::new(Curl(1.5));
    ruled
        .system
        .add_law(id, "curl", law)
        .expect("a rod takes a law");
    steady(&mut built, 0.0);
    steady(&mut ruled, 0.0);
    assert_relative_eq!(tip(&built, "rod"), tip(&ruled, "rod"), epsilon = 1e-12);
}

#[test]
fn a_wall_holds_a_rod_of_any_direction_and_time_may_run_back() {
    let force = |direction: &str, normal: &str, force: &str| {
        let mut model = model(&format!(
            r#"(
                title: "turned",
                rods: [(
                    name: "rod", direction: {direction}, normal: {normal}, length: 1, elements: 8, radius: 0.01,
                    density: 1000, material: Rigidities(shear: 100, axial: 100, bending: 0.1, twist: 0.1),
                )],
                boundary: [(apply: Clamp(cell: Half))],
                forcing: [(apply: EndForce(force: {force}, scale: Ramp(to: 1, over: 1)))],
                solver: Steady(),
            )"#
        ));
        let mut solver = SteadySolver::new(&mut model.system, SteadyOptions::default())
            .unwrap_or_else(|e| panic!("{e}"));
        [1.0, 0.3].map(|time| {
            let report = solver.advance(&mut model.system, time);
            let report = report.unwrap_or_else(|e| panic!("{e}"));
            (tip(&model, "rod"), report.iterations)
        })
    };
    let upright = force("(0, 0, 1)", "(1, 0, 0)", "(0.2, 0, 0)");
    let lying = force("(1, 0, 0)", "(0, 1, 0)", "(0, 0.2, 0)");
    for ((up, steps), (lay, lying_steps)) in upright.into_iter().zip(lying) {
        assert_relative_eq!(lay, Vector3::new(up.z, up.x, up.y), epsilon = 1e-9);
        assert_eq!(steps, lying_steps, "the same way there");
    }
}
