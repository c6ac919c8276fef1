//! What a challenge is made of.

use crate::config::{NonNegative, Positive};
use serde::Deserialize;

/// A challenge, as a RON file says it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spec {
    /// The nominal scenario, from the file's folder; its `uncertain` numbers differ from case to case as their priors say.
    pub scenario: String,
    /// Seed of all draws.
    pub seed: u64,
    /// Cases that conceal nothing.
    pub controls: usize,
    /// Cases with one effect of the library.
    pub singles: usize,
    /// Cases with two.
    pub doubles: usize,
    /// Cases with one of `foreign`.
    pub foreigners: usize,
    /// Path of the number of elements, and its least and largest value.
    pub mesh: (String, usize, usize),
    /// Strength of effects over their typical one: least and largest.
    pub strength: (Positive, Positive),
    /// Set-points of a recording.
    pub set_points: usize,
    /// Largest angle that a rod is wound to \[rad\].
    pub angle: Positive,
    /// Speed of the motors \[rad/s\].
    pub speed: Positive,
    /// Time that a set-point is held \[s\].
    pub hold: Positive,
    /// Rows in a second \[Hz\].
    pub rate: Positive,
    /// Deviations of a row's position \[m\] and rotation \[rad\].
    pub noise: (NonNegative, NonNegative),
    /// Deviations of what is wrong throughout a recording, alike.
    pub bias: (NonNegative, NonNegative),
    /// Deviation of a row's time \[s\].
    pub jitter: NonNegative,
    /// Effects that are in no library.
    #[serde(default)]
    pub foreign: Vec<Foreign>,
}

/// A change of the scenario that no registered effect makes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Foreign {
    /// What it is.
    pub words: String,
    /// List of the scenario that it adds to.
    pub list: String,
    /// What it adds; `{0}` stands for the value.
    pub entry: String,
    /// Least and largest value.
    pub range: (f64, f64),
}
