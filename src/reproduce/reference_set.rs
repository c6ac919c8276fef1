//! The authors' simulated steady states.

use super::{Data, ReproduceError};
use crate::kinematics::{Metrics, Pose};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use npyz::npz::NpzArchive;
use std::path::Path;

/// The sets of the paper: trajectory and folder.
pub(super) const SETS: [(&str, &str); 5] = [
    (
        "elongation",
        "20221025_170312_elongation_seed-101_100-samples",
    ),
    ("bending", "20221025_170335_bending_seed-101_225-samples"),
    ("twisting", "20221025_214951_twisting_seed-101_200-samples"),
    (
        "lemniscate",
        "20221025_215237_lemniscate_seed-101_100-samples",
    ),
    ("combined", "20221025_220436_combined_seed-101_500-samples"),
];

/// The set without poses.
const ANGLES_ONLY: &str = "combined";
/// Points a rod.
const POINTS: usize = 25;

/// One set: motor angles, and where there are any poses and errors of the authors' fits.
pub(super) struct ReferenceSet {
    /// Trajectory.
    pub name: &'static str,
    /// Motor angles \[rad\], an entry a state.
    pub angles: Vec<[f64; 4]>,
    /// Poses of all rods of all states; empty where only the angles are published.
    pub rods: Vec<Vec<Pose>>,
    /// Errors of the authors' fits of two segments.
    pub stored: Option<Metrics>,
}

impl ReferenceSet {
    /// Reads a set.
    pub fn read(data: &Data, name: &'static str, folder: &str) -> Result<Self, ReproduceError> {
        let folder = format!("reference_simulations/{folder}");
        let angles = angles(&data.find(&format!("{folder}/actuation_specs.csv"))?)?;
        if name == ANGLES_ONLY {
            return Ok(Self {
                name,
                angles,
                rods: Vec::new(),
                stored: None,
            });
        }
        let table = data.find(&format!(
            "{folder}/inverse_kinematics_results_spcs_n_S-2.npz"
        ))?;
        let rods = poses(&table, "T_ss", 4 * angles.len())?;
        let fitted = poses(&table, "T_hat_ss", 4 * angles.len())?;
        let pairs = rods.iter().flatten().zip(fitted.iter().flatten());
        let stored = Some(Metrics::near_half_turns(pairs));
        Ok(Self {
            name,
            angles,
            rods,
            stored,
        })
    }
}

fn damaged(path: &Path, reason: impl ToString) -> ReproduceError {
    ReproduceError::Damaged {
        path: path.into(),
        reason: reason.to_string(),
    }
}

/// The columns `u_ss_0` to `u_ss_3`.
fn angles(path: &Path) -> Result<Vec<[f64; 4]>, ReproduceError> {
    #[derive(serde::Deserialize)]
    struct Specs {
        u_ss_0: f64,
        u_ss_1: f64,
        u_ss_2: f64,
        u_ss_3: f64,
    }
    let mut reader = csv::Reader::from_path(path).map_err(|e| damaged(path, e))?;
    let rows = reader.deserialize::<Specs>().map(|row| {
        let specs = row.map_err(|e| damaged(path, e))?;
        let angles = [specs.u_ss_0, specs.u_ss_1, specs.u_ss_2, specs.u_ss_3];
        if angles.iter().all(|angle| angle.is_finite()) {
            Ok(angles)
        } else {
            Err(damaged(path, "it holds an angle that is not finite"))
        }
    });
    rows.collect()
}

/// An array of homogeneous matrices of shape (rods, 4, 4, 25).
fn poses(path: &Path, array: &str, rods: usize) -> Result<Vec<Vec<Pose>>, ReproduceError> {
    let fault = |reason: String| damaged(path, format!("array {array} {reason}"));
    let mut archive = NpzArchive::open(path).map_err(|e| damaged(path, e))?;
    let found = archive.by_name(array).map_err(|e| fault(e.to_string()))?;
    let found = found.ok_or_else(|| fault("is missing".into()))?;
    if found.shape() != [rods as u64, 4, 4, POINTS as u64] || found.order() != npyz::Order::C {
        return Err(fault(format!("has shape {:?}", found.shape())));
    }
    let entries: Vec<f32> = found.into_vec().map_err(|e| fault(e.to_string()))?;
    if !entries.iter().all(|entry| entry.is_finite()) {
        return Err(fault("holds a number that is not finite".into()));
    }
    let rods = entries.chunks_exact(16 * POINTS);
    Ok(rods
        .map(|rod| (0..POINTS).map(|point| pose(rod, point)).collect())
        .collect())
}

fn pose(rod: &[f32], point: usize) -> Pose {
    let at = |i: usize, j: usize| f64::from(rod[(i * 4 + j) * POINTS + point]);
    // single precision: a rotation only nearly
    let turn = Rotation3::from_matrix_unchecked(Matrix3::from_fn(at));
    let mut turn = UnitQuaternion::from_rotation_matrix(&turn);
    turn.renormalize();
    Pose::from_parts(Vector3::from_fn(|i, _| at(i, 3)).into(), turn)
}
