//! Sweeps: the same table whatever the threads, shares and interruptions; a failing job is a row; bad input is told
//! before anything runs, and nothing of different sweeps is mixed.

mod program;

use parquet::file::reader::{FileReader, SerializedFileReader};
use program::{command, refused, run, small, stderr, works};
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const STEADY: [&str; 2] = ["--set", "solver=Steady()"];
const FORCES: &str = "forcing[0].apply.force[0]=0..0.02:3";
const LENGTHS: &str = "rods[0].length=0.08..0.12:2";

/// The rows of a table as texts, without the column of seconds.
fn rows(table: &Path) -> Vec<Vec<String>> {
    let reader = SerializedFileReader::new(File::open(table).expect("a table")).expect("whole");
    let rows = reader.get_row_iter(None).expect("rows");
    rows.map(|row| {
        let columns = row.expect("a row").into_columns();
        let kept = columns.into_iter().filter(|(name, _)| name != "seconds");
        // Debug of a double is exact
        kept.map(|(name, value)| format!("{name}={value:?}"))
            .collect()
    })
    .collect()
}

fn sweep<'a>(options: &[&'a str]) -> Vec<&'a str> {
    let sweep = ["sweep", "small.ron"].into_iter().chain(STEADY);
    sweep.chain(options.iter().copied()).collect()
}

fn grid<'a>(options: &[&'a str]) -> Vec<&'a str> {
    let grid = ["--over", FORCES, "--over", LENGTHS];
    sweep(
        &grid
            .into_iter()
            .chain(options.iter().copied())
            .collect::<Vec<_>>(),
    )
}

#[test]
fn threads_shares_and_interruptions_change_no_bit() {
    let folder = small();
    let path = |name: &str| folder.path().join(name);
    let text = works(folder.path(), &grid(&["--jobs", "1", "--out", "one"]));
    assert!(text.contains("6 jobs: 6 good, 0 failed"), "{text}");
    let expected = rows(&path("one/table.parquet"));
    assert_eq!(expected.len(), 6);
    assert!(
        expected[3][1].contains("0.01") && expected[3][2].contains("0.12"),
        "{expected:?}"
    );
    assert!(expected[0] != expected[2], "the force changes nothing");

    works(folder.path(), &grid(&["--jobs", "3", "--out", "three"]));
    assert_eq!(rows(&path("three/table.parquet")), expected);

    for shard in ["2/4", "1/4", "4/4"] {
        works(folder.path(), &grid(&["--shard", shard, "--out", "shares"]));
    }
    let missing = ["1 of 6 jobs aren't done", "job 2"];
    refused(folder.path(), &["merge", "shares"], 1, &missing);
    works(
        folder.path(),
        &grid(&["--shard", "3/4", "--out", "elsewhere"]),
    );
    works(
        folder.path(),
        &["merge", "shares", "elsewhere", "--out", "t.parquet"],
    );
    assert_eq!(rows(&path("t.parquet")), expected);

    // A process that was killed has left a line without an end; its job is done again.
    let log = path("one/part-1-of-1.jsonl");
    let whole = fs::read_to_string(&log).unwrap();
    fs::write(&log, &whole[..whole.len() - 40]).unwrap();
    refused(folder.path(), &["merge", "one"], 1, &["1 of 6 jobs"]);
    let output = run(folder.path(), &grid(&["--out", "one"]));
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("5 of 6 jobs were done before"));
    assert_eq!(rows(&path("one/table.parquet")), expected);
}

#[test]
fn an_interrupted_sweep_goes_on() {
    let folder = small();
    let long = |out| {
        let grid = [
            "--over",
            "forcing[0].apply.force[0]=0..0.02:40",
            "--jobs",
            "2",
            "--out",
            out,
        ];
        let sets = ["sweep", "small.ron", "--set", "solver.duration=3"];
        sets.into_iter().chain(grid).collect::<Vec<_>>()
    };
    let mut child = command(folder.path(), &long("stopped"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let log = folder.path().join("stopped/part-1-of-1.jsonl");
    let start = Instant::now();
    while fs::metadata(&log).map_or(0, |m| m.len()) < 500 {
        assert!(start.elapsed() < Duration::from_secs(60), "nothing is kept");
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(Duration::from_millis(5));
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
    program::told(&output, 130, &["jobs left", "the same command goes on"]);
    works(folder.path(), &long("stopped"));
    works(folder.path(), &long("whole"));
    let [a, b] =
        ["stopped", "whole"].map(|out| rows(&folder.path().join(out).join("table.parquet")));
    assert_eq!(a.len(), 40);
    assert_eq!(a, b);
}

#[test]
fn a_failing_job_is_a_row_with_its_reason() {
    let folder = small();
    fs::write(
        folder.path().join("jobs.csv"),
        "forcing[0].apply.force[0],rods[0].length\n0.01,0.1\n1e9,0.1\n0.01,-1\n0.02,0.1\n",
    )
    .unwrap();
    let arguments = sweep(&["--list", "jobs.csv", "--out", "failing", "--quiet"]);
    let output = run(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("2 of 4 jobs failed"),
        "{}",
        stderr(&output)
    );
    let rows = rows(&folder.path().join("failing/table.parquet"));
    assert_eq!(rows.len(), 4);
    for (row, (status, reason)) in rows.iter().zip([
        ("good", "Null"),
        ("failed", "no steady state"),
        (
            "failed",
            "rods[0].length: expected a positive finite number, found -1",
        ),
        ("good", "Null"),
    ]) {
        assert!(
            row[3].contains(status) && row[4].contains(reason),
            "{row:?}"
        );
    }
}

#[test]
fn tied_paths_wildcards_and_latin_hypercubes() {
    let folder = small();
    let tied = "forcing[*].apply.force[0], forcing[0].apply.force[1]=0.01..0.02:2";
    works(folder.path(), &sweep(&["--over", tied, "--out", "tied"]));
    let table = rows(&folder.path().join("tied/table.parquet"));
    assert!(table[1][1].starts_with("forcing[*].apply.force[0], forcing[0].apply.force[1]="));
    let bent = |row: &[String], axis: &str| {
        let column = row
            .iter()
            .find(|c| c.starts_with(&format!("position_{axis}_m")));
        let number = column
            .and_then(|c| c.split(['(', ')']).nth(1))
            .expect("a number");
        number.parse::<f64>().expect("a number")
    };
    let (x, y) = (bent(&table[1], "x"), bent(&table[1], "y"));
    assert!(x > 1e-5 && (x - y).abs() < 1e-9, "{x} {y}");

    let latin = |seed, out| {
        let ranges = [
            "--over",
            "forcing[0].apply.force[0]=0..1e-2",
            "--over",
            "rods[0].length=0.1..0.2",
        ];
        let options = ["--latin", "5", "--seed", seed, "--out", out];
        works(folder.path(), &sweep(&[&ranges[..], &options].concat()));
        let list = fs::read_to_string(folder.path().join(out).join("jobs.csv")).unwrap();
        let rows = list
            .lines()
            .skip(1)
            .map(|l| l.split(',').map(|v| v.parse().unwrap()).collect());
        rows.collect::<Vec<Vec<f64>>>()
    };
    let (a, b, c) = (latin("1", "a"), latin("1", "b"), latin("2", "c"));
    assert_eq!(a, b);
    assert!(a != c);
    for (column, from, width) in [(0, 0.0, 1e-2), (1, 0.1, 0.1)] {
        let mut parts: Vec<_> = a
            .iter()
            .map(|r| ((r[column] - from) / width * 5.0) as usize)
            .collect();
        parts.sort_unstable();
        assert_eq!(parts, [0, 1, 2, 3, 4]);
    }
    // The list of a sweep is one that `--list` takes.
    works(
        folder.path(),
        &sweep(&["--list", "a/jobs.csv", "--out", "again"]),
    );
    let tables = ["a", "again"].map(|out| rows(&folder.path().join(out).join("table.parquet")));
    assert_eq!(tables[0], tables[1]);
}

#[test]
fn bad_ranges_and_lists_are_told_before_anything_runs() {
    let folder = small();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write(
        "ragged.csv",
        "rods[0].length,rods[0].radius\n0.1,0.01\n0.1\n",
    );
    write("words.csv", "rods[0].length\n0.1\nlong\n");
    write("header.csv", "rods[0].length\n");
    write("twice.csv", "rods[0].length,rods[*].length\n0.1,0.1\n");
    let over: [(&str, &[&str]); 13] = [
        (
            "rods[0].length=0.1..0.1:3",
            &["the range is empty", "`--set path=value`"],
        ),
        ("rods[0].length=0.1..0.2:0", &["2 values or more, not 0"]),
        (
            "rods[0].length=0.1..0.2:-3",
            &["expected a whole number of values"],
        ),
        (
            "rods[0].length=0.1..0.2",
            &["how many values", "`--latin N`"],
        ),
        (
            "rods[0].length=0.2..0.1:3",
            &["runs backwards", "the smaller number first"],
        ),
        ("rods[0].length=0.1..NaN:3", &["two finite numbers"]),
        (
            "rods[0].length",
            &["expected `=` and a range", "for example"],
        ),
        (
            "rods[7].length=0.1..0.2:3",
            &["--over rods[7]", "`rods` has no [7]"],
        ),
        ("rods[0].lenght=0.1..0.2:3", &["did you mean `length`?"]),
        (
            "rods[0].name=0.1..0.2:3",
            &["`rods[0].name` isn't a number but `\"rod\"`"],
        ),
        ("rods[0].material=0.1..0.2:3", &["isn't a number"]),
        (
            "rods[0].length, rods[*].length=0.1..0.2:3",
            &["`rods[0].length` is meant twice"],
        ),
        ("rods[0].length=0.1..0.2:9999999999", &["too many"]),
    ];
    for (range, words) in over {
        refused(folder.path(), &sweep(&["--over", range]), 2, words);
    }
    let cases: [(&[&str], &[&str]); 11] = [
        (
            &[
                "--over",
                "rods[0].length=1..2:2",
                "--over",
                "rods[*].length=1..2:2",
            ],
            &["`rods[0].length` is changed twice"],
        ),
        (
            &["--over", "rods[0].length=1..2:2", "--latin", "5"],
            &["`:2` has no meaning"],
        ),
        (
            &["--over", "rods[0].length=1..2", "--latin", "0"],
            &["--latin"],
        ),
        (&["--over", FORCES, "--jobs", "0"], &["--jobs"]),
        (&["--over", FORCES, "--shard", "0/4"], &["1/4 to 4/4"]),
        (&["--over", FORCES, "--shard", "5/4"], &["1/4 to 4/4"]),
        (&["--list", "nowhere.csv"], &["nowhere.csv", "No such file"]),
        (&["--list", "ragged.csv"], &["ragged.csv", "line: 3"]),
        (
            &["--list", "words.csv"],
            &["words.csv", "line 3, column `rods[0].length`: `long`"],
        ),
        (&["--list", "header.csv"], &["no row of numbers"]),
        (
            &["--list", "twice.csv"],
            &["`rods[0].length` is changed twice"],
        ),
    ];
    for (options, words) in cases {
        refused(folder.path(), &sweep(options), 2, words);
    }
    assert!(!folder.path().join("out").exists(), "results were begun");
}

#[test]
fn nothing_of_other_sweeps_is_mixed_in() {
    let folder = small();
    works(folder.path(), &grid(&["--out", "a"]));
    let scenario = grid(&["--out", "a", "--set", "rods[0].radius=0.011"]);
    refused(
        folder.path(),
        &scenario,
        2,
        &["another scenario", "give another `--out`"],
    );
    let list = sweep(&["--over", FORCES, "--out", "a"]);
    refused(
        folder.path(),
        &list,
        2,
        &["another list of jobs", "jobs.csv"],
    );
    works(folder.path(), &sweep(&["--over", FORCES, "--out", "b"]));
    refused(
        folder.path(),
        &["merge", "a", "b"],
        2,
        &["b: it is the folder of another sweep"],
    );

    let log = |out: &str| folder.path().join(out).join("part-1-of-1.jsonl");
    fs::copy(log("b"), folder.path().join("a/part-2-of-2.jsonl")).unwrap();
    refused(
        folder.path(),
        &["merge", "a"],
        2,
        &["part-2-of-2.jsonl, line 1", "another sweep"],
    );
    fs::remove_file(folder.path().join("a/part-2-of-2.jsonl")).unwrap();

    let before = fs::read(folder.path().join("b/table.parquet")).unwrap();
    let text = fs::read_to_string(log("b")).unwrap();
    fs::write(log("b"), text.replacen("\"job\":1", "\"job\":", 1)).unwrap();
    refused(
        folder.path(),
        &["merge", "b"],
        2,
        &["part-1-of-1.jsonl, line ", "delete this line"],
    );
    assert_eq!(
        fs::read(folder.path().join("b/table.parquet")).unwrap(),
        before
    );

    fs::write(folder.path().join("file"), "kept").unwrap();
    let below = grid(&["--out", "file/x"]);
    refused(folder.path(), &below, 1, &["can't use file/x", "has room"]);
    refused(
        folder.path(),
        &["merge", "nowhere"],
        2,
        &["nowhere/scenario.ron"],
    );
    assert_eq!(
        fs::read_to_string(folder.path().join("file")).unwrap(),
        "kept"
    );
}
