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

effect!(
    /// Joints have play.
    JointClearance, "joint_clearance", Joint,
    "the joints between rods and platform have play",
    "f = k_F (d - g d / |d|), tau likewise, once the gap g is crossed",
    "shake the platform; invert the robot",
    "dead zone, smoothed where little load seats the joint",
    |robot| {
        if robot.joints == 0 {
            return vec![];
        }
        vec![
            Variant::new("in rotation")
                .number("rotational clearance", "rad", (0.0, 3e-3), (0.0, 0.2))
                .set("joints[*].apply.rotational_clearance", "{0}"),
            // not more than the stiff joint is displaced anyway, or it would not be noticed to first order
            Variant::new("in translation")
                .number("clearance", "m", (0.0, 5e-5), (0.0, 2e-3))
                .set("joints[*].apply.clearance", "{0}"),
        ]
    }
);
