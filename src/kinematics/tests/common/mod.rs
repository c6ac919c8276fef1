//! What the tests share: the public runs' poses, and random numbers.

#![allow(dead_code, reason = "each test file uses a part of this")]

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use auxetica_kinematics::{Observed, Pose};
use auxetica_recordings::{PublishedTable, Recording, RobotGeometry};
use npyz::npz::NpzArchive;

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
    let notice = format!(
        "no data in {}: set AUXETICA_DATA to their folder",
        path.display()
    );
    assert!(std::env::var_os("CI").is_none(), "{notice}");
    eprintln!("SKIPPED: {notice}");
    None
}

/// The published table of a run.
fn table_path(run: &str) -> Option<PathBuf> {
    Some(
        data("recordings")?
            .join(run)
            .join("inverse_kinematics_results_spcs_n_S-2.npz"),
    )
}

/// An array of a published table.
pub fn array(run: &str, name: &str) -> Option<Vec<f32>> {
    let file = File::open(table_path(run)?).unwrap();
    let mut archive = NpzArchive::new(BufReader::new(file)).unwrap();
    Some(archive.by_name(name).unwrap().unwrap().into_vec().unwrap())
}

/// The configurations that the authors found, 11 degrees of freedom.
pub fn published_configurations(run: &str) -> Option<Vec<Vec<f64>>> {
    let wide = |q: &[f32]| q.iter().map(|&entry| f64::from(entry)).collect();
    Some(array(run, "q_hat_ss")?.chunks_exact(11).map(wide).collect())
}

/// Steady poses of a run.
pub struct Steady {
    pub base_angles: Vec<f64>,
    pub poses: Vec<[Pose; 3]>,
    pub arc_lengths: [f64; 3],
}

impl Steady {
    /// Those of the published table.
    pub fn read(run: &str) -> Option<Self> {
        let recording = Recording::read(data("recordings")?.join(run)).unwrap();
        let table = PublishedTable::read(table_path(run)?).unwrap();
        let geometry = RobotGeometry::default();
        let samples = table.samples(&recording, &geometry).unwrap();
        Some(Self {
            base_angles: samples
                .angles
                .iter()
                .map(|angles| angles[geometry.ring_rod])
                .collect(),
            poses: samples.rod_poses(&geometry),
            arc_lengths: samples.arc_lengths(&geometry),
        })
    }

    pub fn observed(&self) -> Vec<Observed<'_>> {
        (self.base_angles.iter().zip(&self.poses))
            .map(|(&angle, poses)| Observed {
                arc_lengths: &self.arc_lengths,
                poses,
                base_angle: Some(angle),
            })
            .collect()
    }
}

/// Uniform random numbers in [-1, 1), the same in every run (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / 2f64.powi(63) - 1.0
    }
}
