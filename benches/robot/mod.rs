//! The paper's robot, and numbers of it that derivatives are taken with respect to.

use auxetica::config::Source;
use std::path::Path;

pub const NUMBERS: [&str; 10] = [
    "rods[0].length",
    "rods[0].radius",
    "rods[0].material.youngs",
    "rods[0].material.shear",
    "rods[0].material.bending",
    "rods[0].material.twist",
    "laws[*].apply.factor",
    "joints[0].apply.stiffness",
    "joints[0].apply.rotational_stiffness",
    "cylinders[0].radius",
];

pub fn scenario() -> Source {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot.ron");
    Source::load(&path, &[]).unwrap_or_else(|e| panic!("{e}"))
}
