//! Running the program, for tests of what people see.
#![allow(dead_code, reason = "each test uses some of it")]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A clamped rod under a force at its tip, for 20 ms.
pub const SMALL: &str = r#"(
    title: "small",
    rods: [(
        name: "rod",
        length: 0.1,
        elements: 10,
        radius: 0.01,
        density: 1000,
        material: Moduli(youngs: 1e6, shear: 4e5),
    )],
    boundary: [(apply: Clamp())],
    forcing: [(apply: EndForce(force: (0.01, 0, 0)))],
    damping: [(apply: LinearDamping(translational: (10, 10, 10), rotational: (1e-2, 1e-2, 1e-2)))],
    solver: Dynamic(duration: 0.02),
    callbacks: [(every: 0.001, apply: Csv(file: "rod.csv"))],
)
"#;

/// A platform on a stiff joint above the rod of [`SMALL`]; too long a step makes its springs swing up without bound.
pub const JOINED: [&str; 2] = [
    r#"cylinders=[(name: "platform", centre: (0, 0, 0.11), radius: 0.02, thickness: 0.01, mass: 0.01)]"#,
    r#"joints=[(between: ("rod", "platform"), apply: SpringDamper(stiffness: 5e5))]"#,
];

/// The program with its arguments, to be run in `folder`.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_auxetica"));
    command.args(arguments).current_dir(folder);
    command
}

pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments)
        .output()
        .expect("the program starts")
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

/// Runs what must work and gives its stdout.
pub fn works(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(
        output.status.success(),
        "{arguments:?}: {}",
        stderr(&output)
    );
    stdout(&output)
}

/// Runs what must be refused with this exit code: silent on stdout, no panic, and every one of `words` on stderr.
#[track_caller]
pub fn refused(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) -> String {
    let output = run(folder, arguments);
    told(&output, code, words)
}

#[track_caller]
pub fn told(output: &Output, code: i32, words: &[&str]) -> String {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(code), "{text}");
    assert!(output.stdout.is_empty(), "{}", stdout(output));
    assert!(text.starts_with("error: "), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is missing from:\n{text}");
    }
    text
}

/// A folder that holds `small.ron`.
pub fn small() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("small.ron"), SMALL).expect("written");
    folder
}

/// A shipped scenario.
pub fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenarios")
        .join(name)
}

/// The shipped scenario of the rod with so many rows.
pub fn rod(rows: u32) -> String {
    let path = shipped(&format!("hsa_rod_{rows}rows.ron"));
    path.to_str().expect("plain").to_owned()
}

/// A number in JSON.
pub fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is a number"))
}

/// A list in JSON.
pub fn list(value: &Value) -> &[Value] {
    value
        .as_array()
        .unwrap_or_else(|| panic!("{value} is a list"))
}
