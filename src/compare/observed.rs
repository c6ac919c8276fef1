//! What a recording shows: motor angles, and poses to hold a simulation against.

use super::{CompareError, Mode};
use crate::engine::{Inputs, Series};
use crate::recordings::{
    Audit, BasePoses, MotorAngles, Pose, PublishedTable, Recording, Reference, RobotGeometry,
    SettleRule, SteadySamples, authors_samples,
};
use std::path::Path;

/// Which steady samples are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SampleKind {
    /// The settled rows at the end of each dwell.
    #[default]
    Settled,
    /// Exactly the samples that the data set's authors took, their row pairing included.
    Authors,
}

/// Motor angles and the poses of platform and ring, one entry a sample. Positions are of marker points in the base
/// frame, rotations from rest.
pub struct Observed {
    /// Name of the recording.
    pub name: String,
    /// Where the poses come from, in words.
    pub origin: &'static str,
    /// Time \[s\].
    pub time: Vec<f64>,
    /// Poses of `platform` and of `ring`.
    pub poses: [Vec<Pose>; 2],
    /// Time \[s\] of rest, all angles zero.
    pub rest: f64,
    /// Rest pose of both, orientation of the markers included.
    pub reference: Reference,
    /// Angles over time from rest on: of the samples if steady, else of every row.
    angles: (Vec<f64>, Vec<[f64; 4]>),
    /// Samples at the settled end of a dwell, if every row is a sample.
    pub settled: Vec<usize>,
    /// Dwells without a sample.
    pub skipped: usize,
    /// What is odd about the recording: gaps, stale frames, jumps, flips.
    pub audit: Audit,
}

/// The published table of steady poses beside a recording.
pub(crate) const TABLE: &str = "inverse_kinematics_results_spcs_n_S-2.npz";

/// The published steady poses of a recording without motion capture, in `folder`.
///
/// # Errors
/// If there is no such table, or it is of another recording.
pub fn published(recording: &Recording, folder: &Path) -> Result<SteadySamples, CompareError> {
    let table = PublishedTable::read(folder.join(TABLE)).map_err(|table| {
        CompareError::Unfit(format!(
            "recording `{}` has no motion capture (mocap_frame_data_history.csv), and its published steady poses can't \
             be read either: {table}",
            recording.name
        ))
    })?;
    Ok(table.samples(recording, &RobotGeometry::default())?)
}

impl Observed {
    /// Reads the recording in `folder`.
    pub fn read(folder: &Path, mode: Mode, kind: SampleKind) -> Result<Self, CompareError> {
        let recording = Recording::read(folder)?;
        let geometry = RobotGeometry::default();
        match mode {
            Mode::Quasistatic | Mode::Dynamic => Self::every_row(&recording, &geometry),
            Mode::Steady if recording.mocap.is_none() => {
                let samples = published(&recording, folder)?;
                Self::steady(&recording, samples, "published table of steady poses")
            }
            Mode::Steady => {
                let samples = match kind {
                    SampleKind::Settled => SettleRule::default().samples(&recording, &geometry)?,
                    SampleKind::Authors => authors_samples(&recording, &geometry)?,
                };
                Self::steady(&recording, samples, "motion capture")
            }
        }
    }

    fn steady(
        recording: &Recording,
        samples: SteadySamples,
        origin: &'static str,
    ) -> Result<Self, CompareError> {
        let mut angles = (samples.time.clone(), samples.angles);
        // The poses at rest belong to the first row, before the first sample.
        let rest = recording.time[recording.first_row()];
        if samples.time.first().is_some_and(|first| *first > rest) {
            angles.0.insert(0, rest);
            angles.1.insert(0, [0.0; 4]);
        }
        Ok(Self {
            name: recording.name.clone(),
            origin,
            rest,
            angles,
            time: samples.time,
            poses: [samples.platform, samples.ring],
            reference: samples.reference,
            settled: Vec::new(),
            skipped: samples.skipped,
            audit: Audit::new(recording)?,
        })
    }

    fn every_row(recording: &Recording, geometry: &RobotGeometry) -> Result<Self, CompareError> {
        let poses = BasePoses::new(recording, geometry)?;
        let reference = Reference::new(recording, &poses)?;
        let BasePoses { platform, ring, .. } = poses.from_rest(&reference);
        let motors = MotorAngles::new(recording);
        let rows = motors.first_row..motors.first_row + motors.time.len();
        let settled = SettleRule::default().samples(recording, geometry)?;
        let settled = settled.row.iter().filter(|row| rows.contains(row));
        let settled = settled.map(|row| row - rows.start).collect();
        Ok(Self {
            name: recording.name.clone(),
            origin: "motion capture",
            time: motors.time.clone(),
            poses: [platform[rows.clone()].to_vec(), ring[rows].to_vec()],
            reference,
            rest: motors.time[0],
            angles: (motors.time, motors.present),
            settled,
            skipped: 0,
            audit: Audit::new(recording)?,
        })
    }

    /// Drops everything after `until` \[s\].
    pub fn end_at(&mut self, until: f64) {
        let kept = self.time.partition_point(|t| *t <= until);
        self.time.truncate(kept);
        self.settled.retain(|sample| *sample < kept);
        for poses in &mut self.poses {
            poses.truncate(kept);
        }
    }

    /// The motor angles \[rad\] as a scenario's inputs `motor_1` to `motor_4`.
    pub fn inputs(&self) -> Result<Inputs, CompareError> {
        let (times, angles) = &self.angles;
        motor_inputs(times, angles).map_err(|e| {
            CompareError::Unfit(format!("motor angles of recording `{}`: {e}", self.name))
        })
    }
}

/// Inputs `motor_1` to `motor_4` of angles \[rad\] at times \[s\].
///
/// # Errors
/// In words, if times don't rise, or a number is not finite.
pub fn motor_inputs(times: &[f64], angles: &[[f64; 4]]) -> Result<Inputs, String> {
    let channel = |i: usize| {
        let values = angles.iter().map(|a| a[i]).collect();
        let series = Series::new(times.to_vec(), values)?;
        Ok((format!("motor_{}", i + 1), series))
    };
    let channels: Result<Vec<_>, String> = (0..4).map(channel).collect();
    channels.map(Inputs::new)
}
