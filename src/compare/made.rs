//! A recording made by Auxetica itself, for when no real one is at hand.

use super::{CompareError, film};
use crate::config::Source;
use crate::recordings::{RADIANS_PER_TICK, Recording};
use std::path::Path;

/// Set-points of the elongation, each held.
const SETPOINTS: usize = 20;
/// Rows on the way to a set-point, and rows at rest there.
const ROWS: (usize, usize) = (3, 12);
/// Time between rows \[s\], as in the real recordings.
const ROW_TIME: f64 = 0.108;

/// Writes to `folder` (which must not exist) the recording of a robot of the scenario's kind that elongates from rest
/// to a half turn of all motors: steady states, without noise.
pub fn make_recording(source: &Source, folder: &Path) -> Result<(), CompareError> {
    let per_setpoint = ROWS.0 + ROWS.1;
    let rows = SETPOINTS * per_setpoint;
    let most = std::f64::consts::PI / RADIANS_PER_TICK;
    let ticks_at = |row: usize| {
        let (setpoint, within) = (row / per_setpoint, row % per_setpoint);
        let share = ((within + 1) as f64 / (ROWS.0 + 1) as f64).min(1.0);
        let from = setpoint.saturating_sub(1) as f64;
        (most * (from + share * (setpoint as f64 - from)) / (SETPOINTS - 1) as f64).round()
    };
    let signs = [1.0, -1.0, 1.0, -1.0];
    let time: Vec<f64> = (0..rows).map(|row| 1.0 + row as f64 * ROW_TIME).collect();
    let present: Vec<[f64; 4]> = (0..rows)
        .map(|row| signs.map(|s| s * ticks_at(row)))
        .collect();
    let angles: Vec<_> = present
        .iter()
        .map(|ticks| ticks.map(|t| t * RADIANS_PER_TICK))
        .collect();
    let goal = (0..rows).map(|row| present[row - row % per_setpoint + per_setpoint - 1]);
    let goal = goal.collect();
    let film = film(source, &time, &angles)?;
    let motors = (present, film.loads);
    let recording = Recording::simulated("made by Auxetica", time, goal, motors, &film.poses);
    Ok(recording.write(folder)?)
}
