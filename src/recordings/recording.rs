//! A recording in memory.

use std::ops::Range;
use std::path::Path;

use crate::files;
use crate::mocap;
use crate::table::Table;
use crate::{Body, Error, Track};

/// How far a motor may have moved between the first two rows (ticks); see [`Recording::first_row`].
const MAX_FIRST_STEP: f64 = 256.0;

/// A recording of the four-rod robot: motor readings and, mostly, motion capture.
///
/// All series have one entry a row, `n` in all.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Name of the recording: that of its folder.
    pub name: String,
    /// Time of every row (s).
    pub time: Vec<f64>,
    /// Goal of every motor (ticks, 4096 a turn).
    pub goal: Vec<[f64; 4]>,
    /// Position of every motor (ticks, 4096 a turn).
    pub present: Vec<[f64; 4]>,
    /// Velocity of every motor, in the motors' unit of about 0.229 turns a minute.
    pub velocities: Vec<[f64; 4]>,
    /// Load of every motor, in the motors' unit, as recorded.
    pub loads: Vec<[f64; 4]>,
    /// Poses by motion capture, if any.
    pub mocap: Option<Mocap>,
}

/// World poses of the bodies that motion capture follows.
#[derive(Debug, Clone, PartialEq)]
pub struct Mocap {
    /// Plate that carries the motors.
    pub base: Track,
    /// Plate that joins the tips of the rods.
    pub platform: Track,
    /// Ring at mid-height of the third rod.
    pub ring: Track,
}

impl Mocap {
    /// The track of a body.
    #[must_use]
    pub fn track(&self, body: Body) -> &Track {
        match body {
            Body::Base => &self.base,
            Body::Platform => &self.platform,
            Body::Ring => &self.ring,
        }
    }
}

impl Recording {
    /// Reads the recording in `folder`. The motion-capture file may be absent, all others may not.
    ///
    /// # Errors
    /// When a file is missing, unreadable, cut off, of another shape than the others, or holds
    /// anything but the finite numbers expected; see [`Error`].
    pub fn read(folder: impl AsRef<Path>) -> Result<Self, Error> {
        let folder = folder.as_ref();
        if !folder.is_dir() {
            return Err(Error::MissingFolder {
                path: folder.into(),
            });
        }
        let time = read_time(folder)?;
        let motors = |file| Table::<4>::read(folder, file)?.expect_rows(time.len());
        Ok(Self {
            name: folder
                .file_name()
                .unwrap_or(folder.as_os_str())
                .to_string_lossy()
                .into_owned(),
            goal: motors(&files::GOAL)?,
            present: motors(&files::PRESENT)?,
            velocities: motors(&files::VELOCITIES)?,
            loads: motors(&files::LOADS)?,
            mocap: if folder.join(files::MOCAP.name).exists() {
                Some(mocap::read(folder, time.len())?)
            } else {
                None
            },
            time,
        })
    }

    /// Checks a recording made in memory: at least one row, series of equal length, finite
    /// numbers, increasing time. One that was read has passed already; everything that takes a
    /// recording relies on it, and may panic on one that does not pass.
    ///
    /// # Errors
    /// When it is not so.
    pub fn check(&self) -> Result<(), Error> {
        let fault = |reason: &str| {
            Err(Error::Inconsistent {
                recording: self.name.clone(),
                reason: reason.into(),
            })
        };
        let series = [&self.goal, &self.present, &self.velocities, &self.loads];
        let tracks: Vec<_> = (self.mocap.iter())
            .flat_map(|mocap| Body::ALL.map(|body| mocap.track(body)))
            .collect();
        let mut lengths = (series.iter().map(|series| series.len()))
            .chain((tracks.iter()).flat_map(|track| [track.position.len(), track.rotation.len()]));
        if self.time.is_empty() {
            return fault("it has no row");
        }
        if lengths.any(|length| length != self.len()) {
            return fault("its series are not of equal length");
        }
        let mut numbers = (self.time.iter())
            .chain(series.into_iter().flatten().flatten())
            .chain((tracks.iter()).flat_map(|track| track.position.iter().flatten()))
            .chain((tracks.iter()).flat_map(|track| track.rotation.iter().flat_map(|q| &q.coords)));
        if !numbers.all(|number| number.is_finite()) {
            return fault("it holds a number that is not finite");
        }
        if !self.time.is_sorted_by(|a, b| a < b) {
            return fault("its time does not increase from row to row");
        }
        Ok(())
    }

    /// Number of rows, the first one included even if its motor readings are not real.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no row at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// First row with real motor readings: 1 if the motors had not answered yet in row 0, else 0.
    ///
    /// The recorded robot's first row reads zero for every motor, as a place-holder. It is told
    /// from motors that do start at zero by the leap that follows.
    #[must_use]
    pub fn first_row(&self) -> usize {
        let silent = [&self.present, &self.velocities, &self.loads]
            .iter()
            .all(|series| series.first() == Some(&[0.0; 4]));
        let leaps = (self.present.get(1))
            .is_some_and(|ticks| ticks.iter().any(|tick| tick.abs() > MAX_FIRST_STEP));
        usize::from(silent && leaps)
    }

    /// Rows with real motor readings.
    #[must_use]
    pub fn rows(&self) -> Range<usize> {
        self.first_row()..self.len()
    }

    /// The motion capture.
    ///
    /// # Errors
    /// When there is none.
    pub fn require_mocap(&self) -> Result<&Mocap, Error> {
        self.mocap.as_ref().ok_or_else(|| Error::NoMocap {
            recording: self.name.clone(),
        })
    }
}

fn read_time(folder: &Path) -> Result<Vec<f64>, Error> {
    let table = Table::<1>::read(folder, &files::TIME)?;
    let time: Vec<f64> = table.rows.iter().map(|&[time]| time).collect();
    for (index, pair) in time.windows(2).enumerate() {
        if pair[1] <= pair[0] {
            return Err(Error::TimeNotIncreasing {
                line: table.lines[index + 1],
                path: table.path,
                previous: pair[0],
                found: pair[1],
            });
        }
    }
    Ok(time)
}
