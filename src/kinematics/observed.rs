//! What inverse kinematics is given.

use crate::Pose;

/// Poses measured along a rod at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Observed<'a> {
    /// Arc lengths of the points (m, of the unstretched rod).
    pub arc_lengths: &'a [f64],
    /// Poses there, in the base frame; as many.
    pub poses: &'a [Pose],
    /// The base's turn `phi0` (rad) where it is known; otherwise it is estimated.
    pub base_angle: Option<f64>,
}

impl Observed<'_> {
    /// Arc lengths and poses, point by point.
    pub(crate) fn points(&self) -> impl Iterator<Item = (f64, &Pose)> {
        assert_eq!(self.arc_lengths.len(), self.poses.len(), "number of poses");
        self.arc_lengths.iter().copied().zip(self.poses)
    }
}
