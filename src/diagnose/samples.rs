//! What a recording is reduced to: the settled end and the beginning of every dwell, and rows on the way.

use super::forward::CHANNELS;
use super::motors::Motors;
use crate::compare::{CompareError, motor_inputs, published};
use crate::engine::Inputs;
use crate::engine::scenario::Turn;
use crate::recordings::{BasePoses, Pose, Recording, Reference, RobotGeometry, SteadySamples};
use nalgebra::Vector3;
use std::path::Path;

/// Rows that are averaged at most.
const BLOCK: usize = 5;
/// Every so many rows on the way, one is taken.
const STRIDE: usize = 6;
/// A model that remembers passes every so many rows while motors turn, all while the robot relaxes after that, and every so
/// many later.
const ON_THE_WAY: usize = 2;
const RELAXING: usize = 4;
const QUIET: usize = 8;
/// Error of the time that a moving row is taken at [s].
const CLOCK: f64 = 0.01;
/// Share of the robot's speed that quasi-static states of moving rows may be wrong by, as a time [s].
const INERTIA: f64 = 0.01;

/// Samples that are taken of a recording at most; slow trajectories show the same again and again.
const MOST: usize = 200;
/// Turn of the base beyond which it isn't the base's that is recorded [rad].
const ASKEW: f64 = 0.5;
/// Motor angle below which nothing turns [rad].
const NO_TURN: f64 = 0.05;
const MOCAP: &str = "mocap_frame_data_history.csv";

/// Deviation of poses from a published table, which doesn't tell it: position [m], rotation [rad].
const PUBLISHED: (f64, f64) = (1e-4, 1e-3);

/// Kinds of channels: positions and rotations of the platform, then of the ring, three channels each.
pub const KINDS: [&str; 4] = [
    "platform's position",
    "platform's turn",
    "ring's position",
    "ring's turn",
];
/// Turn of a body against the model that is a mistake of motion capture [rad], and the share of samples that may have it.
const FLIPPED: (f64, f64) = (1.0, 0.05);

/// When a sample was taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Motors turn.
    Moving,
    /// Just after they have stopped.
    Stopped,
    /// At the end of the dwell.
    Settled,
}

/// What a motor reports.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// Its load, in the motor's unit.
    pub load: f64,
    /// Standard deviation of that.
    pub deviation: f64,
    /// How it turns.
    pub turn: Turn,
}

/// Means over a few rows.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Time of the last of these rows [s].
    pub time: f64,
    /// Motor angles [rad].
    pub angles: [f64; 4],
    /// What the motors report.
    pub motors: [Reading; 4],
    /// Poses of platform and ring in the base frame.
    pub poses: [Pose; 2],
    /// When it was taken.
    pub phase: Phase,
    /// Standard deviation of a position component [m] of each body.
    pub position_deviation: [f64; 2],
    /// Standard deviation of a rotation component [rad] of each body.
    pub rotation_deviation: [f64; 2],
}

/// A recording, reduced.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Name of the recording.
    pub name: String,
    /// Samples in order of time.
    pub list: Vec<Sample>,
    /// Motor angles of all rows.
    pub inputs: Inputs,
    /// Times of rows that a model which remembers must pass [s].
    pub passed: Vec<f64>,
    /// Rest poses of the markers.
    pub reference: Reference,
    /// Motor angles at rest are zero from here [s].
    pub rest: f64,
    /// Deviation of a single row at rest: position [m], rotation [rad].
    pub noise: (f64, f64),
    /// How many times wider than noise residuals of each kind are taken to spread.
    pub wider: [f64; KINDS.len()],
    /// Samples that were left out, since motion capture had mistaken markers.
    pub flipped: usize,
}

impl Samples {
    /// Reads and reduces the recording in `folder`.
    ///
    /// # Errors
    /// If it can't be read or shows no dwell.
    pub fn read(folder: &Path) -> Result<Self, CompareError> {
        let recording = Recording::read(folder)?;
        match recording.mocap {
            Some(_) => Self::of(&recording),
            None => Self::published(&recording, &published(&recording, folder)?),
        }
    }

    /// Whether no motor reports any load.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        let mut all = self.list.iter().flat_map(|sample| &sample.motors);
        all.all(|motor| motor.load == 0.0)
    }

    /// Leaves out samples at which a body seems to be turned by more than a radian against a scenario, unless they are many;
    /// `apart` is simulated less recorded.
    pub fn leave_out_flips(&mut self, apart: &[f64]) {
        let turned = |of: &[f64]| Vector3::from_column_slice(of).norm() > FLIPPED.0;
        let (samples, _) = apart.as_chunks::<CHANNELS>();
        let flipped: Vec<bool> = (samples.iter())
            .map(|of| turned(&of[3..6]) || turned(&of[9..12]))
            .collect();
        let count = flipped.iter().filter(|f| **f).count();
        if count as f64 <= FLIPPED.1 * flipped.len() as f64 {
            let mut flipped = flipped.into_iter();
            self.list.retain(|_| flipped.next() != Some(true));
            self.flipped = count;
        }
    }

    /// Whether kinds of channels count by how far off they are.
    #[must_use]
    pub fn weighed(&self) -> bool {
        self.wider.iter().any(|wider| *wider > 1.0)
    }

    /// Leaves so many samples at most, evenly, and as many fewer rows on the way.
    pub fn thin(&mut self, most: usize) {
        let every = self.list.len().div_ceil(most).max(1);
        thin(&mut self.list, most);
        self.passed = self.passed.iter().copied().step_by(every).collect();
    }

    /// Takes residuals of each kind to spread wider by how far `off` they are over those that are least so.
    pub fn widen(&mut self, off: [f64; KINDS.len()]) {
        let least = off.iter().copied().fold(f64::INFINITY, f64::min);
        for (wider, off) in self.wider.iter_mut().zip(off) {
            *wider *= off / least;
        }
    }

    /// Times between the sample before `i` and `i` that a model which remembers must pass \[s\].
    pub fn on_the_way(&self, i: usize) -> &[f64] {
        let from = if i == 0 {
            self.rest
        } else {
            self.list[i - 1].time
        };
        let place = |time: f64| self.passed.partition_point(|t| *t <= time);
        let to = self.passed.partition_point(|t| *t < self.list[i].time);
        &self.passed[place(from).min(to)..to]
    }

    /// Reduces a recording.
    ///
    /// # Errors
    /// If it has no motion capture or shows no dwell.
    pub fn of(recording: &Recording) -> Result<Self, CompareError> {
        let geometry = RobotGeometry::default();
        let poses = BasePoses::new(recording, &geometry)?;
        let turned = poses.base_rotation.angle();
        if turned > ASKEW {
            return Err(CompareError::Unfit(format!(
                "recording `{}`, {MOCAP}: the base is turned by {turned:.2} rad, and the robot is taken to stand along the \
                 vertical axis; quaternions are x, y, z, w, in columns 3 to 6: are they in another order?",
                recording.name
            )));
        }
        let reference = Reference::new(recording, &poses)?;
        let motors = Motors::of(recording)?;
        let still = &motors.still;
        let (first, rows) = (motors.angles.first_row, still.len());
        let tracks = [&poses.platform[first..], &poses.ring[first..]];
        let noise = noise(still, tracks);
        let mut list = Vec::new();
        let mut series = motors.angles.present.clone();
        let mut row = 0;
        while row < rows {
            let end = (row..rows)
                .find(|r| still[*r] != still[row])
                .unwrap_or(rows);
            if still[row] {
                // the robot comes to rest a little after its motors
                let from = if row == 0 { 0 } else { row + 3 };
                let length = end.saturating_sub(from);
                if length >= 2 {
                    let block = BLOCK.min(length);
                    if length >= 3 * BLOCK {
                        list.push(mean(
                            &motors,
                            tracks,
                            from..from + block,
                            Phase::Stopped,
                            noise,
                        ));
                    }
                    let settled = mean(&motors, tracks, end - block..end, Phase::Settled, noise);
                    series[end - block..end].fill(settled.angles);
                    list.push(settled);
                }
            } else {
                for r in (row..end).step_by(STRIDE).skip(1) {
                    if r + 1 < rows && r > 0 {
                        let mut sample = mean(&motors, tracks, r..r + 1, Phase::Moving, noise);
                        for (b, track) in tracks.iter().enumerate() {
                            let dt = motors.angles.time[r + 1] - motors.angles.time[r - 1];
                            let (before, after) = (&track[r - 1], &track[r + 1]);
                            let apart = after.translation.vector - before.translation.vector;
                            let turn = after.rotation.angle_to(&before.rotation);
                            let time = CLOCK.hypot(INERTIA);
                            let more = [apart.norm() / dt * time, turn / dt * time];
                            sample.position_deviation[b] =
                                sample.position_deviation[b].hypot(more[0]);
                            sample.rotation_deviation[b] =
                                sample.rotation_deviation[b].hypot(more[1]);
                        }
                        list.push(sample);
                    }
                }
            }
            row = end;
        }
        Self::reduced(recording, &motors, series, list, (reference, noise))
    }

    /// Steady samples of a recording without motion capture. Those during which a motor turns are left out.
    fn published(recording: &Recording, steady: &SteadySamples) -> Result<Self, CompareError> {
        let motors = Motors::of(recording)?;
        let still = &motors.still;
        let around = |row: usize| {
            let row = row - motors.angles.first_row;
            row.saturating_sub(1)..(row + 2).min(still.len())
        };
        let settled =
            (0..steady.len()).filter(|i| still[around(steady.row[*i])].iter().all(|s| *s));
        let sample = |i: usize| Sample {
            time: steady.time[i],
            angles: steady.angles[i],
            motors: motors.readings(around(steady.row[i])),
            poses: [steady.platform[i], steady.ring[i]],
            phase: Phase::Settled,
            position_deviation: [PUBLISHED.0; 2],
            rotation_deviation: [PUBLISHED.1; 2],
        };
        let list = settled.map(sample).collect();
        let (series, reference) = (motors.angles.present.clone(), steady.reference.clone());
        Self::reduced(recording, &motors, series, list, (reference, PUBLISHED))
    }

    fn reduced(
        recording: &Recording,
        Motors { angles, still, .. }: &Motors,
        series: Vec<[f64; 4]>,
        mut list: Vec<Sample>,
        (reference, noise): (Reference, (f64, f64)),
    ) -> Result<Self, CompareError> {
        let travel: [f64; 4] = std::array::from_fn(|i| {
            let own = angles.present.iter().map(|a| a[i]);
            own.clone().fold(f64::MIN, f64::max) - own.fold(f64::MAX, f64::min)
        });
        let furthest = travel.iter().copied().fold(0.0, f64::max);
        if furthest < NO_TURN {
            let ticks = furthest / crate::recordings::RADIANS_PER_TICK;
            return Err(CompareError::Unfit(format!(
                "recording `{}`, present_positions_history.csv: the motors turn by no more than {ticks:.1} ticks, of which \
                 4096 are a turn, so it shows nothing of the robot; are its angles in other units? else take a recording in \
                 which they turn",
                recording.name
            )));
        }
        if list.iter().filter(|s| s.phase == Phase::Settled).count() < 3 {
            return Err(CompareError::Unfit(format!(
                "recording `{}` comes to rest fewer than three times in its {:.0} s; a diagnosis needs set-points that are \
                 held (times are in s, motor positions in ticks of which 4096 are a turn)",
                recording.name,
                angles.time[angles.time.len() - 1] - angles.time[0]
            )));
        }
        thin(&mut list, MOST);
        let lively = |row: &usize| {
            let recent = row.saturating_sub(RELAXING)..*row;
            let every = match still[*row] {
                false => ON_THE_WAY,
                true if still[recent].iter().all(|still| *still) => QUIET,
                true => 1,
            };
            row.is_multiple_of(every)
        };
        let passed = (0..still.len()).filter(lively);
        let passed = passed.map(|row| angles.time[row]).collect();
        let inputs = motor_inputs(&angles.time, &series).map_err(CompareError::Unfit)?;
        Ok(Self {
            name: recording.name.clone(),
            list,
            inputs,
            passed,
            reference,
            rest: angles.time[0],
            noise,
            wider: [1.0; KINDS.len()],
            flipped: 0,
        })
    }
}

/// Leaves so many samples at most, evenly of each phase, since phases alternate.
fn thin(list: &mut Vec<Sample>, most: usize) {
    let every = list.len().div_ceil(most).max(1);
    let mut counts = [0; 3];
    list.retain(|sample| {
        let count = &mut counts[sample.phase as usize];
        *count += 1;
        (*count - 1_usize).is_multiple_of(every)
    });
}

fn mean(
    motors: &Motors,
    tracks: [&[Pose]; 2],
    rows: std::ops::Range<usize>,
    phase: Phase,
    noise: (f64, f64),
) -> Sample {
    let count = rows.len() as f64;
    let angles = std::array::from_fn(|i| {
        motors.angles.present[rows.clone()]
            .iter()
            .map(|a| a[i])
            .sum::<f64>()
            / count
    });
    let poses = tracks.map(|track| {
        let poses = &track[rows.clone()];
        let position = poses
            .iter()
            .map(|p| p.translation.vector)
            .sum::<Vector3<f64>>()
            / count;
        let first = poses[0].rotation;
        let turns = poses
            .iter()
            .map(|p| (p.rotation * first.inverse()).scaled_axis());
        let turn = turns.sum::<Vector3<f64>>() / count;
        Pose::from_parts(
            position.into(),
            nalgebra::UnitQuaternion::from_scaled_axis(turn) * first,
        )
    });
    Sample {
        time: motors.angles.time[rows.end - 1],
        angles,
        motors: motors.readings(rows.clone()),
        poses,
        phase,
        position_deviation: [noise.0 / count.sqrt(); 2],
        rotation_deviation: [noise.1 / count.sqrt(); 2],
    }
}

/// Deviations of a component from row to row where the motors rest, over the root of two.
fn noise(still: &[bool], tracks: [&[Pose]; 2]) -> (f64, f64) {
    let (mut shifts, mut turns) = (Vec::new(), Vec::new());
    for row in 4..still.len() {
        if still[row - 4..=row].iter().all(|s| *s) {
            for track in tracks {
                let (a, b) = (&track[row - 1], &track[row]);
                shifts.extend(
                    (b.translation.vector - a.translation.vector)
                        .iter()
                        .map(|x| x.abs()),
                );
                let turn = (b.rotation * a.rotation.inverse()).scaled_axis();
                turns.extend(turn.iter().map(|x| x.abs()));
            }
        }
    }
    (deviation(shifts, 5e-6), deviation(turns, 5e-5))
}

/// Standard deviation of a normal variable of which differences have these sizes, at `least`.
pub(super) fn deviation(mut sizes: Vec<f64>, least: f64) -> f64 {
    sizes.sort_by(f64::total_cmp);
    let middle = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    // the median of a normal variable's size is 0.6745 deviations
    (middle / 0.6745 / 2.0_f64.sqrt()).max(least)
}
