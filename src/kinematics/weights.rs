//! What counts how much in a fit.

/// How much positions and rotations count in a fit.
///
/// A fit minimises half the sum over all points of `position^2 |p - p_hat|^2 + quaternion^2
/// |Q - Q_hat|^2`, where `|Q - Q_hat|`, of the nearer of the two quaternions that stand for a
/// rotation, is twice the sine of a quarter of the angle between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// Of positions (1/m).
    pub position: f64,
    /// Of quaternions (-).
    pub quaternion: f64,
}

impl Weights {
    /// The paper's: a metre counts as much as a unit of a quaternion (eq. 14).
    pub const PAPER: Self = Self {
        position: 1.0,
        quaternion: 1.0,
    };

    /// For measurements with these standard deviations, per axis, in m and rad. The fit is then
    /// one of maximum likelihood.
    #[must_use]
    pub fn from_deviations(position: f64, angle: f64) -> Self {
        Self {
            position: 1.0 / position,
            quaternion: 2.0 / angle,
        }
    }
}
