//! Joints between rods and platform.

use crate::effect;
use auxetica_identify::Variant;

effect!(
    /// Joints give way.
    JointCompliance, "joint_compliance", Joint,
    "the joints between rods and platform give way",
    "tau = k_tau log(R), f = k_F d, softer than stated",
    "a second marker on a rod's tip; push the platform",
    "Stölzle et al. 2023, eq. 6-7",
    |robot| {
        if robot.joints == 0 {
            return vec![];
        }
        vec![
            Variant::new("in rotation")
                .number("rotational stiffness", "N m/rad", (20.0, 3.0), (0.05, 200.0))
                .set("joints[*].apply.rotational_stiffness", "{0}"),
            Variant::new("in translation")
                .number("stiffness", "N/m", (2e5, 5e3), (50.0, 1e6))
                .set("joints[*].apply.stiffness", "{0}"),
        ]
    }
);
