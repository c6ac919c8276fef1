//! The page of a diagnosis in a browser: a reader sees what counts, nothing is fetched, and no script fails.

mod program;

use program::{shipped, works};
use std::path::Path;
use std::process::Command;

/// A headless Chromium; none if there is none here. Continuous integration (`CI` set) must have it.
fn browser(profile: &Path) -> Option<Command> {
    let found = ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(|name| {
            let asked = Command::new(name).arg("--version").output();
            asked.is_ok_and(|output| output.status.success())
        });
    let Some(name) = found else {
        assert!(
            std::env::var_os("CI").is_none(),
            "Chromium is not there; install it"
        );
        eprintln!("not looked at: Chromium is not there");
        return None;
    };
    let mut command = Command::new(name);
    command.args([
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-quic",
        "--no-first-run",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--enable-logging=stderr",
    ]);
    command.arg(format!("--user-data-dir={}", profile.display()));
    Some(command)
}

/// The text of elements, tags taken out.
fn text(dom: &str) -> String {
    let mut text = String::new();
    let mut inside = false;
    for c in dom.chars() {
        match c {
            '<' => inside = true,
            '>' => (inside, text) = (false, text + " "),
            c if !inside => text.push(c),
            _ => {}
        }
    }
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_reader_of_the_page_sees_the_verdict_the_evidence_and_what_to_do_next() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let Some(mut browser) = browser(&at.join("profile")) else {
        return;
    };
    let spec = include_str!("../scenarios/challenges/small.ron");
    let small = spec
        .replace(
            "../hsa_robot_concealed.ron",
            shipped("hsa_robot_concealed.ron").to_str().expect("plain"),
        )
        .replace("controls: 1, singles: 2", "controls: 0, singles: 1")
        .replace("set_points: 20", "set_points: 8");
    std::fs::write(at.join("spec.ron"), small).expect("written");
    works(at, &["-q", "conceal", "spec.ron", "--out", "c"]);
    let case = |name: &str| format!("c/case_000/{name}");
    let names = auxetica::challenge::RECORDINGS.map(case);
    let [train, holdout] = [&names[..2], &names[2..]];
    let scenario = shipped("hsa_robot_concealed.ron");
    let mut arguments = vec![
        "-q",
        "diagnose",
        scenario.to_str().expect("plain"),
        "--train",
    ];
    arguments.extend(train.iter().map(String::as_str));
    arguments.push("--holdout");
    arguments.extend(holdout.iter().map(String::as_str));
    // one of a few effects, or none of them: the page has the same sections
    arguments.extend(["--effects", "gravity,payload,rod_asymmetry,encoder_scale"]);
    arguments.extend([
        "--report",
        "d.html",
        "--json",
        "d.json",
        "--write-scenario",
        "d.ron",
    ]);
    works(at, &arguments);

    let page = at.join("d.html");
    let url = format!("file://{}", page.display());
    let shown = browser
        .args(["--dump-dom", &url])
        .output()
        .expect("it runs");
    let (dom, log) = (
        String::from_utf8_lossy(&shown.stdout).into_owned(),
        String::from_utf8_lossy(&shown.stderr).into_owned(),
    );
    assert!(shown.status.success(), "{log}");
    assert!(!log.contains("CONSOLE"), "{log}");
    // nothing from elsewhere, nothing that runs
    for outside in [
        "src=", "href=", "@import", "url(http", "<script", "<link", "<iframe",
    ] {
        assert!(!dom.contains(outside), "{outside} is in the page");
    }
    let json = std::fs::read_to_string(at.join("d.json")).expect("it is there");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let seen = text(&dom);
    let words = json["words"].as_str().expect("words");
    assert!(seen.contains(words), "`{words}` is missing from:\n{seen}");
    for heading in [
        "Where",
        "Before and after",
        "Calibrated numbers",
        "The recordings",
        "Do it again",
    ] {
        assert!(dom.contains(&format!("<h2>{heading}</h2>")), "{heading}");
    }
    for name in ["train", "holdout"].into_iter().chain([
        "auxetica -q diagnose",
        "held out",
        "95 %",
        "time [s]",
    ]) {
        assert!(seen.contains(name), "{name}:\n{seen}");
    }
    for recording in program::list(&json["augmented"]["recordings"]) {
        let rmse = format!("{:.3}", program::number(&recording["position_rmse_mm"]));
        assert!(seen.contains(&rmse), "{rmse} mm:\n{seen}");
    }
    for effect in program::list(&json["effects"]) {
        assert!(
            seen.contains(effect["id"].as_str().expect("an id")),
            "{seen}"
        );
    }
    // two pictures, of the error over time and over winding
    assert_eq!(dom.matches("<svg").count(), 2);
}
