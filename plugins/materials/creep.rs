//! A Prony branch.

use crate::branch;
use auxetica_engine::{Body, LawView, Moment, NonNegative, Positive, RodLaw, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// Adds a spring and a dashpot in series beside the rod's own elasticity: `share S (e - e_v)` with
/// `e_v' = (e - e_v) / time`, for all strains alike; backward Euler between the states that are reached.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Creep {
    /// Rigidity of the branch over that of the rod [-].
    share: NonNegative,
    /// Relaxation time [s].
    time: Positive,
}

register!(
    dyn RodLaw: Creep,
    example = "Creep(share: 0.2, time: 5)",
    source = "standard linear solid (Zener)",
);

impl Creep {
    fn viscous(&self, now: f64, was: f64, dt: f64) -> f64 {
        let part = dt / *self.time;
        (was + part * now) / (1.0 + part)
    }
}

impl RodLaw for Creep {
    fn rest(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    fn stress(&self, now: &Moment<'_>, rod: &mut LawView<'_>) {
        if let Some(dt) = branch::since(rod, now.time) {
            branch::add_loads(rod, |strain, was, _| {
                *self.share * (strain - self.viscous(strain, was, dt))
            });
        }
    }

    fn memory(&self, rod: &Body<'_>) -> usize {
        branch::size(rod)
    }

    fn remember(&self, now: &Moment<'_>, rod: &mut LawView<'_>) {
        let since = branch::since(rod, now.time);
        branch::update(rod, now.time, |strain, was, _| {
            since.map_or(strain, |dt| self.viscous(strain, was, dt))
        });
    }
}
