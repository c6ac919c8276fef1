//! Named inputs over time (motor angles, say) and the signals that plugins take them from.

use auxetica_config::{Finite, Positive, remedy};
use serde::{Deserialize, Serialize};

/// A piecewise-linear function of time, constant before its first and after its last point.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(try_from = "Vec<(f64, f64)>", into = "Vec<(f64, f64)>")]
#[schemars(with = "Vec<(f64, f64)>")]
pub struct Series {
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Series {
    /// A series through `(times[i], values[i])`; times \[s\] increase strictly and all numbers are finite.
    pub fn new(times: Vec<f64>, values: Vec<f64>) -> Result<Self, String> {
        if times.is_empty() || times.len() != values.len() {
            return Err(format!(
                "a series needs as many values as times, it has {} and {}; give at least one (time, value)",
                values.len(),
                times.len()
            ));
        }
        if let Some(bad) = times.iter().chain(&values).find(|v| !v.is_finite()) {
            return Err(format!("a series holds {bad}; give finite numbers"));
        }
        if let Some(i) = times.windows(2).position(|w| w[0] >= w[1]) {
            return Err(format!(
                "times of a series must increase, but {} s is followed by {} s; give each point a later time",
                times[i],
                times[i + 1]
            ));
        }
        Ok(Self { times, values })
    }

    /// Value at `time` \[s\].
    pub fn at(&self, time: f64) -> f64 {
        let after = self.times.partition_point(|t| *t <= time);
        if after == 0 {
            return self.values[0];
        }
        if after == self.times.len() {
            return self.values[after - 1];
        }
        let (t0, t1) = (self.times[after - 1], self.times[after]);
        let (v0, v1) = (self.values[after - 1], self.values[after]);
        v0 + (v1 - v0) * (time - t0) / (t1 - t0)
    }

    /// Times \[s\], increasing.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Values at these times.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// First and last time \[s\].
    pub fn span(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }
}

impl TryFrom<Vec<(f64, f64)>> for Series {
    type Error = String;

    fn try_from(points: Vec<(f64, f64)>) -> Result<Self, String> {
        let (times, values) = points.into_iter().unzip();
        Self::new(times, values)
    }
}

impl From<Series> for Vec<(f64, f64)> {
    fn from(series: Series) -> Self {
        series.times.into_iter().zip(series.values).collect()
    }
}

/// The inputs of a scenario by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    channels: Vec<(String, Series)>,
}

impl Inputs {
    /// Inputs of the given names.
    pub fn new(channels: Vec<(String, Series)>) -> Self {
        Self { channels }
    }

    /// Input `name`, if there is one.
    pub fn get(&self, name: &str) -> Option<&Series> {
        self.channels
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, series)| series)
    }

    /// Puts another series in the place of input `name`.
    pub fn replace(&mut self, name: &str, series: Series) {
        if let Some((_, old)) = self.channels.iter_mut().find(|(known, _)| known == name) {
            *old = series;
        }
    }

    /// Names in the order given.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.channels.iter().map(|(name, _)| name.as_str())
    }

    /// Every input with its name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Series)> {
        self.channels
            .iter()
            .map(|(name, series)| (name.as_str(), series))
    }
}

/// A number that may change with time.
#[derive(Clone, Debug, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Signal {
    /// Always the same.
    Constant(Finite),
    /// From 0 at time 0 linearly to `to`, reached after `over` \[s\] and kept.
    Ramp {
        /// Final value.
        to: Finite,
        /// Duration \[s\].
        over: Positive,
    },
    /// The input of this name (see the scenario's `inputs`).
    Input(String),
    /// Piecewise linear through `(time [s], value)`, constant outside.
    Table(Series),
}

impl Signal {
    /// Value at the present time. An input that isn't there counts as 0; [`Signal::check`] refuses it before.
    pub fn at(&self, now: &Moment<'_>) -> f64 {
        match self {
            Self::Constant(value) => (*value).into(),
            Self::Ramp { to, over } => {
                f64::from(*to) * (now.time / f64::from(*over)).clamp(0.0, 1.0)
            }
            Self::Input(name) => now.inputs.get(name).map_or(0.0, |s| s.at(now.time)),
            Self::Table(series) => series.at(now.time),
        }
    }

    /// What is wrong with the signal, in words.
    pub fn check(&self, inputs: &Inputs) -> Result<(), String> {
        match self {
            Self::Input(name) if inputs.get(name).is_none() => Err(format!(
                "there is no input `{name}`; {}",
                remedy(name, &inputs.names().collect::<Vec<_>>(), "inputs")
            )),
            _ => Ok(()),
        }
    }
}

/// The present: what hooks are told beside their body.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// Time \[s\].
    pub time: f64,
    /// The scenario's inputs.
    pub inputs: &'a Inputs,
}
