//! Rate-independent hysteresis.

use crate::branch;
use auxetica_engine::{Body, LawView, Moment, NonNegative, Positive, RodLaw, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// Adds an elastic, perfectly plastic branch beside the rod's own elasticity: `share S (e - z)`, where z follows e at a
/// distance of at most the yield strain (the play operator), for all strains alike.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hysteresis {
    /// Rigidity of the branch over that of the rod [-].
    share: NonNegative,
    /// Shear or axial strain at which the branch yields [-].
    strain: Positive,
    /// Curvature or twist at which the branch yields [rad/m].
    curvature: Positive,
}

register!(
    dyn RodLaw: Hysteresis,
    example = "Hysteresis(share: 0.2, strain: 0.05, curvature: 5)",
    source = "Prandtl's body; play operator",
);

impl Hysteresis {
    fn follow(&self, strain: f64, was: f64, is_curvature: bool) -> f64 {
        let width = if is_curvature {
            *self.curvature
        } else {
            *self.strain
        };
        was.clamp(strain - width, strain + width)
    }
}

impl RodLaw for Hysteresis {
    fn rest(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    fn stress(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        branch::add_loads(rod, |strain, was, is_curvature| {
            *self.share * (strain - self.follow(strain, was, is_curvature))
        });
    }

    fn memory(&self, rod: &Body<'_>) -> usize {
        branch::size(rod)
    }

    fn remember(&self, now: &Moment<'_>, rod: &mut LawView<'_>) {
        branch::update(rod, now.time, |strain, was, is_curvature| {
            self.follow(strain, was, is_curvature)
        });
    }
}
