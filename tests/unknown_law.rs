//! A law of the rods that no effect of the library has is described by its terms, and nothing else is.

mod common;

use auxetica::config::{Finite, Source};
use auxetica::diagnose::forward::{differences, platform_rms};
use auxetica::diagnose::samples::Samples;
use auxetica::diagnose::verdict::Kind;
use auxetica::engine::{LawView, Moment, ReadBody, RodLaw, register};
use common::concealed::{Case, Hidden};
use nalgebra::Vector3;

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

#[test]
fn a_law_of_no_effect_is_described_by_its_term_and_the_scenario_with_it_runs_to_the_same_figures() {
    let made = Case::new(
        &Hidden::Foreign("laws", "(apply: TwistPull(pull: 2e-3))"),
        5,
        6.0,
    );
    let some = ["auxetic_nonlinearity", "unknown"];
    let (d, augmented) = made.diagnosed(&some);
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
    for (told, folder) in held_out.zip(&made.recordings()[2..]) {
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
fn a_cause_that_would_have_to_be_what_it_cannot_be_is_not_given() {
    // nearly a cable that is far away: its numbers would go on and on
    let force = "(on: \"rod_1\", apply: EndForce(force: (1.2, 1.2, 0)))";
    let (d, _) = Case::new(&Hidden::Foreign("forcing", force), 5, 6.0).diagnosed(&["tether"]);
    println!("{}", d.words);
    assert_eq!(d.verdict, Kind::Unexplained, "{}", d.words);
    assert!(
        d.words.contains("ended where what is physical ends"),
        "{}",
        d.words
    );
    assert!(d.explained > 0.9, "{}", d.explained);
}

#[test]
fn a_known_effect_and_a_control_are_given_no_law() {
    let made = Case::new(
        &Hidden::Foreign("laws", "(on: \"rod_1\", apply: Extension(gain: 0.9))"),
        5,
        6.0,
    );
    let (d, _) = made.diagnosed(&["rod_asymmetry", "unknown"]);
    assert_eq!(d.verdict, Kind::Effect, "{}", d.words);
    assert_eq!(d.effects[0].id, "rod_asymmetry");

    let made = Case::new(&Hidden::Nothing, 5, 6.0);
    let (d, _) = made.diagnosed(&["unknown"]);
    assert_eq!(d.verdict, Kind::None, "{}", d.words);
    assert!(d.effects.is_empty());
}
