//! Runs that fail: the exit code says whose fault it was, stderr says when, where and what to do, and rows recorded
//! until then, or files of before, are kept whole.

mod program;

use program::{JOINED, command, refused, run, small, stderr, told, works};
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The number of rows of a CSV file, each checked to have all fields of the header.
fn whole_rows(path: &Path) -> usize {
    let text = fs::read_to_string(path).expect("a table");
    assert!(text.ends_with('\n'), "the last row is cut");
    let mut rows = csv::Reader::from_reader(text.as_bytes());
    rows.records()
        .inspect(|row| assert!(row.is_ok(), "{row:?}"))
        .count()
}

#[test]
fn a_step_beyond_the_stability_limit_leaves_results_as_they_were() {
    let folder = small();
    works(folder.path(), &["run", "small.ron"]);
    let files = ["out/small/rod.csv", "out/small/scenario.ron"];
    let before = files.map(|file| fs::read(folder.path().join(file)).unwrap());
    // Steps of 10 s are so long that damping lets nothing move at all, which isn't stability.
    for dt in ["1e-3", "10"] {
        let set = format!("solver.dt={dt}");
        let words = [
            &*format!("--set {set}:1:11"),
            "beyond the stability limit of 2.6",
            "or `Auto`",
        ];
        refused(
            folder.path(),
            &["run", "small.ron", "--set", &set],
            2,
            &words,
        );
    }
    let after = files.map(|file| fs::read(folder.path().join(file)).unwrap());
    assert!(before == after, "results were replaced by nothing");
}

#[test]
fn a_blow_up_says_when_where_and_why_and_keeps_its_rows() {
    let folder = small();
    // quiet: who insists on an unstable step is warned of it first
    let mut arguments = vec!["run", "-q", "small.ron", "--set", "callbacks[0].on=\"rod\""];
    for set in JOINED {
        arguments.extend(["--set", set]);
    }
    for set in [
        "solver.dt=1e-3",
        "solver.unstable=true",
        "solver.duration=10",
    ] {
        arguments.extend(["--set", set]);
    }
    let words = [
        "blew up at t = ",
        "step ",
        "body `",
        "node ",
        "largest stable time step",
    ];
    let text = refused(folder.path(), &arguments, 1, &words);
    let (_, steps) = text.split_once(", step ").expect("told");
    let (steps, _) = steps.split_once(':').expect("told");
    let steps: usize = steps.parse().expect("a number of steps");
    assert!(steps > 3, "{text}");
    assert_eq!(
        whole_rows(&folder.path().join("out/small/rod.csv")),
        11 * steps
    );
}

#[test]
fn a_rod_that_is_no_rod_any_more_has_blown_up() {
    // Its numbers stay finite: elements are turned at random, or torn a thousandfold.
    for set in [
        "solver.dt=1e-3",
        "forcing[0].apply=EndForce(force: (1e5, 0, 0))",
    ] {
        let folder = small();
        let mut arguments = vec!["run", "-q", "small.ron", "--set", "solver.unstable=true"];
        arguments.extend(["--set", "solver.duration=10", "--set", set]);
        let words = ["blew up at t = ", "body `rod`, node ", "its element"];
        refused(folder.path(), &arguments, 1, &words);
        whole_rows(&folder.path().join("out/small/rod.csv"));
    }
}

#[test]
fn a_load_that_explodes_later_keeps_the_rows_before() {
    let folder = small();
    let set = "forcing[0].apply=EndForce(force: (1e300, 0, 0), scale: Table([(0, 0), (0.01, 0), (0.0101, 1e5)]))";
    let text = refused(
        folder.path(),
        &["run", "small.ron", "--set", set],
        1,
        &["blew up at t = 0.010", "`rod`", "node "],
    );
    assert!(text.contains("not finite"), "{text}");
    let rows = whole_rows(&folder.path().join("out/small/rod.csv"));
    assert!((10 * 11..=12 * 11).contains(&rows), "{rows}");
}

#[test]
fn unwritable_results() {
    let folder = small();
    fs::write(folder.path().join("file"), "kept").unwrap();
    let below = folder.path().join("file/a.csv");
    let below = format!("callbacks[0].apply.file={:?}", below.display().to_string());
    let full = "callbacks[0].apply.file=\"/dev/full\"";
    let twice = "callbacks=[(apply: Csv(file: \"a.csv\")), (apply: Csv(file: \"a.csv\"))]";
    let cases: [(&[&str], &[&str]); 4] = [
        (
            &["--out", "file/x"],
            &["can't write file/x", "check that the folder exists"],
        ),
        (
            &["--set", &below],
            &[
                "writing ",
                "file/a.csv",
                "there can be no folder",
                "give another `file`",
            ],
        ),
        (
            &["--set", full],
            &["writing /dev/full", "No space left", "has room"],
        ),
        (
            &["--set", twice],
            &[
                "a.csv",
                "another recorder is writing it",
                "give another `file`",
            ],
        ),
    ];
    for (options, words) in cases {
        let arguments: Vec<_> = ["run", "small.ron"]
            .iter()
            .chain(options)
            .copied()
            .collect();
        refused(folder.path(), &arguments, 1, words);
    }
    assert_eq!(
        fs::read_to_string(folder.path().join("file")).unwrap(),
        "kept"
    );
}

#[test]
fn an_interrupted_run_keeps_its_rows() {
    let folder = small();
    let arguments = [
        "run",
        "small.ron",
        "--set",
        "solver.duration=1e6",
        "--set",
        "callbacks[0].every=0.1",
    ];
    let mut child = command(folder.path(), &arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let table = folder.path().join("out/small/rod.csv");
    let start = Instant::now();
    while fs::metadata(&table).map_or(0, |m| m.len()) < 5000 {
        assert!(
            start.elapsed() < Duration::from_secs(30),
            "nothing is recorded"
        );
        assert!(
            child.try_wait().unwrap().is_none(),
            "the run ended by itself"
        );
        std::thread::sleep(Duration::from_millis(20));
    }
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success()
    );
    let output = child.wait_with_output().unwrap();
    told(
        &output,
        130,
        &["was stopped at t = ", "recorded until then is kept"],
    );
    let rows = whole_rows(&table);
    assert!(rows > 0 && rows.is_multiple_of(11), "{rows} rows");
}

#[test]
fn a_rod_that_nothing_holds_has_no_steady_state() {
    let folder = small();
    let arguments = [
        "run",
        "small.ron",
        "--set",
        "boundary=[]",
        "--set",
        "solver=Steady()",
    ];
    let text = refused(
        folder.path(),
        &arguments,
        1,
        &[
            "no steady state was found at t = 0 s",
            "`rod`",
            "boundary condition",
            "; ",
        ],
    );
    assert!(text.len() < 500, "{text}");
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let folder = small();
    for arguments in [
        &["plugins"][..],
        &["plugins", "Csv"],
        &["run", "small.ron"],
        &["--help"],
    ] {
        let mut child = command(folder.path(), arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let mut text = String::new();
        child
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut text)
            .unwrap();
        let status = child.wait().unwrap();
        assert!(
            status.success() && text.is_empty(),
            "{arguments:?}: {status} {text}"
        );
    }
}

#[test]
fn wrong_arguments() {
    let folder = small();
    refused(
        folder.path(),
        &["frobnicate"],
        2,
        &["unrecognized subcommand 'frobnicate'", "--help"],
    );
    refused(folder.path(), &["run"], 2, &["<SCENARIO>", "Usage"]);
    refused(
        folder.path(),
        &["plugins", "Gravitty"],
        2,
        &["no plugin named `Gravitty`", "did you mean `Gravity`?"],
    );
    let full = fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let status = command(folder.path(), &["plugins"])
        .stdout(full)
        .stderr(Stdio::null())
        .status();
    assert_eq!(status.unwrap().code(), Some(1));
    let quiet = run(folder.path(), &["--quiet", "run", "small.ron"]);
    assert!(quiet.status.success() && stderr(&quiet).is_empty());
}
