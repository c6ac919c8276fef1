//! An angle that is read wrongly.

use auxetica_engine::{Drive, Finite, Series, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// What arrives is `scale` times what is given, plus `zero`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gear {
    /// Factor [-].
    #[serde(default)]
    scale: Option<Finite>,
    /// Offset, in the unit of the input [rad].
    #[serde(default)]
    zero: Option<Finite>,
}

register!(
    dyn Drive: Gear,
    example = "Gear(scale: 0.98, zero: 0.05)",
    source = "linear calibration",
);

impl Drive for Gear {
    fn transmit(&self, given: &Series) -> Result<Series, String> {
        let (scale, zero) = (
            self.scale.map_or(1.0, f64::from),
            self.zero.map_or(0.0, f64::from),
        );
        let values = given.values().iter().map(|v| scale * v + zero);
        Series::new(given.times().to_vec(), values.collect())
    }
}
