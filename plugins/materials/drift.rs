//! Properties that change as a run goes on.

use auxetica_engine::{Finite, LawView, Moment, Positive, ReadBody, RodLaw, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// Extension and rigidities that drift by a share of themselves, `1 + x (1 - exp(-t / time))`: a rod that warms.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drift {
    /// Final change of the extension [-].
    #[serde(default)]
    extension: Option<Finite>,
    /// Final change of all rigidities [-].
    #[serde(default)]
    stiffness: Option<Finite>,
    /// Time constant [s].
    time: Positive,
}

register!(
    dyn RodLaw: Drift,
    example = "Drift(stiffness: -0.1, time: 60)",
    source = "first-order warming",
);

impl RodLaw for Drift {
    fn rest(&self, now: &Moment<'_>, rod: &mut LawView<'_>) {
        let warm = 1.0 - (-now.time / *self.time).exp();
        let extension = self.extension.map_or(0.0, f64::from) * warm;
        let stiffness = (1.0 + self.stiffness.map_or(0.0, f64::from) * warm).max(0.01);
        for e in 0..rod.elements() {
            let change = (rod.rest_length(e) - rod.reference_length(e)) * extension;
            rod.set_rest_length(e, rod.rest_length(e) + change);
            rod.set_shear_stretch(e, rod.shear_stretch(e) * stiffness);
        }
        for v in rod.cells() {
            rod.set_bend_twist(v, rod.bend_twist(v) * stiffness);
        }
    }
}
