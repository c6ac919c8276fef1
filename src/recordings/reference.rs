//! The robot at rest, and where the markers sit on its bodies.

use std::ops::Range;

use nalgebra::Vector3;

use crate::median::median_pose;
use crate::{BasePoses, Error, Pose, Recording};

/// How far a motor at rest may stray (ticks), and the fastest it may seem to turn.
const REST_TICKS: f64 = 2.0;
const REST_VELOCITY: f64 = 1.0;

/// Poses at rest: before the first motion, where the motors' angles are zero by definition.
///
/// A marker frame sits on its body at an arbitrary angle and a little off its axis. Both are
/// settled here: the orientation at rest is taken for that of the undeformed robot, and the
/// position at rest tells where the marker point sits (see [`MarkerFrame`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Centroid of the platform's markers (m) and its orientation, in the base frame.
    pub platform: Pose,
    /// Centroid of the ring's markers (m) and its orientation, in the base frame.
    pub ring: Pose,
    /// Rows of the recording that this is the median of.
    pub rows: Range<usize>,
}

impl Reference {
    /// The median pose over the rows before the first motion: the first row with real motor
    /// readings and those after it until a motor moves or is told to.
    ///
    /// # Errors
    /// When the recording has no row.
    pub fn new(recording: &Recording, poses: &BasePoses) -> Result<Self, Error> {
        let rows = rest_rows(recording);
        match (
            median_pose(&poses.platform[rows.clone()]),
            median_pose(&poses.ring[rows.clone()]),
        ) {
            (Some(platform), Some(ring)) => Ok(Self {
                platform,
                ring,
                rows,
            }),
            _ => Err(Error::Inconsistent {
                recording: recording.name.clone(),
                reason: "it has no row at rest".into(),
            }),
        }
    }
}

#[expect(clippy::float_cmp, reason = "goals are copied, not computed")]
fn rest_rows(recording: &Recording) -> Range<usize> {
    let rows = recording.rows();
    let first = rows.start;
    let resting = |row: usize| {
        let still = |i: usize| {
            (recording.present[row][i] - recording.present[first][i]).abs() <= REST_TICKS
                && recording.velocities[row][i].abs() <= REST_VELOCITY
        };
        (0..4).all(still) && recording.goal[row] == recording.goal[first]
    };
    let moving = rows.clone().skip(1).find(|&row| !resting(row));
    first..moving.unwrap_or(rows.end)
}

/// How the height of a marker point on its body is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OffsetZ {
    /// From the sample at rest: recorded and simulated heights agree there, and displacements
    /// from rest are compared.
    Reference,
    /// Given (m), from the body's point along the base frame's z: heights are compared as they
    /// are. The platform's markers are 7.5 mm above its outer face.
    Given(f64),
}

/// Where a marker point sits on a simulated body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkerFrame {
    /// From the body's point to the marker point (m), in axes fixed to the body that lie along
    /// the base frame's while the robot rests.
    pub offset: Vector3<f64>,
}

impl MarkerFrame {
    /// Finds the marker point on a body from where it was recorded at rest (a pose of
    /// [`Reference`]) and where the simulated body's point is at rest (m), both in the base frame.
    #[must_use]
    pub fn new(recorded: &Pose, simulated: &Vector3<f64>, height: OffsetZ) -> Self {
        let mut offset = recorded.translation.vector - simulated;
        if let OffsetZ::Given(z) = height {
            offset.z = z;
        }
        Self { offset }
    }

    /// The pose that motion capture would show for a simulated body: its marker point (m) and its
    /// rotation from rest, to compare with [`BasePoses::from_rest`] and
    /// [`SteadySamples`](crate::SteadySamples).
    ///
    /// `body` has the body's point (m) and its rotation from rest along the base frame's axes.
    #[must_use]
    pub fn marker_pose(&self, body: &Pose) -> Pose {
        crate::frames::shifted(body, body.rotation * self.offset)
    }
}
