//! Motors, clamps and drives.

use crate::effect;
use auxetica_identify::{Robot, Variant};

/// One form for each motor.
fn each_motor(robot: &Robot, form: impl Fn(Variant, &str) -> Variant) -> Vec<Variant> {
    let motor = |i: usize| {
        let name = format!("motor_{}", i + 1);
        form(Variant::new(name.clone()), &name)
    };
    (0..robot.rods.len()).map(motor).collect()
}

effect!(
    /// Motors give way.
    MotorComplianceEffect, "motor_compliance", Boundary,
    "shafts or horns give way to the rods' torque",
    "phi_rod = phi - tau / k",
    "put a marker on a horn; lock a rod's tip",
    "springs in series",
    |_robot| vec![
        Variant::new("")
            .number("stiffness", "N m/rad", (200.0, 3.0), (0.02, 200.0))
            .append("laws", "(apply: MotorCompliance(stiffness: {0}))"),
    ]
);

effect!(
    /// The base gives way.
    BaseComplianceEffect, "base_compliance", Boundary,
    "the base gives way where the rods are clamped",
    "tilt = (m + r x f) / k_tau, d = f / k_F, at each rod's motor",
    "a marker on the base beside a rod; push the platform",
    "springs in series",
    |_robot| vec![
        Variant::new("in rotation")
            .number("rotational stiffness", "N m/rad", (500.0, 5.0), (0.1, 500.0))
            .append("laws", "(apply: BaseCompliance(rotational_stiffness: {0}))"),
        Variant::new("in translation")
            .number("stiffness", "N/m", (2e5, 5e3), (50.0, 2e5))
            .append("laws", "(apply: BaseCompliance(stiffness: {0}))"),
    ]
);

effect!(
    /// Friction in motors and gears.
    MotorFriction, "motor_friction", Boundary,
    "motors and gears rub: a motor works against it as long as it turns, and holds part of it when it stops",
    "tau_motor = tau + (f + mu |tau|) sgn(w), of which a share of friction stays at rest",
    "let a motor turn without its rod, both ways",
    "Coulomb friction",
    |_robot| {
        let always = Variant::new("always the same")
            .number("friction", "N m", (0.0, 0.05), (0.0, 5.0))
            .set("motor_loads.friction", "{0}");
        let in_proportion = Variant::new("in proportion to the torque")
            .number("friction over torque", "-", (0.0, 0.2), (0.0, 3.0))
            .set("motor_loads.friction_of_torque", "{0}");
        let held = |form: Variant| {
            form.number("share at rest", "-", (0.0, 0.5), (0.0, 1.0))
                .set("motor_loads.held", "{1}")
        };
        [always, in_proportion].map(held).into()
    },
    in_loads
);

effect!(
    /// Play at reversals.
    BacklashEffect, "backlash", Boundary,
    "the motors have play: a rod stays behind when its motor reverses",
    "phi_rod follows phi at most b behind",
    "small reversals under load",
    "play operator",
    |_robot| vec![
        Variant::new("")
            .number("play", "rad", (0.0, 0.04), (0.0, 0.6))
            .append("drives", "(apply: Backlash(play: {0}))"),
    ]
);

effect!(
    /// Motors are late.
    MotorLag, "motor_lag", Boundary,
    "the rods' starts follow the recorded angles with a lag",
    "tau phi' = phi_recorded - phi",
    "record the position that the motor has; drive at three speeds",
    "first-order lag",
    |_robot| vec![
        Variant::new("")
            .number("time", "s", (0.0, 0.06), (0.0, 3.0))
            .append("drives", "(apply: Lag(time: {0}))"),
    ]
);

effect!(
    /// A gear ratio that isn't as stated.
    EncoderScale, "encoder_scale", Boundary,
    "a motor turns more or less than its encoder says",
    "phi = (1 + g) reading",
    "a protractor on the horn",
    "linear calibration",
    |robot| each_motor(robot, |v, motor| {
        v.number("scale", "-", (1.0, 0.95), (0.3, 2.0))
            .append("drives", format!("(on: {motor:?}, apply: Gear(scale: {{0}}))"))
    })
);

effect!(
    /// A zero that isn't.
    EncoderZero, "encoder_zero", Boundary,
    "a motor's zero angle is not where it is taken to be",
    "phi = reading + phi_0",
    "a protractor on the horn; start each run from the unwound rod",
    "linear calibration",
    |robot| each_motor(robot, |v, motor| {
        v.number("zero", "rad", (0.0, 0.05), (-1.5, 1.5))
            .append("drives", format!("(on: {motor:?}, apply: Gear(zero: {{0}}))"))
    })
);

effect!(
    /// The flexible part isn't as long as stated.
    EffectiveLength, "effective_length", Boundary,
    "the flexible part of the rods is longer or shorter than stated",
    "L = L_0 + dL",
    "a calliper",
    "geometry",
    |robot| {
        let length = |i: usize, l: f64| {
            Variant::new("")
                .number("length", "m", (l, 0.96 * l), (0.6 * l, 1.5 * l))
                .set(format!("rods[{i}].length"), "{0}")
        };
        robot.lengths.iter().enumerate().take(1).map(|(i, l)| length(i, *l)).collect()
    }
);
