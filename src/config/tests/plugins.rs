//! Slots are filled by the plugins that they name; what is wrong in a slot is told at its place.

use auxetica_config::{
    Count, Direction, Hook, Nested, NonNegative, Positive, Problems, Profile, Source, Vec3,
    options, plugins, register,
};
use ron::value::RawValue;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

trait Forcing {
    fn strength(&self) -> f64;
}

impl Hook for dyn Forcing {
    const NOUN: &'static str = "forcing";
    const SLOT: &'static str = "forcing";
}

trait Joint {}

impl Hook for dyn Joint {
    const NOUN: &'static str = "joint";
    const SLOT: &'static str = "joints";
}

/// Uniform gravity.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Gravity {
    /// Acceleration in m/s².
    g: Vec3,
}

impl Forcing for Gravity {
    fn strength(&self) -> f64 {
        self.g[2]
    }
}

register!(dyn Forcing: Gravity, example = "Gravity(g: (0, 0, -9.81))", source = "Newton 1687");

/// Another forcing, grown over a time.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Ramp {
    /// Time in s.
    over: Positive,
    /// What grows.
    of: Nested<dyn Forcing>,
}

impl Forcing for Ramp {
    fn strength(&self) -> f64 {
        self.of.strength() / *self.over
    }
}

register!(dyn Forcing: Ramp, example = "Ramp(over: 1, of: Gravity(g: (0, 0, 1)))", source = "none");

#[derive(Clone, Copy, Deserialize, Serialize, JsonSchema)]
enum Side {
    Left,
    Right,
}

#[derive(Deserialize, JsonSchema)]
#[expect(dead_code, reason = "read for its schema only")]
enum Output {
    Csv(File),
    None,
}

#[derive(Deserialize, JsonSchema)]
#[expect(dead_code, reason = "read for its schema only")]
struct File {
    file: String,
}

fn left() -> Side {
    Side::Left
}

fn no_damping() -> NonNegative {
    NonNegative::new(0.0).unwrap()
}

/// A hinge.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[expect(dead_code, reason = "read for its schema only")]
struct Hinge {
    axis: Direction,
    #[serde(default = "left")]
    side: Side,
    #[serde(default = "no_damping")]
    damping: NonNegative,
    stiffness: Profile,
    count: Option<Count>,
    names: Vec<String>,
    output: Output,
}

impl Joint for Hinge {}

const HINGE: &str =
    "Hinge(axis: (0, 0, 2), stiffness: [1, 2.5], names: [], output: Csv(file: \"x\"), count: 3)";

register!(dyn Joint: Hinge, example = HINGE, source = "none");

trait Twice {}

impl Hook for dyn Twice {
    const NOUN: &'static str = "twice";
    const SLOT: &'static str = "twice";
}

impl Twice for Gravity {}

register!(dyn Twice: Gravity, example = "Gravity(g: (0, 0, 0))", source = "none");
register!(dyn Twice: Gravity, example = "Gravity(g: (0, 0, 0))", source = "none");

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Scenario<'a> {
    #[serde(borrow, default)]
    forcing: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    joints: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    twice: Option<&'a RawValue>,
}

fn build(text: &str) -> Result<Vec<f64>, Problems> {
    let source = Source::from_text("test.ron", text, &[])?;
    let scenario: Scenario = source.parse()?;
    let mut problems = Problems::default();
    let mut strengths = Vec::new();
    for slot in &scenario.forcing {
        let built = problems.collect(source.build::<dyn Forcing>(slot));
        strengths.extend(built.map(|forcing| forcing.strength()));
    }
    for slot in &scenario.joints {
        problems.collect(source.build::<dyn Joint>(slot));
    }
    if let Some(slot) = scenario.twice {
        problems.collect(source.build::<dyn Twice>(slot));
    }
    problems.into_result().map(|()| strengths)
}

#[track_caller]
fn says(text: &str, words: &[&str]) {
    let error = build(text).unwrap_err().to_string();
    for word in words {
        assert!(error.contains(word), "no {word:?} in\n{error}");
    }
}

#[test]
fn slots_become_plugins_and_plugins_hold_plugins() {
    let text =
        "(forcing: [/* first */ Gravity(g: (0, 0, -2)), Ramp(over: 2, of: Gravity(g: (0, 0, 8)))])";
    assert_eq!(build(text).unwrap(), [-2.0, 4.0]);
    build(&format!("(joints: [{HINGE}])")).unwrap();
}

#[test]
fn every_example_builds_and_refuses_an_unknown_field() {
    for plugin in plugins() {
        (plugin.build)(&options(), plugin.example).unwrap();
        let typo = plugin.example.replacen('(', "(xyz: 1, ", 1);
        assert!(
            (plugin.build)(&options(), &typo).is_err(),
            "{}",
            plugin.name
        );
    }
}

#[test]
fn unknown_names_are_told_with_the_known_ones() {
    says(
        "(forcing: [Gravty(g: (0, 0, 1))])",
        &[
            "there is no forcing named `Gravty`",
            "did you mean `Gravity`?",
            "`Gravity`, `Ramp`",
            "test.ron:1:12",
            "in `forcing[0]`",
        ],
    );
    says("(forcing: [(g: 1)])", &["a forcing begins with its name"]);
    says("(forcing: [3])", &["a forcing begins with its name"]);
}

#[test]
fn a_plugin_of_another_hook_is_sent_there() {
    says(
        "(forcing: [Hinge()])",
        &[
            "`Hinge` is a joint, not a forcing",
            "put it under `joints:`",
        ],
    );
}

#[test]
fn one_name_from_two_crates_is_refused_naming_both() {
    says(
        "(twice: Gravity(g: (0, 0, 1)))",
        &[
            "several crates register a twice named `Gravity`",
            "`auxetica-config`, `auxetica-config`",
        ],
    );
}

#[test]
fn every_problem_of_every_slot_is_told_at_its_place() {
    says(
        "(\n  forcing: [\n    Gravity(q: 1, g: (0, inf, \"a\")),\n    Ramp(over: -1, of: Gravity(h: 3)),\n  ],\n  joints: [Hinge(axis: (0, 0, 0))],\n)",
        &[
            "test.ron:3:13",
            "unknown field `q` in `Gravity`",
            "in `forcing[0].q`",
            "allowed fields: `g`",
            "test.ron:3:26",
            "expected a finite number, found inf",
            "in `forcing[0].g[1]`",
            "test.ron:3:31",
            "expected a number, found `\"a\"`",
            "test.ron:4:16",
            "expected a positive finite number, found -1",
            "in `forcing[1].over`",
            "test.ron:4:32",
            "unknown field `h` in `Gravity`",
            "in `forcing[1].of.h`",
            "test.ron:6:24",
            "expected a direction, found (0, 0, 0)",
            "in `joints[0].axis`",
        ],
    );
}

#[test]
fn missing_fields_and_wrong_brackets_are_told_at_the_value() {
    says(
        "(forcing: [\n Gravity(),\n])",
        &["2:2", "missing field `g` in `Gravity`"],
    );
    says("(forcing: [Gravity])", &["expected `Gravity(..)`", "1:12"]);
    says(
        "(forcing: [Gravity(g: (0, 0))])",
        &["1:23", "expected 3 values, found 2"],
    );
    says("(forcing: [Gravity(g: (0, 0, 0, 0))])", &["expected `)`"]);
    says(
        "(forcing: [Gravity(g: [0, 0, 0])])",
        &["expected `(`", "1:23"],
    );
    says(
        "(forcings: [])",
        &["unknown field `forcings`", "did you mean `forcing`?"],
    );
    let hinge =
        |with: &str| format!("(joints: [Hinge(axis: (1, 0, 0), names: [], output: None, {with})])");
    says(
        &hinge("stiffness: []"),
        &["the list is empty", "in `joints[0].stiffness`"],
    );
    says(
        &hinge("stiffness: [1, -2]"),
        &["found -2", "in `joints[0].stiffness[1]`"],
    );
    says(
        &hinge("stiffness: -2"),
        &["expected a positive finite number, found -2", "1:70"],
    );
    says(&hinge("stiffness: \"x\""), &["a positive number or a list"]);
    says(
        &hinge("stiffness: 1, side: Rigt"),
        &["`Rigt` is not one of the choices", "did you mean `Right`?"],
    );
    says(
        &hinge("stiffness: 1, count: 2.5"),
        &["whole number of at least 1, found 2.5"],
    );
    says(
        &hinge("stiffness: 1, count: 0"),
        &["whole number of at least 1, found 0"],
    );
    says(&hinge("stiffness: 1, damping: -0.1"), &["found -0.1"]);
    says(&hinge("stiffness: 1, stiffness: 2"), &["given twice"]);
}

#[test]
fn fields_are_described_in_words() {
    let hinge = plugins().find(|plugin| plugin.name == "Hinge").unwrap();
    let words: Vec<_> = hinge
        .fields()
        .into_iter()
        .map(|f| {
            format!(
                "{}: {} = {:?} {}",
                f.name, f.type_words, f.default, f.required
            )
        })
        .collect();
    assert_eq!(
        words,
        [
            "axis: direction (x, y, z), normalised = None true",
            "side: Left | Right = Some(\"Left\") false",
            "damping: number of at least 0 = Some(\"0\") false",
            "stiffness: positive number or list of them = None true",
            "count: whole number of at least 1 = None false",
            "names: list of text = None true",
            "output: None | Csv(file: text) = None true",
        ]
    );
    let ramp = plugins().find(|plugin| plugin.name == "Ramp").unwrap();
    assert_eq!(ramp.summary(), "Another forcing, grown over a time.");
    assert_eq!(ramp.package, "auxetica-config");
    let of = ramp
        .fields()
        .into_iter()
        .find(|field| field.name == "of")
        .unwrap();
    assert_eq!(
        (of.type_words.as_str(), of.doc.as_str()),
        ("a forcing", "What grows.")
    );
}

#[test]
fn plugins_are_listed_by_noun_and_name() {
    let names: Vec<_> = plugins().map(|plugin| (plugin.noun, plugin.name)).collect();
    assert!(names.is_sorted());
}

#[test]
fn a_program_adds_problems_of_its_own() {
    let text = "(\n forcing: [Gravity(g: (0, 0, 1))],\n)";
    let source = Source::from_text("test.ron", text, &[]).unwrap();
    let scenario: Scenario = source.parse().unwrap();
    assert_eq!(source.path_of(scenario.forcing[0]), "forcing[0]");
    let problem = source
        .problem_in(scenario.forcing[0], "too much")
        .with_hint("take less");
    assert_eq!((problem.line, problem.column), (2, 12));
    assert!(problem.to_string().contains("help: take less"), "{problem}");
    let problem = source.problem("forcing[0].g[2]", "too much");
    assert_eq!((problem.line, problem.column), (2, 30));
    assert_eq!(source.problem("none.such", "too much").line, 1);
}
