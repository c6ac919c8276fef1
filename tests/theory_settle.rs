//! A column that is pressed beyond Euler's load settles, from next to upright, where the elastica has it.

mod common;

use auxetica::engine::{ImplicitOptions, ImplicitSolver, SteadyOptions, SteadySolver};
use common::{model, tip};
use std::f64::consts::{FRAC_PI_2, PI};

/// Modulus of the elastica of a clamped column pressed by a multiple of Euler's load: `K(p) = pi / 2 sqrt(multiple)`.
fn modulus(multiple: f64) -> f64 {
    // Gauss's arithmetic-geometric mean
    let quarter_period = |p: f64| {
        let (mut a, mut b) = (1.0, (1.0 - p * p).sqrt());
        for _ in 0..20 {
            (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
        }
        FRAC_PI_2 / a
    };
    let (mut low, mut high) = (0.0, 0.999_999);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if quarter_period(middle) < FRAC_PI_2 * multiple.sqrt() {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn a_column_beyond_eulers_load_settles_on_the_elastica() {
    for multiple in [1.1, 1.5, 2.0] {
        let load = multiple * PI.powi(2) / 4.0;
        let mut model = model(&format!(
            r#"(
                title: "column",
                rods: [(
                    name: "rod", length: 1, elements: 60, radius: 0.005, density: 1e4,
                    material: Rigidities(shear: 1e6, axial: 1e6, bending: 1, twist: 1),
                )],
                boundary: [(apply: Clamp(cell: Half))],
                forcing: [(apply: EndForce(force: (1e-4, 0, {:?})))],
                solver: Steady(),
            )"#,
            -load
        ));
        let options = ImplicitOptions {
            spectral_radius: 0.0,
            tolerance: 1e-9,
            ..ImplicitOptions::default()
        };
        let mut solver = ImplicitSolver::new(&mut model.system, options).unwrap();
        solver.settle(&mut model.system, 0.3).unwrap();
        // nothing is left of the motion: the state is a steady one, and stable
        let before = tip(&model, "rod");
        let mut steady = SteadySolver::new(&mut model.system, SteadyOptions::default()).unwrap();
        steady.advance(&mut model.system, 0.0).unwrap();
        let after = tip(&model, "rod");
        assert!((after - before).norm() < 1e-6, "{before:?}, {after:?}");
        // only the small force keeps the column from turning about the load's line
        assert!(steady.stability(&mut model.system).unwrap().is_stable());
        let deflection = 2.0 * modulus(multiple) / load.sqrt();
        let off = after.x / deflection - 1.0;
        println!(
            "{multiple} times Euler's load: {:.4} of the length sideways, {off:+.1e} off the elastica; {:?}",
            after.x,
            solver.report()
        );
        assert!(off.abs() < 3e-3, "{multiple}: {} for {deflection}", after.x);
    }
}
