//! Broken recordings and comparisons that can't be: exit code 2 with the file, line and field, nothing on stdout, and
//! a result of before stays as it was.

mod program;

use auxetica::recordings::{Mocap, Pose, Recording, Track};
use nalgebra::{Translation3, UnitQuaternion};
use program::{refused, shipped, small};
use std::fs;
use std::path::Path;

const TIME: &str = "experiment_time_history.csv";
const PRESENT: &str = "present_positions_history.csv";
const MOCAP: &str = "mocap_frame_data_history.csv";
const ROWS: usize = 12;

fn still(height: f64) -> Track {
    let pose = Pose::from_parts(
        Translation3::new(0.0, height, 0.0),
        UnitQuaternion::identity(),
    );
    Track::new(std::iter::repeat_n(pose, ROWS))
}

/// A robot that doesn't move.
fn recording(folder: &Path) {
    let recording = Recording {
        name: "still".into(),
        time: (0..ROWS).map(|row| 1.0 + row as f64 * 0.1).collect(),
        goal: vec![[0.0; 4]; ROWS],
        present: vec![[0.0; 4]; ROWS],
        velocities: vec![[0.0; 4]; ROWS],
        loads: vec![[0.0; 4]; ROWS],
        mocap: Some(Mocap {
            base: still(0.01),
            platform: still(0.12),
            ring: still(0.06),
        }),
    };
    recording.write(folder).expect("written");
}

fn line(number: usize, new: &str) -> impl Fn(&str) -> String {
    move |text| {
        let lines = text.lines().enumerate();
        lines
            .map(|(i, line)| format!("{}\n", if i + 1 == number { new } else { line }))
            .collect()
    }
}

#[test]
fn broken_files_are_told_at_their_line() {
    let robot = shipped("hsa_robot_recorded.ron");
    let robot = robot.to_str().expect("plain");
    type Change = Box<dyn Fn(&str) -> String>;
    let cut = |text: &str| text[..text.len() - 1].to_owned();
    let half = |text: &str| text.lines().take(6).map(|l| format!("{l}\n")).collect();
    let cases: [(&str, Change, &[&str]); 9] = [
        (
            PRESENT,
            Box::new(cut),
            &["line 12", "cut off", "restore the file"],
        ),
        (
            PRESENT,
            Box::new(half),
            &["6 samples, but 12 times", "restore the cut one"],
        ),
        (
            PRESENT,
            Box::new(line(4, "1,2,3")),
            &["line 4", "3 columns where 4 are expected", "mend the line"],
        ),
        (
            PRESENT,
            Box::new(line(4, "1,NaN,3,4")),
            &["line 4, column 2 (motor 2)", "not finite", "drop this row"],
        ),
        (
            PRESENT,
            Box::new(line(4, "1,2,x,4")),
            &[
                "line 4, column 3 (motor 3)",
                "\"x\" is not a number",
                "mend",
            ],
        ),
        (
            TIME,
            Box::new(line(5, "0.5")),
            &["line 5", "does not come after", ";"],
        ),
        (
            TIME,
            Box::new(|_| String::new()),
            &["is empty", "restore it"],
        ),
        (
            MOCAP,
            Box::new(line(2, "1,2,0.5,0,0,0.5,0,0.1,0")),
            &["line 2", "quaternion", ";"],
        ),
        (
            MOCAP,
            Box::new(line(2, "1,9,0,0,0,1,0,0.1,0")),
            &["line 2", "9", ";"],
        ),
    ];
    for (file, change, words) in cases {
        let folder = small();
        let path = folder.path().join("rec");
        recording(&path);
        let text = fs::read_to_string(path.join(file)).unwrap();
        fs::write(path.join(file), change(&text)).unwrap();
        fs::write(folder.path().join("result.json"), "before").unwrap();
        let arguments = [
            "compare",
            robot,
            "--recording",
            "rec",
            "--json",
            "result.json",
        ];
        let told = refused(folder.path(), &arguments, 2, words);
        assert!(told.contains(file), "{told}");
        let kept = fs::read_to_string(folder.path().join("result.json")).unwrap();
        assert_eq!(kept, "before");
    }
}

#[test]
fn comparisons_that_can_not_be() {
    let folder = small();
    let at = |name: &str| folder.path().join(name);
    recording(&at("rec"));
    recording(&at("blind"));
    fs::remove_file(at("blind").join(MOCAP)).unwrap();
    recording(&at("partial"));
    fs::remove_file(at("partial").join(PRESENT)).unwrap();
    let robot = shipped("hsa_robot_recorded.ron");
    let robot = robot.to_str().expect("plain");
    let cases: [(&[&str], &[&str]); 7] = [
        (
            &[robot, "--recording", "nowhere"],
            &["nowhere", "no such folder", "give the folder"],
        ),
        (&[robot, "--recording", "small.ron"], &["small.ron"]),
        (
            &[robot, "--recording", "partial"],
            &[PRESENT, "missing", "restore it"],
        ),
        (
            &[robot, "--recording", "blind"],
            &["no motion capture", MOCAP, "inverse_kinematics_results"],
        ),
        (
            &[robot, "--recording", "blind", "--mode", "dynamic"],
            &["motion capture"],
        ),
        (
            &["small.ron", "--recording", "rec"],
            &["no marker `platform`", "add one under `markers`"],
        ),
        (
            &[robot, "--recording", "rec", "--until", "0.5"],
            &["no sample to compare"],
        ),
    ];
    for (options, words) in cases {
        let arguments: Vec<_> = ["compare"].iter().chain(options).copied().collect();
        refused(folder.path(), &arguments, 2, words);
    }
}
