//! What the tests share: where the public data are, and a small recording made up.

#![allow(dead_code, reason = "each test file uses a part of this")]

use std::path::{Path, PathBuf};

use auxetica_recordings::{Mocap, Pose, Recording, Track, to_world};
use nalgebra::{UnitQuaternion, Vector3};

/// The five runs of the public data set and their numbers of rows.
pub const RUNS: [(&str, usize); 5] = [
    ("20221011_174514", 2371),
    ("20221011_184131", 7175),
    ("20221012_103309", 4732),
    ("20221012_140717", 20009),
    ("20221012_153814", 2559),
];

/// The run of which the data set has no motion capture.
pub const WITHOUT_MOCAP: &str = "20221012_140717";

/// A folder of the public data, or `None`, with a notice, where they are absent.
///
/// # Panics
/// When they are absent in continuous integration, which must not skip the tests.
pub fn data(folder: &str) -> Option<PathBuf> {
    let root = std::env::var_os("AUXETICA_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"),
        PathBuf::from,
    );
    let path = root.join(folder);
    if path.is_dir() {
        return Some(path);
    }
    assert!(
        std::env::var_os("CI").is_none(),
        "no data in {}: set AUXETICA_DATA to their folder",
        path.display()
    );
    eprintln!(
        "SKIPPED: no data in {}: set AUXETICA_DATA to their folder",
        path.display()
    );
    None
}

/// A made-up recording of two dwells: at rest for 12 rows, then motors 1 and 3 turn by 600 ticks
/// within 4 rows, the platform rises by 3 mm, and all rest again.
pub fn small() -> Recording {
    let rows = 24;
    let travel = |row: usize| (row.saturating_sub(12) as f64 / 4.0).min(1.0);
    let zero = [1000.0, 3000.0, -500.0, 2000.0];
    let ticks = |share: f64| {
        let mut ticks = zero;
        ticks[0] += 600.0 * share;
        ticks[2] += 600.0 * share;
        ticks
    };
    let track = |x: f64, y: f64, z: f64, rise: f64| {
        Track::new((0..rows).map(|row| {
            // Below the accuracy of any check, but no two frames alike.
            let jitter = 1e-7 * (row as f64).sin();
            let position = Vector3::new(x + jitter, y, z + rise * travel(row));
            let turn =
                UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 10.0 * rise * travel(row));
            to_world(&Pose::from_parts(position.into(), turn))
        }))
    };
    Recording {
        name: "small".into(),
        time: (0..rows).map(|row| 1.0 + 0.108 * row as f64).collect(),
        goal: (0..rows)
            .map(|row| ticks(f64::from(u8::from(row >= 12))))
            .collect(),
        present: (0..rows).map(|row| ticks(travel(row))).collect(),
        velocities: (0..rows)
            .map(|row| {
                if (13..=16).contains(&row) {
                    [40.0, 0.0, 40.0, 0.0]
                } else {
                    [0.0; 4]
                }
            })
            .collect(),
        loads: vec![[1.0, -2.0, 3.0, 0.0]; rows],
        mocap: Some(Mocap {
            base: track(0.38, -0.12, 0.0035, 0.0),
            platform: track(0.383, -0.121, 0.120, 0.003),
            ring: track(0.356, -0.144, 0.055, 0.001),
        }),
    }
}
