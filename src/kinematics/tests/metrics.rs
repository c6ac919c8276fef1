//! Error measures on poses whose errors are known.

use auxetica_kinematics::{Metrics, Pose};
use nalgebra::{UnitQuaternion, Vector3};

#[test]
fn errors_are_root_mean_squares_over_all_points() {
    let base = Pose::rotation(Vector3::new(0.1, -0.4, 0.8));
    let shifted = Pose::translation(3e-3, 0.0, 4e-3) * base;
    let pairs = [(&base, &base), (&base, &shifted), (&shifted, &base)];
    let three = Metrics::new(pairs);
    let measured = Metrics::new(pairs.into_iter().skip(1));
    assert!((measured.position - 5e-3).abs() < 1e-15);
    assert!((measured.position / three.position - 1.5f64.sqrt()).abs() < 1e-12);
    assert!(three.quaternion < 1e-15 && three.euler.amax() < 1e-15);
    assert!(Metrics::new([]).position < 1e-300);
}

#[test]
fn rotations_are_counted_as_quaternions_and_as_euler_angles() {
    let measured = Pose::identity();
    let [alpha, beta, gamma] = [0.2, -0.3, 0.4];
    let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    let turn = about(Vector3::x_axis(), alpha)
        * about(Vector3::y_axis(), beta)
        * about(Vector3::z_axis(), gamma);
    let fitted = Pose::from_parts(Vector3::zeros().into(), turn);
    let errors = Metrics::new([(&measured, &fitted)]);
    assert!((errors.quaternion - (turn.angle() / 2.0).sin()).abs() < 1e-15);
    assert!((errors.euler - Vector3::new(alpha, -beta, gamma)).amax() < 1e-15);
    // A quaternion and its opposite are the same rotation.
    let opposite = UnitQuaternion::new_unchecked(-turn.into_inner());
    let opposite = Pose::from_parts(Vector3::zeros().into(), opposite);
    assert!(Metrics::new([(&opposite, &fitted)]).quaternion < 1e-15);
}

#[test]
fn printed_quaternions_differ_where_signs_do() {
    let measured = Pose::rotation(Vector3::new(1e-9, 0.0, 0.0));
    let fitted = Pose::rotation(Vector3::new(-1e-9, 0.0, 0.0));
    let gap = 2.0 * (5.0 * f64::from(f32::EPSILON)).sqrt();
    let errors = Metrics::as_printed([(&measured, &fitted)]);
    assert!((errors.quaternion - gap).abs() < 1e-6);
}
