//! The command line on what is right: the files it says are written, `--set` changes the result, shipped scenarios are
//! good, and a comparison measures nothing where there is nothing and something where there is.

mod program;

use auxetica::compare::make_recording;
use auxetica::config::Source;
use program::{run, shipped, small, stderr, stdout, works};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The recorded robot with few elements, to be quick.
const COARSE: &str = "rods[0].elements=6";
const GRAVITY: &str = "forcing=[(apply: Gravity(g: (9.81, 0, 0)))]";

#[test]
fn run_writes_the_files_it_says() {
    let folder = small();
    let text = works(folder.path(), &["run", "small.ron", "--out", "results"]);
    assert!(text.starts_with("small\n"), "{text}");
    assert!(text.contains("stability limit"), "{text}");
    let written: Vec<_> = text
        .lines()
        .filter_map(|l| l.strip_prefix("written: "))
        .collect();
    assert_eq!(written, ["results/rod.csv"]);
    let mut table = csv::Reader::from_path(folder.path().join(written[0])).unwrap();
    let header = table.headers().unwrap().clone();
    let header: Vec<_> = header.iter().take(3).collect();
    assert_eq!(header, ["time_s", "body", "index"]);
    // 21 times of 11 nodes
    assert_eq!(table.records().inspect(|r| assert!(r.is_ok())).count(), 231);
    // What is kept beside it runs again and gives the same.
    let first = fs::read(folder.path().join("results/rod.csv")).unwrap();
    let again = ["run", "results/scenario.ron", "--out", "again"];
    works(folder.path(), &again);
    assert!(fs::read(folder.path().join("again/rod.csv")).unwrap() == first);
    let names = fs::read_dir(folder.path().join("results")).unwrap();
    assert_eq!(names.count(), 2, "scenario.ron and rod.csv, no leftovers");
}

#[test]
fn the_timoshenko_scenario_gives_its_known_deflection() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = shipped("timoshenko.ron");
    let text = works(folder.path(), &["run", scenario.to_str().expect("plain")]);
    assert!(text.contains("written: out/timoshenko/beam.csv"), "{text}");
    assert!(text.contains("-67."), "{text}");
    assert!(folder.path().join("out/timoshenko/beam.csv").is_file());
}

#[test]
fn set_changes_the_result_and_quiet_is_quiet() {
    let folder = small();
    let tip = |set: &str| {
        let output = run(
            folder.path(),
            &["run", "--quiet", "small.ron", "--set", set],
        );
        assert!(output.status.success() && stderr(&output).is_empty());
        let text = stdout(&output);
        let row = text
            .lines()
            .find(|l| l.trim_start().starts_with("rod"))
            .expect("the tip");
        row.split_whitespace()
            .nth(2)
            .expect("x")
            .parse::<f64>()
            .expect("a number")
    };
    let (once, twice) = (
        tip("title=\"as it is\""),
        tip("forcing[0].apply.force[0]=0.02"),
    );
    assert!(once > 0.1, "{once}");
    assert!((twice / once - 2.0).abs() < 0.02, "{once} {twice}");
}

#[test]
fn shipped_scenarios_are_good() {
    let folder = tempfile::tempdir().unwrap();
    let mut files: Vec<_> = fs::read_dir(shipped(""))
        .unwrap()
        .map(|f| f.unwrap().path())
        .collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "ron"));
    let mut arguments = vec!["check"];
    arguments.extend(files.iter().map(|file| file.to_str().expect("plain")));
    let text = works(folder.path(), &arguments);
    assert_eq!(text.matches(": good (").count(), files.len(), "{text}");
    assert!(files.len() >= 8);
    arguments.push("--quiet");
    assert_eq!(works(folder.path(), &arguments), "");
}

/// `compare --json -` on a recording that the robot itself has made.
fn compared(folder: &Path, options: &[&str]) -> Value {
    let robot = shipped("hsa_robot_recorded.ron");
    if !folder.join("rec").exists() {
        let source = Source::load(&robot, &[COARSE.to_owned()]).expect("good");
        make_recording(&source, &folder.join("rec")).expect("made");
    }
    let mut arguments = vec![
        "compare",
        robot.to_str().expect("plain"),
        "--recording",
        "rec",
    ];
    arguments.extend(["--json", "-", "--set", COARSE]);
    arguments.extend(options);
    serde_json::from_str(&works(folder, &arguments)).expect("JSON alone on stdout")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn a_model_agrees_with_its_own_recording() {
    let folder = tempfile::tempdir().unwrap();
    let same = compared(folder.path(), &[]);
    assert_eq!(same["recording"], "rec");
    assert_eq!(same["mode"], "steady");
    assert_eq!(same["samples"], 20);
    assert_eq!(same["unsolved"], 0);
    let bodies = same["bodies"].as_array().expect("a list");
    assert_eq!(bodies.len(), 2);
    for (body, name) in bodies.iter().zip(["platform", "ring"]) {
        let mut keys: Vec<_> = body.as_object().expect("an object").keys().collect();
        keys.sort();
        assert_eq!(
            keys,
            [
                "name",
                "position_bias_mm",
                "position_rmse_mm",
                "rotation_rmse_mrad",
                "worst"
            ]
        );
        assert_eq!(body["name"], name);
        assert!(number(&body["position_rmse_mm"]) < 0.05, "{body}");
        assert!(number(&body["rotation_rmse_mrad"]) < 1.0, "{body}");
        assert_eq!(body["position_bias_mm"].as_array().map(Vec::len), Some(3));
        let worst = &body["worst"];
        assert!(worst["sample"].is_u64(), "{worst}");
        assert!(
            number(&worst["time_s"]) >= 1.0 && number(&worst["position_mm"]) < 0.1,
            "{worst}"
        );
    }
    let every_row = compared(folder.path(), &["--mode", "quasistatic"]);
    assert_eq!(every_row["mode"], "quasistatic");
    assert!(every_row["samples"].as_u64() > Some(200), "{every_row}");
    let platform = &every_row["bodies"][0];
    assert!(number(&platform["position_rmse_mm"]) < 0.05, "{platform}");
    let other = compared(folder.path(), &["--set", GRAVITY]);
    let platform = &other["bodies"][0];
    assert!(number(&platform["position_rmse_mm"]) > 0.2, "{platform}");
}

#[test]
fn a_comparison_is_shown_written_and_cut() {
    let folder = tempfile::tempdir().unwrap();
    let until = compared(folder.path(), &["--mode", "dynamic", "--until", "1.3"]);
    assert_eq!(until["mode"], "dynamic");
    // rows at 1, 1.108 and 1.216 s
    assert_eq!(until["samples"], 3);
    assert!(number(&until["bodies"][0]["position_rmse_mm"]).is_finite());
    let robot = shipped("hsa_robot_recorded.ron");
    let robot = robot.to_str().expect("plain");
    let json = [
        "compare",
        robot,
        "--recording",
        "rec",
        "--until",
        "5",
        "--set",
        COARSE,
        "--json",
        "result.json",
    ];
    let text = works(folder.path(), &json);
    for words in ["platform", "ring", "RMSE [mm]", "against recording rec"] {
        assert!(text.contains(words), "{text}");
    }
    let result = fs::read_to_string(folder.path().join("result.json")).unwrap();
    assert!(serde_json::from_str::<Value>(&result).is_ok(), "{result}");
    // What can't be written leaves no part of itself.
    fs::create_dir(folder.path().join("taken")).unwrap();
    let mut arguments = json;
    arguments[9] = "taken";
    let output = run(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("can't write taken"),
        "{}",
        stderr(&output)
    );
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        3,
        "rec, result.json, taken"
    );
    assert_eq!(
        fs::read_to_string(folder.path().join("result.json")).unwrap(),
        result
    );
}

#[test]
fn without_arguments_or_data_it_makes_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("empty")).unwrap();
    let output = program::command(folder.path(), &[])
        .env("AUXETICA_DATA", "empty")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let notice = stderr(&output);
    assert!(
        notice.contains("a recording that Auxetica makes itself"),
        "{notice}"
    );
    assert!(notice.contains("set AUXETICA_DATA"), "{notice}");
    let text = stdout(&output);
    assert!(
        text.contains("platform") && text.contains("Try next:"),
        "{text}"
    );
    assert!(folder.path().join("out/made_by_auxetica").is_dir());
}

#[test]
fn check_tells_the_stability_limit_and_what_sets_it() {
    let folder = small();
    let text = works(folder.path(), &["check", "small.ron"]);
    let words = ["stability limit 2.6", "set by bending", "most in `rod`"];
    assert!(words.iter().all(|w| text.contains(w)), "{text}");
    // A joint that is stiffer than the rod takes over.
    let mut arguments = vec!["check", "small.ron"];
    for set in program::JOINED {
        arguments.extend(["--set", set]);
    }
    let text = works(folder.path(), &arguments);
    assert!(
        text.contains("set by SpringDamper (joints[0].apply)"),
        "{text}"
    );
}

#[test]
fn a_time_step_close_to_the_limit_is_warned_of() {
    let folder = small();
    let run = |dt| run(folder.path(), &["run", "small.ron", "--set", dt]);
    let close = run("solver.dt=2.55e-4");
    assert!(close.status.success());
    assert!(
        stderr(&close).starts_with("warning: the time step"),
        "{}",
        stderr(&close)
    );
    assert!(stdout(&close).contains("close to it"), "{}", stdout(&close));
    for dt in ["solver.dt=Auto", "solver.dt=1e-4"] {
        let good = run(dt);
        assert!(stderr(&good).is_empty(), "{}", stderr(&good));
        assert!(!stdout(&good).contains("close to it"), "{}", stdout(&good));
    }
}
