//! The exponential map of SE(3) and its derivatives, smooth through zero.

use nalgebra::{Isometry3, Matrix3, Quaternion, RealField, UnitQuaternion, Vector3, convert};

/// The pose `exp([theta]x rho; 0 0)` at the end of a piece of constant strain: `theta` its
/// rotation vector (rad), `rho` its linear strain times length (m). Eq. 12, with the rotation
/// as a quaternion.
#[inline]
pub fn exponential<T: RealField + Copy>(theta: &Vector3<T>, rho: &Vector3<T>) -> Isometry3<T> {
    let k = Coefficients::new(theta);
    let turned = theta.cross(rho);
    let translation = rho + turned * k.b + theta.cross(&turned) * k.c;
    Isometry3::from_parts(translation.into(), k.rotation(theta))
}

/// How the exponential changes with its arguments.
pub struct Derivatives<T> {
    /// Both the rotation (in the frame where the piece begins) by `theta`, and the translation
    /// by `rho`: the left Jacobian of SO(3).
    pub left: Matrix3<T>,
    /// Translation by `theta`.
    pub bend: Matrix3<T>,
}

/// [`exponential`] with its derivatives.
#[inline]
pub fn exponential_and_derivatives<T: RealField + Copy>(
    theta: &Vector3<T>,
    rho: &Vector3<T>,
) -> (Isometry3<T>, Derivatives<T>) {
    let k = Coefficients::new(theta);
    let (db, dc) = k.slopes();
    let x = theta.cross_matrix();
    let left = Matrix3::identity() + x * k.b + x * x * k.c;
    let turned = theta.cross(rho);
    let twice = theta.cross(&turned);
    // d(rho + b theta x rho + c theta x (theta x rho)), the products' own change first
    let products =
        rho.cross_matrix() * k.b + (turned.cross_matrix() + x * rho.cross_matrix()) * k.c;
    let bend = (turned * db + twice * dc) * theta.transpose() - products;
    let pose = Isometry3::from_parts((left * rho).into(), k.rotation(theta));
    (pose, Derivatives { left, bend })
}

/// Functions of the angle `t = |theta|`.
struct Coefficients<T> {
    /// t^2
    squared: T,
    /// sin(t/2)/t
    sinc: T,
    /// cos(t/2)
    cos: T,
    /// (1 - cos t)/t^2
    b: T,
    /// (t - sin t)/t^3
    c: T,
}

/// Below this t^2 differences of nearly equal terms are replaced by their series.
const SERIES_BELOW: f64 = 1.0;
/// The series of b in t^2.
const B: [f64; 9] = series(2);
/// The series of c in t^2.
const C: [f64; 9] = series(3);

impl<T: RealField + Copy> Coefficients<T> {
    #[inline]
    fn new(theta: &Vector3<T>) -> Self {
        let squared = theta.norm_squared();
        let angle = squared.sqrt();
        let two: T = convert(2.0);
        let (sin, cos) = (angle / two).sin_cos();
        let sinc = if squared > T::zero() {
            sin / angle
        } else {
            convert(0.5)
        };
        let b = two * sinc * sinc;
        let c = if squared < convert(SERIES_BELOW) {
            horner(&C, squared).0
        } else {
            (T::one() - two * sinc * cos) / squared
        };
        Self {
            squared,
            sinc,
            cos,
            b,
            c,
        }
    }

    #[inline]
    fn rotation(&self, theta: &Vector3<T>) -> UnitQuaternion<T> {
        UnitQuaternion::new_unchecked(Quaternion::from_parts(self.cos, theta * self.sinc))
    }

    /// (db/dt)/t and (dc/dt)/t.
    #[inline]
    fn slopes(&self) -> (T, T) {
        let two: T = convert(2.0);
        if self.squared < convert(SERIES_BELOW) {
            let slope = |series| two * horner(series, self.squared).1;
            (slope(&B), slope(&C))
        } else {
            let a = two * self.sinc * self.cos;
            let three: T = convert(3.0);
            (
                (a - two * self.b) / self.squared,
                (self.b - three * self.c) / self.squared,
            )
        }
    }
}

/// Value and slope of a polynomial, lowest coefficient first.
#[inline]
fn horner<T: RealField + Copy>(coefficients: &[f64], x: T) -> (T, T) {
    let start = (T::zero(), T::zero());
    (coefficients.iter().rev()).fold(start, |(value, slope), &k| {
        (value * x + convert(k), slope * x + value)
    })
}

/// (-1)^k / (first + 2k)!
const fn series(first: usize) -> [f64; 9] {
    let mut terms = [0.0; 9];
    let mut reciprocal = 1.0;
    let mut n = 1;
    while n <= first + 2 * (terms.len() - 1) {
        reciprocal /= n as f64;
        if n >= first && (n - first).is_multiple_of(2) {
            let k = (n - first) / 2;
            terms[k] = if k.is_multiple_of(2) {
                reciprocal
            } else {
                -reciprocal
            };
        }
        n += 1;
    }
    terms
}
