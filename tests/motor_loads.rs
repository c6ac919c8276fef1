//! What motors report as their loads tells of friction and of wrong readings, and of nothing where nothing is wrong.

mod common;

use auxetica::challenge::Concealed;
use auxetica::config::Source;
use auxetica::diagnose::verdict::{Diagnosis, Kind};
use auxetica::engine::scenario::{MotorLoads, Scenario, Turn};
use auxetica::identify::Hooked;
use common::concealed::{Case, Hidden};

/// Diagnoses recordings that conceal an effect, or nothing, and gives form and values that were concealed and the scenario
/// with what was found.
fn diagnosed(concealed: Option<&str>, seed: u64) -> (Diagnosis, Option<Concealed>, Source) {
    let hidden = concealed.map_or(Hidden::Nothing, Hidden::Effect);
    let case = Case::new(&hidden, seed, 6.0);
    let (diagnosis, augmented) = case.diagnosed(&["motor_friction", "load_calibration"]);
    (diagnosis, case.truth(), augmented)
}

#[test]
fn loads_of_a_robot_without_faults_are_as_its_torques_say() {
    let (d, ..) = diagnosed(None, 3);
    assert_eq!(d.verdict, Kind::None, "{}", d.words);
    let loads = d.loads.expect("they are reported");
    assert!(loads.reduced_chi2[0] < 1.5, "{:?}", loads.reduced_chi2);
    assert_eq!(
        loads.words,
        "The motors' loads are as the model's torques say."
    );
}

#[test]
fn friction_and_wrong_readings_are_named_with_their_values_though_poses_show_nothing() {
    // each kind of either is drawn
    let cases = [
        ("always the same", 3, Kind::Effect),
        ("in proportion to the torque", 5, Kind::Effect),
        ("gain of motor", 3, Kind::Recording),
        ("zero of motor", 5, Kind::Recording),
        ("all zeros", 7, Kind::Recording),
    ];
    for (form, seed, kind) in cases {
        let (id, hook) = match kind {
            Kind::Effect => ("motor_friction", Hooked::Boundary),
            _ => ("load_calibration", Hooked::Recording),
        };
        let (d, truth, augmented) = diagnosed(Some(id), seed);
        let truth = truth.expect("it conceals something");
        assert!(truth.form.starts_with(form), "{id}, {seed}: {}", truth.form);
        assert_eq!(d.verdict, kind, "{id}: {}", d.words);
        let [named] = &d.effects[..] else {
            panic!("{id}: {:?}", d.effects);
        };
        assert_eq!((named.id.as_str(), named.hook), (id, hook));
        assert!(named.words.contains(&truth.form), "{}", named.words);
        assert_eq!(named.parameters.len(), truth.values.len());
        for (p, (_, truth)) in named.parameters.iter().zip(&truth.values) {
            let off = (p.value - truth).abs();
            println!("{form}, {}: {} for {truth}", p.name, p.value);
            assert!(
                off < 0.1 * truth,
                "{form}, {}: {} for {truth}",
                p.name,
                p.value
            );
        }
        let loads = d.loads.expect("they are reported");
        for r in loads.recordings.iter().filter(|r| r.role == "holdout") {
            assert!(r.rms[1] < 0.6 * r.rms[0], "{id}: {:?}", r.rms);
        }
        // the scenario that is written reports loads so
        let scenario: Scenario<'_> = augmented.parse().unwrap_or_else(|e| panic!("{e}"));
        let motors = scenario.motor_loads.expect("it says what they report");
        assert!((*motors.gain / loads.gain.value - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_reading_is_gain_times_torque_and_friction_plus_its_zero() {
    let text = "(gain: 100, gains: (1, 2, 1, 1), offsets: (0, 5, 0, 0), friction: 0.1, friction_of_torque: 0.5, held: 0.2)";
    let motors: MotorLoads = ron::from_str(text).expect("it is right");
    let turning = |sense: f64, now: bool| motors.reading(1, -0.4, Turn { sense, now });
    // 0.1 + 0.5 * 0.4 = 0.3 N m of friction
    assert!((turning(1.0, true) - (200.0 * (-0.4 + 0.3) + 5.0)).abs() < 1e-12);
    assert!((turning(-1.0, true) - (200.0 * (-0.4 - 0.3) + 5.0)).abs() < 1e-12);
    assert!((turning(-1.0, false) - (200.0 * (-0.4 - 0.06) + 5.0)).abs() < 1e-12);
    assert!((turning(0.0, false) - (200.0 * -0.4 + 5.0)).abs() < 1e-12);
}
