//! Strains that load each other.

use auxetica_engine::{Finite, LawView, Moment, ReadBody, RodLaw, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Linear coupling with the energy `stretch_twist e k_z + bend_shear (s_x k_x + s_y k_y)` per length: e is the axial
/// strain, s the shear strains, k curvatures and twist. Both are chiral.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coupling {
    /// Between stretch and twist [N m].
    #[serde(default)]
    stretch_twist: Option<Finite>,
    /// Between bending and shear about the same axis [N m].
    #[serde(default)]
    bend_shear: Option<Finite>,
}

register!(
    dyn RodLaw: Coupling,
    example = "Coupling(stretch_twist: 0.05)",
    source = "the linear constitutive law of a chiral rod",
);

impl RodLaw for Coupling {
    fn rest(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    fn stress(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let or = |x: Option<Finite>| x.map_or(0.0, f64::from);
        let (bend, stretch) = (or(self.bend_shear), or(self.stretch_twist));
        let constants = Vector3::new(bend, bend, stretch);
        let n = rod.elements();
        for e in 0..n {
            let cells = [e, e + 1].into_iter().filter(|v| rod.cells().contains(v));
            let sum = cells.fold(Vector3::zeros(), |sum, v| sum + rod.kappa(v) / 2.0);
            rod.add_stress(e, constants.component_mul(&sum));
        }
        for v in rod.cells() {
            let beside = [v.checked_sub(1), (v < n).then_some(v)];
            let sum = beside.into_iter().flatten();
            let sum = sum.fold(Vector3::zeros(), |sum, e| sum + rod.sigma(e) / 2.0);
            rod.add_couple(v, constants.component_mul(&sum));
        }
    }
}
