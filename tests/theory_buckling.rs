//! Rods buckle at the loads of theory: Euler's under compression, Greenhill's under twist.

mod common;

use auxetica::engine::{Forcing, LoadView, Model, Moment, ReadBody};
use common::{model, nodes, steady, tip};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Where the stiffness against a small imperfection vanishes, from `(load, deflection)` at the two largest loads.
/// Below buckling the deflection is that imperfection over a stiffness which falls linearly with the load (Southwell).
fn buckling_load(loads: [f64; 2], deflections: [f64; 2]) -> f64 {
    let stiffness = deflections.map(|w| 1.0 / w);
    loads[1] + (loads[1] - loads[0]) * stiffness[1] / (stiffness[0] - stiffness[1])
}

/// A slender rod of bending rigidity 1 and length 1, clamped through half cells at the start.
fn slender(elements: usize, twist: f64, hooks: &str) -> Model {
    model(&format!(
        r#"(
            title: "slender rod",
            rods: [(
                name: "rod", length: 1, elements: {elements}, radius: 0.005, density: 1000,
                material: Rigidities(shear: 1e6, axial: 1e6, bending: 1, twist: {twist}),
            )],
            {hooks}
            solver: Steady(),
        )"#
    ))
}

#[test]
fn a_compressed_cantilever_buckles_at_eulers_load() {
    let euler = PI.powi(2) / 4.0;
    let loads = [0.95, 0.98].map(|share| share * euler);
    let deflections = loads.map(|load| {
        let mut model = slender(
            40,
            1.0,
            &format!(
                "boundary: [(apply: Clamp(cell: Half))],
             forcing: [(apply: EndForce(force: (1e-7, 0, -{load})))],"
            ),
        );
        steady(&mut model, 0.0);
        tip(&model, "rod").x
    });
    let error = buckling_load(loads, deflections) / euler - 1.0;
    println!("Euler: {:+.3} %", 100.0 * error);
    assert!(error.abs() < 2e-4, "{error}");
}

/// A force on one node.
struct Push(usize, Vector3<f64>);

impl Forcing for Push {
    fn apply(&self, _now: &Moment<'_>, body: &mut LoadView<'_>) {
        body.add_force(self.0, self.1);
    }
}

/// Both ends clamped, the start turned. With z = x + i y the couple M leaves B z''' - i M z'' constant, and z = z' = 0
/// at both ends first has another solution than 0 at M L / B = 8.9868, twice the first root of tan x = x. Before it the
/// rod is straight and without axial force, so that it doesn't matter whether an end may slide.
#[test]
fn a_twisted_rod_buckles_at_greenhills_couple() {
    let (critical, twist, elements) = (8.986_818_916, 3.0, 60);
    let couples = [0.95, 0.98].map(|share| share * critical);
    let deflections = couples.map(|couple| {
        let mut model = slender(
            elements,
            twist,
            &format!(
                "boundary: [
                (apply: MotorAngle(angle: Ramp(to: {}, over: 1), cell: Half)),
                (apply: Clamp(end: Tip, cell: Half)),
             ],",
                couple / twist
            ),
        );
        let rod = model.system.find("rod").expect("the rod");
        let push = Push(elements / 3, Vector3::new(1e-6, 0.0, 0.0));
        model
            .system
            .add_forcing(rod, "push", Box::new(push))
            .expect("a rod can be pushed");
        steady(&mut model, 1.0);
        let body = model.system.body(rod);
        let middle = body.couple(elements / 2).z.abs();
        assert!(
            (middle / couple - 1.0).abs() < 1e-4,
            "couple {middle} instead of {couple}"
        );
        nodes(&model, "rod")
            .iter()
            .map(|p| p.xy().norm())
            .fold(0.0, f64::max)
    });
    let error = buckling_load(couples, deflections) / critical - 1.0;
    println!(
        "Greenhill: {:+.3} %, deflections {deflections:?}",
        100.0 * error
    );
    assert!(
        deflections[1] > 2.0 * deflections[0],
        "the imperfection doesn't excite the mode"
    );
    assert!(error.abs() < 2e-3, "{error}");
}
