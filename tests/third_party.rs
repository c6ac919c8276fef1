//! A crate of somebody else's adds a forcing and a callback with nothing but the public traits: scenarios name them,
//! the command line runs them, and their faults are told like those of shipped plugins.
//!
//! A program of theirs is `use my_plugin as _; fn main() -> ExitCode { auxetica::cli::main() }`; here the plugins
//! stand in the test, and the command line is called in-process.

use auxetica::config::{Finite, NonNegative, Source, Vec3, plugins};
use auxetica::engine::{
    Body, Callback, CallbackError, Forcing, LoadView, Model, Moment, ReadBody, RunError, Snapshot,
    register,
};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ffi::OsString;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Drag of a steady wind on slow bodies: a force on each node, proportional to its mass and to how fast the air passes.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Wind {
    /// Velocity of the air, world frame [m/s].
    air: Vec3,
    /// Drag per mass and speed [1/s].
    drag: NonNegative,
    /// From here on the drag isn't a number, to see how that is told [s].
    #[serde(default)]
    broken_from: Option<Finite>,
}

register!(
    dyn Forcing: Wind,
    example = "Wind(air: (1, 0, 0), drag: 2)",
    source = "test",
);

impl Forcing for Wind {
    fn apply(&self, now: &Moment<'_>, body: &mut LoadView<'_>) {
        let broken = self.broken_from.is_some_and(|from| now.time >= *from);
        let drag = if broken { f64::NAN } else { *self.drag };
        for i in 0..body.nodes() {
            let passing = Vector3::from(*self.air) - body.velocity(i);
            let force = passing * (drag * body.mass(i));
            body.add_force(i, force);
        }
    }
}

/// Writes the last position of every body that it sees.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct LastPlace {
    /// File name, in the folder of results.
    file: PathBuf,
    #[serde(skip)]
    path: PathBuf,
    #[serde(skip)]
    text: String,
}

register!(
    dyn Callback: LastPlace,
    example = r#"LastPlace(file: "last.txt")"#,
    source = "test",
);

impl Callback for LastPlace {
    fn start(&mut self, out: &Path, _bodies: &[Body<'_>]) -> Result<(), CallbackError> {
        self.path = out.join(&self.file);
        Ok(())
    }

    fn record(&mut self, snapshot: &Snapshot<'_>) -> Result<(), CallbackError> {
        let rows = snapshot.bodies.iter().map(|body| {
            let r = body.position(0);
            format!(
                "{} {} {} {} {}\n",
                snapshot.time,
                body.name(),
                r.x,
                r.y,
                r.z
            )
        });
        self.text = rows.collect();
        Ok(())
    }

    fn finish(&mut self) -> Result<Vec<PathBuf>, CallbackError> {
        std::fs::write(&self.path, &self.text).map_err(|source| CallbackError {
            what: format!("writing {}", self.path.display()),
            source: source.into(),
        })?;
        Ok(vec![self.path.clone()])
    }
}

const SCENARIO: &str = r#"(
    title: "adrift",
    rods: [(
        name: "rod", length: 0.1, elements: 5, radius: 0.01, density: 1000,
        material: Moduli(youngs: 1e6, shear: 4e5),
    )],
    cylinders: [(name: "disc", centre: (0, 1, 0), radius: 0.05, thickness: 0.01, mass: 0.3)],
    forcing: [(apply: Wind(air: (3, 0, -1), drag: 2))],
    solver: Dynamic(duration: 0.5),
    callbacks: [(every: 0.5, apply: LastPlace(file: "last.txt"))],
)
"#;

fn auxetica(arguments: &[&str], file: &Path, more: &[&str]) -> ExitCode {
    let name = [OsString::from("theirs")].into_iter();
    let words = |words: &[&str]| words.iter().map(OsString::from).collect::<Vec<_>>();
    auxetica::cli::main_with(
        name.chain(words(arguments))
            .chain([file.into()])
            .chain(words(more)),
    )
}

#[test]
fn their_plugins_run_from_a_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("adrift.ron");
    std::fs::write(&file, SCENARIO).unwrap();
    let out = folder.path().join("results");
    let out_text = out.to_str().expect("plain");
    let code = auxetica(&["--quiet", "run"], &file, &["--out", out_text]);
    assert_eq!(code, ExitCode::SUCCESS);
    let text = std::fs::read_to_string(out.join("last.txt")).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|l| l.split(' ').collect()).collect();
    assert_eq!(rows.len(), 2, "{text}");
    for (row, name, start) in [
        (&rows[0], "rod", [0.0; 3]),
        (&rows[1], "disc", [0.0, 1.0, 0.0]),
    ] {
        assert_eq!(row[1], name);
        let number = |i: usize| row[i].parse::<f64>().expect("a number");
        let (time, drag) = (number(0), 2.0);
        assert!((time - 0.5).abs() < 1e-9, "{time}");
        // v' = drag (air - v) from rest
        let moved = time - (1.0 - f64::exp(-drag * time)) / drag;
        for (i, air) in [3.0, 0.0, -1.0].into_iter().enumerate() {
            let expected = start[i] + air * moved;
            assert!(
                (number(i + 2) - expected).abs() < 1e-3,
                "{name} {i}: {} {expected}",
                number(i + 2)
            );
        }
    }
    assert!(out.join("scenario.ron").is_file());
}

#[test]
fn their_faults_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("adrift.ron");
    std::fs::write(&file, SCENARIO.replace("drag", "darg")).unwrap();
    assert_eq!(auxetica(&["check"], &file, &[]), ExitCode::from(2));
    let problems = Source::load(&file, &[])
        .and_then(|source| Model::build(&source, None))
        .map(drop)
        .expect_err("refused");
    let text = problems.to_string();
    for words in [
        "adrift.ron:8:",
        "`forcing[0].apply.darg`",
        "did you mean `drag`?",
    ] {
        assert!(text.contains(words), "{text}");
    }
    assert!(plugins().any(|p| p.name == "Wind" && p.package == "auxetica"));
}

#[test]
fn a_load_that_becomes_nan_is_told_with_its_plugin() {
    let folder = tempfile::tempdir().unwrap();
    let set = "forcing[0].apply.broken_from=0.25".to_owned();
    let source = Source::from_text("adrift.ron", SCENARIO, &[set]).expect("a good path");
    let mut model = Model::build(&source, None).expect("a good scenario");
    let go_on = &mut |_| ControlFlow::Continue(());
    let error = model
        .run(folder.path(), go_on, &mut |_| ())
        .expect_err("NaN");
    let text = error.to_string();
    assert!(text.contains("Wind (forcing[0].apply)"), "{text}");
    let RunError::BlowUp { blow_up, dt, .. } = error else {
        panic!("{error}");
    };
    assert!((blow_up.time - 0.25).abs() < 2.0 * dt, "{text}");
    assert_eq!((&*blow_up.body, blow_up.node), ("rod", 0), "{text}");
    assert!(
        folder.path().join("last.txt").is_file(),
        "what was recorded is kept"
    );
}
