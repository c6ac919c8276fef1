//! What motors report as their loads.

use auxetica_config::{Finite, NonNegative, Positive};
use serde::Deserialize;

/// What motors report as their loads: readings that grow with the torque that turns the rod.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotorLoads {
    /// Reading for a torque of 1 N m.
    pub gain: Positive,
    /// Each motor's gain over that.
    #[serde(default = "alike")]
    pub gains: [Positive; 4],
    /// Each motor's reading without a torque.
    #[serde(default = "none")]
    pub offsets: [Finite; 4],
    /// Torque of friction in motors and gears, against which they turn \[N m\].
    #[serde(default)]
    pub friction: NonNegative,
    /// Further friction over the torque that turns the rod.
    #[serde(default)]
    pub friction_of_torque: NonNegative,
    /// Share of all friction that stays when they have stopped.
    #[serde(default)]
    pub held: NonNegative,
}

/// How a motor turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turn {
    /// +1 or -1 as it turned last, 0 if it has not.
    pub sense: f64,
    /// Whether it turns now.
    pub now: bool,
}

fn alike() -> [Positive; 4] {
    [Positive::new(1.0).expect("one is positive"); 4]
}

fn none() -> [Finite; 4] {
    [Finite::new(0.0).expect("zero is finite"); 4]
}

impl MotorLoads {
    /// Reading of motor `i` that turns its rod with this torque \[N m\].
    pub fn reading(&self, i: usize, torque: f64, turn: Turn) -> f64 {
        let share = if turn.now { 1.0 } else { *self.held };
        let friction = *self.friction + *self.friction_of_torque * torque.abs();
        let all = torque + share * friction * turn.sense;
        *self.gain * *self.gains[i] * all + *self.offsets[i]
    }
}
