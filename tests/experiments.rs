//! The experiment that a class comes with really decides: what the true model shows in it is what its member predicts, not
//! what the other does.

mod common;

use auxetica::config::Source;
use auxetica::diagnose::experiments::{Member, Plan, Setup, choose, menu, predict};
use auxetica::diagnose::samples::{Phase, Samples};
use auxetica::diagnose::trial::Trial;
use auxetica::diagnose::verdict::Floor;
use auxetica::identify::{Effect, Parameter, Robot, Variant};
use common::made::recorded;
use nalgebra::Vector3;
use std::path::Path;
use std::time::Instant;

const FLOOR: Floor = Floor {
    position_mm: 0.07,
    rotation_mrad: 0.7,
};

fn shipped(sets: &[String]) -> Source {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot_concealed.ron");
    Source::load(&file, sets).unwrap_or_else(|e| panic!("{e}"))
}

fn form(id: &str, name: &str, robot: &Robot) -> Variant {
    let effects = <dyn Effect>::all();
    let effect = effects
        .iter()
        .find(|e| e.id() == id)
        .expect("it is shipped");
    let mut forms = effect.variants(robot).into_iter();
    forms
        .find(|form| form.name == name)
        .expect("it has this form")
}

#[test]
fn gravity_and_a_payload_are_told_apart_by_the_experiment_that_is_chosen() {
    // rods that weigh more than the platform does
    let heavy = "rods[0].density=4000".to_owned();
    let source = shipped(std::slice::from_ref(&heavy));
    let robot = Robot::of(&source).unwrap_or_else(|e| panic!("{e}"));
    let own = Parameter::declared(&source).unwrap_or_else(|e| panic!("{e}"));
    let forms = [
        form("gravity", "along z", &robot),
        form("payload", "centred", &robot),
    ];
    // other rigidities than the scenario states, and gravity
    let truth = shipped(&[
        heavy,
        "rods[0].material.axial=160".into(),
        "rods[0].material.bending=0.019".into(),
        "forcing=[(apply: Gravity(g: (0, 0, 9.81)))]".into(),
    ]);
    let recording = recorded(&truth, &robot).unwrap_or_else(|e| panic!("{e}"));
    let data = [Samples::of(&recording).unwrap_or_else(|e| panic!("{e}"))];
    let fitted = |id: &'static str, form| {
        let trial = Trial::new(&source, &own, &data).with(form);
        let nominal: Vec<f64> = own.iter().map(|p| p.nominal).collect();
        let start = trial.start(&trial.typical(&nominal), None);
        let start = start.unwrap_or_else(|e| panic!("{e}"));
        let all = 0..start.at.len();
        let fit = trial.fit(start, all, 12);
        Member::new(id, &trial, &fit.at, Some(&trial.covariance(&fit)))
            .unwrap_or_else(|e| panic!("{e}"))
    };
    let members = [fitted("gravity", &forms[0]), fitted("payload", &forms[1])];
    let settled = data[0].list.iter().filter(|s| s.phase == Phase::Settled);
    let angles: Vec<[f64; 4]> = settled.map(|s| s.angles).collect();

    let begun = Instant::now();
    let chosen = choose(&members, menu(&angles), &FLOOR).expect("members can follow some");
    println!(
        "{} ({:.1} floors, {:.2} s)",
        chosen.plan.words,
        chosen.apart,
        begun.elapsed().as_secs_f64()
    );
    assert!(
        chosen.decides(),
        "{}: {} floors",
        chosen.plan.words,
        chosen.apart
    );
    let shown = predict(&truth, &chosen.plan).unwrap_or_else(|e| panic!("{e}"));
    let off = |k: usize| {
        let p = &chosen.predictions[k];
        let position = Vector3::from(p.position_mm) - 1e3 * shown.position;
        let rotation = Vector3::from(p.rotation_mrad) - 1e3 * shown.rotation;
        (position.norm() / FLOOR.position_mm).hypot(rotation.norm() / FLOOR.rotation_mrad)
    };
    println!("off by {:.2} and {:.2} floors", off(0), off(1));
    assert_eq!(chosen.predictions[0].id, "gravity");
    assert!(off(0) < 0.5 * off(1), "{} against {}", off(0), off(1));
}

#[test]
fn a_robot_that_nothing_pulls_does_not_mind_being_turned_and_one_in_gravity_hangs_the_other_way() {
    let plan = |by| Plan {
        words: String::new(),
        setup: Setup::Turned(by),
        way: vec![(0.0, [0.0; 4]), (1.0, [0.0; 4])],
        at: 1.0,
        before: 1.0,
    };
    let shift = |source: &Source, by: Vector3<f64>| {
        predict(source, &plan(by)).unwrap_or_else(|e| panic!("{e}"))
    };
    let quarter = std::f64::consts::FRAC_PI_2 * Vector3::x();
    let free = shipped(&[]);
    for by in [quarter, 2.0 * quarter, Vector3::new(0.3, 1.0, -2.0)] {
        let still = shift(&free, by);
        assert!(still.position.norm() < 1e-8, "{by}: {}", still.position);
        assert!(still.rotation.norm() < 1e-6, "{by}: {}", still.rotation);
    }
    // turned about x by a quarter, what pulled along z pulls along y of the base
    let heavy = shipped(&["forcing=[(apply: Gravity(g: (0, 0, 9.81)))]".into()]);
    let [x, y, z] = shift(&heavy, quarter).position.into();
    assert!(y > 2e-4 && x.abs() < 1e-6 && z < 0.0, "{x} {y} {z}");
    let [x, y, z] = shift(&heavy, 2.0 * quarter).position.into();
    assert!(z < -1e-5 && x.abs() < 1e-6 && y.abs() < 1e-6, "{x} {y} {z}");
}
