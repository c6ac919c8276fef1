//! A step of the robot, joints, motors, laws and damping included, allocates nothing.

mod common;

use auxetica::config::Source;
use auxetica::engine::Model;
use std::path::Path;

#[test]
fn a_step_allocates_nothing() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot.ron");
    let source = Source::load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
    let mut model = Model::build(&source, None).unwrap_or_else(|e| panic!("{e}"));
    let steps = |model: &mut Model| {
        for _ in 0..100 {
            model.system.step(3e-5).expect("the robot moves gently");
        }
    };
    steps(&mut model);
    let count = allocation_counter::measure(|| steps(&mut model)).count_total;
    assert_eq!(count, 0, "allocations in 100 steps");
}
