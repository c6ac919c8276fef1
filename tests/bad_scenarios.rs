//! Whatever is wrong with a scenario is refused with exit code 2, its file, line and field, and a remedy; nothing is
//! solved, nothing goes to stdout, and nothing panics.

mod program;

use program::{JOINED, SMALL, refused, small};
use std::fs;

/// `old` replaced by `new` in the small scenario, and what must be said.
type Edit = (&'static str, &'static str, &'static [&'static str]);

/// Faults in the file: each must be told with `broken.ron:LINE`.
#[rustfmt::skip]
const EDITS: [Edit; 41] = [
    ("length: 0.1", "length: -0.1", &["broken.ron:5:17", "`rods[0].length`", "found -0.1", "give a number above 0"]),
    ("length: 0.1", "length: 0", &["broken.ron:5:17", "`rods[0].length`", "found 0", "give a number above 0"]),
    ("length: 0.1", "length: \"long\"", &["broken.ron:5:17", "expected a number", "for example 0.5"]),
    ("length: 0.1", "lenght: 0.1", &["broken.ron:5:9", "unknown field `lenght`", "did you mean `length`?"]),
    ("length: 0.1,", "length: 0.1", &["broken.ron:6:9", "expected `,`", "is a comma missing"]),
    ("length: 0.1,", "length: 0.1, length: 0.2,", &["broken.ron:5:22", "`length` is given twice", "remove one"]),
    ("radius: 0.01", "radius: NaN", &["broken.ron:7:17", "`rods[0].radius`", "found NaN", "give a number above 0"]),
    ("radius: 0.01", "radius: [0.01, 0.02]", &["broken.ron:7:17", "`rods[0].radius`", "2 numbers for 10 places", "give one for each"]),
    ("radius: 0.01", "radius: 0.01, wall: 0.02", &["broken.ron:7:29", "`rods[0].wall`", "thicker than the radius", "leave it out"]),
    ("radius: 0.01", "radius: 1e-200", &["broken.ron:4:15", "must be positive and finite", "in SI units"]),
    ("density: 1000", "density: inf", &["broken.ron:8:18", "`rods[0].density`", "found inf", "give a number above 0"]),
    ("        density: 1000,\n", "", &["broken.ron:3:12", "missing field `density`", "add `density: ..`"]),
    ("elements: 10", "elements: 0", &["broken.ron:6:19", "`rods[0].elements`", "found 0", "give 1, 2, 3"]),
    ("elements: 10", "elements: 2.5", &["broken.ron:6:19", "`rods[0].elements`", "found 2.5", "give 1, 2, 3"]),
    ("shear: 4e5),", "shear: 4e5,", &["broken.ron:10:6", "to close the `(` of line 3", "is a `)` missing"]),
    ("shear: 4e5)", "shear: [4e5])", &["broken.ron:9:19", "`rods[0].material`", "1 numbers for 10 places"]),
    ("\"small\"", "\"small", &["broken.ron:2:12", "goes on over the end of its line", "closing `\"` missing"]),
    ("\"rod.csv\"", "\"rod.csv", &["broken.ron:15:49", "never closed", "add the missing `\"`"]),
    ("name: \"rod\",", "name: \"rod\", at: {\"a\": (0, 0, 0), \"rod\": (1, 0, 0)},", &["broken.ron:4:15", "the name `rod` is taken", "give another"]),
    ("name: \"rod\",", "name: \"rod\", normal: (0, 0, 1),", &["broken.ron:4:30", "lies along the rod", "give another"]),
    ("name: \"rod\",", "name: \"rod\", direction: (0, 0, 0),", &["broken.ron:4:33", "expected a direction", "not zero"]),
    ("EndForce(", "EndFroce(", &["broken.ron:12:23", "no forcing named `EndFroce`", "did you mean `EndForce`?"]),
    ("EndForce(force: (0.01, 0, 0))", "Clamp()", &["broken.ron:12:23", "`Clamp` is a boundary condition", "put it under `boundary:`"]),
    ("(0.01, 0, 0)", "(0.01, 0)", &["broken.ron:12:39", "expected 3 values, found 2", "give 3 values"]),
    ("(0.01, 0, 0)", "(0.01, 0, 0), scal: 2", &["broken.ron:12:53", "unknown field `scal` in `EndForce`", "did you mean `scale`?"]),
    ("(0.01, 0, 0)", "(0.01, 0, 0), scale: Input(\"motor\")", &["broken.ron:12:23", "`forcing[0].apply`", "no input `motor`", "there are no inputs"]),
    ("(0.01, 0, 0)", "(0.01, 0, 0), scale: Table([(0, 0), (0, 1)])", &["broken.ron:12:66", "0 s is followed by 0 s", "give each point a later time"]),
    ("forcing: [(apply", "forcing: [(on: \"rood\", apply", &["broken.ron:12:20", "`forcing[0].on`", "no body named `rood`", "did you mean `rod`?"]),
    ("translational: (10,", "translational: (-10,", &["broken.ron:13:23", "can't be negative", "give 0 or more"]),
    ("Dynamic(", "Dinamic(", &["broken.ron:14:13", "`Dinamic`", "did you mean `Dynamic`?"]),
    ("duration: 0.02", "duration: 0.02, dt: 1", &["broken.ron:14:41", "`solver.dt`", "beyond the stability limit", "`Auto`"]),
    ("duration: 0.02", "duration: 0.02, dt: Atuo", &["broken.ron:14:41", "`solver.dt`", "found `Atuo`", "did you mean `Auto`?"]),
    ("duration: 0.02", "duration: 0.02, dt: -1e-6", &["broken.ron:14:41", "`solver.dt`", "found -0.000001", "give a number above 0"]),
    ("every: 0.001", "every: 0", &["broken.ron:15:25", "`callbacks[0].every`", "give a number above 0"]),
    ("Csv(file", "Csv(quantities: [Position, Position], file", &["broken.ron:15:55", "Position is named twice", "name it once"]),
    ("solver:", "markers: [(name: \"tip\", on: \"rod\", along: 1.5)], solver:", &["broken.ron:14:47", "`markers[0].along`", "past the rod's tip", "give 0 to 1"]),
    ("solver:", "markers: [(name: \"m\", on: \"rod\"), (name: \"m\", on: \"rod\")], solver:", &["broken.ron:14:46", "`markers[1].name`", "is taken", "give another"]),
    ("solver:", "laws: [(apply: Auxetic(handedness: Left, factor: 1, eps_min: 0.5, eps_max: 0.1))], solver:", &["broken.ron:14:20", "`laws[0].apply`", "eps_min 0.5 exceeds eps_max 0.1", "give a smaller"]),
    ("solver:", "motor_loads: (gain: -3), solver:", &["broken.ron:14:25", "`motor_loads.gain`", "found -3", "give a number above 0"]),
    ("solver:", "inputs: Channels(channels: {\"a\": []}), solver:", &["broken.ron:14:38", "`inputs.channels[\"a\"]`", "at least one"]),
    ("solver:", "joints: [(between: (\"rod\", \"plate\"), apply: SpringDamper(stiffness: 1))], solver:", &["broken.ron:14:24", "`joints[0].between`", "no body named `plate`", "bodies: `rod`"]),
];

#[test]
fn faults_in_the_file_are_told_at_their_line() {
    let folder = small();
    let path = folder.path().join("broken.ron");
    for (old, new, words) in EDITS {
        assert!(SMALL.contains(old), "{old}");
        fs::write(&path, SMALL.replacen(old, new, 1)).unwrap();
        // `run` and not `check`: nothing may be written
        refused(folder.path(), &["run", "broken.ron"], 2, words);
    }
    assert!(!folder.path().join("out").exists(), "results were begun");
}

#[test]
fn faults_on_the_command_line_are_told_where_they_stand() {
    let folder = small();
    let [platform, _] = JOINED;
    let heavy = |mass: &str| platform.replace("mass: 0.01", mass);
    let joint = |a: &str, b: &str| {
        format!("joints=[(between: (\"{a}\", \"{b}\"), apply: SpringDamper(stiffness: 1))]")
    };
    let cases: [(&[&str], &[&str]); 17] = [
        (
            &["rods[0].lenght=1"],
            &["--set rods[0].lenght=1:1:9", "did you mean `length`?"],
        ),
        (
            &["rods[7].length=1"],
            &[
                "--set rods[7].length=1:1:6",
                "`rods` has no [7]",
                "[0] to [0]",
            ],
        ),
        (
            &["rodz[0].length=1"],
            &[
                "--set rodz[0].length=1:1:1",
                "`rodz`",
                "did you mean `rods`?",
            ],
        ),
        (
            &["rods[0].length"],
            &[
                "expected `=` and a value",
                "for example `--set rods[0].length=0.1`",
            ],
        ),
        (
            &["rods[0].length="],
            &["expected a value", "the value is written as in a scenario"],
        ),
        (&["rods[0].length=(1"], &["never closed"]),
        (
            &["rods[0].length=-1"],
            &[
                "--set rods[0].length=-1:1:16",
                "`rods[0].length`",
                "give a number above 0",
            ],
        ),
        (
            &["rods=[]"],
            &[
                "--set rods=[]:1:6",
                "no bodies",
                "give `rods` or `cylinders`",
            ],
        ),
        (
            &[&heavy("mass: 0")],
            &["`cylinders[0].mass`", "found 0", "give a number above 0"],
        ),
        (
            &[&heavy("mass: -1")],
            &["`cylinders[0].mass`", "found -1", "give a number above 0"],
        ),
        (
            &[&heavy("mass: 1, density: 1")],
            &["`cylinders[0].mass`", "leave one out"],
        ),
        (
            &[&platform.replace(", mass: 0.01", "")],
            &["neither `density` nor `mass`", "add one of them"],
        ),
        (
            &[&platform.replace("\"platform\"", "\"rod\"")],
            &[
                "`cylinders[0].name`",
                "the name `rod` is taken",
                "give another",
            ],
        ),
        (
            &[platform, &joint("rod", "rod")],
            &["`joints[0].between`", "on both sides", "name another body"],
        ),
        (
            &[platform, &joint("rod[11]", "platform")],
            &["`rod` has no node 11", "give 0 to 10"],
        ),
        (
            &[platform, &joint("rod[x]", "platform")],
            &["`x` in `rod[x]` is not a node", "give 0, 1, 2"],
        ),
        (
            &["forcing[0].apply=5"],
            &["begins with its name", "`EndForce`"],
        ),
    ];
    for (sets, words) in cases {
        let mut arguments = vec!["run", "small.ron"];
        for set in sets {
            arguments.extend(["--set", set]);
        }
        refused(folder.path(), &arguments, 2, words);
    }
    assert!(!folder.path().join("out").exists(), "results were begun");
}

#[test]
fn all_faults_are_told_at_once() {
    let folder = small();
    let text = SMALL
        .replace("length: 0.1", "length: -1")
        .replace("density: 1000", "density: 0")
        .replace("duration: 0.02", "duration: \"long\"");
    fs::write(folder.path().join("broken.ron"), text).unwrap();
    let words = ["broken.ron:5:17", "broken.ron:8:18", "broken.ron:14:31"];
    refused(folder.path(), &["check", "broken.ron"], 2, &words);
}

#[test]
fn files_that_are_no_scenarios() {
    let folder = small();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    write("empty.ron", b"");
    write("binary.ron", &[0xff, 0xfe, 0x00, 0x80, 0xc3, 0x28]);
    write("control.ron", b"(title: \"a\0b\", \x01\x02)");
    write("orphan.ron", b"(base: \"nowhere.ron\")");
    write("a.ron", b"(base: \"b.ron\")");
    write("b.ron", b"(base: \"a.ron\")");
    write("deep.ron", "(".repeat(100_000).as_bytes());
    let cases: [(&str, &[&str]); 9] = [
        (
            "nowhere.ron",
            &["`nowhere.ron` cannot be read", "check the name"],
        ),
        (".", &["`.` cannot be read", "not its folder"]),
        (
            "empty.ron",
            &[
                "empty.ron:1:1",
                "expected a value, found the end",
                "values look like",
            ],
        ),
        (
            "binary.ron",
            &["`binary.ron` cannot be read", "a text in UTF-8"],
        ),
        (
            "control.ron",
            &[
                "control.ron:1:16",
                "are mixed",
                "write every field as `name: value`",
            ],
        ),
        (
            "orphan.ron",
            &[
                "orphan.ron:1:8",
                "`base`",
                "no file `nowhere.ron`",
                "relative to the folder",
            ],
        ),
        (
            "a.ron",
            &[
                "b.ron:1:8",
                "`base`",
                "derived from itself",
                "break the circle",
            ],
        ),
        ("small.ron/x", &["cannot be read"]),
        (
            "deep.ron",
            &["deep.ron:1:61", "nested more than 60 deep", "brackets"],
        ),
    ];
    for (file, words) in cases {
        for command in ["check", "run"] {
            refused(folder.path(), &[command, file], 2, words);
        }
    }
}
