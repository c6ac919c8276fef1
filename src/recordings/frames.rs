//! From the world of the motion capture to the robot's base frame and back.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::median::{median_position, median_rotation};
use crate::{Error, Pose, Recording, Reference, RobotGeometry};

/// A world pose in axes along the base frame's, origin unmoved: `p_B = (x_W, -z_W, y_W)`.
///
/// The orientation is that of the same marker frame with its axes renamed alike
/// (`T_B = W⁻¹ T_W W`), so that an unturned body is unturned in either.
#[must_use]
pub fn to_base(world: &Pose) -> Pose {
    exchange(world, |v| Vector3::new(v.x, -v.z, v.y))
}

/// The inverse of [`to_base`]: `p_W = (x_B, z_B, -y_B)`.
#[must_use]
pub fn to_world(base: &Pose) -> Pose {
    exchange(base, |v| Vector3::new(v.x, v.z, -v.y))
}

/// Turns position and axis of rotation alike.
fn exchange(pose: &Pose, axes: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Pose {
    let rotation = Quaternion::from_parts(pose.rotation.w, axes(pose.rotation.imag()));
    Pose::from_parts(
        axes(pose.translation.vector).into(),
        UnitQuaternion::new_unchecked(rotation),
    )
}

/// Poses of a recording in the robot's base frame, one entry for every row of the recording.
///
/// Only the base's translation is removed, as the data set's authors do: the axes are the
/// world's, renamed. The origin is fixed for the run.
#[derive(Debug, Clone, PartialEq)]
pub struct BasePoses {
    /// Centroid of the platform's markers (m) and orientation of the platform.
    pub platform: Vec<Pose>,
    /// Centroid of the ring's markers (m) and orientation of the ring.
    pub ring: Vec<Pose>,
    /// Origin of the base frame (m), in the world's axes renamed as by [`to_base`].
    pub origin: Vector3<f64>,
    /// Median orientation of the base, near identity; not removed from the poses.
    pub base_rotation: UnitQuaternion<f64>,
}

impl BasePoses {
    /// Brings a recording's poses into the base frame. Its origin is the run's median base
    /// position, lowered from the base's markers to the base plane.
    ///
    /// # Errors
    /// When the recording has no motion capture, or no row.
    pub fn new(recording: &Recording, geometry: &RobotGeometry) -> Result<Self, Error> {
        let mocap = recording.require_mocap()?;
        let (Some(position), Some(rotation)) = (
            median_position(&mocap.base.position),
            median_rotation(&mocap.base.rotation),
        ) else {
            return Err(Error::Inconsistent {
                recording: recording.name.clone(),
                reason: "it has no row".into(),
            });
        };
        let base = to_base(&Pose::from_parts(position.into(), rotation));
        let origin = base.translation.vector - Vector3::z() * geometry.base_markers;
        let poses = |track: &crate::Track| {
            (0..track.position.len())
                .map(|row| shifted(&to_base(&track.pose(row)), -origin))
                .collect()
        };
        Ok(Self {
            platform: poses(&mocap.platform),
            ring: poses(&mocap.ring),
            origin,
            base_rotation: base.rotation,
        })
    }

    /// The same poses as they are compared with a simulation: positions unchanged, each rotation
    /// counted from the body's orientation at rest, `R(t) R_rest⁻¹`.
    #[must_use]
    pub fn from_rest(&self, reference: &Reference) -> Self {
        let turned = |poses: &[Pose], rest: &Pose| {
            (poses.iter())
                .map(|pose| rotation_from(pose, rest))
                .collect()
        };
        Self {
            platform: turned(&self.platform, &reference.platform),
            ring: turned(&self.ring, &reference.ring),
            ..*self
        }
    }
}

/// `pose` with its position moved by `offset`.
pub(crate) fn shifted(pose: &Pose, offset: Vector3<f64>) -> Pose {
    Pose::from_parts((pose.translation.vector + offset).into(), pose.rotation)
}

/// `pose` with its rotation counted from that of `rest`, along the base frame's axes.
pub(crate) fn rotation_from(pose: &Pose, rest: &Pose) -> Pose {
    Pose::from_parts(pose.translation, pose.rotation * rest.rotation.inverse())
}
