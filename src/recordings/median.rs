//! Medians of numbers and poses: what most samples agree on, whatever a few of them do.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::Pose;

/// Median of finite numbers; the mean of the two middle ones if their count is even.
///
/// `None` for no numbers.
pub(crate) fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        n if n % 2 == 1 => Some(values[middle]),
        _ => Some(0.5 * (values[middle - 1] + values[middle])),
    }
}

/// Median of each component.
pub(crate) fn median_position(positions: &[Vector3<f64>]) -> Option<Vector3<f64>> {
    let component = |i: usize| median(positions.iter().map(|p| p[i]));
    Some(Vector3::new(component(0)?, component(1)?, component(2)?))
}

/// Median of each component of the quaternions, at unit length.
///
/// A rotation has two quaternions: each is taken with the sign that puts it nearer to the one
/// most central among (at most) 32 of them, so that a few flipped rotations do no harm.
pub(crate) fn median_rotation(rotations: &[UnitQuaternion<f64>]) -> Option<UnitQuaternion<f64>> {
    let candidates = rotations
        .iter()
        .step_by(rotations.len().div_ceil(32).max(1));
    let central = candidates
        .clone()
        .map(|centre| {
            let distance: f64 = candidates.clone().map(|other| centre.angle_to(other)).sum();
            (centre, distance)
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))?
        .0;
    let component = |i: usize| {
        median(rotations.iter().map(|q| {
            let aligned = q.coords.dot(&central.coords) >= 0.0;
            if aligned { q.coords[i] } else { -q.coords[i] }
        }))
    };
    let [x, y, z, w] = [component(0)?, component(1)?, component(2)?, component(3)?];
    UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-6).or(Some(*central))
}

/// Median position and median rotation.
pub(crate) fn median_pose(poses: &[Pose]) -> Option<Pose> {
    let positions: Vec<_> = poses.iter().map(|pose| pose.translation.vector).collect();
    let rotations: Vec<_> = poses.iter().map(|pose| pose.rotation).collect();
    let position = median_position(&positions)?;
    Some(Pose::from_parts(
        position.into(),
        median_rotation(&rotations)?,
    ))
}
