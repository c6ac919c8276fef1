//! Steady samples: the robot at rest under constant motor angles.

use nalgebra::UnitQuaternion;
use nalgebra::Vector3;

use crate::frames::shifted;
use crate::{Pose, Reference, RobotGeometry};

/// Steady samples of a recording, one entry a sample in every series.
///
/// Poses are in the base frame, as [`BasePoses::from_rest`](crate::BasePoses::from_rest) gives
/// them: the marker point's position and the rotation from rest.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadySamples {
    /// Time (s).
    pub time: Vec<f64>,
    /// Row of the recording whose motor readings belong to the sample.
    pub row: Vec<usize>,
    /// Motor angles (rad), zero in the first row with real motor readings.
    pub angles: Vec<[f64; 4]>,
    /// Platform.
    pub platform: Vec<Pose>,
    /// Ring at mid-height of the third rod.
    pub ring: Vec<Pose>,
    /// The poses at rest: what the rotations are counted from, where the marker points were.
    pub reference: Reference,
    /// Dwells that gave no sample.
    pub skipped: usize,
}

impl SteadySamples {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.row.len()
    }

    /// Whether there is no sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.row.is_empty()
    }

    /// Poses of three points along the flexible part of the ring's rod, as the published tables
    /// of inverse kinematics have them, in the frame where that part begins: its base (turned by
    /// its motor, at the origin), the ring and the rod's tip.
    ///
    /// The ring's rotation is counted from rest, the tip's is the platform's own; the points are
    /// put on the rod's axis by the horizontal position that their markers had at rest.
    #[must_use]
    pub fn rod_poses(&self, geometry: &RobotGeometry) -> Vec<[Pose; 3]> {
        let [ring_offset, tip_offset] = self.marker_offsets(geometry);
        let on_rod = |pose: &Pose, offset: Vector3<f64>| {
            shifted(pose, -geometry.ring_rod_base() - pose.rotation * offset)
        };
        let samples = self.angles.iter().zip(self.ring.iter().zip(&self.platform));
        samples
            .map(|(angles, (ring, platform))| {
                let angle = angles[geometry.ring_rod];
                let rotation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
                let base = Pose::from_parts(Vector3::zeros().into(), rotation);
                let own = platform.rotation * self.reference.platform.rotation;
                let platform = Pose::from_parts(platform.translation, own);
                let (ring, tip) = (on_rod(ring, ring_offset), on_rod(&platform, tip_offset));
                [base, ring, tip]
            })
            .collect()
    }

    /// Arc lengths of the three points of [`rod_poses`](Self::rod_poses) along the flexible part
    /// of the rod (m): their heights at rest.
    #[must_use]
    pub fn arc_lengths(&self, geometry: &RobotGeometry) -> [f64; 3] {
        let [_, tip_offset] = self.marker_offsets(geometry);
        let Reference { platform, ring, .. } = &self.reference;
        let tip = platform.translation.vector - platform.rotation * tip_offset;
        let base = geometry.proximal_end;
        [0.0, ring.translation.z - base, tip.z - base]
    }

    /// Marker points of ring and platform as seen from ring and rod tip, in their own frames (m).
    fn marker_offsets(&self, geometry: &RobotGeometry) -> [Vector3<f64>; 2] {
        let horizontal = |v: Vector3<f64>| Vector3::new(v.x, v.y, 0.0);
        let Reference { platform, ring, .. } = &self.reference;
        [
            horizontal(ring.translation.vector - geometry.ring_rod_base()),
            geometry.tip_to_markers() + horizontal(platform.translation.vector),
        ]
    }
}
