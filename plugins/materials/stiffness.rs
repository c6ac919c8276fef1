//! Rigidities that differ from those of the scenario.

use auxetica_engine::{Finite, LawView, Moment, ReadBody, RodLaw, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Multiplies the rigidities that the laws before have left, by constants, with the twist and along the rod. No factor
/// falls below a hundredth.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stiffness {
    /// Factor of both shear rigidities [-].
    #[serde(default)]
    shear: Option<Finite>,
    /// Factor of the axial rigidity [-].
    #[serde(default)]
    axial: Option<Finite>,
    /// Factors of the bending rigidities about `d1` and `d2` [-].
    #[serde(default)]
    bending: Option<(Finite, Finite)>,
    /// Factor of the twist rigidity [-].
    #[serde(default)]
    twist: Option<Finite>,
    /// Growth of both shear rigidities with the size of the twist [m/rad].
    #[serde(default)]
    shear_per_twist: Option<Finite>,
    /// Growth of the axial rigidity with the size of the twist [m/rad].
    #[serde(default)]
    axial_per_twist: Option<Finite>,
    /// Growth of both bending rigidities with the size of the twist [m/rad].
    #[serde(default)]
    bending_per_twist: Option<Finite>,
    /// Growth of the twist rigidity with the size of the twist [m/rad].
    #[serde(default)]
    twist_per_twist: Option<Finite>,
    /// Change of all rigidities from start to tip, as a share of their mean [-].
    #[serde(default)]
    gradient: Option<Finite>,
}

register!(
    dyn RodLaw: Stiffness,
    example = "Stiffness(axial: 1.1, bending: (0.9, 1.1))",
    source = "Stölzle et al. 2023, eq. 5, and rods that are not made alike",
);

impl RodLaw for Stiffness {
    fn rest(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let or = |x: Option<Finite>, default: f64| x.map_or(default, f64::from);
        let (shear, axial) = (or(self.shear, 1.0), or(self.axial, 1.0));
        let (bx, by) = self
            .bending
            .map_or((1.0, 1.0), |(x, y)| (x.into(), y.into()));
        let twist = or(self.twist, 1.0);
        let growth = |of: [Option<Finite>; 2]| of.map(|slope| or(slope, 0.0));
        let stretch = growth([self.shear_per_twist, self.axial_per_twist]);
        let bend = growth([self.bending_per_twist, self.twist_per_twist]);
        let gradient = or(self.gradient, 0.0);
        let n = rod.elements();
        let along = |at: f64| 1.0 + gradient * (at / n as f64 - 0.5);
        let twist_of = |rod: &LawView<'_>, e: usize| {
            let cells = [e, e + 1].into_iter().filter(|v| rod.cells().contains(v));
            let (sum, count) = cells.fold((0.0, 0), |(s, c), v| (s + rod.twist(v).abs(), c + 1));
            sum / f64::from(count.max(1))
        };
        for e in 0..n {
            let size = twist_of(rod, e);
            let [across, axially] = stretch.map(|slope| 1.0 + slope * size);
            let factors = Vector3::new(shear * across, shear * across, axial * axially);
            let factors = factors.map(|f| (f * along(e as f64 + 0.5)).max(0.01));
            rod.set_shear_stretch(e, rod.shear_stretch(e).component_mul(&factors));
        }
        for v in rod.cells() {
            let size = rod.twist(v).abs();
            let [across, about] = bend.map(|slope| 1.0 + slope * size);
            let factors = Vector3::new(bx * across, by * across, twist * about);
            let factors = factors.map(|f| (f * along(v as f64)).max(0.01));
            rod.set_bend_twist(v, rod.bend_twist(v).component_mul(&factors));
        }
    }
}
