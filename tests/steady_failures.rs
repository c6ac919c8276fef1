//! Where there is no steady state the solver says whose fault it is, and leaves the system as it was.

mod common;

use auxetica::engine::{
    Forcing, LawView, LoadView, Model, Moment, ReadBody, RodLaw, SteadyOptions, SteadySolver,
    steady::NotSteady,
};
use common::model;
use nalgebra::Vector3;

/// Everything held and connected.
const HELD: &str = r#"boundary: [(on: "rod", apply: Clamp())],
           joints: [(between: ("rod.tip", "disc"), apply: SpringDamper(stiffness: 1e4, rotational_stiffness: 10))],"#;

fn scenario(rest: &str) -> Model {
    model(&format!(
        r#"(
            title: "a rod and a disc",
            rods: [(
                name: "rod", length: 0.1, elements: 10, radius: 0.01, density: 1000,
                material: Moduli(youngs: 1e6, shear: 3e5),
            )],
            cylinders: [(name: "disc", centre: (0, 0, 0.105), radius: 0.03, thickness: 0.01, density: 1000)],
            forcing: [(apply: Gravity())],
            {rest}
            solver: Steady(),
        )"#
    ))
}

/// Why there is no steady state.
fn reason(model: &mut Model) -> String {
    let mut solver = SteadySolver::new(&mut model.system, SteadyOptions::default()).unwrap();
    let before = model.system.save();
    let NotSteady { reason, .. } = solver.advance(&mut model.system, 1.0).unwrap_err();
    assert_eq!(model.system.save(), before);
    println!("{reason}");
    reason
}

#[test]
fn a_free_robot_is_named() {
    let mut model = scenario(
        r#"joints: [(between: ("rod.tip", "disc"), apply: SpringDamper(stiffness: 1e4, rotational_stiffness: 10))],"#,
    );
    let reason = reason(&mut model);
    assert!(reason.starts_with("`rod`, `disc` are free to "), "{reason}");
}

#[test]
fn a_free_disc_is_named() {
    let reason = reason(&mut scenario("boundary: [(on: \"rod\", apply: Clamp())],"));
    assert!(
        reason.starts_with("`disc` is free to move along"),
        "{reason}"
    );
}

#[test]
fn a_disc_on_a_ball_joint_is_named() {
    let mut model = scenario(
        r#"boundary: [(on: "rod", apply: Clamp())],
           joints: [(between: ("rod.tip", "disc"), apply: SpringDamper(stiffness: 1e4, rotational_stiffness: 0))],"#,
    );
    // off its balance by a torque about its own axis, which nothing takes
    let disc = model.system.find("disc").unwrap();
    let spin = Spin(1e-3);
    model
        .system
        .add_forcing(disc, "Spin", Box::new(spin))
        .unwrap();
    let reason = reason(&mut model);
    assert!(
        reason.starts_with("`disc` is free to turn about"),
        "{reason}"
    );
}

struct Spin(f64);

impl Forcing for Spin {
    fn apply(&self, _now: &Moment<'_>, body: &mut LoadView<'_>) {
        body.add_torque(0, Vector3::z() * self.0);
    }
}

#[test]
fn a_load_that_is_no_number_is_named() {
    let mut model = scenario(HELD);
    let disc = model.system.find("disc").unwrap();
    model
        .system
        .add_forcing(disc, "Spin (forcing[1])", Box::new(Spin(f64::NAN)))
        .unwrap();
    let reason = reason(&mut model);
    assert!(
        reason.contains("loads on `disc` at node 0") && reason.contains("from Spin (forcing[1])"),
        "{reason}"
    );
}

/// A law that is no number beyond a stretch.
struct Brittle {
    limit: f64,
}

impl RodLaw for Brittle {
    fn rest(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    fn stress(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        for e in 0..rod.elements() {
            let stretch = rod.sigma(e).z.abs();
            let stress = if stretch > self.limit { f64::NAN } else { 0.0 };
            rod.add_stress(e, Vector3::z() * stress);
        }
    }
}

#[test]
fn a_law_that_has_no_value_is_named() {
    for (limit, words) in [
        (-1.0, "come from Brittle (laws[0])"),
        (1e-5, "loads on `rod` at node"),
    ] {
        let mut model = scenario(HELD);
        let rod = model.system.find("rod").unwrap();
        let law = Box::new(Brittle { limit });
        let named = model.system.add_law(rod, "Brittle (laws[0])", law);
        named.unwrap();
        let reason = reason(&mut model);
        assert!(reason.contains(words), "{reason}");
    }
}
