//! Where a fit begins.

use std::f64::consts::{PI, TAU};

use nalgebra::{Vector3, Vector6};

use crate::exponential::{exponential, exponential_and_derivatives};
use crate::{Observed, Pose, Spcs};

/// A configuration near the one that fits: that of the constant strains between each two
/// neighbouring points, averaged over segments and rod by length. Turns between neighbours of
/// more than `longest_turn` (rad, at most pi) are taken the other way round.
pub fn guess(rod: &Spcs, observed: &Observed<'_>, longest_turn: f64) -> Vec<f64> {
    let mut points: Vec<(f64, Pose)> = observed.points().map(|(s, pose)| (s, *pose)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let base_angle = observed.base_angle.unwrap_or_else(|| base_angle(&points));
    let base = Pose::rotation(Vector3::z() * base_angle);
    points.retain(|&(s, _)| s > 0.0);
    points.insert(0, (0.0, base));

    let mut q = vec![0.0; rod.dof()];
    q[0] = base_angle;
    let mut weights = vec![0.0; rod.dof()];
    for pair in points.windows(2) {
        let [(from, start), (to, end)] = [pair[0], pair[1]];
        let Some(strains) = strains_between(start, end, to - from, longest_turn) else {
            continue;
        };
        let mut begin = 0.0;
        for (length, columns) in rod.lengths().iter().zip(rod.columns()) {
            let overlap = to.min(begin + length) - from.max(begin);
            begin += length;
            for (strain, column) in columns.iter().enumerate() {
                let (Some(column), true) = (*column, overlap > 0.0) else {
                    continue;
                };
                let rest = if strain == 5 { 1.0 } else { 0.0 };
                q[column] += overlap * (strains[strain] - rest);
                weights[column] += overlap;
            }
        }
    }
    for (entry, weight) in q.iter_mut().zip(weights).skip(1) {
        *entry /= if weight > 0.0 { weight } else { 1.0 };
    }
    q
}

/// Turn of the base (rad) when the strains between the first two points reach back to it.
fn base_angle(points: &[(f64, Pose)]) -> f64 {
    let [(first, start), (second, end), ..] = *points else {
        return 0.0;
    };
    let strains = strains_between(start, end, second - first, PI).unwrap_or_default();
    let back = strains * -first;
    let (theta, rho): (Vector3<f64>, Vector3<f64>) = (
        back.fixed_rows::<3>(0).into(),
        back.fixed_rows::<3>(3).into(),
    );
    let base = start * exponential(&theta, &rho);
    2.0 * base.rotation.k.atan2(base.rotation.w)
}

/// The constant strains that lead from one pose to the other over a length (m).
fn strains_between(start: Pose, end: Pose, length: f64, longest_turn: f64) -> Option<Vector6<f64>> {
    let between = start.inv_mul(&end);
    let mut theta = between.rotation.scaled_axis();
    let turn = theta.norm();
    if turn > longest_turn {
        theta *= 1.0 - TAU / turn;
    }
    let (_, derivatives) = exponential_and_derivatives(&theta, &Vector3::zeros());
    let rho = derivatives.left.try_inverse()? * between.translation.vector;
    (length > 0.0).then(|| Vector6::new(theta.x, theta.y, theta.z, rho.x, rho.y, rho.z) / length)
}
