//! Rotations between material frames. A frame is a matrix `Q` whose rows are its directors in the world frame.
//!
//! A frame turned by the rotation vector `theta` (material components, right-handed) is `exp(-[theta]x) Q`.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// The frame `q` turned by `theta` [rad], given in material components (Gazzola et al. 2018, eq. 2.10 integrated).
#[inline]
pub fn turned(q: &Matrix3<f64>, theta: &Vector3<f64>) -> Matrix3<f64> {
    exp(&-theta) * q
}

/// Rotation vector [rad] that turns frame `a` into frame `b`, in the material components of either (they agree).
/// Its length is in [0, pi].
#[inline]
pub fn between(a: &Matrix3<f64>, b: &Matrix3<f64>) -> Vector3<f64> {
    log(&(a * b.transpose()))
}

/// Rotation matrix of a rotation vector (Rodrigues).
#[inline]
pub fn exp(theta: &Vector3<f64>) -> Matrix3<f64> {
    let squared = theta.norm_squared();
    // sin(t)/t and (1 - cos t)/t^2; the series is exact to rounding below its bound.
    let (sinc, cosc) = if squared < 1e-4 {
        (
            1.0 - squared / 6.0 * (1.0 - squared / 20.0 * (1.0 - squared / 42.0)),
            0.5 - squared / 24.0 * (1.0 - squared / 30.0 * (1.0 - squared / 56.0)),
        )
    } else {
        let angle = squared.sqrt();
        let (sin, cos) = angle.sin_cos();
        (sin / angle, (1.0 - cos) / squared)
    };
    let x = theta.cross_matrix();
    Matrix3::identity() + x * sinc + x * x * cosc
}

/// Rotation vector of a rotation matrix, of length at most pi.
#[inline]
pub fn log(r: &Matrix3<f64>) -> Vector3<f64> {
    let twice_sine_axis = Vector3::new(
        r[(2, 1)] - r[(1, 2)],
        r[(0, 2)] - r[(2, 0)],
        r[(1, 0)] - r[(0, 1)],
    );
    let cosine = (r.trace() - 1.0) / 2.0;
    let sine_squared = twice_sine_axis.norm_squared() / 4.0;
    if cosine > 0.0 && sine_squared < 1e-4 {
        // asin(s)/s as a series in s^2
        let s = sine_squared;
        let ratio = 1.0
            + s / 6.0 * (1.0 + s * 9.0 / 20.0 * (1.0 + s * 25.0 / 42.0 * (1.0 + s * 49.0 / 72.0)));
        twice_sine_axis * (ratio / 2.0)
    } else if cosine > -0.99 {
        let sine = sine_squared.sqrt();
        twice_sine_axis * (sine.atan2(cosine) / (2.0 * sine))
    } else {
        // Near a half turn the antisymmetric part vanishes and the quaternion keeps its accuracy.
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*r)).scaled_axis()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn log_inverts_exp_from_tiny_angles_to_almost_a_half_turn() {
        let axis = Vector3::new(0.3, -0.7, 0.2).normalize();
        for angle in [1e-12, 1e-6, 9e-3, 1.1e-2, 0.5, 2.0, 3.0, 3.1, 3.135] {
            let theta = axis * angle;
            assert_relative_eq!(log(&exp(&theta)), theta, epsilon = 1e-12 * (1.0 + angle));
        }
    }

    #[test]
    fn a_frame_that_turns_with_a_right_handed_vector_follows_it() {
        let quarter = Vector3::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        let q = turned(&Matrix3::identity(), &quarter);
        // d1 now points along world y
        assert_relative_eq!(q.row(0).transpose(), Vector3::y(), epsilon = 1e-15);
        assert_relative_eq!(between(&Matrix3::identity(), &q), quarter, epsilon = 1e-15);
    }
}
