//! Stresses and couples that don't grow in proportion to strain.

use auxetica_engine::{Finite, LawView, Moment, ReadBody, RodLaw, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Adds to stretch `S (quadratic e^2 + cubic e^3)`, in compression `S (compression - 1) e`, and to bending
/// `B bending |k|^2 k`, with the present rigidities S, B, the axial strain e and the curvature k.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nonlinear {
    /// Quadratic axial coefficient [-].
    #[serde(default)]
    quadratic: Option<Finite>,
    /// Cubic axial coefficient [-].
    #[serde(default)]
    cubic: Option<Finite>,
    /// Axial rigidity in compression over that in tension [-].
    #[serde(default)]
    compression: Option<Finite>,
    /// Coefficient of cubic bending [m2/rad2].
    #[serde(default)]
    bending: Option<Finite>,
}

register!(
    dyn RodLaw: Nonlinear,
    example = "Nonlinear(cubic: 2.0, bending: 1e-3)",
    source = "the second and third terms of a constitutive law's series",
);

impl RodLaw for Nonlinear {
    fn rest(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    fn stress(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let or = |x: Option<Finite>, default: f64| x.map_or(default, f64::from);
        let (quadratic, cubic) = (or(self.quadratic, 0.0), or(self.cubic, 0.0));
        let softer = or(self.compression, 1.0) - 1.0;
        for e in 0..rod.elements() {
            let strain = rod.sigma(e).z;
            let below = strain.min(0.0);
            let more = quadratic * strain * strain + cubic * strain.powi(3) + softer * below;
            rod.add_stress(e, Vector3::z() * (rod.shear_stretch(e).z * more));
        }
        let bending = or(self.bending, 0.0);
        if bending != 0.0 {
            for v in rod.cells() {
                let curvature = Vector3::new(1.0, 1.0, 0.0).component_mul(&rod.kappa(v));
                let couple = curvature * (bending * curvature.norm_squared());
                rod.add_couple(v, rod.bend_twist(v).component_mul(&couple));
            }
        }
    }
}
