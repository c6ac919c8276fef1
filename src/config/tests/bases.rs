//! A file may be derived from another; faults name the file in which they were written.

use std::fs;
use std::path::PathBuf;

use auxetica_config::{Positive, Source};
use serde::Deserialize;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Scenario {
    title: String,
    rods: Vec<Rod>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Rod {
    length: Positive,
    name: String,
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            fs::create_dir_all(folder.path().join(name).parent().unwrap()).unwrap();
            fs::write(folder.path().join(name), text).unwrap();
        }
        Self(folder)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn error(&self, name: &str, sets: &[&str]) -> String {
        let sets: Vec<_> = sets.iter().map(|set| (*set).to_owned()).collect();
        Source::load(&self.file(name), &sets)
            .and_then(|source| source.parse::<Scenario>().map(|_| ()))
            .unwrap_err()
            .to_string()
    }
}

const COMMON: &str =
    "(\n    title: \"common\",\n    rods: [\n        (length: 0.1, name: \"a\"),\n    ],\n)\n";

#[test]
fn a_derived_file_changes_its_base_and_the_base_of_that() {
    let folder = Folder::new(&[
        ("sub/common.ron", COMMON),
        (
            "middle.ron",
            "(base: \"sub/common.ron\", title: \"middle\", set: { \"rods[0].length\": 3 })",
        ),
        (
            "top.ron",
            "(base: \"middle.ron\", set: { \"rods[0].length\": 2, \"rods[*].name\": \"b\" })",
        ),
    ]);
    let source = Source::load(&folder.file("top.ron"), &[]).unwrap();
    let scenario: Scenario = source.parse().unwrap();
    assert_eq!(
        (scenario.title.as_str(), *scenario.rods[0].length),
        ("middle", 2.0)
    );
    assert_eq!(scenario.rods[0].name, "b");
    let source = Source::load(&folder.file("top.ron"), &["title=\"set\"".to_owned()]).unwrap();
    assert_eq!(source.parse::<Scenario>().unwrap().title, "set");
}

#[test]
fn the_keys_of_set_are_plain_strings() {
    let folder = Folder::new(&[
        ("common.ron", COMMON),
        (
            "top.ron",
            "(base: \"common.ron\", set: { r#\"title\"#: \"x\" })",
        ),
    ]);
    let error = folder.error("top.ron", &[]);
    assert!(
        error.contains("expected a path in double quotes"),
        "{error}"
    );
}

#[test]
fn faults_name_the_text_in_which_they_were_written() {
    let folder = Folder::new(&[
        ("common.ron", &COMMON.replace("0.1", "-0.1")),
        (
            "top.ron",
            "(\n    base: \"common.ron\",\n    set: { \"rods[0].name\": 7 },\n)",
        ),
    ]);
    let error = folder.error("top.ron", &[]);
    assert!(error.contains("common.ron:4:18"), "{error}");
    assert!(error.contains("top.ron:3:28"), "{error}");
    assert!(
        error.contains("in `rods[0].length`") && error.contains("in `rods[0].name`"),
        "{error}"
    );
    let error = folder.error("top.ron", &["rods[0].length=-3", "rods[0].name=\"x\""]);
    assert!(error.contains("--set rods[0].length=-3:1:16"), "{error}");
    assert!(!error.contains("top.ron"), "{error}");
    let error = folder.error(
        "top.ron",
        &["rods[0].length=3", "rods[0].name=\"x\"", "rods[0].lenth=3"],
    );
    assert!(error.contains("--set rods[0].lenth=3:1:9"), "{error}");
    assert!(error.contains("did you mean `length`?"), "{error}");
}

#[test]
fn a_circle_of_bases_is_refused() {
    let folder = Folder::new(&[
        ("a.ron", "(base: \"b.ron\")"),
        ("b.ron", "(base: \"a.ron\")"),
    ]);
    let error = folder.error("a.ron", &[]);
    assert!(
        error.contains("is derived from itself") && error.contains("b.ron:1:8"),
        "{error}"
    );
}

#[test]
fn missing_files_are_named_with_a_remedy() {
    let folder = Folder::new(&[("a.ron", "(base: \"no.ron\")")]);
    let error = folder.error("a.ron", &[]);
    assert!(
        error.contains("no.ron`") && error.contains("relative to the folder"),
        "{error}"
    );
    let error = folder.error("none.ron", &[]);
    assert!(
        error.contains("none.ron` cannot be read") && error.contains("check the name"),
        "{error}"
    );
}

#[test]
fn a_text_that_is_no_file_has_no_base() {
    let error = Source::from_text("embedded", "(base: \"b.ron\")", &[])
        .unwrap_err()
        .to_string();
    assert!(error.contains("not a file"), "{error}");
}
