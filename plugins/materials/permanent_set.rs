//! Rods that stay longer than they were.

use auxetica_engine::{Body, Finite, LawView, Moment, ReadBody, RodLaw, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// Adds to the rest length of every element a share of the largest extension that it has had so far.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PermanentSet {
    /// Share of the largest extension that stays [-].
    share: Finite,
}

register!(
    dyn RodLaw: PermanentSet,
    example = "PermanentSet(share: 0.03)",
    source = "plastic set in proportion to the largest strain",
);

impl PermanentSet {
    fn extension(&self, rod: &LawView<'_>, e: usize) -> f64 {
        rod.rest_length(e) / rod.reference_length(e) - 1.0 - f64::from(self.share) * rod.memory()[e]
    }
}

impl RodLaw for PermanentSet {
    fn rest(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        for e in 0..rod.elements() {
            let more = f64::from(self.share) * rod.memory()[e] * rod.reference_length(e);
            rod.set_rest_length(e, rod.rest_length(e) + more);
        }
    }

    fn memory(&self, rod: &Body<'_>) -> usize {
        rod.elements()
    }

    fn remember(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        for e in 0..rod.elements() {
            let extension = self.extension(rod, e);
            let largest = &mut rod.memory_mut()[e];
            *largest = largest.max(extension);
        }
    }
}
