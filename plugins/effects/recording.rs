//! Faults of the recording.

use crate::effect;
use auxetica_identify::Variant;

effect!(
    /// Clocks differ.
    TimeOffset, "time_offset", Recording,
    "motion capture and motors have clocks that are apart",
    "y(t - d)",
    "a tap that both record; runs at constant speed",
    "dead time",
    |_robot| vec![
        Variant::new("")
            .number("delay", "s", (0.0, 0.06), (-1.0, 1.0))
            .append("drives", "(apply: Delay(by: {0}))"),
    ]
);

effect!(
    /// Frames are turned or shifted.
    FrameMisalignment, "frame_misalignment", Recording,
    "the motion capture's frame is turned or shifted against the robot's base",
    "y = R y + t",
    "sweep a rigid wand; turn the robot in the volume",
    "rigid motion",
    |_robot| vec![
        Variant::new("turned")
            .number("turn about x", "rad", (0.0, 0.01), (-3.2, 3.2))
            .number("turn about y", "rad", (0.0, 0.01), (-3.2, 3.2))
            .number("turn about z", "rad", (0.0, 0.01), (-3.2, 3.2))
            .set("capture", "(turn: ({0}, {1}, {2}))"),
        Variant::new("shifted")
            .number("shift along x", "m", (0.0, 1e-3), (-0.05, 0.05))
            .number("shift along y", "m", (0.0, 1e-3), (-0.05, 0.05))
            .number("shift along z", "m", (0.0, 1e-3), (-0.05, 0.05))
            .set("capture", "(shift: ({0}, {1}, {2}))"),
    ]
);

effect!(
    /// A marker sits elsewhere.
    MarkerOffset, "marker_offset", Recording,
    "markers sit elsewhere on their body than stated",
    "y = p + R (o + do)",
    "a photograph; seat the marker anew",
    "rigid offset",
    |robot| {
        let form = |i: usize, name: &String| {
            let [x, y, z] = robot.offsets[i];
            let around = |at: f64| (at, at + 1e-3);
            let range = |at: f64| (at - 0.05, at + 0.05);
            Variant::new(name.clone())
                .number("offset along x", "m", around(x), range(x))
                .number("offset along y", "m", around(y), range(y))
                .number("offset along z", "m", around(z), range(z))
                .set(format!("markers[{i}].offset"), "({0}, {1}, {2})")
        };
        robot.markers.iter().enumerate().map(|(i, name)| form(i, name)).collect()
    }
);
