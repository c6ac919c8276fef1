//! The analytic Jacobian against central differences.

mod common;

use std::f64::consts::TAU;

use auxetica_kinematics::{Spcs, StrainSelector, Variation};
use nalgebra::{Matrix6xX, Vector6};

use Variation::{Constant, Piecewise, Rest};
use common::Random;

/// Jacobian by central differences.
fn differences(rod: &Spcs, q: &[f64], s: f64) -> Matrix6xX<f64> {
    let step = 1e-4;
    let columns: Vec<Vector6<f64>> = (0..q.len())
        .map(|i| {
            let moved = |by: f64| {
                let mut q = q.to_vec();
                q[i] += by;
                rod.pose(&q, s)
            };
            let (ahead, behind) = (moved(step), moved(-step));
            let turn = (ahead.rotation * behind.rotation.inverse()).scaled_axis();
            let shift = ahead.translation.vector - behind.translation.vector;
            Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z) / (2.0 * step)
        })
        .collect();
    Matrix6xX::from_columns(&columns)
}

fn assert_jacobian(rod: &Spcs, q: &[f64], s: f64) {
    let (pose, jacobian) = rod.pose_and_jacobian(q, s);
    let drift = pose.inv_mul(&rod.pose(q, s));
    assert!(drift.translation.vector.norm() < 1e-15 && drift.rotation.angle() < 1e-15);
    let error = (jacobian - differences(rod, q, s)).amax();
    assert!(error < 1e-8, "{error:e} at s = {s}, q = {q:?}");
}

#[test]
fn derivatives_are_those_of_the_pose_for_any_selection_and_number_of_segments() {
    let selections = [
        StrainSelector::UNSHEARED,
        StrainSelector::SHEARED,
        StrainSelector::PIECEWISE,
        StrainSelector([Constant; 6]),
        StrainSelector([Rest; 6]),
        StrainSelector([Rest, Constant, Piecewise, Rest, Constant, Piecewise]),
    ];
    let mut random = Random(1);
    for selector in selections {
        for segments in [1, 2, 5] {
            let rod = Spcs::uniform(selector, 0.1, segments);
            for _ in 0..20 {
                let q: Vec<f64> = (0..rod.dof()).map(|_| 15.0 * random.next()).collect();
                for s in [0.0, 0.013, 0.05, 0.1, 0.2] {
                    assert_jacobian(&rod, &q, s);
                }
            }
        }
    }
}

#[test]
fn derivatives_are_smooth_at_rest_and_at_a_full_turn() {
    let length = 0.1;
    let rod = Spcs::uniform(StrainSelector::PIECEWISE, length, 2);
    let mut random = Random(2);
    let turn = TAU / (length / 2.0);
    let curvatures = [0.0, 1e-300, 1e-12, 1e-8, 1e-4, 1e-2, 1.0, 19.99, 20.01]
        .into_iter()
        .chain([-1e-2, -1e-6, -1e-9, 0.0, 1e-7, 1e-3].map(|gap| turn + gap));
    for curvature in curvatures {
        for _ in 0..20 {
            let mut q: Vec<f64> = (0..13).map(|_| 0.3 * random.next()).collect();
            for first in [1, 7] {
                let axis = Vector6::from_fn(|_, _| random.next()).xyz().normalize();
                for (i, entry) in axis.iter().enumerate() {
                    q[first + i] = entry * curvature;
                }
            }
            assert_jacobian(&rod, &q, length);
        }
    }
}
