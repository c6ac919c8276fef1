//! A law of the rods for what nothing in the library explains.

use crate::constitutive::handed;
use auxetica_identify::{Effect, Hooked, Robot, Variant};

/// A stored energy of the rods, one monomial in their strains at a time: it describes, and is no cause.
#[derive(Clone, Debug, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Unknown {}

auxetica_engine::register!(
    dyn Effect: Unknown,
    example = "Unknown()",
    source = "series of a hyperelastic rod's energy",
);

/// The strains, and sizes that matter: of shear and elongation, and of curvature and twist times the rod's length.
const STRAINS: [(&str, f64); 4] = [
    ("shear", 0.05),
    ("elongation", 0.05),
    ("curvature", 0.3),
    ("twist", 1.5),
];
/// Energy per length at such strains [N].
const TYPICAL: f64 = 0.01;
/// Times that beyond which a coefficient isn't tried.
const MOST: f64 = 500.0;
/// Degrees of the monomials: less than cubic ones are linear laws, which are in the library.
const DEGREES: std::ops::RangeInclusive<usize> = 3..=4;

/// Powers of the strains whose monomials no effect of the library has: shear and curvature have no direction.
fn monomials() -> impl Iterator<Item = [usize; 4]> {
    let all = (0..5_usize.pow(4)).map(|i| [i % 5, i / 5 % 5, i / 25 % 5, i / 125]);
    all.filter(|[shear, elongation, curvature, twist]| {
        let powers = [shear, elongation, curvature, twist];
        let alone = powers.iter().filter(|power| ***power > 0).count() == 1;
        DEGREES.contains(&powers.into_iter().sum())
            && shear % 2 == 0
            && curvature % 2 == 0
            // the stiffness of a cubic one vanishes at small strains already
            && *elongation < 3
            // nonlinear stretch and nonlinear bending
            && !(alone && (*elongation > 0 || *curvature > 0))
    })
}

/// A product, such as `elongation * twist^2`.
fn product(powers: [usize; 4]) -> String {
    let factors = STRAINS.iter().zip(powers).filter(|(_, power)| *power > 0);
    let factors = factors.map(|((name, _), power)| match power {
        1 => (*name).to_owned(),
        _ => format!("{name}^{power}"),
    });
    factors.collect::<Vec<_>>().join(" * ")
}

/// Unit of a coefficient by the power of curvature and twist together.
fn unit(bends: usize) -> &'static str {
    ["N", "N m/rad", "N m2/rad2", "N m3/rad3", "N m4/rad4"][bends]
}

impl Effect for Unknown {
    fn id(&self) -> &'static str {
        "unknown"
    }

    fn words(&self) -> &'static str {
        "unknown law of the rods, a description and not a cause"
    }

    fn equation(&self) -> &'static str {
        "W +="
    }

    fn hook(&self) -> Hooked {
        Hooked::Constitutive
    }

    fn variants(&self, robot: &Robot) -> Vec<Variant> {
        let length = robot.lengths.iter().sum::<f64>() / robot.lengths.len().max(1) as f64;
        let term = |powers: [usize; 4]| {
            let [_, _, curvature, twist] = powers;
            let each = STRAINS.iter().zip(powers);
            let sizes = each.map(|((_, size), power)| size.powi(power as i32));
            let bends = curvature + twist;
            let typical = TYPICAL * length.powi(bends as i32) / sizes.product::<f64>();
            let form = Variant::new(product(powers)).number(
                format!("coefficient of {}", product(powers)),
                unit(bends),
                (0.0, typical),
                (-MOST * typical, MOST * typical),
            );
            let [shear, elongation, curvature, twist] = powers;
            let law = |value: &str| {
                format!(
                    "StrainEnergy(terms: [(coefficient: {value}, shear: {shear}, elongation: {elongation}, \
                     curvature: {curvature}, twist: {twist})])"
                )
            };
            match twist % 2 {
                0 => form.append("laws", format!("(apply: {})", law("{0}"))),
                // a right-handed rod's twist is opposite to its winding
                _ => handed(robot, form, &law("-{0}"), &law("{0}")),
            }
        };
        monomials().map(term).collect()
    }

    fn experiment(&self) -> &'static str {
        "measure the force and the torque of a single rod over the strains of the law"
    }

    fn is_cause(&self) -> bool {
        false
    }
}
