//! What acts on the robot from outside.

use crate::effect;
use auxetica_identify::Variant;

effect!(
    /// Weight.
    GravityEffect, "gravity", Forcing,
    "the robot's own weight is missing",
    "f = rho A g",
    "tilt or invert the robot",
    "weight",
    |robot| {
        let g_z = |v: Variant| v.number("g_z", "m/s2", (0.0, 9.81), (-12.0, 12.0));
        let gravity = |v: Variant| v.append("forcing", "(apply: Gravity(g: (0, 0, {0})))");
        let mut forms = vec![gravity(g_z(Variant::new("along z")))];
        // a scenario without gravity lacks the weight of what the platform carries, too
        if let Some(platform) = robot.cylinders.last() {
            let load = g_z(Variant::new("along z, and a payload"))
                .number("mass", "kg", (0.0, 0.08), (0.0, 2.0))
                .number("x", "m", (0.0, 0.01), (-0.06, 0.06))
                .number("y", "m", (0.0, 0.01), (-0.06, 0.06));
            forms.push(gravity(load).append(
                "forcing",
                format!("(on: {platform:?}, apply: Payload(mass: {{1}}, at: ({{2}}, {{3}}, 0), g: (0, 0, {{0}})))"),
            ));
        }
        if robot.gravity { vec![] } else { forms }
    }
);

effect!(
    /// Gravity at an angle.
    MountTilt, "mount_tilt", Forcing,
    "the robot is mounted at an angle to the vertical",
    "f = rho A R(a, b) g",
    "turn the base by half a turn",
    "weight",
    |robot| {
        let form = Variant::new("")
            .number("g_x", "m/s2", (0.0, 0.5), (-9.81, 9.81))
            .number("g_y", "m/s2", (0.0, 0.5), (-9.81, 9.81));
        match robot.gravity {
            true => vec![form.append("forcing", "(apply: Gravity(g: ({0}, {1}, 0)))")],
            false => vec![
                form.number("g_z", "m/s2", (0.0, 9.81), (-12.0, 12.0))
                    .append("forcing", "(apply: Gravity(g: ({0}, {1}, {2})))"),
            ],
        }
    }
);

effect!(
    /// A mass on the platform.
    PayloadEffect, "payload", Body,
    "the platform carries a mass that the model lacks, or its centre of mass is elsewhere",
    "f = m g at r",
    "put on a known mass; invert the robot",
    "weight",
    |robot| {
        let Some(platform) = robot.cylinders.last() else { return vec![] };
        let form = |v: Variant, at: &str| v.append(
            "forcing",
            format!("(on: {platform:?}, apply: Payload(mass: {{0}}, at: ({at}, 0), g: (0, 0, 9.81)))"),
        );
        let mass = |name: &str| Variant::new(name).number("mass", "kg", (0.0, 0.08), (-0.5, 2.0));
        vec![
            form(mass("centred"), "0, 0"),
            form(
                mass("off centre")
                    .number("x", "m", (0.0, 0.01), (-0.06, 0.06))
                    .number("y", "m", (0.0, 0.01), (-0.06, 0.06)),
                "{1}, {2}",
            ),
        ]
    }
);

effect!(
    /// A cable.
    TetherEffect, "tether", Forcing,
    "a cable or spring pulls at the platform",
    "f = k (|a - p| - l) towards a, while taut",
    "unplug or re-route the cable",
    "unilateral spring",
    |robot| {
        let Some(platform) = robot.cylinders.last() else { return vec![] };
        let from = |(name, x, y): (&str, f64, f64)| {
            Variant::new(name)
                .number("anchor x", "m", (x, x), (-0.6, 0.6))
                .number("anchor y", "m", (y, y), (-0.6, 0.6))
                .number("anchor z", "m", (0.08, 0.08), (-0.3, 0.5))
                .number("stiffness", "N/m", (0.0, 25.0), (0.0, 2000.0))
                .number("slack length", "m", (0.1, 0.1), (0.0, 0.6))
                .append(
                    "forcing",
                    format!("(on: {platform:?}, apply: Tether(anchor: ({{0}}, {{1}}, {{2}}), stiffness: {{3}}, slack: {{4}}))"),
                )
        };
        let sides = [
            ("from +x", 0.15, 0.0),
            ("from -x", -0.15, 0.0),
            ("from +y", 0.0, 0.15),
            ("from -y", 0.0, -0.15),
        ];
        sides.map(from).to_vec()
    }
);

effect!(
    /// Something in the way.
    ObstacleEffect, "obstacle", Forcing,
    "the platform runs into something",
    "f = k max(0, depth)",
    "move the robot and repeat",
    "penalty contact",
    |robot| {
        let Some(platform) = robot.cylinders.last() else { return vec![] };
        let side = |(name, axis, sign, at): (&str, usize, f64, f64)| {
            let mut point = ["0", "0", "0"];
            point[axis] = "{0}";
            let mut normal = ["0", "0", "0"];
            normal[axis] = if sign > 0.0 { "-1" } else { "1" };
            Variant::new(name)
                .number("place", "m", (at, at), (-0.2, 0.3))
                .number("stiffness", "N/m", (0.0, 300.0), (0.0, 1e5))
                .append(
                    "forcing",
                    format!(
                        "(on: {platform:?}, apply: Obstacle(point: ({}), normal: ({}), stiffness: {{1}}))",
                        point.join(", "),
                        normal.join(", ")
                    ),
                )
        };
        let sides = [
            ("at +x", 0, 1.0, 0.015),
            ("at -x", 0, -1.0, -0.015),
            ("at +y", 1, 1.0, 0.015),
            ("at -y", 1, -1.0, -0.015),
            ("beyond the tip", 2, 1.0, 0.12),
        ];
        sides.map(side).to_vec()
    }
);
