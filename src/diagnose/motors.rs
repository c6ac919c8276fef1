//! How a recording's motors turn, and what they report.

use super::samples::{Reading, deviation};
use crate::compare::{CompareError, turns};
use crate::engine::scenario::Turn;
use crate::recordings::{MotorAngles, Recording};

/// Fewest rows that say anything.
const FEWEST: usize = 20;
/// Time that loads may be ahead of poses or behind them [s].
const LAG: f64 = 0.04;
/// Standard deviation of what is rounded to whole numbers.
const ROUNDED: f64 = 0.29;

/// Motors row by row.
pub(super) struct Motors {
    /// Their angles.
    pub(super) angles: MotorAngles,
    /// How they turn.
    turns: Vec<[Turn; 4]>,
    /// Whether they rest.
    pub(super) still: Vec<bool>,
    /// What they report as their loads.
    loads: Vec<[f64; 4]>,
    /// Standard deviation of a load from row to row where they rest.
    noise: f64,
}

impl Motors {
    /// Those of a recording.
    ///
    /// # Errors
    /// If it is too short.
    pub(super) fn of(recording: &Recording) -> Result<Self, CompareError> {
        let angles = MotorAngles::new(recording);
        let rows = angles.time.len();
        if rows < FEWEST {
            return Err(CompareError::Unfit(format!(
                "recording `{}` has {rows} rows with motor readings; a diagnosis needs at least {FEWEST}",
                recording.name
            )));
        }
        let turns = turns(&angles.time, &angles.present);
        let still: Vec<bool> = (turns.iter())
            .map(|motors| motors.iter().all(|motor| !motor.now))
            .collect();
        let loads = recording.loads[angles.first_row..][..rows].to_vec();
        let noise = noise(&loads, &still);
        Ok(Self {
            angles,
            turns,
            still,
            loads,
            noise,
        })
    }

    /// What they report in some rows, one after the other.
    pub(super) fn readings(&self, rows: std::ops::Range<usize>) -> [Reading; 4] {
        let (count, last) = (rows.len() as f64, rows.end - 1);
        std::array::from_fn(|i| {
            let turn = self.turns[last][i];
            let sum: f64 = self.loads[rows.clone()].iter().map(|load| load[i]).sum();
            // a load that grows is of a moment before or after
            let before = last.saturating_sub(1);
            let dt = (self.angles.time[last] - self.angles.time[before]).max(1e-6);
            let growth = (self.loads[last][i] - self.loads[before][i]) / dt;
            let late = if turn.now { LAG * growth } else { 0.0 };
            Reading {
                load: sum / count,
                deviation: (self.noise / count.sqrt()).hypot(late),
                turn,
            }
        })
    }
}

/// Deviation of loads from row to row where motors rest, over the root of two.
fn noise(loads: &[[f64; 4]], still: &[bool]) -> f64 {
    let resting = (1..loads.len()).filter(|row| still[row - 1] && still[*row]);
    let steps =
        resting.flat_map(|row| (0..4).map(move |i| (loads[row][i] - loads[row - 1][i]).abs()));
    deviation(steps.collect(), ROUNDED)
}
