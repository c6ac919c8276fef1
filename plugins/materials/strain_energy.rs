//! Laws that a sum of monomials in the strains says.

use auxetica_engine::{Finite, LawView, Moment, ReadBody, RodLaw, Setting, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Largest power of a strain.
const HIGHEST: u8 = 8;

/// A monomial `c s^a e^b k^p t^q` of the energy: s is the size of the shear, e the elongation beyond the rest length,
/// k the size of the curvature, t the twist about `d3`. Powers that are left out are 0.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Term {
    /// The coefficient c [N (m/rad)^(p + q)].
    coefficient: Finite,
    /// Power a of the shear, even: no direction of the section is special.
    #[serde(default)]
    shear: u8,
    /// Power b of the elongation.
    #[serde(default)]
    elongation: u8,
    /// Power p of the curvature, even.
    #[serde(default)]
    curvature: u8,
    /// Power q of the twist; for rods that are wound the other way odd powers take the other sign.
    #[serde(default)]
    twist: u8,
}

/// Adds to stress and couple the derivatives `dW/dsigma` and `dW/dkappa` of an energy per rest length [J/m], which is a sum
/// of monomials in the strains. Terms of shear and elongation alone are taken element by element, others cell by cell, with
/// the mean shear and elongation of the elements beside. Like the linear law, it knows no work on rest lengths that follow
/// the twist.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrainEnergy {
    /// The sum.
    terms: Vec<Term>,
}

register!(
    dyn RodLaw: StrainEnergy,
    example = "StrainEnergy(terms: [(coefficient: 1e-3, elongation: 1, twist: 2)])",
    source = "hyperelastic rod; objective and isotropic about its axis",
);

/// `x^n`, and its derivative by x.
fn power(x: f64, n: u8) -> (f64, f64) {
    match n {
        0 => (1.0, 0.0),
        _ => {
            let lower = x.powi(i32::from(n) - 1);
            (lower * x, f64::from(n) * lower)
        }
    }
}

/// `|v|^n` of an even n, and its derivative by v over v.
fn even_power(v: [f64; 2], n: u8) -> (f64, f64) {
    let (value, slope) = power(v[0] * v[0] + v[1] * v[1], n / 2);
    (value, 2.0 * slope)
}

impl Term {
    fn is_of_elements(&self) -> bool {
        self.curvature == 0 && self.twist == 0
    }

    /// Derivatives of the energy by the strains of an element and by those of a cell.
    fn derivatives(&self, sigma: Vector3<f64>, kappa: Vector3<f64>) -> [Vector3<f64>; 2] {
        let (s, s_slope) = even_power([sigma.x, sigma.y], self.shear);
        let (e, e_slope) = power(sigma.z, self.elongation);
        let (k, k_slope) = even_power([kappa.x, kappa.y], self.curvature);
        let (t, t_slope) = power(kappa.z, self.twist);
        let c = *self.coefficient;
        let across = c * s_slope * e * k * t;
        let bending = c * s * e * k_slope * t;
        [
            Vector3::new(across * sigma.x, across * sigma.y, c * s * e_slope * k * t),
            Vector3::new(
                bending * kappa.x,
                bending * kappa.y,
                c * s * e * k * t_slope,
            ),
        ]
    }
}

impl RodLaw for StrainEnergy {
    fn rest(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    fn stress(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let n = rod.elements();
        let of = |elements: bool| {
            let terms = self.terms.iter();
            terms.filter(move |term| term.is_of_elements() == elements)
        };
        for e in 0..n {
            let sigma = rod.sigma(e);
            for term in of(true) {
                let [stress, _] = term.derivatives(sigma, Vector3::zeros());
                rod.add_stress(e, stress);
            }
        }
        if of(false).next().is_none() {
            return;
        }
        for v in rod.cells() {
            let beside = [v.checked_sub(1), (v < n).then_some(v)];
            let beside = || beside.into_iter().flatten();
            let share = 1.0 / beside().count() as f64;
            let sum = beside().fold(Vector3::zeros(), |sum, e| sum + rod.sigma(e));
            let (sigma, kappa) = (sum * share, rod.kappa(v));
            for term in of(false) {
                let [stress, couple] = term.derivatives(sigma, kappa);
                rod.add_couple(v, couple);
                for e in beside() {
                    let length = rod.rest_voronoi(v) / rod.rest_length(e);
                    rod.add_stress(e, stress * (share * length));
                }
            }
        }
    }

    fn check(&self, _setting: &Setting<'_>) -> Result<(), String> {
        if self.terms.is_empty() {
            return Err("`terms` is empty; give one at least, or leave the law out".into());
        }
        for (i, term) in self.terms.iter().enumerate() {
            let powers = [
                ("shear", term.shear, true),
                ("elongation", term.elongation, false),
                ("curvature", term.curvature, true),
                ("twist", term.twist, false),
            ];
            if powers.iter().all(|(_, power, _)| *power == 0) {
                return Err(format!(
                    "terms[{i}] depends on no strain; give a power of shear, elongation, curvature or twist"
                ));
            }
            for (name, power, even) in powers {
                if power > HIGHEST || even && power % 2 == 1 {
                    let which = if even { "an even power" } else { "a power" };
                    return Err(format!(
                        "terms[{i}].{name} is {power}; give {which} of {HIGHEST} at most"
                    ));
                }
            }
        }
        Ok(())
    }
}
