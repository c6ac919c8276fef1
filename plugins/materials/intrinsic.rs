//! Rods that are bent or twisted as made.

use auxetica_engine::{LawView, Moment, ReadBody, RodLaw, Vec3, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Gives single rods intrinsic curvatures and twist, in their material frames.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Intrinsic {
    /// Curvatures about `d1` and `d2`, and twist [rad/m].
    curvature: Vec3,
}

register!(
    dyn RodLaw: Intrinsic,
    example = "Intrinsic(curvature: (0.5, 0, 0))",
    source = "Gazzola et al. 2018, eq. 2.14: intrinsic strains",
);

impl RodLaw for Intrinsic {
    fn rest(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let curvature = Vector3::from(*self.curvature);
        for v in rod.cells() {
            rod.set_rest_kappa(v, curvature);
        }
    }
}
