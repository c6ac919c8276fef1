//! Recordings that show nothing say "nothing is missing" only if they would have shown it.

use auxetica::challenge::{NOMINAL, RECORDINGS, Spec, conceal};
use auxetica::config::Source;
use auxetica::diagnose::verdict::{Diagnosis, Kind};
use auxetica::diagnose::{Request, diagnose};
use std::path::Path;

/// Diagnoses recordings of a robot that lacks nothing, wound by up to `angle` \[rad\].
fn diagnosed(angle: f64) -> Diagnosis {
    let folder = tempfile::tempdir().expect("a folder");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot_concealed.ron");
    let spec = format!(
        r#"(
            scenario: {shipped:?}, seed: 4,
            controls: 1, singles: 0, doubles: 0, foreigners: 0, effects: [],
            mesh: ("rods[0].elements", 12, 12), strength: (1, 1),
            recordings: Simulated(
                set_points: 8, angle: {angle:?}, speed: 1.05, hold: 1.5, rate: 9.26,
                noise: (5e-5, 5e-4), bias: (1e-5, 1e-4), jitter: 2e-3,
            ),
        )"#
    );
    let file = folder.path().join("spec.ron");
    std::fs::write(&file, spec).expect("written");
    let (spec, nominal) = Spec::load(&file).unwrap_or_else(|e| panic!("{e}"));
    let made = folder.path().join("made");
    conceal(&spec, &nominal, &made, &|_| ()).unwrap_or_else(|e| panic!("{e}"));
    let all = RECORDINGS.map(|name| made.join("case_000").join(name));
    let source = Source::load(&made.join(NOMINAL), &[]).unwrap_or_else(|e| panic!("{e}"));
    let request = Request {
        source: &source,
        train: &all[..2],
        holdout: &all[2..],
        effects: &[],
        seed: 1,
    };
    let (diagnosis, _) = diagnose(&request, &|_| ()).unwrap_or_else(|e| panic!("{e}"));
    for n in &diagnosis.noticeable {
        println!("{} {:.3}", n.words(), n.share);
    }
    println!("{}", diagnosis.words);
    diagnosis
}

#[test]
fn motors_that_hardly_turn_are_too_little_data() {
    let d = diagnosed(0.15);
    assert_eq!(d.verdict, Kind::Insufficient, "{}", d.words);
    assert!(d.words.starts_with("Too little data"), "{}", d.words);
    assert!(d.effects.is_empty());
    let unseen = d.noticeable.iter().filter(|n| n.share > 1.0).count();
    assert!(2 * unseen > d.noticeable.len());
}

#[test]
fn motors_that_turn_far_are_enough() {
    let d = diagnosed(6.0);
    assert_eq!(d.verdict, Kind::None, "{}", d.words);
}
