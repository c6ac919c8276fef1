//! Viscosity beside elasticity.

use crate::branch;
use auxetica_engine::{Body, LawView, Moment, NonNegative, RodLaw, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// Adds `time S e'` to the stress of every strain e, with backward differences between the states that are reached.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KelvinVoigt {
    /// Retardation time, viscosity over rigidity [s].
    time: NonNegative,
}

register!(
    dyn RodLaw: KelvinVoigt,
    example = "KelvinVoigt(time: 0.05)",
    source = "Kelvin-Voigt solid",
);

impl RodLaw for KelvinVoigt {
    fn rest(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    fn stress(&self, now: &Moment<'_>, rod: &mut LawView<'_>) {
        if let Some(dt) = branch::since(rod, now.time).filter(|dt| *dt > 0.0) {
            branch::add_loads(rod, |strain, was, _| *self.time * (strain - was) / dt);
        }
    }

    fn memory(&self, rod: &Body<'_>) -> usize {
        branch::size(rod)
    }

    fn remember(&self, now: &Moment<'_>, rod: &mut LawView<'_>) {
        branch::update(rod, now.time, |strain, _, _| strain);
    }
}
