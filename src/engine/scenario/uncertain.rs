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
        match self.prior.map(|(mean, _)| *mean) {
            Some(mean) if !(least..=most).contains(&mean) => Err((
                "prior",
                format!(
                    "the prior's mean {mean} is outside the range ({least}, {most}); give both in the unit of the scenario's value"
                ),
            )),
            _ => self.check_unit().map(|()| nominal),
        }
    }

    /// Numbers of a scenario are in SI units, so a unit that the path contradicts means a wrong range.
    fn check_unit(&self) -> Result<(), (&'static str, String)> {
        let plain = |unit: &str| {
            unit.replace([' ', '^', '*', '\u{b7}'], "")
                .replace('\u{b2}', "2")
        };
        match unit(&self.path) {
            Some(unit) if !self.unit.is_empty() && plain(unit) != plain(&self.unit) => Err((
                "unit",
                format!(
                    "the unit `{}` contradicts the path: `{}` is in {unit}; mend the unit, and the range if it isn't in {unit}",
                    self.unit, self.path
                ),
            )),
            _ => Ok(()),
        }
    }
}

/// The unit of a number of a rod or rigid body, as far as its path says.
fn unit(path: &str) -> Option<&'static str> {
    let (list, rest) = path.split_once('[')?;
    let (_, field) = rest.split_once("].")?;
    // numbers of profiles and vectors are in the unit of the whole
    let field = field.split('[').next()?;
    Some(match (list, field) {
        ("rods", "length" | "radius" | "wall" | "at" | "caps.start" | "caps.tip")
        | ("cylinders", "centre" | "radius" | "thickness")
        | ("markers", "offset") => "m",
        ("rods" | "cylinders", "density") => "kg/m3",
        ("cylinders", "mass") => "kg",
        ("rods", "material.youngs") => "Pa",
        ("rods", "material.axial") => "N",
        ("rods", "material.bending" | "material.twist") => "N m2",
        _ => return None,
    })
}
