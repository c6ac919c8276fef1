//! What rods do.

use crate::{each_rod, effect};
use auxetica_identify::{Robot, Variant};

effect!(
    /// The rest length does not grow in proportion to the twist.
    AuxeticNonlinearity, "auxetic_nonlinearity", Constitutive,
    "the rods' rest length does not grow in proportion to their twist",
    "eps' = s tanh(eps / s), or eps' = eps + c eps^2",
    "measure a free rod's length against its twist angle",
    "Stölzle et al. 2023, section II-C",
    |_robot| vec![
        Variant::new("saturating")
            .number("saturation", "-", (20.0, 1.2), (0.2, 20.0))
            .append("laws", "(apply: Extension(saturation: {0}))"),
        Variant::new("quadratic")
            .number("quadratic", "-", (0.0, -0.15), (-1.0, 1.0))
            .append("laws", "(apply: Extension(quadratic: {0}))"),
    ]
);

effect!(
    /// Axial force is no linear function of stretch.
    AxialNonlinearity, "axial_nonlinearity", Constitutive,
    "the rods' axial force does not grow in proportion to their stretch",
    "n_z = S_z (e + b e^2 + c e^3)",
    "pull a rod at a fixed twist; measure the blocked force",
    "series of a constitutive law",
    |_robot| vec![
        Variant::new("quadratic")
            .number("quadratic", "-", (0.0, 0.5), (-10.0, 10.0))
            .append("laws", "(apply: Nonlinear(quadratic: {0}))"),
        Variant::new("cubic")
            .number("cubic", "-", (0.0, 2.0), (-100.0, 200.0))
            .append("laws", "(apply: Nonlinear(cubic: {0}))"),
    ]
);

effect!(
    /// Compression and tension differ.
    TensionCompressionAsymmetry, "tension_compression_asymmetry", Constitutive,
    "the rods are not as stiff in compression as in tension",
    "n_z = r S_z e for e < 0",
    "pull and push a rod at a fixed twist",
    "bimodular material",
    |_robot| vec![
        Variant::new("")
            .number("compression over tension", "-", (1.0, 1.3), (0.1, 10.0))
            .append("laws", "(apply: Nonlinear(compression: {0}))"),
    ]
);

effect!(
    /// Bending stiffens or softens with curvature.
    BendingNonlinearity, "bending_nonlinearity", Constitutive,
    "the rods' bending couple does not grow in proportion to their curvature",
    "m = B k (1 + c k^2)",
    "push the platform sideways far and little",
    "series of a constitutive law",
    |_robot| vec![
        Variant::new("")
            .number("cubic coefficient", "m2/rad2", (0.0, 1e-3), (-0.01, 0.1))
            .append("laws", "(apply: Nonlinear(bending: {0}))"),
    ]
);

effect!(
    /// Rigidities grow with the twist.
    TwistDependentStiffness, "twist_dependent_stiffness", Constitutive,
    "the rods' stiffness changes with their twist",
    "S = S_0 (1 + a |k_z|), B = B_0 (1 + b |k_z|)",
    "load the platform at three twists; measure a rod's spring constant against its twist angle",
    "Stölzle et al. 2023, eq. 5",
    |_robot| vec![
        Variant::new("of stretch")
            .number("growth of stretch rigidities", "m/rad", (0.0, 2e-3), (-0.015, 0.1))
            .append("laws", "(apply: Stiffness(shear_per_twist: {0}, axial_per_twist: {0}))"),
        Variant::new("of bending and twist")
            .number("growth of bending and twist rigidities", "m/rad", (0.0, 2e-3), (-0.015, 0.1))
            .append("laws", "(apply: Stiffness(bending_per_twist: {0}, twist_per_twist: {0}))"),
        Variant::new("of all")
            .number("growth of stretch rigidities", "m/rad", (0.0, 2e-3), (-0.015, 0.1))
            .number("growth of bending and twist rigidities", "m/rad", (0.0, 2e-3), (-0.015, 0.1))
            .append(
                "laws",
                "(apply: Stiffness(shear_per_twist: {0}, axial_per_twist: {0}, bending_per_twist: {1}, twist_per_twist: {1}))",
            ),
        // a rod that is nearly a mechanism until it is wound
        Variant::new("along the axis and in bending")
            .number("growth of the axial rigidity", "m/rad", (0.0, 0.02), (-0.015, 1.0))
            .number("growth of the bending rigidities", "m/rad", (0.0, 2e-3), (-0.015, 0.1))
            .append("laws", "(apply: Stiffness(axial_per_twist: {0}, bending_per_twist: {1}))"),
    ]
);

effect!(
    /// The law's missing couple.
    ReciprocalCoupling, "reciprocal_coupling", Constitutive,
    "axial force gives a twist couple in return, which the published law leaves out",
    "m_z += x h C_eps n_z dilatation",
    "measure the holding torque of a rod that is pulled and one that isn't",
    "Betti's reciprocity for Stölzle et al. 2023, eq. 2-3",
    |robot| {
        let variant = Variant::new("").number("share", "-", (0.0, 0.5), (-2.0, 3.0));
        if robot.handed_laws.is_empty() {
            return vec![];
        }
        let filled = robot.handed_laws.iter().fold(variant, |v, i| {
            v.set(format!("laws[{i}].apply.reciprocal"), "{0}")
        });
        vec![filled]
    }
);

/// A law for all rods whose sign goes with the handedness: `{0}` right-handed, the second text left-handed.
pub(crate) fn handed(robot: &Robot, variant: Variant, right: &str, left: &str) -> Variant {
    let of = |sign: f64| -> Vec<&String> {
        let rods = robot.rods.iter().zip(&robot.handed);
        rods.filter(|(_, h)| **h * sign > 0.0)
            .map(|(rod, _)| rod)
            .collect()
    };
    let (rights, lefts) = (of(1.0), of(-1.0));
    if rights.is_empty() || lefts.is_empty() {
        return variant.append("laws", format!("(apply: {right})"));
    }
    variant
        .append("laws", format!("(on: {rights:?}, apply: {right})"))
        .append("laws", format!("(on: {lefts:?}, apply: {left})"))
}

effect!(
    /// Chiral coupling of strains.
    CrossCoupling, "cross_coupling", Constitutive,
    "stretch and twist, or bending and shear, load each other",
    "energy c h e k_z, or c h (s_x k_x + s_y k_y)",
    "drive each mode alone and watch the others",
    "linear law of a chiral rod",
    |robot| vec![
        handed(
            robot,
            Variant::new("stretch-twist").number("coupling", "N m", (0.0, 0.02), (-0.5, 0.5)),
            "Coupling(stretch_twist: {0})",
            "Coupling(stretch_twist: -{0})",
        ),
        handed(
            robot,
            Variant::new("bend-shear").number("coupling", "N m", (0.0, 0.1), (-1.0, 1.0)),
            "Coupling(bend_shear: {0})",
            "Coupling(bend_shear: -{0})",
        ),
    ]
);

effect!(
    /// Bending rigidities differ about both directors.
    BendingAnisotropy, "bending_anisotropy", Constitutive,
    "the rods bend more easily about one axis of their section than about the other",
    "B = diag(r B, B, B_z), turning with the rod",
    "bend the same way with the rods turned by a quarter",
    "orthotropic section",
    |_robot| vec![
        Variant::new("")
            .number("ratio of bending rigidities", "-", (1.0, 1.15), (0.2, 5.0))
            .append("laws", "(apply: Stiffness(bending: ({0}, 1)))"),
    ]
);

effect!(
    /// Rods are not alike.
    RodAsymmetry, "rod_asymmetry", Constitutive,
    "the rods are not alike",
    "eps_i = g_i eps, S_i = g_i S, B_i = g_i B",
    "swap two rods; measure each rod alone",
    "manufacturing spread",
    |robot| {
        let mut forms = each_rod(robot, "extension of", |v, rod| {
            v.number("extension gain", "-", (1.0, 0.95), (0.5, 1.5))
                .append("laws", format!("(on: {rod:?}, apply: Extension(gain: {{0}}))"))
        });
        forms.extend(each_rod(robot, "stretch stiffness of", |v, rod| {
            v.number("axial gain", "-", (1.0, 0.9), (0.3, 3.0)).append(
                "laws",
                format!("(on: {rod:?}, apply: Stiffness(axial: {{0}}, shear: {{0}}))"),
            )
        }));
        forms.extend(each_rod(robot, "bending stiffness of", |v, rod| {
            v.number("bending gain", "-", (1.0, 0.9), (0.3, 3.0)).append(
                "laws",
                format!("(on: {rod:?}, apply: Stiffness(bending: ({{0}}, {{0}}), twist: {{0}}))"),
            )
        }));
        forms.extend(each_rod(robot, "all stiffness of", |v, rod| {
            v.number("stiffness gain", "-", (1.0, 0.9), (0.3, 3.0)).append(
                "laws",
                format!("(on: {rod:?}, apply: Stiffness(axial: {{0}}, shear: {{0}}, bending: ({{0}}, {{0}}), twist: {{0}}))"),
            )
        }));
        // all others over the first, since the scenario's own rigidities scale all alike
        let over_first = |v: Variant, what: &str, field: &str| {
            let from = v.quantities.len();
            robot.rods.iter().skip(1).enumerate().fold(v, |v, (i, rod)| {
                v.number(format!("{what} gain of {rod}"), "-", (1.0, 1.1), (0.3, 3.0)).append(
                    "laws",
                    format!("(on: {rod:?}, apply: Stiffness({field}: {{{}}}))", from + i),
                )
            })
        };
        let left: Vec<&String> = robot.rods.iter().zip(&robot.handed).filter(|(_, h)| **h < 0.0).map(|(rod, _)| rod).collect();
        if !left.is_empty() && left.len() < robot.rods.len() {
            forms.push(
                Variant::new("stretch and twist stiffness of left-handed rods")
                    .number("axial gain of left-handed rods", "-", (1.0, 1.1), (0.3, 3.0))
                    .number("twist gain of left-handed rods", "-", (1.0, 1.1), (0.3, 3.0))
                    .append("laws", format!("(on: {left:?}, apply: Stiffness(axial: {{0}}, twist: {{1}}))")),
            );
        }
        if robot.rods.len() > 1 {
            let twist = |name| over_first(Variant::new(name), "twist", "twist");
            forms.push(twist("twist stiffness of each rod"));
            forms.push(over_first(twist("stretch and twist stiffness of each rod"), "axial", "axial"));
        }
        forms
    }
);

effect!(
    /// Rods are bent as made.
    IntrinsicCurvature, "intrinsic_curvature", Constitutive,
    "a rod is curved at rest",
    "m = B (k - k_0)",
    "lay the rod on a table; turn it in its socket",
    "Gazzola et al. 2018, intrinsic strains",
    |robot| {
        let form = |v: Variant, on: &str| {
            v.number("curvature about d1", "rad/m", (0.0, 0.5), (-20.0, 20.0))
                .number("curvature about d2", "rad/m", (0.0, 0.5), (-20.0, 20.0))
                .append("laws", format!("({on}apply: Intrinsic(curvature: ({{0}}, {{1}}, 0)))"))
        };
        let mut forms = each_rod(robot, "", |v, rod| form(v, &format!("on: {rod:?}, ")));
        forms.push(form(Variant::new("all rods"), ""));
        let mut own = Variant::new("each rod");
        for (i, rod) in robot.rods.iter().enumerate() {
            for (d, about) in ["d1", "d2"].iter().enumerate() {
                // unlike, since alike rods are the form before
                let typical = [[0.5, 0.1], [-0.1, 0.5], [-0.5, -0.1], [0.1, -0.5]][i % 4][d];
                own = own.number(format!("curvature of {rod} about {about}"), "rad/m", (0.0, typical), (-20.0, 20.0));
            }
            let (a, b) = (2 * i, 2 * i + 1);
            own = own.append("laws", format!("(on: {rod:?}, apply: Intrinsic(curvature: ({{{a}}}, {{{b}}}, 0)))"));
        }
        forms.push(own);
        forms
    }
);

effect!(
    /// Stiffness changes along the rods.
    StiffnessGradient, "stiffness_gradient", Constitutive,
    "the rods are stiffer at one end than at the other",
    "S(s) = S (1 + g (s / L - 1/2))",
    "add a second ring",
    "graded rod",
    |_robot| vec![
        Variant::new("")
            .number("gradient", "-", (0.0, 0.2), (-1.8, 1.8))
            .append("laws", "(apply: Stiffness(gradient: {0}))"),
    ]
);

effect!(
    /// Viscosity beside elasticity.
    KelvinVoigtEffect, "kelvin_voigt", Constitutive,
    "the rods resist the rate of strain",
    "n = S (e + tau e')",
    "drive the same path at three speeds; let the platform ring down",
    "Kelvin-Voigt solid",
    |_robot| vec![
        Variant::new("")
            .number("retardation time", "s", (0.0, 0.08), (0.0, 5.0))
            .append("laws", "(apply: KelvinVoigt(time: {0}))"),
    ]
);

effect!(
    /// Stress relaxes in holds.
    ViscoelasticCreep, "viscoelastic_creep", Constitutive,
    "the rods creep while the motors hold",
    "n = S (e + x (e - e_v)), e_v' = (e - e_v) / tau",
    "hold one set-point for more than five time constants",
    "standard linear solid",
    |_robot| vec![
        Variant::new("")
            .number("share", "-", (0.0, 0.15), (0.0, 5.0))
            .number("time", "s", (3.0, 3.0), (0.1, 300.0))
            .append("laws", "(apply: Creep(share: {0}, time: {1}))"),
    ]
);

effect!(
    /// Rate-independent hysteresis.
    HysteresisEffect, "hysteresis", Constitutive,
    "the rods' stress depends on the direction of loading, at any speed",
    "n = S (e + x (e - z)), z follows e at most a yield strain behind",
    "nested loops at two speeds",
    "Prandtl's body",
    |_robot| vec![
        Variant::new("")
            .number("share", "-", (0.0, 0.2), (0.0, 5.0))
            .number("yield strain", "-", (0.03, 0.03), (1e-3, 1.0))
            .number("yield curvature", "rad/m", (4.0, 4.0), (0.1, 100.0))
            .append("laws", "(apply: Hysteresis(share: {0}, strain: {1}, curvature: {2}))"),
    ]
);

effect!(
    /// Rods stay longer after their first extension.
    PermanentSetEffect, "permanent_set", Constitutive,
    "the rods stay longer after they were extended",
    "eps += x max(eps so far)",
    "repeat the first trajectory last",
    "plastic set",
    |_robot| vec![
        Variant::new("")
            .number("share", "-", (0.0, 0.03), (-0.5, 0.5))
            .append("laws", "(apply: PermanentSet(share: {0}))"),
    ]
);

effect!(
    /// Properties drift as the robot warms.
    ThermalDrift, "thermal_drift", Constitutive,
    "the rods' properties drift while the run goes on",
    "S = S_0 (1 + x (1 - exp(-t / tau))), or the same of eps",
    "run cold and warm",
    "first-order warming",
    |_robot| vec![
        Variant::new("of stiffness")
            .number("change of stiffness", "-", (0.0, -0.1), (-0.9, 3.0))
            .number("time", "s", (30.0, 30.0), (3.0, 1000.0))
            .append("laws", "(apply: Drift(stiffness: {0}, time: {1}))"),
        Variant::new("of extension")
            .number("change of extension", "-", (0.0, -0.05), (-0.9, 3.0))
            .number("time", "s", (30.0, 30.0), (3.0, 1000.0))
            .append("laws", "(apply: Drift(extension: {0}, time: {1}))"),
    ]
);
