//! Diagnoses that can't be: exit code 2 with file, field and remedy, nothing on stdout, and results of before stay as they
//! were.

mod common;
mod program;

use auxetica::config::Source;
use auxetica::identify::Robot;
use common::made::recorded;
use program::{refused, shipped};
use std::fs;
use std::path::{Path, PathBuf};

const MOCAP: &str = "mocap_frame_data_history.csv";
const PRESENT: &str = "present_positions_history.csv";
const TARGETS: [&str; 3] = ["d.json", "d.html", "d.ron"];

/// A folder with recordings `a`, `b` and `c`.
fn recordings() -> tempfile::TempDir {
    let source = Source::load(&shipped("hsa_robot_concealed.ron"), &[]);
    let source = source.unwrap_or_else(|e| panic!("{e}"));
    let robot = Robot::of(&source).unwrap_or_else(|e| panic!("{e}"));
    let recording = recorded(&source, &robot).unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["a", "b", "c"] {
        recording.write(folder.path().join(name)).expect("written");
    }
    for target in TARGETS {
        fs::write(folder.path().join(target), "as it was").expect("written");
    }
    folder
}

/// Changes the fields of every row of a file.
fn edit(file: &Path, change: impl Fn(&[&str]) -> Vec<String>) {
    let text = fs::read_to_string(file).expect("a table");
    let rows = text.lines().map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        change(&fields).join(",") + "\n"
    });
    fs::write(file, rows.collect::<String>()).expect("written");
}

fn scaled(fields: &[&str], from: usize, factor: f64) -> Vec<String> {
    let scale = |(i, field): (usize, &&str)| match i < from {
        true => (*field).to_owned(),
        false => format!("{:?}", factor * field.parse::<f64>().expect("a number")),
    };
    fields.iter().enumerate().map(scale).collect()
}

fn order(fields: &[&str], order: &[usize]) -> Vec<String> {
    order.iter().map(|i| fields[*i].to_owned()).collect()
}

#[track_caller]
fn refuse(folder: &Path, scenario: &Path, more: &[&str], words: &[&str]) {
    let scenario = scenario.to_str().expect("plain");
    let mut arguments = vec!["-q", "diagnose", scenario, "--effects", "gravity"];
    arguments.extend([
        "--json",
        TARGETS[0],
        "--report",
        TARGETS[1],
        "--write-scenario",
        TARGETS[2],
    ]);
    arguments.extend(more);
    refused(folder, &arguments, 2, words);
    for target in TARGETS {
        let text = fs::read_to_string(folder.join(target)).expect("it is there");
        assert_eq!(text, "as it was", "{target} was touched");
    }
}

fn robot() -> PathBuf {
    shipped("hsa_robot_concealed.ron")
}

const GIVEN: [&str; 5] = ["--train", "a", "b", "--holdout", "c"];

#[test]
fn recordings_in_other_units_or_of_another_order_are_told() {
    type Change = fn(&[&str]) -> Vec<String>;
    let cases: [(&str, Change, &[&str]); 10] = [
        (
            MOCAP,
            |f| scaled(f, 2, 0.0),
            &[MOCAP, "line 1", "quaternion"],
        ),
        (
            MOCAP,
            |f| scaled(f, 6, 0.0),
            &["`a`", MOCAP, "positions are in m"],
        ),
        (
            MOCAP,
            |f| scaled(f, 6, 1e3),
            &["`a`", MOCAP, "in mm and not in m"],
        ),
        (
            MOCAP,
            |f| scaled(f, 6, 39.37),
            &["`a`", MOCAP, "in inches and not in m"],
        ),
        (
            MOCAP,
            |f| order(f, &[0, 1, 5, 2, 3, 4, 6, 7, 8]),
            &["`a`", MOCAP, "x, y, z, w"],
        ),
        (
            PRESENT,
            |f| scaled(f, 0, 0.0),
            &["`a`", PRESENT, "no more than 0.0 ticks"],
        ),
        (
            PRESENT,
            |f| scaled(f, 0, std::f64::consts::TAU / 4096.0),
            &["`a`", PRESENT, "other units"],
        ),
        (
            PRESENT,
            |f| scaled(f, 0, 360.0 / 4096.0),
            &["`a`", "4096 are a turn"],
        ),
        (
            PRESENT,
            |f| order(f, &[1, 2, 3, 0]),
            &["`a`", PRESENT, "another order"],
        ),
        (PRESENT, |f| scaled(f, 0, -1.0), &["`a`"]),
    ];
    for (file, change, words) in cases {
        let folder = recordings();
        for name in ["a", "b", "c"] {
            edit(&folder.path().join(name).join(file), change);
        }
        refuse(folder.path(), &robot(), &GIVEN, words);
    }
    // held-out recordings, too
    let folder = recordings();
    edit(&folder.path().join("c").join(MOCAP), |f| scaled(f, 6, 1e3));
    refuse(
        folder.path(),
        &robot(),
        &GIVEN,
        &["`c`", "in mm and not in m"],
    );
}

#[test]
fn too_few_recordings_or_one_given_twice_are_told() {
    let folder = recordings();
    let cases: [(&[&str], &[&str]); 5] = [
        (
            &["--train", "a", "--holdout", "b"],
            &["two recordings", "--train DIR"],
        ),
        (&["--train", "a", "b"], &["--holdout DIR"]),
        (
            &["--train", "a", "a", "--holdout", "b"],
            &["\"a\" is given twice"],
        ),
        (
            &["--train", "a", "b", "--holdout", "./b"],
            &["is given twice", "--holdout"],
        ),
        (
            &["--train", "a", "b", "--holdout", "nowhere"],
            &["nowhere", "no such folder"],
        ),
    ];
    for (given, words) in cases {
        refuse(folder.path(), &robot(), given, words);
    }
    // before anything is computed
    let scenario = robot();
    let scenario = scenario.to_str().expect("plain");
    let given = [
        &["-q", "diagnose", scenario, "--json", "no/d.json"][..],
        &GIVEN,
    ]
    .concat();
    refused(folder.path(), &given, 2, &["no/d.json", "make the folder"]);
}

#[test]
fn scenarios_that_can_not_be_calibrated_or_are_of_another_robot_are_told() {
    let folder = recordings();
    let set = |value: &str| {
        let uncertain = format!("uncertain=[(name: \"it\", {value})]");
        [&GIVEN[..], &["--set", &uncertain]]
            .concat()
            .iter()
            .map(|a| (*a).to_owned())
            .collect::<Vec<_>>()
    };
    let length = |rest: &str| set(&format!("path: \"rods[0].length\", {rest}"));
    let cases: [(Vec<String>, &[&str]); 5] = [
        (
            length("range: (50, 70)"),
            &["outside the range (50, 70)", "uncertain[0].range"],
        ),
        (
            length("unit: \"N\", range: (0.05, 0.07)"),
            &[
                "unit `N` contradicts the path",
                "`rods[0].length` is in m",
                "uncertain[0].unit",
            ],
        ),
        (
            length("unit: \"m\", range: (0.05, 0.07), prior: (60, 1)"),
            &["mean 60 is outside the range", "uncertain[0].prior"],
        ),
        (
            set("path: \"rods[0].lenght\", range: (0, 1)"),
            &["lenght", "uncertain[0].path"],
        ),
        (
            [&GIVEN[..], &["--set", "uncertain=[]"]]
                .concat()
                .iter()
                .map(|a| (*a).to_owned())
                .collect(),
            &["declares nothing under `uncertain`"],
        ),
    ];
    for (given, words) in &cases {
        let given: Vec<&str> = given.iter().map(String::as_str).collect();
        refuse(folder.path(), &robot(), &given, words);
    }
    let three = shipped("hsa_robot_three_rods.ron");
    let length = [
        "--set",
        "uncertain=[(name: \"length\", path: \"rods[0].length\", range: (0.01, 1))]",
    ];
    let given = [&GIVEN[..], &length].concat();
    refuse(
        folder.path(),
        &three,
        &given,
        &["no marker `ring`", "add one under `markers`"],
    );
    let six = [
        "--set",
        "rods[0].length=0.3",
        "--set",
        "cylinders[0].centre=(0, 0, 0.35)",
    ];
    let given = [
        &GIVEN[..],
        &six,
        &[
            "--set",
            "uncertain=[(name: \"length\", path: \"rods[0].length\", range: (0.01, 1))]",
        ],
    ]
    .concat();
    refuse(
        folder.path(),
        &robot(),
        &given,
        &[
            "on recording `",
            "give the scenario of the robot that was recorded",
        ],
    );
}
