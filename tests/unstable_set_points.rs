//! Set-points at which a scenario isn't stable are found: those of a robot with rods too soft in bending to stand upright when
//! it is twisted far, and none of a stiffer one, nor of one that is let go.

mod common;

use auxetica::config::Source;
use auxetica::diagnose::forward::unstable;
use auxetica::diagnose::samples::{Phase, Samples};
use auxetica::engine::{Inputs, Series};
use auxetica::identify::Robot;
use common::made::recorded;
use std::path::Path;

fn robot(bending: f64) -> Source {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot_concealed.ron");
    let bending = format!("rods[0].material.bending={bending:?}");
    let source = Source::load(&file, &[bending, "uncertain=[]".to_owned()]);
    source.unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn set_points_at_which_the_scenario_is_not_stable_are_found() {
    let stiff = robot(0.02);
    let shape = Robot::of(&stiff).unwrap_or_else(|e| panic!("{e}"));
    let recording = recorded(&stiff, &shape).unwrap_or_else(|e| panic!("{e}"));
    let samples = Samples::of(&recording).unwrap_or_else(|e| panic!("{e}"));
    let (times, all) = unstable(&stiff, &samples).unwrap_or_else(|e| panic!("{e}"));
    assert!(times.is_empty() && all >= 8, "{times:?} of {all}");

    // two opposite rods wound further and further: beyond some angle the robot stands upright on an edge
    let last = samples.list.last().expect("samples").time;
    let motor = |i: usize| {
        let to = [6.0, 0.0, 6.0, 0.0][i];
        let series = Series::new(vec![0.0, last], vec![0.0, to]).expect("two points");
        (format!("motor_{}", i + 1), series)
    };
    let mut wound = samples.clone();
    wound.inputs = Inputs::new((0..4).map(motor).collect());
    let soft = robot(0.01);
    let (times, _) = unstable(&soft, &wound).unwrap_or_else(|e| panic!("{e}"));
    let settled = wound.list.iter().filter(|s| s.phase == Phase::Settled);
    let settled: Vec<f64> = settled.map(|s| s.time).collect();
    println!("{times:?} of {settled:?}");
    assert_eq!(times, settled[6..]);

    // let go, it leans
    let leaning = soft.with(&["solver=Steady(branch: Stable)".to_owned()]);
    let leaning = leaning.unwrap_or_else(|e| panic!("{e}"));
    let (times, _) = unstable(&leaning, &wound).unwrap_or_else(|e| panic!("{e}"));
    assert!(times.is_empty(), "{times:?}");
}
