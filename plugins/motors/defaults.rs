//! Defaults that the actuation sequences share.

use auxetica_engine::{NonNegative, Positive};

pub fn half_turn() -> Positive {
    Positive::new(179.9).expect("defaults are positive")
}
pub fn ramp() -> Positive {
    Positive::new(5.0).expect("defaults are positive")
}
pub fn hold() -> NonNegative {
    NonNegative::new(10.0).expect("defaults aren't negative")
}
pub fn motors() -> String {
    "motor_".into()
}
