//! Inputs written out in the scenario.

use auxetica_engine::{Actuation, Dwell, Inputs, Series, register};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Inputs by name, each piecewise linear in time and constant outside.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Channels {
    /// Points `(time [s], value)` of each input.
    channels: BTreeMap<String, Series>,
    /// Times [s] at which the sequence is at rest, where a steady run stops; by default the last time of all.
    #[serde(default)]
    dwells: Vec<f64>,
}

register!(
    dyn Actuation: Channels,
    example = r#"Channels(channels: {"motor_1": [(0, 0), (5, 3.14)]})"#,
    source = "Auxetica",
);

impl Actuation for Channels {
    fn inputs(&self) -> Result<Inputs, String> {
        let channels = self.channels.iter();
        Ok(Inputs::new(
            channels
                .map(|(name, s)| (name.clone(), s.clone()))
                .collect(),
        ))
    }

    fn dwells(&self) -> Vec<Dwell> {
        let last = || self.channels.values().map(|s| s.span().1).reduce(f64::max);
        let times = if self.dwells.is_empty() {
            last().into_iter().collect()
        } else {
            self.dwells.clone()
        };
        let unnamed = |time| Dwell {
            time,
            name: String::new(),
        };
        times.into_iter().map(unnamed).collect()
    }
}
