//! What a challenge is made of.

use super::ChallengeError;
use crate::config::{NonNegative, Positive, Source};
use serde::Deserialize;
use std::path::Path;

/// A challenge, as a RON file says it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spec {
    /// The nominal scenario, from the file's folder.
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
    /// Effects that are concealed; all if empty.
    #[serde(default)]
    pub effects: Vec<String>,
    /// Effects that are in no library.
    #[serde(default)]
    pub foreign: Vec<Foreign>,
    /// What an effect is concealed in.
    pub recordings: Recorded,
}

/// Recordings that effects are concealed in.
#[derive(Clone, Debug, Deserialize)]
pub enum Recorded {
    /// Simulated, the scenario's uncertain numbers differing from case to case as their priors say.
    Simulated(Tours),
    /// Real ones, with every pose moved by what the effects change in the nominal scenario.
    Real(Onto),
}

/// Two simulated recordings to train on, two to judge by.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tours {
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
}

/// Real recordings: folders in `recordings/` of the data, or elsewhere.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Onto {
    /// Those to train on.
    pub train: Vec<String>,
    /// Those to judge by.
    pub holdout: Vec<String>,
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

impl Spec {
    /// Reads a specification; returns its scenario, too.
    ///
    /// # Errors
    /// If it can't be read, or its scenario can't.
    pub fn load(file: &Path) -> Result<(Self, Source), ChallengeError> {
        let text = std::fs::read_to_string(file).map_err(|e| ChallengeError::file(file, e))?;
        let spec: Self = crate::config::options().from_str(&text).map_err(|e| {
            ChallengeError::Unfit(format!("{}:{}: {}", file.display(), e.span, e.code))
        })?;
        if let Some(e) = spec.wrong() {
            let file = file.display();
            return Err(ChallengeError::Unfit(format!("{file}: {e}")));
        }
        let folder = file.parent().unwrap_or(Path::new("."));
        let source = Source::load(&folder.join(&spec.scenario), &[])?;
        Ok((spec, source))
    }

    /// What makes no sense, in words.
    fn wrong(&self) -> Option<String> {
        let (mesh, strength) = (&self.mesh, (*self.strength.0, *self.strength.1));
        let reversed = |field: &str, least: f64, most: f64| {
            let wrong = least > most || !least.is_finite() || !most.is_finite();
            wrong.then(|| format!("`{field}` goes from {least} to {most}; give the least first"))
        };
        let foreign =
            |f: &Foreign| reversed(&format!("range of `{}`", f.words), f.range.0, f.range.1);
        reversed("mesh", mesh.1 as f64, mesh.2 as f64)
            .or_else(|| reversed("strength", strength.0, strength.1))
            .or_else(|| self.foreign.iter().find_map(foreign))
            .or_else(|| self.recordings.wrong())
    }
}

impl Recorded {
    fn wrong(&self) -> Option<String> {
        match self {
            Self::Simulated(tours) if tours.set_points < 3 => Some(
                "`set_points` is less than 3, which no diagnosis takes; give more".into(),
            ),
            Self::Real(Onto { train, holdout }) if train.len() < 2 || holdout.is_empty() => Some(
                "`train` names less than two recordings, or `holdout` none; a diagnosis takes as many".into(),
            ),
            _ => None,
        }
    }
}
