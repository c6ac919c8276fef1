//! The steady samples that the data set's authors took, with their pairing of rows.
//!
//! They read the files with the first line taken for a header. That drops a row of every file,
//! but only the base's row of the first motion-capture frame: from then on their platform and
//! ring are one sample early. The published tables follow this, so it is reproduced here; for
//! anything else take [`SettleRule`](crate::SettleRule).

use nalgebra::Vector3;

use crate::dwells::dwells;
use crate::frames::{rotation_from, shifted, to_base};
use crate::motors::angles_from;
use crate::{Error, Pose, Recording, Reference, RobotGeometry, SteadySamples};

/// Fastest signed mean of the four motors' velocities, in their unit, that the authors call steady.
const MAX_MEAN_VELOCITY: f64 = 1.0;

/// Rows of the recording whose motor readings the authors took for steady, one for each change
/// of goal. The `sample_idx_ss` of their tables is one less.
#[must_use]
pub fn authors_rows(recording: &Recording) -> Vec<usize> {
    let rows = 1.min(recording.len())..recording.len();
    let after_changes = dwells(recording, rows).into_iter().skip(1);
    after_changes
        .filter_map(|dwell| {
            let steady: Vec<usize> = dwell
                .filter(|&row| {
                    let sum: f64 = recording.velocities[row].iter().sum();
                    sum / 4.0 <= MAX_MEAN_VELOCITY
                })
                .collect();
            // The index of the least error counts all four motors of a row, yet is used as one
            // of a row, and is held to the last row where it goes past it.
            let errors = steady.iter().flat_map(|&row| {
                (0..4).map(move |i| (recording.goal[row][i] - recording.present[row][i]).abs())
            });
            let (least, _) = errors.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
            steady.get(least).or(steady.last()).copied()
        })
        .collect()
}

/// The authors' steady samples: motors and base of one row, platform and ring of the row before,
/// each relative to the base's position in that very row. `row` is that of the motors.
///
/// # Errors
/// When the recording has no motion capture, or fewer than two rows.
pub fn authors_samples(
    recording: &Recording,
    geometry: &RobotGeometry,
) -> Result<SteadySamples, Error> {
    let mocap = recording.require_mocap()?;
    let Some(zero) = recording.present.get(1) else {
        return Err(Error::Inconsistent {
            recording: recording.name.clone(),
            reason: "it has fewer than two rows".into(),
        });
    };
    let markers = Vector3::z() * geometry.base_markers;
    let pose = |track: &crate::Track, row: usize| -> Pose {
        let base = to_base(&mocap.base.pose(row)).translation.vector - markers;
        shifted(&to_base(&track.pose(row - 1)), -base)
    };
    let reference = Reference {
        platform: pose(&mocap.platform, 1),
        ring: pose(&mocap.ring, 1),
        rows: 1..2,
    };
    let row = authors_rows(recording);
    Ok(SteadySamples {
        time: row.iter().map(|&row| recording.time[row]).collect(),
        angles: (row.iter())
            .map(|&row| angles_from(&recording.present[row], zero))
            .collect(),
        platform: (row.iter())
            .map(|&row| rotation_from(&pose(&mocap.platform, row), &reference.platform))
            .collect(),
        ring: (row.iter())
            .map(|&row| rotation_from(&pose(&mocap.ring, row), &reference.ring))
            .collect(),
        skipped: (dwells(recording, 1..recording.len()).len() - 1).saturating_sub(row.len()),
        reference,
        row,
    })
}
