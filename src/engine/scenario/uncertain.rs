//! Numbers of a scenario that are known within a range only, for whoever identifies them.

use auxetica_config::{Finite, Positive, Source};
use serde::Deserialize;

/// A number of the scenario that measurements are to tell.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Uncertain {
    /// What reports call it.
    pub name: String,
    /// Where it stands in the scenario: `rods[0].material.bending`, or `laws[*].apply.factor` for one value at several
    /// places.
    pub path: String,
    /// Its unit, for reports.
    #[serde(default)]
    pub unit: String,
    /// Least and largest value.
    pub range: (Finite, Finite),
    /// Mean and standard deviation known beforehand, if any.
    #[serde(default)]
    pub prior: Option<(Finite, Positive)>,
}

impl Uncertain {
    /// The scenario's present value, or the field that is wrong and why.
    pub fn nominal(&self, source: &Source) -> Result<f64, (&'static str, String)> {
        let nominal = source.number(&self.path).map_err(|e| ("path", e))?;
        let (least, most) = (*self.range.0, *self.range.1);
        if least >= most {
            let message = format!(
                "the range ({least}, {most}) is empty or reversed; give the lesser end first"
            );
            return Err(("range", message));
        }
        if !(least..=most).contains(&nominal) {
            let message = format!(
                "the scenario's value {nominal} is outside the range ({least}, {most}); widen it or change the value"
            );
            return Err(("range", message));
        }
        Ok(nominal)
    }
}
