//! Steady samples from the settled end of every dwell.

use std::ops::Range;

use crate::dwells::dwells;
use crate::median::{median, median_pose};
use crate::motors::angles_from;
use crate::{BasePoses, Error, Recording, Reference, RobotGeometry, SteadySamples};

/// When a dwell counts as settled, and which of its rows are taken.
#[derive(Debug, Clone, PartialEq)]
pub struct SettleRule {
    /// Fastest that any motor may turn, in the unit of [`Recording::velocities`].
    pub max_velocity: f64,
    /// Farthest that any motor may be from where it is in the dwell's last row (ticks).
    pub max_drift: f64,
    /// Rows to wait after the motors have stopped, for the robot to come to rest.
    pub wait: usize,
    /// Fewest settled rows that make a sample.
    pub min_rows: usize,
    /// Most settled rows that are taken: the last ones of the dwell.
    pub max_rows: usize,
}

impl Default for SettleRule {
    fn default() -> Self {
        Self {
            max_velocity: 2.0,
            max_drift: 3.0,
            wait: 2,
            min_rows: 3,
            max_rows: 8,
        }
    }
}

impl SettleRule {
    /// Takes a sample from every dwell that settles: the median of pose and angles over its last
    /// rows, so that a few frames with swapped markers do no harm. `time` and `row` are those of
    /// the last row taken.
    ///
    /// # Errors
    /// When the recording has no motion capture, or no row.
    pub fn samples(
        &self,
        recording: &Recording,
        geometry: &RobotGeometry,
    ) -> Result<SteadySamples, Error> {
        let poses = BasePoses::new(recording, geometry)?;
        let reference = Reference::new(recording, &poses)?;
        let poses = poses.from_rest(&reference);
        let zero = recording.present[recording.first_row()];
        let mut samples = SteadySamples {
            time: Vec::new(),
            row: Vec::new(),
            angles: Vec::new(),
            platform: Vec::new(),
            ring: Vec::new(),
            reference,
            skipped: 0,
        };
        for dwell in dwells(recording, recording.rows()) {
            let sample = self.settled_rows(recording, dwell).and_then(|rows| {
                let tick = |i: usize| median(recording.present[rows.clone()].iter().map(|t| t[i]));
                let ticks = [tick(0)?, tick(1)?, tick(2)?, tick(3)?];
                let platform = median_pose(&poses.platform[rows.clone()])?;
                let ring = median_pose(&poses.ring[rows.clone()])?;
                Some((rows.end - 1, ticks, platform, ring))
            });
            let Some((row, ticks, platform, ring)) = sample else {
                samples.skipped += 1;
                continue;
            };
            samples.time.push(recording.time[row]);
            samples.row.push(row);
            samples.angles.push(angles_from(&ticks, &zero));
            samples.platform.push(platform);
            samples.ring.push(ring);
        }
        Ok(samples)
    }

    /// The settled rows at the end of a dwell, or `None` if they are too few.
    fn settled_rows(&self, recording: &Recording, dwell: Range<usize>) -> Option<Range<usize>> {
        let last = dwell.end.checked_sub(1)?;
        let still = |row: usize| {
            (0..4).all(|i| {
                let drift = recording.present[row][i] - recording.present[last][i];
                drift.abs() <= self.max_drift
                    && recording.velocities[row][i].abs() <= self.max_velocity
            })
        };
        let still_rows = dwell.clone().rev().take_while(|&row| still(row)).count();
        let first = dwell.end - still_rows;
        // Motors that never moved during the dwell leave nothing to wait for.
        let wait = if first > dwell.start { self.wait } else { 0 };
        let settled = still_rows.saturating_sub(wait);
        (settled >= self.min_rows.max(1)).then(|| dwell.end - settled.min(self.max_rows)..dwell.end)
    }
}
