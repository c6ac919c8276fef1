//! The steady solver keeps to the branch that starts at rest, however far the motors turn at once: one jump ends where
//! many small steps end. It finds few tangents on the way, and so does the implicit solver.

use auxetica::config::Source;
use auxetica::engine::{
    ImplicitOptions, ImplicitSolver, Inputs, Model, Series, SteadyOptions, SteadySolver,
};
use nalgebra::Vector3;
use std::path::Path;

/// A robot whose motors turn from rest to `angles` over 1 s.
fn robot(scenario: &str, angles: [f64; 4]) -> (Model, SteadySolver) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenarios")
        .join(scenario);
    let source = Source::load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
    let motor = |(i, angle): (usize, f64)| {
        let series = Series::new(vec![0.0, 1.0], vec![0.0, angle]).expect("two points");
        (format!("motor_{}", i + 1), series)
    };
    let inputs = Inputs::new(angles.into_iter().enumerate().map(motor).collect());
    let mut model = Model::build(&source, Some(inputs)).unwrap_or_else(|e| panic!("{e}"));
    let solver = SteadySolver::new(&mut model.system, SteadyOptions::default())
        .unwrap_or_else(|e| panic!("{e}"));
    (model, solver)
}

/// Platform of the recorded robot \[m\] after its motors have turned to `angles` in so many steps.
fn platform(angles: [f64; 4], steps: u32) -> Vector3<f64> {
    let (mut model, mut solver) = robot("hsa_robot_recorded.ron", angles);
    for step in 0..=steps {
        let time = f64::from(step) / f64::from(steps);
        solver
            .advance(&mut model.system, time)
            .unwrap_or_else(|e| panic!("{angles:?} in {steps} steps: {e}"));
    }
    let marker = &model.markers[0];
    model.marker_pose(marker).expect("the platform's marker").0
}

#[test]
fn a_jump_ends_where_small_steps_end() {
    // bends in all directions, elongation, a mix; the first had once ended 26 mm away
    for angles in [
        [1.96, -1.96, 1.18, -1.18],
        [3.1, -3.1, 0.0, 0.0],
        [0.0, -2.5, 2.5, 0.0],
        [2.1, -2.1, 2.1, -2.1],
        [2.6, -0.4, 1.2, -2.9],
    ] {
        let apart = (platform(angles, 1) - platform(angles, 40)).norm();
        println!("{angles:?}: {apart:.1e} m");
        assert!(apart < 1e-9, "{angles:?}: {apart:.1e} m");
    }
}

/// Half a turn of all motors from rest, then a little further: what it takes is work that a clock can't tell reliably.
#[test]
fn iterations_share_tangents() {
    let (mut model, mut solver) = robot("hsa_robot.ron", [3.1, -3.1, 3.1, -3.1]);
    let from_rest = solver.advance(&mut model.system, 0.99).unwrap();
    let further = solver.advance(&mut model.system, 1.0).unwrap();
    println!("{from_rest:?}, {further:?}");
    assert!(from_rest.factorisations <= 7 && from_rest.evaluations <= 430);
    assert!(further.factorisations == 0 && further.evaluations <= 10);
}

#[test]
fn implicit_steps_share_tangents() {
    let (mut model, _) = robot("hsa_robot.ron", [3.1, -3.1, 3.1, -3.1]);
    let options = ImplicitOptions::default();
    let mut solver = ImplicitSolver::new(&mut model.system, options).unwrap();
    for step in 1..=50 {
        let time = 0.02 * f64::from(step);
        solver.advance(&mut model.system, time).unwrap();
    }
    let report = solver.report();
    println!("{report:?}");
    assert!(report.halved <= 1 && report.iterations <= 170 && report.factorisations <= 7);
}
