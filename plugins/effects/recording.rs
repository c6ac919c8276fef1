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

effect!(
    /// Motors report their loads wrongly.
    LoadCalibration, "load_calibration", Recording,
    "a motor's load reading has another gain than the others', or doesn't count from zero",
    "load = g tau + o",
    "hang a weight from a lever on the horn",
    "gauge",
    |_robot| {
        let of_four = |i: usize, other: &str| {
            let mut all = [other; 4];
            all[i] = "{0}";
            format!("({})", all.join(", "))
        };
        let gain = |i: usize| {
            Variant::new(format!("gain of motor_{}", i + 1))
                .number("gain over the others'", "-", (1.0, 1.2), (0.1, 10.0))
                .set("motor_loads.gains", of_four(i, "1"))
        };
        let zero = |i: usize| {
            Variant::new(format!("zero of motor_{}", i + 1))
                .number("reading without a torque", "-", (0.0, 20.0), (-2000.0, 2000.0))
                .set("motor_loads.offsets", of_four(i, "0"))
        };
        let zeros = Variant::new("all zeros")
            .number("reading without a torque", "-", (0.0, 20.0), (-2000.0, 2000.0))
            .set("motor_loads.offsets", "({0}, {0}, {0}, {0})");
        (0..4).map(gain).chain((0..4).map(zero)).chain([zeros]).collect()
    },
    in_loads
);
