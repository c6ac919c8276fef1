//! A base that gives way moves a rod's tip as springs in series do.

mod common;

use approx::assert_relative_eq;
use common::{model, steady, tip};
use nalgebra::{Vector3, vector};

const LENGTH: f64 = 0.1;
const CAP: f64 = 0.03;

/// Tip of a rod along z with a rigid first end, under a force at its tip [m].
fn pushed(force: Vector3<f64>, cell: &str, laws: &str) -> Vector3<f64> {
    let [x, y, z] = force.into();
    let mut model = model(&format!(
        r#"(
            title: "a rod on a base",
            rods: [(
                name: "rod", length: {LENGTH}, elements: 8, radius: 0.01, density: 1000, caps: (start: {CAP}),
                material: Rigidities(shear: 100, axial: 150, bending: 0.02, twist: 0.01),
            )],
            laws: [{laws}],
            boundary: [(apply: Clamp(cell: {cell}))],
            forcing: [(apply: EndForce(force: ({x:?}, {y:?}, {z:?})))],
            solver: Steady(),
        )"#
    ));
    steady(&mut model, 0.0);
    tip(&model, "rod")
}

#[test]
fn small_loads_move_the_tip_by_the_springs_too() {
    let (k, k_f) = (0.4, 300.0);
    let law = format!("(apply: BaseCompliance(rotational_stiffness: {k}, stiffness: {k_f}))");
    let force: Vector3<f64> = 1e-5 * vector![3.0, -2.0, 1.0];
    let arm = LENGTH + CAP;
    let moved = force / k_f + arm * arm / k * vector![force.x, force.y, 0.0];
    for cell in ["Rigid", "Half"] {
        let more = pushed(force, cell, &law) - pushed(force, cell, "");
        // what the solver tolerates
        assert_relative_eq!(more, moved, epsilon = 3e-11);
    }
}

#[test]
fn an_axial_force_loads_the_lever_where_it_is() {
    // a stiff, twist-free rod on its base is a pendulum upside down: k angle = F (L + a) sin(angle) at its own load
    let (k, force) = (2.0, vector![0.02, 0.0, -5.0]);
    let law = format!("(apply: BaseCompliance(rotational_stiffness: {k}))");
    let stiff = "(apply: Stiffness(shear: 1e4, axial: 1e4, bending: (1e3, 1e3)))";
    let tip = pushed(force, "Rigid", &format!("{stiff}, {law}"));
    let arm = LENGTH + CAP;
    let angle = (0..100).fold(0.0_f64, |angle, _| {
        arm / k * (force.x * angle.cos() - force.z * angle.sin())
    });
    // the rod itself gives way a little
    assert_relative_eq!(tip.x, arm * angle.sin(), max_relative = 3e-3);
}

#[test]
fn springs_that_are_left_out_are_rigid() {
    let force = vector![0.3, 0.1, -1.0];
    let rigid = pushed(force, "Half", "");
    let law = pushed(force, "Half", "(apply: BaseCompliance())");
    assert_relative_eq!(law, rigid, epsilon = 1e-12);
}

#[test]
fn springs_in_series_come_after_all_other_laws_wherever_they_are_listed() {
    let force = vector![0.3, 0.1, -1.0];
    for series in [
        "(apply: BaseCompliance(rotational_stiffness: 0.4, stiffness: 300))",
        "(apply: MotorCompliance(stiffness: 0.1))",
    ] {
        let other = "(apply: Stiffness(axial: 0.5, shear: 0.7, bending: (0.8, 0.9), twist: 0.6))";
        let after = pushed(force, "Half", &format!("{other}, {series}"));
        let before = pushed(force, "Half", &format!("{series}, {other}"));
        assert_relative_eq!(after, before, epsilon = 1e-12);
        assert!(
            (after - pushed(force, "Half", other)).norm() > 1e-6,
            "{series}"
        );
    }
}
