//! Every effect leaves its mark in a recording that is made with it, and its numbers are found again in it.

mod common;

use auxetica::config::Source;
use auxetica::diagnose::samples::Samples;
use auxetica::diagnose::trial::Trial;
use auxetica::identify::{Effect, Quantity, Robot, Variant};
use common::made::recorded;
use rayon::prelude::*;
use std::path::Path;

/// A value at which the effect is not as strong as typically.
fn strong(q: &Quantity) -> f64 {
    let value = if q.absent_where_large() {
        q.typical / 0.8
    } else {
        q.null + 0.8 * (q.typical - q.null)
    };
    value.clamp(q.range.0, q.range.1)
}

/// One form of each kind, with its effect: what is the same on every rod is tried on one.
fn forms(robot: &Robot) -> Vec<(&'static str, Variant)> {
    let mut seen = std::collections::BTreeSet::new();
    let mut forms = Vec::new();
    let mut effects = <dyn Effect>::all();
    // others show in loads only: `motor_loads`
    effects.retain(|effect| !effect.in_loads());
    for effect in effects {
        for form in effect.variants(robot) {
            let kind = form.name.trim_end_matches(|c: char| c.is_ascii_digit());
            if seen.insert((effect.id(), kind.to_owned())) {
                forms.push((effect.id(), form));
            }
        }
    }
    forms
}

#[test]
fn the_numbers_of_every_effect_are_found_in_a_recording_made_with_it() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot_concealed.ron");
    let source = Source::load(&file, &[]).unwrap_or_else(|e| panic!("{e}"));
    let robot = Robot::of(&source).unwrap_or_else(|e| panic!("{e}"));
    let all = forms(&robot);
    all.par_iter().for_each(|(id, form)| {
        let what = format!("{id} {}", form.name);
        let truth: Vec<f64> = form.quantities.iter().map(strong).collect();
        let robot_with = form
            .apply(&source, &truth)
            .unwrap_or_else(|e| panic!("{what}: {e}"));
        let recording = recorded(&robot_with, &robot);
        let data = recording.and_then(|recording| Samples::of(&recording));
        let data = [data.unwrap_or_else(|e| panic!("{what}: {e}"))];
        let trial = Trial::new(&source, &[], &data).with(form);
        let at = |values: &[f64]| {
            trial
                .start(values, None)
                .unwrap_or_else(|e| panic!("{what}: {e}"))
        };
        let null: Vec<f64> = form.quantities.iter().map(|q| q.null).collect();
        let without = at(&null).chi2();
        let start = at(&trial.typical(&[]));
        let all = 0..truth.len();
        let fit = trial.fit(start, all, 15);
        if without < 1.0 {
            assert_eq!(what, "obstacle at -y", "it leaves no mark");
            return;
        }
        let left = fit.chi2();
        assert!(
            // models that remember pass every other row only
            left < 2e-2 * without.min(1e3),
            "{what}: {without} -> {left}"
        );
        for ((q, found), truth) in form.quantities.iter().zip(&fit.at).zip(&truth) {
            // a time constant as long as the tour shows little
            let share = if *id == "thermal_drift" { 0.15 } else { 0.07 };
            // an anchor on an axis has no size of its own
            let size = match truth.abs().max(q.typical.abs()) {
                0.0 => 0.05 * (q.range.1 - q.range.0),
                size => size,
            };
            assert!(
                (found - truth).abs() < share * size,
                "{what}, {}: {found} for {truth}",
                q.name
            );
        }
    });
}
