//! How well poses are matched.

use nalgebra::Vector3;

use crate::Pose;

/// Root mean square errors of poses (eq. 15 and 16).
///
/// The paper counts three points a sample: besides the two that were measured the rod's base,
/// which is constructed and so has no error. Over the measured points alone the errors are
/// `sqrt(3/2)` times larger.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metrics {
    /// Distance of positions (m).
    pub position: f64,
    /// Distance of the vector parts of the quaternions whose scalar part is not negative (-). Of
    /// rotations near half a turn it is large even when they agree.
    pub quaternion: f64,
    /// XYZ Euler angles of the rotation between (rad).
    pub euler: Vector3<f64>,
}

impl Metrics {
    /// Errors over all pairs of a measured and a fitted pose; zero when there are none.
    #[must_use]
    pub fn new<'a>(pairs: impl IntoIterator<Item = (&'a Pose, &'a Pose)>) -> Self {
        Self::with(vector_part, pairs)
    }

    /// [`new`](Self::new) with, of the two quaternions of each fitted rotation, the one that is
    /// nearer to the measured: for rotations about half a turn.
    #[must_use]
    pub fn near_half_turns<'a>(pairs: impl IntoIterator<Item = (&'a Pose, &'a Pose)>) -> Self {
        Self::of(pairs, |measured, fitted| {
            let (measured, fitted) = (measured.rotation, fitted.rotation);
            let sign = measured.dot(&fitted).signum();
            measured.imag() - fitted.imag() * sign
        })
    }

    /// [`new`](Self::new) with the quaternions of the paper's authors, `sign(x) sqrt(x^2 + 5 e)`
    /// with `e` the epsilon of single precision in each entry: entries of different sign are at
    /// least 0.0015 apart.
    #[must_use]
    pub fn as_printed<'a>(pairs: impl IntoIterator<Item = (&'a Pose, &'a Pose)>) -> Self {
        let softening = 5.0 * f64::from(f32::EPSILON);
        let soften = |x: f64| x.signum() * (x * x + softening).sqrt();
        Self::with(|pose| vector_part(pose).map(soften), pairs)
    }

    fn with<'a>(
        vector_part: impl Fn(&Pose) -> Vector3<f64>,
        pairs: impl IntoIterator<Item = (&'a Pose, &'a Pose)>,
    ) -> Self {
        Self::of(pairs, |measured, fitted| {
            vector_part(measured) - vector_part(fitted)
        })
    }

    fn of<'a>(
        pairs: impl IntoIterator<Item = (&'a Pose, &'a Pose)>,
        quaternion_difference: impl Fn(&Pose, &Pose) -> Vector3<f64>,
    ) -> Self {
        let mut count = 0;
        let (mut position, mut quaternion, mut euler) = (0.0, 0.0, Vector3::zeros());
        for (measured, fitted) in pairs {
            count += 1;
            let offset = measured.translation.vector - fitted.translation.vector;
            position += offset.norm_squared();
            quaternion += quaternion_difference(measured, fitted).norm_squared();
            euler += euler_xyz(measured, fitted).map(|angle| angle * angle);
        }
        let root = |sum: f64| (sum / f64::from(count.max(1))).sqrt();
        Self {
            position: root(position),
            quaternion: root(quaternion),
            euler: euler.map(root),
        }
    }
}

/// Vector part of the quaternion whose scalar part is not negative.
fn vector_part(pose: &Pose) -> Vector3<f64> {
    let quaternion = pose.rotation;
    if quaternion.w < 0.0 {
        -quaternion.imag()
    } else {
        quaternion.imag()
    }
}

/// Angles (alpha, beta, gamma) of `R = Rx Ry Rz`, the rotation from measured to fitted.
fn euler_xyz(measured: &Pose, fitted: &Pose) -> Vector3<f64> {
    let r = (measured.rotation.inverse() * fitted.rotation).to_rotation_matrix();
    let alpha = (-r[(1, 2)]).atan2(r[(2, 2)]);
    let beta = (r[(0, 2)] * alpha.cos()).atan2(r[(2, 2)]);
    let gamma = (-r[(0, 1)]).atan2(r[(0, 0)]);
    Vector3::new(alpha, beta, gamma)
}
