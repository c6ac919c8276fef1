//! Forward kinematics against closed forms, the matrix exponential and the published fits.

mod common;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use auxetica_kinematics::{Pose, Spcs, StrainSelector, Variation};
use nalgebra::{Matrix4, Rotation3, Vector3, Vector6};

use auxetica_kinematics::table2::RUNS;
use common::{Random, Steady, array, published_configurations};

/// A rod of one segment, all strains free.
fn one_segment(length: f64) -> Spcs {
    Spcs::uniform(StrainSelector::PIECEWISE, length, 1)
}

fn assert_point(pose: &Pose, expected: [f64; 3]) {
    let error = pose.translation.vector - Vector3::from(expected);
    assert!(error.norm() < 1e-15, "{error}");
}

#[test]
fn constant_curvature_is_an_arc_of_a_circle() {
    let (length, curvature) = (0.1, 20.0);
    let rod = one_segment(length);
    for s in [0.0, 1e-9, 0.02, 0.05, 0.1] {
        let pose = rod.pose(&[0.0, 0.0, curvature, 0.0, 0.0, 0.0, 0.0], s);
        let angle = curvature * s;
        // About y: the rod leans towards x.
        assert_point(
            &pose,
            [
                (1.0 - angle.cos()) / curvature,
                0.0,
                angle.sin() / curvature,
            ],
        );
        let turned = pose
            .rotation
            .angle_to(&Rotation3::from_axis_angle(&Vector3::y_axis(), angle).into());
        assert!(turned < 1e-7);
    }
}

#[test]
fn shear_and_stretch_alone_move_along_a_line() {
    let rod = one_segment(0.08);
    let pose = rod.pose(&[0.0, 0.0, 0.0, 0.0, 0.2, -0.1, 0.5], 0.08);
    assert_point(&pose, [0.016, -0.008, 0.12]);
    assert!(pose.rotation.angle() < 1e-15);
}

#[test]
fn curvature_and_twist_make_a_helix() {
    let (curvature, twist, length) = (30.0f64, 40.0f64, 0.09);
    let pose = one_segment(length).pose(&[0.0, curvature, 0.0, twist, 0.0, 0.0, 0.0], length);
    // Radius k/(k^2 + t^2), rise per angle t/(k^2 + t^2), about the axis along (k, 0, t).
    let total = curvature.hypot(twist);
    let angle = total * length;
    let axis = Vector3::new(curvature, 0.0, twist) / total;
    let along = axis.z * length;
    let radius = curvature / total.powi(2);
    let inwards = -Vector3::y();
    let forward = inwards.cross(&axis);
    let expected = axis * along + (inwards * (1.0 - angle.cos()) + forward * angle.sin()) * radius;
    assert_point(&pose, expected.into());
}

#[test]
fn base_turns_and_ends_hold() {
    let rod = Spcs::uniform(StrainSelector::SHEARED, 0.06, 2);
    let mut q = vec![
        FRAC_PI_2, -3.0, 0.1, 0.0, 12.0, 0.0, 0.0, 0.0, 7.0, 0.1, 0.0,
    ];
    let turned = rod.pose(&q, 0.06);
    q[0] = 0.0;
    let straight = rod.pose(&q, 0.06);
    let p = straight.translation.vector;
    assert_point(&turned, [-p.y, p.x, p.z]);
    assert_eq!(rod.pose(&q, -0.1), Pose::identity());
    assert_eq!(rod.pose(&q, 1.0), straight);
}

#[test]
fn selectors_place_strains_in_the_paper_s_order() {
    let rod = Spcs::new(StrainSelector::SHEARED, &[0.02, 0.04]);
    let q: Vec<f64> = (0..11).map(f64::from).collect();
    assert_eq!(
        rod.strains(&q, 0),
        Vector6::new(3.0, 4.0, 1.0, 5.0, 6.0, 3.0)
    );
    assert_eq!(
        rod.strains(&q, 1),
        Vector6::new(7.0, 8.0, 1.0, 9.0, 10.0, 3.0)
    );
    let dofs = [
        StrainSelector::UNSHEARED,
        StrainSelector::SHEARED,
        StrainSelector::PIECEWISE,
    ];
    assert_eq!(dofs.map(|selector| selector.dof(2)), [7, 11, 13]);
    let rigid = Spcs::uniform(StrainSelector([Variation::Rest; 6]), 0.1, 3);
    assert_point(&rigid.pose(&[1.0], 0.05), [0.0, 0.0, 0.05]);
}

#[test]
fn every_strain_gives_the_matrix_exponential_from_none_to_beyond_a_turn() {
    let rod = one_segment(1.0);
    let mut random = Random(3);
    let angles = [0.0, 1e-300, 1e-12, 1e-8, 1e-4, 0.01, 0.99, 1.01, PI, 6.0];
    let near_a_turn = [1e-9, 1e-5, 1e-2].map(|gap| TAU - gap);
    for angle in angles.into_iter().chain(near_a_turn).chain([TAU, 6.5]) {
        for _ in 0..50 {
            let k = Vector3::from_fn(|_, _| random.next()).normalize() * angle;
            let offset = Vector3::from_fn(|_, _| random.next());
            let q = [0.0, k.x, k.y, k.z, offset.x, offset.y, offset.z];
            let mut twist = Matrix4::zeros();
            twist
                .fixed_view_mut::<3, 3>(0, 0)
                .copy_from(&k.cross_matrix());
            twist
                .fixed_view_mut::<3, 1>(0, 3)
                .copy_from(&(offset + Vector3::z()));
            let error = (rod.pose(&q, 1.0).to_homogeneous() - twist.exp()).amax();
            assert!(error < 1e-14, "{angle}: {error:e}");
        }
    }
}

#[test]
fn batches_are_the_poses_one_by_one() {
    let rod = Spcs::uniform(StrainSelector::SHEARED, 0.06, 2);
    let mut random = Random(4);
    let configurations: Vec<Vec<f64>> = (0..40)
        .map(|_| (0..11).map(|_| random.next()).collect())
        .collect();
    let arc_lengths = [0.01, 0.045];
    let poses = rod.poses(&configurations, &arc_lengths);
    let with_jacobians = rod.poses_and_jacobians(&configurations, &arc_lengths);
    for (i, q) in configurations.iter().enumerate() {
        for (j, &s) in arc_lengths.iter().enumerate() {
            assert_eq!(poses[i][j], rod.pose(q, s));
            assert_eq!(with_jacobians[i][j], rod.pose_and_jacobian(q, s));
        }
    }
}

#[test]
fn published_configurations_give_the_published_poses() {
    for run in RUNS {
        let Some(steady) = Steady::read(run.recording) else {
            return;
        };
        let configurations = published_configurations(run.recording).unwrap();
        let published = array(run.recording, "T_hat_ss").unwrap();
        let rod = Spcs::uniform(StrainSelector::SHEARED, steady.arc_lengths[2], 2);
        let poses = rod.poses(&configurations, &steady.arc_lengths);
        let mut largest = 0.0f64;
        for (poses, published) in poses.iter().zip(published.chunks_exact(48)) {
            for (point, pose) in poses.iter().enumerate() {
                let expected =
                    Vector3::from_fn(|i, _| f64::from(published[(4 * i + 3) * 3 + point]));
                largest = largest.max((pose.translation.vector - expected).amax());
            }
        }
        println!("{}: positions within {largest:.1e} m", run.name);
        assert!(largest < 9e-8, "{}: {largest:e}", run.name);
    }
}
