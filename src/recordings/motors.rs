//! Motor angles.

use std::f64::consts::PI;

use crate::Recording;

/// One tick of a motor's encoder (rad); a turn has 4096.
pub const RADIANS_PER_TICK: f64 = PI / 2048.0;

/// Angles of the motors over time; motor `i` drives rod `i`.
///
/// The signs are those of the data: a growing angle winds the right-handed rods 1 and 3, a
/// falling one the left-handed rods 2 and 4.
#[derive(Debug, Clone, PartialEq)]
pub struct MotorAngles {
    /// Row of the recording that the series begin with: its first with real motor readings.
    pub first_row: usize,
    /// Time (s).
    pub time: Vec<f64>,
    /// Angles that the motors had (rad), zero in the first row. Drive simulations with these.
    pub present: Vec<[f64; 4]>,
    /// Angles that the motors were told to take (rad), from the same zero. Under load the motors
    /// stay up to 0.06 rad behind.
    pub goal: Vec<[f64; 4]>,
}

impl MotorAngles {
    /// The angles of a recording, from its first row with real motor readings on.
    #[must_use]
    pub fn new(recording: &Recording) -> Self {
        let rows = recording.rows();
        let zero = recording.present.get(rows.start).copied();
        let angles = |ticks: &[[f64; 4]]| {
            (ticks.iter())
                .map(|ticks| angles_from(ticks, &zero.unwrap_or_default()))
                .collect()
        };
        Self {
            first_row: rows.start,
            time: recording.time[rows.clone()].to_vec(),
            present: angles(&recording.present[rows.clone()]),
            goal: angles(&recording.goal[rows]),
        }
    }
}

/// Angles (rad) of motors at `ticks`, counted from `zero`.
pub(crate) fn angles_from(ticks: &[f64; 4], zero: &[f64; 4]) -> [f64; 4] {
    std::array::from_fn(|i| (ticks[i] - zero[i]) * RADIANS_PER_TICK)
}
