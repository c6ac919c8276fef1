//! Least squares: there and back, bounds, weights, covariance.

mod common;

use std::f64::consts::TAU;

use auxetica_kinematics::table2::SELECTORS;
use auxetica_kinematics::{LeastSquares, Observed, Pose, Spcs, StrainSelector, Variation, Weights};
use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector3};

use common::Random;

/// A configuration of a lively rod: curvatures up to 25 rad/m, shears and stretch up to 0.3.
fn lively(rod: &Spcs, random: &mut Random) -> Vec<f64> {
    let StrainSelector(variations) = rod.selector();
    let strains = |variation| (0..6).filter(move |&strain| variations[strain] == variation);
    let constant = strains(Variation::Constant);
    let piecewise = (rod.lengths().iter()).flat_map(|_| strains(Variation::Piecewise));
    let scales = (constant.chain(piecewise)).map(|strain| if strain < 3 { 25.0 } else { 0.3 });
    (std::iter::once(3.0).chain(scales))
        .map(|scale| scale * random.next())
        .collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

#[test]
fn forward_and_back_returns_the_configuration() {
    let mut random = Random(5);
    let [unsheared, sheared, piecewise] = SELECTORS;
    let constant = StrainSelector([Variation::Constant; 6]);
    for selector in [unsheared, sheared, piecewise, constant] {
        for segments in 1..=4 {
            let rod = Spcs::uniform(selector, 0.05 * f64::from(segments), segments as usize);
            let arc_lengths: Vec<f64> = (1..=segments).map(|i| 0.05 * f64::from(i)).collect();
            let solver = LeastSquares::new(rod.clone());
            for scale in [0.0, 1e-9, 1e-4, 1.0] {
                for _ in 0..50 {
                    let q: Vec<f64> = (lively(&rod, &mut random).iter())
                        .map(|entry| scale * entry)
                        .collect();
                    let poses: Vec<Pose> = arc_lengths.iter().map(|&s| rod.pose(&q, s)).collect();
                    let observed = Observed {
                        arc_lengths: &arc_lengths,
                        poses: &poses,
                        base_angle: Some(q[0]),
                    };
                    let fit = solver.fit(&observed, None);
                    let error = largest_difference(&fit.configuration, &q);
                    assert!(fit.converged && error < 1e-9, "{error:e} {q:?} {fit:?}");
                }
            }
        }
    }
}

#[test]
fn forward_and_back_near_a_full_turn() {
    let rod = Spcs::uniform(StrainSelector::PIECEWISE, 0.1, 1);
    let arc_lengths = [0.02, 0.05, 0.08, 0.1];
    let mut random = Random(9);
    for gap in [-1e-3, -1e-6, -1e-9, 0.0, 1e-9, 1e-4] {
        for _ in 0..50 {
            let axis = Vector3::from_fn(|_, _| random.next()).normalize();
            let curvature = axis * (TAU + gap) / 0.1;
            let mut q = lively(&rod, &mut random);
            q[1..4].copy_from_slice(curvature.as_slice());
            let poses = arc_lengths.map(|s| rod.pose(&q, s));
            let observed = Observed {
                arc_lengths: &arc_lengths,
                poses: &poses,
                base_angle: Some(q[0]),
            };
            let fit = LeastSquares::new(rod.clone()).fit(&observed, None);
            let error = largest_difference(&fit.configuration, &q);
            assert!(fit.converged && error < 1e-9, "{error:e} {q:?} {fit:?}");
        }
    }
}

#[test]
fn base_angle_is_found_when_it_is_not_given() {
    let rod = Spcs::uniform(StrainSelector::SHEARED, 0.1, 2);
    let arc_lengths = [0.02, 0.04, 0.07, 0.1];
    let mut random = Random(6);
    for _ in 0..100 {
        let q = lively(&rod, &mut random);
        let poses = arc_lengths.map(|s| rod.pose(&q, s));
        let observed = Observed {
            arc_lengths: &arc_lengths,
            poses: &poses,
            base_angle: None,
        };
        let fit = LeastSquares::new(rod.clone()).fit(&observed, None);
        let error = largest_difference(&fit.configuration, &q);
        assert!(fit.converged && error < 1e-9, "{error:e} {fit:?}");
    }
}

#[test]
fn a_warm_start_keeps_a_twist_of_more_than_half_a_turn_between_points() {
    let rod = Spcs::uniform(StrainSelector::UNSHEARED, 0.1, 2);
    let arc_lengths = [0.1];
    let twists: Vec<f64> = (0..=80).map(f64::from).collect();
    let poses: Vec<[Pose; 1]> = (twists.iter())
        .map(|&twist| [rod.pose(&[0.0, twist, 0.1, 1.0, 0.0, 1.0, 0.0], 0.1)])
        .collect();
    let samples: Vec<Observed<'_>> = (poses.iter())
        .map(|poses| Observed {
            arc_lengths: &arc_lengths,
            poses,
            base_angle: Some(0.0),
        })
        .collect();
    let fits = LeastSquares::new(rod).fit_sequence(&samples);
    for (fit, twist) in fits.iter().zip(twists) {
        assert!((fit.configuration[1] - twist).abs() < 1e-3, "{fit:?}");
    }
}

#[test]
fn bounds_hold_and_the_rest_fits_as_well_as_it_can() {
    let rod = Spcs::uniform(StrainSelector::UNSHEARED, 0.1, 1);
    let arc_lengths = [0.05, 0.1];
    let poses = arc_lengths.map(|s| rod.pose(&[0.0, 3.0, 0.1, 20.0, 5.0], s));
    let observed = Observed {
        arc_lengths: &arc_lengths,
        poses: &poses,
        base_angle: Some(0.0),
    };
    let mut solver = LeastSquares::new(rod);
    solver.max_curvature = 15.0;
    let fit = solver.fit(&observed, None);
    assert!(fit.converged && fit.cost > 0.0);
    assert!((fit.configuration[3] - 15.0).abs() < 1e-12);
    for i in [1, 2, 4] {
        let gain = |by: f64| {
            let mut start = fit.configuration.clone();
            start[i] += by;
            let mut look = solver.clone();
            look.max_evaluations = 1;
            look.fit(&observed, Some(&start)).cost - fit.cost
        };
        assert!(gain(1e-4) > 0.0 && gain(-1e-4) > 0.0, "entry {i}");
    }
    let covariance = fit.covariance().unwrap();
    assert!(covariance.row(3).amax() < 1e-300 && covariance[(4, 4)] > 0.0);
}

#[test]
fn poses_that_tell_too_little_or_nothing_end_the_fit() {
    let rod = Spcs::uniform(StrainSelector::PIECEWISE, 0.1, 3);
    let arc_lengths = [0.05];
    let poses = [rod.pose(&lively(&rod, &mut Random(7)), 0.05)];
    let observed = Observed {
        arc_lengths: &arc_lengths,
        poses: &poses,
        base_angle: Some(0.0),
    };
    let solver = LeastSquares::new(rod);
    let fit = solver.fit(&observed, None);
    assert!(fit.converged && fit.cost < 1e-20);
    assert_eq!(fit.covariance(), None);
    // The third segment lies past the only point.
    assert!(
        fit.configuration[13..]
            .iter()
            .all(|&entry| entry.abs() < 1e-300)
    );

    let lost = [Pose::translation(f64::NAN, 0.0, 0.0)];
    let observed = Observed {
        poses: &lost,
        ..observed
    };
    assert!(!solver.fit(&observed, None).converged);
}

#[test]
fn covariance_is_that_of_repeated_measurements() {
    let (metres, radians) = (2e-4, 5e-3);
    let rod = Spcs::uniform(StrainSelector::SHEARED, 0.1, 2);
    let mut random = Random(8);
    let q = lively(&rod, &mut random);
    let arc_lengths = [0.03, 0.06, 0.1];
    let mut solver = LeastSquares::new(rod.clone());
    solver.weights = Weights::from_deviations(metres, radians);
    let mut noise = |deviation: f64| {
        // Twelve uniform numbers are as good as a normal one here.
        let mut normal = || (0..12).map(|_| 0.5 * random.next()).sum::<f64>();
        Vector3::from_fn(|_, _| deviation * normal())
    };
    let repeats = 4000;
    let mut deviations: Vec<DVector<f64>> = Vec::new();
    let mut covariance = DMatrix::zeros(0, 0);
    for _ in 0..repeats {
        let poses = arc_lengths.map(|s| {
            let pose = rod.pose(&q, s);
            let turn = UnitQuaternion::from_scaled_axis(noise(radians));
            let moved = pose.translation.vector + noise(metres);
            Pose::from_parts(moved.into(), turn * pose.rotation)
        });
        let observed = Observed {
            arc_lengths: &arc_lengths,
            poses: &poses,
            base_angle: None,
        };
        let fit = solver.fit(&observed, None);
        covariance = fit.covariance().unwrap();
        deviations.push(DVector::from_vec(fit.configuration) - DVector::from_column_slice(&q));
    }
    // In units of the deviations told, those found are 1 on average whatever the direction.
    let whitened = covariance.cholesky().unwrap();
    let mean = deviations.iter().sum::<DVector<f64>>() / f64::from(repeats);
    let found = (deviations.iter())
        .map(|d| d - &mean)
        .map(|d| whitened.l().solve_lower_triangular(&d).unwrap())
        .map(|d| &d * d.transpose())
        .sum::<DMatrix<f64>>()
        / f64::from(repeats);
    let error = (found - DMatrix::identity(11, 11)).amax();
    assert!(error < 0.12, "{error}");
}
