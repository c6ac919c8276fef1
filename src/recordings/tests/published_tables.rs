//! The published tables are reproduced from the recordings: which rows, and which poses.

mod common;

use std::path::{Path, PathBuf};

use auxetica_recordings::{
    Pose, PublishedTable, Recording, RobotGeometry, authors_rows, authors_samples,
};
use nalgebra::Matrix4;

use common::{RUNS, WITHOUT_MOCAP, data};

fn table_path(run: &Path) -> PathBuf {
    run.join("inverse_kinematics_results_spcs_n_S-2.npz")
}

/// Largest difference between entries of homogeneous matrices.
fn difference(poses: &[[Pose; 3]], transforms: &[[Matrix4<f64>; 3]]) -> f64 {
    assert_eq!(poses.len(), transforms.len());
    (poses.iter().flatten())
        .zip(transforms.iter().flatten())
        .map(|(pose, transform)| (pose.to_homogeneous() - transform).amax())
        .fold(0.0, f64::max)
}

#[test]
fn authors_rows_are_those_of_every_table() {
    let Some(folder) = data("recordings") else {
        return;
    };
    let samples = [100, 225, 200, 500, 100];
    for ((name, _), samples) in RUNS.into_iter().zip(samples) {
        let run = Recording::read(folder.join(name)).unwrap();
        let table = PublishedTable::read(table_path(&folder.join(name))).unwrap();
        assert_eq!(table.row.len(), samples);
        assert_eq!(authors_rows(&run), table.row, "{name}");
    }
}

#[test]
fn authors_poses_are_those_of_the_tables() {
    let Some(folder) = data("recordings") else {
        return;
    };
    let geometry = RobotGeometry::default();
    for (name, _) in RUNS.into_iter().filter(|(name, _)| *name != WITHOUT_MOCAP) {
        let run = Recording::read(folder.join(name)).unwrap();
        let table = PublishedTable::read(table_path(&folder.join(name))).unwrap();
        let samples = authors_samples(&run, &geometry).unwrap();
        let error = difference(&samples.rod_poses(&geometry), &table.transforms);
        println!("{name}: poses differ by {error:.1e}");
        assert!(error < 3.3e-7, "{name}: {error}");
        for (ours, theirs) in samples.arc_lengths(&geometry).iter().zip(table.arc_lengths) {
            assert!((ours - theirs).abs() < 1e-7, "{name}: {ours} {theirs}");
        }
    }
}

#[test]
fn tables_give_steady_samples_without_motion_capture() {
    let Some(folder) = data("recordings") else {
        return;
    };
    let geometry = RobotGeometry::default();
    for (name, _) in RUNS {
        let run = Recording::read(folder.join(name)).unwrap();
        let table = PublishedTable::read(table_path(&folder.join(name))).unwrap();
        let samples = table.samples(&run, &geometry).unwrap();
        // Back again: nothing is lost on the way from rod to platform.
        let error = difference(&samples.rod_poses(&geometry), &table.transforms);
        assert!(error < 1e-6, "{name}: {error}");
        for (ours, theirs) in samples.arc_lengths(&geometry).iter().zip(table.arc_lengths) {
            assert!((ours - theirs).abs() < 1e-12);
        }
        if name == WITHOUT_MOCAP {
            continue;
        }
        // Beside the same samples from motion capture, less where the markers sit.
        let measured = authors_samples(&run, &geometry).unwrap();
        let rest = &measured.reference;
        for (from_table, from_mocap) in samples.ring.iter().zip(&measured.ring) {
            assert!(from_table.rotation.angle_to(&from_mocap.rotation) < 1e-6);
        }
        for (from_table, from_mocap) in samples.platform.iter().zip(&measured.platform) {
            let turned = from_mocap.rotation * rest.platform.rotation;
            assert!(from_table.rotation.angle_to(&turned) < 1e-6);
            let mut off_axis = rest.platform.translation.vector;
            off_axis.z = 0.0;
            let on_axis = from_mocap.translation.vector - turned * off_axis;
            assert!((from_table.translation.vector - on_axis).norm() < 1e-6);
        }
    }
}

#[test]
fn table_of_another_run_is_refused() {
    let Some(folder) = data("recordings") else {
        return;
    };
    let run = Recording::read(folder.join(RUNS[0].0)).unwrap();
    let table = PublishedTable::read(table_path(&folder.join(RUNS[1].0))).unwrap();
    let error = table.samples(&run, &RobotGeometry::default()).unwrap_err();
    assert!(error.to_string().contains("does not belong"), "{error}");
}

#[test]
fn damaged_tables_are_refused_not_fatal() {
    let Some(folder) = data("recordings") else {
        return;
    };
    let bytes = std::fs::read(table_path(&folder.join(RUNS[0].0))).unwrap();
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("table.npz");
    for length in (0..bytes.len()).step_by(bytes.len() / 60) {
        std::fs::write(&path, &bytes[..length]).unwrap();
        assert!(
            PublishedTable::read(&path).is_err(),
            "cut to {length} bytes"
        );
    }
    for place in (0..bytes.len()).step_by(bytes.len() / 200) {
        let mut damaged = bytes.clone();
        damaged[place] ^= 0xff;
        std::fs::write(&path, &damaged).unwrap();
        // Most damage lies in arrays that are not read; none may panic.
        let _ = PublishedTable::read(&path);
    }
}
