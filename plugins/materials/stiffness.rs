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
    /// Growth of shear and axial rigidities with the size of the twist [m/rad].
    #[serde(default)]
    stretch_per_twist: Option<Finite>,
    /// Growth of bending and twist rigidities with the size of the twist [m/rad].
    #[serde(default)]
    bend_per_twist: Option<Finite>,
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
        let stretch = or(self.stretch_per_twist, 0.0);
        let bend = or(self.bend_per_twist, 0.0);
        let gradient = or(self.gradient, 0.0);
        let n = rod.elements();
        let along = |at: f64| 1.0 + gradient * (at / n as f64 - 0.5);
        let twist_of = |rod: &LawView<'_>, e: usize| {
            let cells = [e, e + 1].into_iter().filter(|v| rod.cells().contains(v));
            let (sum, count) = cells.fold((0.0, 0), |(s, c), v| (s + rod.twist(v).abs(), c + 1));
            sum / f64::from(count.max(1))
        };
        for e in 0..n {
            let grown = 1.0 + stretch * twist_of(rod, e);
            let common = (along(e as f64 + 0.5) * grown).max(0.01);
            let factors = Vector3::new(shear, shear, axial).map(|f| f.max(0.01)) * common;
            rod.set_shear_stretch(e, rod.shear_stretch(e).component_mul(&factors));
        }
        for v in rod.cells() {
            let grown = 1.0 + bend * rod.twist(v).abs();
            let common = (along(v as f64) * grown).max(0.01);
            let factors = Vector3::new(bx, by, twist).map(|f| f.max(0.01)) * common;
            rod.set_bend_twist(v, rod.bend_twist(v).component_mul(&factors));
        }
    }
}
