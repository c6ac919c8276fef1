//! A law of the rods that no effect of the library has is described by its terms, and nothing else is.

use auxetica::challenge::{NOMINAL, RECORDINGS, Spec, conceal};
use auxetica::config::{Finite, Source};
use auxetica::diagnose::forward::{differences, platform_rms};
use auxetica::diagnose::samples::Samples;
use auxetica::diagnose::verdict::{Diagnosis, Kind};
use auxetica::diagnose::{Request, diagnose};
use auxetica::engine::{LawView, Moment, ReadBody, RodLaw, register};
use nalgebra::Vector3;
use std::path::{Path, PathBuf};

/// Rods that pull with the square of their twist, and resist twist by that pull: the energy `c e k_z^2` per length, put
/// together otherwise than the law that is to describe it.
#[derive(serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct TwistPull {
    /// c [N m2/rad2].
    pull: Finite,
}

register!(
    dyn RodLaw: TwistPull,
    example = "TwistPull(pull: 1e-3)",
    source = "test",
);

impl RodLaw for TwistPull {
    fn rest(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    fn stress(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let n = rod.elements();
        for e in 0..n {
            let cells = [e, e + 1].into_iter().filter(|v| rod.cells().contains(v));
            let twists: f64 = cells.map(|v| rod.kappa(v).z.powi(2)).sum();
            rod.add_stress(e, Vector3::z() * (*self.pull * twists / 2.0));
        }
        for v in rod.cells() {
            let elongation = (rod.sigma(v - 1).z + rod.sigma(v).z) / 2.0;
            let couple = 2.0 * *self.pull * elongation * rod.kappa(v).z;
            rod.add_couple(v, Vector3::z() * couple);
        }
    }
}

/// Recordings of one robot that conceals this entry of its laws, or nothing.
fn concealing(entry: Option<&str>) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot_concealed.ron");
    let (controls, foreigners) = (usize::from(entry.is_none()), usize::from(entry.is_some()));
    let spec = format!(
        r#"(
            scenario: {shipped:?}, seed: 5,
            controls: {controls}, singles: 0, doubles: 0, foreigners: {foreigners},
            mesh: ("rods[0].elements", 14, 14), strength: (1, 1),
            recordings: Simulated(
                set_points: 8, angle: 6, speed: 1.05, hold: 1.5, rate: 9.26,
                noise: (5e-5, 5e-4), bias: (1e-5, 1e-4), jitter: 2e-3,
            ),
            foreign: [(words: "a law", list: "laws", entry: {entry:?}, range: (1, 1))],
        )"#,
        entry = entry.unwrap_or_default()
    );
    let file = folder.path().join("spec.ron");
    std::fs::write(&file, spec).expect("written");
    let (spec, nominal) = Spec::load(&file).unwrap_or_else(|e| panic!("{e}"));
    let out = folder.path().join("made");
    conceal(&spec, &nominal, &out, &|_| ()).unwrap_or_else(|e| panic!("{e}"));
    folder
}

fn recordings(folder: &Path) -> Vec<PathBuf> {
    let all = RECORDINGS.iter();
    all.map(|name| folder.join("made/case_000").join(name))
        .collect()
}

fn diagnosed(folder: &Path, effects: &[&str]) -> (Diagnosis, Source) {
    let nominal = folder.join("made").join(NOMINAL);
    let source = Source::load(&nominal, &[]).unwrap_or_else(|e| panic!("{e}"));
    let recordings = recordings(folder);
    let effects: Vec<String> = effects.iter().map(|e| (*e).to_owned()).collect();
    let (train, holdout) = recordings.split_at(2);
    let request = Request {
        source: &source,
        train,
        holdout,
        effects: &effects,
        seed: 1,
    };
    diagnose(&request, &|_| ()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_law_of_no_effect_is_described_by_its_term_and_the_scenario_with_it_runs_to_the_same_figures() {
    let made = concealing(Some("(apply: TwistPull(pull: 2e-3))"));
    let some = ["auxetic_nonlinearity", "unknown"];
    let (d, augmented) = diagnosed(made.path(), &some);
    println!("{}", d.words);
    assert_eq!(d.verdict, Kind::Effect, "{}", d.words);
    assert_eq!(d.effects.len(), 1);
    let law = &d.effects[0];
    assert_eq!(law.id, "unknown");
    assert!(
        law.equation.ends_with(" N m2/rad2 * elongation * twist^2"),
        "{}",
        law.equation
    );
    assert!(
        d.words.contains("a description and not a cause: W +="),
        "{}",
        d.words
    );
    let [number] = &law.parameters[..] else {
        panic!("{:?}", law.parameters);
    };
    assert!((number.value - 2e-3).abs() < 2e-4, "{number:?}");
    let held_out = d
        .augmented
        .recordings
        .iter()
        .filter(|r| r.role == "holdout");
    let again = Source::from_text("again", augmented.text(), &[]).unwrap_or_else(|e| panic!("{e}"));
    for (told, folder) in held_out.zip(&recordings(made.path())[2..]) {
        let samples = Samples::read(folder).unwrap_or_else(|e| panic!("{e}"));
        let apart = differences(&again, &samples).unwrap_or_else(|e| panic!("{e}"));
        let rms = platform_rms(&apart, &samples).0;
        assert!(
            rms < 1.3 * d.floor.position_mm,
            "{}: {rms} mm held out, floor {} mm",
            told.name,
            d.floor.position_mm
        );
        assert!((rms - told.position_rmse_mm).abs() < 1e-9);
    }
}

#[test]
fn a_known_effect_and_a_control_are_given_no_law() {
    let made = concealing(Some("(on: \"rod_1\", apply: Extension(gain: 0.9))"));
    let (d, _) = diagnosed(made.path(), &["rod_asymmetry", "unknown"]);
    assert_eq!(d.verdict, Kind::Effect, "{}", d.words);
    assert_eq!(d.effects[0].id, "rod_asymmetry");

    let made = concealing(None);
    let (d, _) = diagnosed(made.path(), &["unknown"]);
    assert_eq!(d.verdict, Kind::None, "{}", d.words);
    assert!(d.effects.is_empty());
}
