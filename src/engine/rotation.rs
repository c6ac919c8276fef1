//! Rotations between material frames. A frame is a matrix `Q` whose rows are its directors in the world frame.
//!
//! A frame turned by the rotation vector `theta` (material components, right-handed) is `exp(-[theta]x) Q`.

use crate::number::Number;
use crate::triple::{Rows, Triple, triple};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// The frame `q` turned by `theta` [rad], given in material components (Gazzola et al. 2018, eq. 2.10 integrated).
#[inline]
pub fn turned(q: &Matrix3<f64>, theta: &Vector3<f64>) -> Matrix3<f64> {
    let turn = Rows::from(&exp(&-theta));
    turn.product(&q.into()).into()
}

/// Rotation vector [rad] that turns frame `a` into frame `b`, in the material components of either (they agree).
/// Its length is in [0, pi].
#[inline]
pub fn between(a: &Matrix3<f64>, b: &Matrix3<f64>) -> Vector3<f64> {
    log(&Rows::from(a).product_transposed(&b.into()).into())
}

/// World components of a vector to those in a frame.
#[inline]
pub fn to_material(frame: &Matrix3<f64>, world: &Vector3<f64>) -> Vector3<f64> {
    Rows::from(frame).times(world.into()).into()
}

/// Components of a vector in a frame to world components.
#[inline]
pub fn to_world(frame: &Matrix3<f64>, material: &Vector3<f64>) -> Vector3<f64> {
    Rows::from(frame).transposed_times(material.into()).into()
}

/// Squares of angles \[rad2\] up to which [`exp`] is a power series.
pub(crate) const SMALL_SQUARE: f64 = 1.0 / 16.0;
/// Squared sines of half angles up to which [`log`] is a power series: angles to 0.41 rad.
pub(crate) const SMALL_HAVERSINE: f64 = 1.0 / 24.0;

/// sin(t)/t in t^2.
const SINC: [f64; 6] = alternating(1.0, 2.0);
/// (1 - cos t)/t^2 in t^2.
const COSC: [f64; 6] = alternating(0.5, 3.0);
/// t/sin(t) in sin(t/2)^2.
const ARCSINE: [f64; 12] = {
    let mut c = [1.0; 12];
    let mut n = 1;
    while n < c.len() {
        c[n] = c[n - 1] * (2 * n) as f64 / (2 * n + 1) as f64;
        n += 1;
    }
    c
};

/// Each coefficient is the one before over `-k (k + 1)`, `k` growing by two from `from`.
const fn alternating(first: f64, from: f64) -> [f64; 6] {
    let mut c = [first; 6];
    let mut n = 1;
    while n < c.len() {
        let k = from + 2.0 * (n - 1) as f64;
        c[n] = -c[n - 1] / (k * (k + 1.0));
        n += 1;
    }
    c
}

/// Horner's rule for even and odd powers each: two chains, which a processor follows at once.
#[inline(always)]
pub(crate) fn polynomial<T: Number, const N: usize>(coefficients: &[f64; N], x: T) -> T {
    let square = x * x;
    let mut last = x.constant(coefficients[N - 1]);
    let mut other = x.constant(coefficients[N - 2]);
    for i in (0..N - 2).rev() {
        (last, other) = (other, last * square + x.constant(coefficients[i]));
    }
    // `other` has the even powers
    other + last * x
}

/// `1 + sinc [theta]x + cosc [theta]x^2` (Rodrigues).
#[inline(always)]
fn rodrigues<T: Number>(theta: Triple<T>, squared: T, sinc: T, cosc: T) -> Rows<T> {
    let (s, c) = (theta * sinc, theta * cosc);
    let (xy, xz, yz) = (c.x * theta.y, c.x * theta.z, c.y * theta.z);
    let one = cosc.constant(1.0);
    let (xx, yy, zz) = (theta.x * theta.x, theta.y * theta.y, theta.z * theta.z);
    Rows([
        triple(one + cosc * (xx - squared), xy - s.z, xz + s.y),
        triple(xy + s.z, one + cosc * (yy - squared), yz - s.x),
        triple(xz - s.y, yz + s.x, one + cosc * (zz - squared)),
    ])
}

/// Rotation matrix of a rotation vector whose square is at most [`SMALL_SQUARE`], exact to rounding.
#[inline(always)]
pub(crate) fn exp_small<T: Number>(theta: Triple<T>, squared: T) -> Rows<T> {
    let (sinc, cosc) = (polynomial(&SINC, squared), polynomial(&COSC, squared));
    rodrigues(theta, squared, sinc, cosc)
}

/// Rotation matrix of a rotation vector.
#[inline]
pub fn exp(theta: &Vector3<f64>) -> Matrix3<f64> {
    let theta = Triple::from(theta);
    let squared = theta.squared();
    if squared <= SMALL_SQUARE {
        return exp_small(theta, squared).into();
    }
    let angle = squared.sqrt();
    let (sin, cos) = angle.sin_cos();
    rodrigues(theta, squared, sin / angle, (1.0 - cos) / squared).into()
}

/// Twice the sine of a rotation's angle along its axis, and the square of the sine of half the angle.
#[inline(always)]
pub(crate) fn sines<T: Number>(r: &Rows<T>) -> (Triple<T>, T) {
    let [a, b, c] = r.0;
    let twice_sine_axis = triple(c.y - b.z, a.z - c.x, b.x - a.y);
    let trace = a.x + b.y + c.z;
    (twice_sine_axis, (trace.constant(3.0) - trace) * 0.25)
}

/// Rotation vector from [`sines`] if the second is at most [`SMALL_HAVERSINE`], exact to rounding.
#[inline(always)]
pub(crate) fn log_small<T: Number>(twice_sine_axis: Triple<T>, haversine: T) -> Triple<T> {
    twice_sine_axis * (polynomial(&ARCSINE, haversine) * 0.5)
}

/// Rotation vector of a rotation matrix, of length at most pi.
#[inline]
pub fn log(r: &Matrix3<f64>) -> Vector3<f64> {
    let (twice_sine_axis, haversine) = sines(&r.into());
    if haversine <= SMALL_HAVERSINE {
        return log_small(twice_sine_axis, haversine).into();
    }
    let twice_sine_axis = Vector3::from(twice_sine_axis);
    let cosine = (r.trace() - 1.0) / 2.0;
    if cosine > -0.99 {
        let sine = twice_sine_axis.norm() / 2.0;
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

    /// The formulas with library functions only.
    fn plain_exp(theta: &Vector3<f64>) -> Matrix3<f64> {
        let angle = theta.norm();
        let x = (theta / angle).cross_matrix();
        // 1 - cos without cancellation
        Matrix3::identity() + x * angle.sin() + x * x * (2.0 * (angle / 2.0).sin().powi(2))
    }

    #[test]
    fn power_series_agree_with_the_plain_formulas_to_rounding() {
        let axis = Vector3::new(0.3, -0.7, 0.2).normalize();
        for i in 1..2000 {
            let theta = axis * (0.5 * f64::from(i) / 2000.0);
            let r = exp(&theta);
            assert!((r - plain_exp(&theta)).amax() < 4e-16, "exp at {i}");
            let (axis, haversine) = sines(&(&r).into());
            let axis = Vector3::from(axis);
            let half = haversine.sqrt().asin();
            let plain = axis * (half / (2.0 * half).sin());
            let off = (log(&r) - plain).norm() / plain.norm();
            assert!(off < 1e-15 || haversine < 1e-4, "log at {i}: {off:.1e}");
            assert!((log(&r) - theta).norm() < 6e-16, "log at {i}");
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
