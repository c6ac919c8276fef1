//! The steady solver keeps to the branch that starts at rest, however far the motors turn at once: one jump ends where
//! many small steps end.

use auxetica::config::Source;
use auxetica::engine::{Inputs, Model, Series, SteadyOptions, SteadySolver};
use nalgebra::Vector3;
use std::path::Path;

/// Platform of the recorded robot \[m\] after its motors have turned to `angles` in so many steps.
fn platform(angles: [f64; 4], steps: u32) -> Vector3<f64> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot_recorded.ron");
    let source = Source::load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
    let motor = |(i, angle): (usize, f64)| {
        let series = Series::new(vec![0.0, 1.0], vec![0.0, angle]).expect("two points");
        (format!("motor_{}", i + 1), series)
    };
    let inputs = Inputs::new(angles.into_iter().enumerate().map(motor).collect());
    let mut model = Model::build(&source, Some(inputs)).unwrap_or_else(|e| panic!("{e}"));
    let mut solver = SteadySolver::new(&mut model.system, SteadyOptions::default())
        .unwrap_or_else(|e| panic!("{e}"));
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
