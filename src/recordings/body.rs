//! The bodies that motion capture follows, and their poses over time.

use std::fmt;

use nalgebra::{UnitQuaternion, Vector3};

use crate::Pose;

/// A body that carries motion-capture markers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Body {
    /// Plate that carries the motors.
    Base,
    /// Plate that joins the tips of the rods.
    Platform,
    /// Ring at mid-height of the third rod.
    Ring,
}

impl Body {
    /// All bodies, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Base, Self::Platform, Self::Ring];

    /// Number of the body in the files: 2, 3 or 4.
    #[must_use]
    pub fn number(self) -> u8 {
        match self {
            Self::Base => 2,
            Self::Platform => 3,
            Self::Ring => 4,
        }
    }
}

impl fmt::Display for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Base => "base",
            Self::Platform => "platform",
            Self::Ring => "ring",
        })
    }
}

/// Poses of one body in the world frame, one a row.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Centroid of the body's markers (m), one a row.
    pub position: Vec<Vector3<f64>>,
    /// Orientation of the body's marker frame, one a row, sign-continuous.
    pub rotation: Vec<UnitQuaternion<f64>>,
    /// How many quaternions were negated to make the sign continuous.
    pub sign_flips: usize,
}

impl Track {
    /// Takes the poses of a body and makes the sign of its quaternions continuous, which leaves
    /// every rotation as it is.
    #[must_use]
    pub fn new(poses: impl IntoIterator<Item = Pose>) -> Self {
        let mut track = Self {
            position: Vec::new(),
            rotation: Vec::new(),
            sign_flips: 0,
        };
        let mut negated = false;
        for pose in poses {
            let mut rotation = pose.rotation;
            let opposite =
                (track.rotation.last()).is_some_and(|last| last.coords.dot(&rotation.coords) < 0.0);
            if opposite {
                rotation = UnitQuaternion::new_unchecked(-rotation.into_inner());
            }
            track.sign_flips += usize::from(opposite != negated);
            negated = opposite;
            track.position.push(pose.translation.vector);
            track.rotation.push(rotation);
        }
        track
    }

    /// Pose at a row.
    ///
    /// # Panics
    /// When there is no such row.
    #[must_use]
    pub fn pose(&self, row: usize) -> Pose {
        Pose::from_parts(self.position[row].into(), self.rotation[row])
    }
}
