//! The actuation sequences of the paper's section IV-A: angles are the authors', sample by sample, robots of other rods
//! turn no motor too far or the wrong way, and every sample is waited at.

mod common;

use auxetica::engine::Model;
use common::{data, model};

/// The authors' largest angle [rad].
const MOST: f64 = 179.9 * std::f64::consts::PI / 180.0;
/// Their code keeps motors this far from it [rad].
const SHY: f64 = 1e-6;

fn actuated(inputs: &str) -> Model {
    model(&format!(
        r#"(
            title: "motors alone",
            cylinders: [(name: "body", centre: (0, 0, 0), radius: 1, thickness: 1, mass: 1)],
            inputs: {inputs},
            solver: Steady(),
        )"#
    ))
}

/// Angles of the motors whose inputs have this prefix, at every dwell.
fn angles(model: &Model, prefix: &str) -> Vec<Vec<f64>> {
    let inputs = || model.system.inputs().iter();
    let at = |time: f64| {
        let motors = inputs().filter(|(name, _)| name.starts_with(prefix));
        motors.map(|(_, series)| series.at(time)).collect()
    };
    model.dwells.iter().map(|dwell| at(dwell.time)).collect()
}

fn sequence(course: &str) -> Vec<Vec<f64>> {
    let inputs = format!("ActuationSequence(course: {course})");
    angles(&actuated(&inputs), "motor_")
}

/// Largest difference [rad].
fn apart(ours: &[f64], theirs: &[f64]) -> f64 {
    assert_eq!(ours.len(), theirs.len());
    let both = ours.iter().zip(theirs);
    both.map(|(ours, theirs)| (ours.clamp(SHY - MOST, MOST - SHY) - theirs).abs())
        .fold(0.0, f64::max)
}

#[test]
fn single_samples_are_the_authors() {
    // u_ss of the data set's actuation_specs.csv
    for (course, count, sample, published) in [
        (
            "Elongation()",
            100,
            1,
            [
                0.031715629538765645,
                -0.031715629538765645,
                0.031715629538765645,
                -0.031715629538765645,
            ],
        ),
        (
            "Circles()",
            225,
            1,
            [
                1.6736262450653725,
                -1.8662886170844772,
                1.4662210792724264,
                -1.2735587072533217,
            ],
        ),
        (
            "Lemniscate()",
            100,
            2,
            [
                1.472152322436789,
                -1.8664354902184568,
                1.66769500190101,
                -1.2734118341193421,
            ],
        ),
        (
            "Twisting()",
            200,
            2,
            [
                0.03155625451595778,
                -3.108291069821841,
                0.03155625451595778,
                -3.108291069821841,
            ],
        ),
        (
            "Random()",
            500,
            1,
            [
                3.0768211405048396,
                -2.7166773533538757,
                0.00038187233884356964,
                -0.483940159744485,
            ],
        ),
    ] {
        let samples = sequence(course);
        assert_eq!(samples.len(), count, "{course}");
        let apart = apart(&samples[sample], &published);
        assert!(apart < 1e-12, "{course}: {apart:e}");
    }
}

#[test]
fn all_samples_are_the_authors() {
    for (name, course) in [
        (
            "20221025_170312_elongation_seed-101_100-samples",
            "Elongation(samples: 100)",
        ),
        (
            "20221025_170335_bending_seed-101_225-samples",
            "Circles(azimuths: 15, magnitudes: 15)",
        ),
        (
            "20221025_215237_lemniscate_seed-101_100-samples",
            "Lemniscate(samples: 100)",
        ),
        (
            "20221025_214951_twisting_seed-101_200-samples",
            "Twisting(samples: 200)",
        ),
        (
            "20221025_220436_combined_seed-101_500-samples",
            "Random(samples: 500, seed: 101)",
        ),
    ] {
        let Some(file) = data(&format!("reference_simulations/{name}/actuation_specs.csv")) else {
            return;
        };
        let mut table = csv::Reader::from_path(file).unwrap();
        let rows = table.records().map(|row| row.unwrap());
        let theirs: Vec<[f64; 4]> = rows
            .map(|row| std::array::from_fn(|m| row[5 + m].parse().unwrap()))
            .collect();
        let ours = sequence(course);
        assert_eq!(ours.len(), theirs.len(), "{course}");
        let pairs = ours.iter().zip(&theirs);
        let largest = pairs.map(|(o, t)| apart(o, t)).fold(0.0, f64::max);
        println!("{course}: {} samples, within {largest:.1e} rad", ours.len());
        assert!(largest < 1e-12, "{course}: {largest:e} rad");
    }
}

#[test]
fn seeds_decide() {
    let drawn = |seed: u64| sequence(&format!("Random(samples: 20, seed: {seed})"));
    assert_eq!(drawn(7), drawn(7));
    assert_ne!(drawn(7), drawn(8));
    assert_ne!(drawn(7), drawn(7 + (1 << 32)));
}

/// Rods at the same distances around the axis, from x on.
fn around(hands: &str) -> String {
    let step = 360.0 / hands.len() as f64;
    let rod = |(i, hand): (usize, char)| {
        let hand = if hand == 'R' { "Right" } else { "Left" };
        format!("(azimuth: {}, handedness: {hand})", i as f64 * step)
    };
    let rods: Vec<_> = hands.chars().enumerate().map(rod).collect();
    format!("[{}]", rods.join(", "))
}

#[test]
fn other_robots_wind_every_rod_its_own_way_and_not_too_far() {
    for hands in [
        "R", "RL", "RRR", "RLR", "LLLL", "RLRLR", "RLRLRL", "RLRLRLRL",
    ] {
        let rods = around(hands);
        for course in [
            "Elongation()",
            "Circles()",
            "Lemniscate()",
            "Twisting()",
            "Random()",
        ] {
            let inputs = format!("ActuationSequence(course: {course}, angle: 90, rods: {rods})");
            for sample in angles(&actuated(&inputs), "motor_") {
                for (angle, hand) in sample.iter().zip(hands.chars()) {
                    let winding = if hand == 'R' { *angle } else { -angle };
                    assert!(
                        (-1e-12..=90.0_f64.to_radians() + 1e-12).contains(&winding),
                        "{hands} {course}: {winding}"
                    );
                }
            }
        }
    }
}

#[test]
fn bends_of_three_and_six_rods_wind_those_opposite() {
    // winding in shares of the largest angle, rod by rod from x on; a bend about y, north, shortens those at +x
    for (hands, primitive, shares) in [
        ("RRR", "Elongation", vec![1.0, 1.0, 1.0]),
        ("RRR", "BendNorth", vec![0.0, 1.0, 1.0]),
        ("RRR", "BendSouth", vec![1.0, 0.0, 0.0]),
        ("RLRLRL", "Elongation", vec![1.0; 6]),
        (
            "RLRLRL",
            "BendNorth",
            vec![0.0, 0.25, 0.75, 1.0, 0.75, 0.25],
        ),
        (
            "RLRLRL",
            "TwistClockwise",
            vec![0.0, 1.0, 0.0, 1.0, 0.0, 1.0],
        ),
    ] {
        let rods = around(hands);
        let inputs = format!("MotionPrimitives(sequence: [{primitive}], angle: 90, rods: {rods})");
        let found = &angles(&actuated(&inputs), "motor_")[0];
        for (angle, share) in found.iter().zip(&shares) {
            let winding = angle.abs() / 90.0_f64.to_radians();
            assert!(
                (winding - share).abs() < 1e-12,
                "{hands} {primitive}: {found:?}"
            );
        }
    }
}

#[test]
fn motors_wait_at_every_sample_and_primitives_return() {
    let model =
        actuated("ActuationSequence(course: Elongation(samples: 3), ramp: 2, hold: 1, angle: 90)");
    let times: Vec<f64> = model.dwells.iter().map(|d| d.time).collect();
    assert_eq!(format!("{times:?}"), "[3.0, 6.0, 9.0]");
    let motor = model
        .system
        .inputs()
        .get("motor_1")
        .expect("there are motors");
    for (time, share) in [
        (0.0, 0.0),
        (3.0, 0.0),
        (4.0, 0.25),
        (5.0, 0.5),
        (6.0, 0.5),
        (8.0, 1.0),
        (99.0, 1.0),
    ] {
        let wanted = share * 90.0_f64.to_radians();
        assert!(
            (motor.at(time) - wanted).abs() < 1e-12,
            "{time} s: {}",
            motor.at(time)
        );
    }
    let model =
        actuated("MotionPrimitives(sequence: [Elongation, BendEast], ramp: 2, hold: 1, angle: 90)");
    let names: Vec<_> = model
        .dwells
        .iter()
        .map(|d| (d.time, d.name.as_str()))
        .collect();
    assert_eq!(names, [(3.0, "Elongation"), (8.0, "BendEast")]);
    let motor = model
        .system
        .inputs()
        .get("motor_1")
        .expect("there are motors");
    assert!(motor.at(5.0).abs() < 1e-12 && motor.at(6.0) > 0.1);
}

#[test]
fn segments_move_together_under_names_of_their_own() {
    let model = actuated(
        r#"Together(of: [
            MotionPrimitives(sequence: [Elongation, BendEast], ramp: 2, hold: 1),
            MotionPrimitives(sequence: [Elongation, BendWest], ramp: 2, hold: 1, motors: "upper_"),
            ActuationSequence(course: Elongation(samples: 1), ramp: 5, hold: 1, motors: "third_"),
        ])"#,
    );
    let names: Vec<_> = model
        .dwells
        .iter()
        .map(|d| (d.time, d.name.as_str()))
        .collect();
    assert_eq!(
        names,
        [
            (3.0, "Elongation"),
            (6.0, "sample 0"),
            (8.0, "BendEast + BendWest")
        ]
    );
    // east winds rods 1 and 2, west 3 and 4
    let [east, west] = ["motor_", "upper_"].map(|motors| angles(&model, motors)[2].clone());
    assert!(east[0] > 3.0 && (east[0] - west[2]).abs() < 1e-12 && west[0].abs() < 1e-12);
}
