//! When motors turn, and in which sense.

use crate::engine::scenario::Turn;
use crate::recordings::RADIANS_PER_TICK;

/// Ticks per second below which a motor rests.
const STILL: f64 = 30.0;

/// How each motor turns, row by row, by times \[s\] and angles \[rad\]. In the first row it does as in the second.
#[must_use]
pub fn turns(times: &[f64], angles: &[[f64; 4]]) -> Vec<[Turn; 4]> {
    let limit = STILL * RADIANS_PER_TICK;
    let mut last = [Turn::default(); 4];
    let turn = |row: usize| {
        let row = row.max(1).min(times.len() - 1);
        let before = row.saturating_sub(1);
        let dt = (times[row] - times[before]).abs().max(1e-6);
        for (i, turn) in last.iter_mut().enumerate() {
            let turned = angles[row][i] - angles[before][i];
            turn.now = turned.abs() / dt >= limit;
            if turn.now {
                turn.sense = turned.signum();
            }
        }
        last
    };
    (0..times.len()).map(turn).collect()
}
