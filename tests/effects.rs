//! Effects that a diagnosis tries: each form builds, is not there at its null value, and changes what the robot does at
//! its typical value.

use auxetica::config::Source;
use auxetica::engine::scenario::Turn;
use auxetica::engine::{Model, SteadyOptions, SteadySolver};
use auxetica::identify::{Effect, Robot};
use std::path::Path;

/// The concealed robot on its way to a bent, twisted pose.
fn scenario() -> Source {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot_concealed.ron");
    let motor =
        |i: usize, to: f64| format!("\"motor_{i}\": [(0, 0), (4, {to}), (5, {})]", 0.8 * to);
    let motors = [motor(1, 2.5), motor(2, -1.0), motor(3, 1.5), motor(4, -0.2)].join(", ");
    let sets = [format!("inputs=Channels(channels: {{{motors}}})")];
    Source::load(&file, &sets).unwrap_or_else(|e| panic!("{e}"))
}

/// Places of platform and ring as motion capture sees them, at two times [m].
fn places(source: &Source) -> Vec<f64> {
    let mut model = Model::build(source, None).unwrap_or_else(|e| panic!("{e}"));
    let mut solver =
        SteadySolver::new(&mut model.system, SteadyOptions::default()).expect("a robot");
    let mut all = Vec::new();
    for time in [0.0, 1.0, 2.0, 3.0, 3.9, 4.7, 6.0] {
        let found = solver.advance(&mut model.system, time);
        found.unwrap_or_else(|e| panic!("{e}"));
        for marker in &model.markers {
            let (point, _) = model.marker_pose(marker).expect("a marker");
            let turn = model
                .capture
                .turn
                .map_or(nalgebra::Vector3::zeros(), |v| (*v).into());
            let shift = model
                .capture
                .shift
                .map_or(nalgebra::Vector3::zeros(), |v| (*v).into());
            let seen = nalgebra::Rotation3::from_scaled_axis(turn) * point + shift;
            all.extend(seen.iter());
        }
        // what turning motors report, ten thousand to the metre
        let motors = model.motor_loads.as_ref().expect("they report loads");
        let turn = Turn {
            sense: 1.0,
            now: true,
        };
        let torques = model.motor_torques();
        all.extend((0..4).map(|i| 1e-4 * motors.reading(i, torques[i], turn)));
    }
    all
}

fn farthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

#[test]
fn an_effect_is_absent_at_its_null_and_present_at_its_typical_value() {
    let source = scenario();
    let robot = Robot::of(&source).unwrap_or_else(|e| panic!("{e}"));
    let without = places(&source);
    let mut forms = 0;
    let mut shown = std::collections::BTreeMap::new();
    for effect in <dyn Effect>::all() {
        for form in effect.variants(&robot) {
            let what = format!("{} {}", effect.id(), form.name);
            let at = |values: Vec<f64>| {
                let changed = form.apply(&source, &values);
                places(&changed.unwrap_or_else(|e| panic!("{what}: {e}")))
            };
            let null = at(form.quantities.iter().map(|q| q.null).collect());
            let typical = at(form.quantities.iter().map(|q| q.typical).collect());
            // saturation and compliance are absent at infinity only; other forms are, to what the solver tolerates
            let endless = [
                "auxetic_nonlinearity saturating",
                "base_compliance in rotation",
                "base_compliance in translation",
                "motor_compliance ",
            ];
            let least = if endless.contains(&&*what) {
                2e-4
            } else {
                1e-7
            };
            let absent = farthest(&null, &without);
            assert!(
                absent < least,
                "{what} moves the robot by {absent} m at its null"
            );
            let present = farthest(&typical, &without);
            let most: &mut f64 = shown.entry(effect.id()).or_default();
            *most = most.max(present);
            // what pushes or stops the platform acts in some poses only, and an unloaded robot whose rods all soften alike
            // keeps its shape
            let local = ["obstacle", "tether"].contains(&effect.id())
                || what == "thermal_drift of stiffness";
            assert!(
                local || present > 1e-5,
                "{what} moves the robot by {present} m only"
            );
            assert!(
                present > 3.0 * absent || local,
                "{what}: {present} m against {absent} m"
            );
            forms += 1;
        }
    }
    assert!(forms > 60, "{forms} forms");
    for (id, most) in shown {
        assert!(most > 1e-5, "no form of {id} moves the robot");
    }
}

#[test]
fn identifiers_are_unique_and_said_in_words() {
    let effects = <dyn Effect>::all();
    let ids: std::collections::BTreeSet<_> = effects.iter().map(|e| e.id()).collect();
    assert_eq!(ids.len(), effects.len());
    for effect in &effects {
        assert!(effect.words().len() > 20, "{}", effect.id());
        assert!(!effect.experiment().is_empty(), "{}", effect.id());
    }
}
