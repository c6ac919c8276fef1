//! The paper's simulated robot, ready to be put into steady states.

use super::ReproduceError;
use crate::config::Source;
use crate::engine::{Inputs, Model, ReadBody};
use crate::report::Pose;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

const SCENARIO: &str = include_str!("../../scenarios/hsa_robot.ron");

/// The robot of `scenarios/hsa_robot.ron`, under its own inputs or others.
pub(super) fn robot(inputs: Option<Inputs>) -> Result<Model, ReproduceError> {
    let source = Source::from_text("scenarios/hsa_robot.ron (embedded)", SCENARIO, &[])?;
    Ok(Model::build(&source, inputs)?)
}

/// Names of the rods.
pub(super) const RODS: [&str; 4] = ["rod_1", "rod_2", "rod_3", "rod_4"];

/// Poses of a rod's elements, at their middles, z along the rod.
pub(super) fn along(model: &Model, rod: &str) -> Vec<Pose> {
    let id = model.system.find(rod).expect("the scenario has this rod");
    let rod = model.system.body(id);
    let middle = |e: usize| (rod.position(e) + rod.position(e + 1)) / 2.0;
    (0..rod.elements())
        .map(|e| pose(middle(e), rod.director(e)))
        .collect()
}

/// Poses of the elements of all rods as the authors have them: laterally from the rod's first middle, along the robot
/// from the rod's base.
pub(super) fn element_poses(model: &Model) -> Vec<Vec<Pose>> {
    let of = |rod: &str| {
        let mut poses = along(model, rod);
        let id = model.system.find(rod).expect("the scenario has this rod");
        let first = poses[0].translation.vector;
        let origin = Vector3::new(first.x, first.y, model.system.body(id).position(0).z);
        for pose in &mut poses {
            pose.translation.vector -= origin;
        }
        poses
    };
    RODS.map(of).into()
}

/// A pose of a point and a frame whose rows are the directors.
pub(super) fn pose(point: Vector3<f64>, frame: Matrix3<f64>) -> Pose {
    let turn = Rotation3::from_matrix_unchecked(frame.transpose());
    Pose::from_parts(point.into(), UnitQuaternion::from_rotation_matrix(&turn))
}

/// Pose of the platform.
pub(super) fn platform_pose(model: &Model) -> Pose {
    let id = model
        .system
        .find("platform")
        .expect("the scenario has a platform");
    let platform = model.system.body(id);
    pose(platform.position(0), platform.director(0))
}
