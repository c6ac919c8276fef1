//! Play between motor and rod.

use auxetica_engine::{Drive, NonNegative, Series, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// The play operator: what arrives follows what is given at a distance of at most `play`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Backlash {
    /// Half the width of the dead zone [rad]; it begins in its middle.
    play: NonNegative,
}

register!(
    dyn Drive: Backlash,
    example = "Backlash(play: 0.05)",
    source = "play operator (Krasnosel'skii and Pokrovskii 1989)",
);

impl Drive for Backlash {
    fn transmit(&self, given: &Series) -> Result<Series, String> {
        let mut at = given.values()[0];
        let values = given.values().iter().map(|v| {
            at = at.clamp(v - *self.play, v + *self.play);
            at
        });
        Series::new(given.times().to_vec(), values.collect())
    }
}
