//! Inputs that arrive late.

use auxetica_engine::{Drive, Finite, NonNegative, Series, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// A first-order lag: `time x' = given - x`, exact for inputs that are linear between their points.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lag {
    /// Time constant [s].
    time: NonNegative,
}

register!(
    dyn Drive: Lag,
    example = "Lag(time: 0.05)",
    source = "first-order transfer function",
);

/// A dead time: what is given at t arrives at t + `by`; negative if what is seen runs ahead.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Delay {
    /// Dead time [s].
    by: Finite,
}

register!(
    dyn Drive: Delay,
    example = "Delay(by: 0.03)",
    source = "dead time",
);

impl Drive for Lag {
    fn transmit(&self, given: &Series) -> Result<Series, String> {
        let (times, values) = (given.times(), given.values());
        let tau = *self.time;
        if tau == 0.0 {
            return Ok(given.clone());
        }
        let mut x = values[0];
        let mut arrived = vec![x];
        for k in 1..times.len() {
            let dt = times[k] - times[k - 1];
            let slope = (values[k] - values[k - 1]) / dt;
            // behind a ramp by tau times its slope once the start has decayed
            let behind = x - (values[k - 1] - tau * slope);
            x = values[k] - tau * slope + behind * (-dt / tau).exp();
            arrived.push(x);
        }
        Series::new(times.to_vec(), arrived)
    }
}

impl Drive for Delay {
    fn transmit(&self, given: &Series) -> Result<Series, String> {
        let times = given.times().iter().map(|t| t + f64::from(self.by));
        Series::new(times.collect(), given.values().to_vec())
    }
}
