//! What is odd about a recording, without being wrong.

use std::fmt;

use nalgebra::UnitQuaternion;

use crate::median::{median, median_rotation};
use crate::{Body, Error, Pose, Recording, Track, to_base};

/// A gap is a step of time longer than this many median ones. The recorded robot pauses for
/// 0.26 s, 2.4 median steps, after every change of goal: that is no gap.
const GAP: f64 = 2.5;
/// Rows to either side of one that its orientation is compared with.
const FLIP_WINDOW: usize = 15;
/// How far an orientation may be from most of its neighbours (rad).
const FLIP_ANGLE: f64 = 1.0;
/// A jump is longer than this many median steps at rest, and longer than [`MIN_JUMP`].
const JUMP: f64 = 8.0;
/// Least jump that is reported (m).
const MIN_JUMP: f64 = 1e-4;

/// Oddities of a recording: reported, never mended.
#[derive(Debug, Clone, PartialEq)]
pub struct Audit {
    /// Name of the recording.
    pub recording: String,
    /// Number of rows.
    pub rows: usize,
    /// First row with real motor readings; rows before it hold zeros as place-holders.
    pub first_row: usize,
    /// From the first real row to the last (s).
    pub duration: f64,
    /// Median step of time (s).
    pub median_step: f64,
    /// Steps of time longer than 2.5 median ones.
    pub gaps: Vec<Gap>,
    /// Findings on base, platform and ring; empty without motion capture.
    pub bodies: Vec<BodyAudit>,
    /// Median orientation of the base along the base frame's axes, near identity. It is not
    /// removed from the poses. `None` without motion capture.
    pub base_rotation: Option<UnitQuaternion<f64>>,
}

/// A gap in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Row after the gap.
    pub row: usize,
    /// Length of the step (s).
    pub seconds: f64,
}

/// A leap of a body while the motors rest, as when markers are swapped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// Row after the leap.
    pub row: usize,
    /// Length of the leap (m).
    pub distance: f64,
}

/// Oddities of one body's motion capture.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyAudit {
    /// The body.
    pub body: Body,
    /// Rows that repeat the pose of the row before exactly: no new measurement.
    pub stale: Vec<usize>,
    /// Leaps while the motors rest, beyond 0.1 mm and eight times the median step at rest.
    pub jumps: Vec<Jump>,
    /// Rows whose orientation is more than 1 rad from most of those around it.
    pub flips: Vec<usize>,
    /// Changes of the quaternions' sign, removed on reading.
    pub sign_flips: usize,
}

impl Audit {
    /// Audits a recording.
    ///
    /// # Errors
    /// When the recording has fewer than two rows with real motor readings.
    pub fn new(recording: &Recording) -> Result<Self, Error> {
        let rows = recording.rows();
        let steps = |row: usize| recording.time[row] - recording.time[row - 1];
        let median_step =
            median((rows.start + 1..rows.end).map(steps)).ok_or_else(|| Error::Inconsistent {
                recording: recording.name.clone(),
                reason: "it has fewer than two rows".into(),
            })?;
        let gaps = (rows.start + 1..rows.end)
            .map(|row| Gap {
                row,
                seconds: steps(row),
            })
            .filter(|gap| gap.seconds > GAP * median_step)
            .collect();
        let resting: Vec<bool> = (0..recording.len())
            .map(|row| at_rest(recording, row))
            .collect();
        let bodies = recording.mocap.iter().flat_map(|mocap| {
            Body::ALL.map(|body| BodyAudit::new(body, mocap.track(body), &resting))
        });
        let base_rotation = (recording.mocap.as_ref())
            .and_then(|mocap| median_rotation(&mocap.base.rotation))
            .map(|rotation| to_base(&Pose::from_parts(Default::default(), rotation)).rotation);
        Ok(Self {
            recording: recording.name.clone(),
            rows: recording.len(),
            first_row: rows.start,
            duration: recording.time[rows.end - 1] - recording.time[rows.start],
            median_step,
            gaps,
            bodies: bodies.collect(),
            base_rotation,
        })
    }
}

/// Whether the motors rest in the three rows up to a row and in the one after it: the robot
/// comes to rest a little later than its motors, and motion capture may be a row ahead of them
/// where the goal changes.
fn at_rest(recording: &Recording, row: usize) -> bool {
    let still = |row: usize| {
        let turned = |i: usize| recording.present[row][i] - recording.present[row - 1][i];
        (0..4).all(|i| turned(i).abs() <= 1.0 && recording.velocities[row][i].abs() <= 1.0)
    };
    row >= recording.first_row() + 3
        && (row - 2..=row + 1)
            .take_while(|&row| row < recording.len())
            .all(still)
}

impl BodyAudit {
    fn new(body: Body, track: &Track, resting: &[bool]) -> Self {
        let rows = 1..track.position.len();
        let step = |row: usize| (track.position[row] - track.position[row - 1]).norm();
        let stale = |&row: &usize| {
            track.position[row] == track.position[row - 1]
                && track.rotation[row] == track.rotation[row - 1]
        };
        let at_rest = rows.clone().filter(|&row| resting[row]);
        let typical = median(at_rest.clone().map(step)).unwrap_or_default();
        let limit = (JUMP * typical).max(MIN_JUMP);
        Self {
            body,
            stale: rows.clone().filter(stale).collect(),
            jumps: at_rest
                .map(|row| Jump {
                    row,
                    distance: step(row),
                })
                .filter(|jump| jump.distance > limit)
                .collect(),
            flips: (0..rows.end).filter(|&row| flipped(track, row)).collect(),
            sign_flips: track.sign_flips,
        }
    }
}

/// Whether most orientations around a row are far from the one in it.
fn flipped(track: &Track, row: usize) -> bool {
    let last = track.rotation.len().min(row + FLIP_WINDOW + 1);
    let window = &track.rotation[row.saturating_sub(FLIP_WINDOW)..last];
    // |p . q| is the cosine of half the angle between two rotations.
    let near = (0.5 * FLIP_ANGLE).cos();
    let far = (window.iter())
        .filter(|other| other.coords.dot(&track.rotation[row].coords).abs() < near)
        .count();
    2 * far > window.len()
}

impl fmt::Display for Audit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{}: {} rows from row {} on, {:.1} s at {:.1} ms, {} gaps",
            self.recording,
            self.rows - self.first_row,
            self.first_row,
            self.duration,
            1e3 * self.median_step,
            self.gaps.len(),
        )?;
        for gap in &self.gaps {
            writeln!(f, "  gap of {:.3} s before row {}", gap.seconds, gap.row)?;
        }
        for body in &self.bodies {
            let longest = body.jumps.iter().map(|j| j.distance).fold(0.0, f64::max);
            writeln!(
                f,
                "  {}: {} stale frames, {} jumps at rest (up to {:.2} mm), {} flipped frames, \
                 {} sign changes",
                body.body,
                body.stale.len(),
                body.jumps.len(),
                1e3 * longest,
                body.flips.len(),
                body.sign_flips,
            )?;
        }
        match &self.base_rotation {
            Some(rotation) => write!(
                f,
                "  base turned by {:.2} mrad in the median",
                1e3 * rotation.angle()
            ),
            None => write!(f, "  no motion capture"),
        }
    }
}
