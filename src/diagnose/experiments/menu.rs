//! Experiments that a roboticist can do with a robot in hand: a load, another orientation, other motor angles.

use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// An experiment: what is done to the robot, how its motors go, and which poses of the platform are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// What to do and what to look at, in words.
    pub words: String,
    /// What is done to the robot.
    pub setup: Setup,
    /// Times [s] and motor angles [rad], straight from one to the next, from zero at time zero.
    pub way: Vec<(f64, [f64; 4])>,
    /// When the platform is looked at [s].
    pub at: f64,
    /// When it was before [s]; if something is done to the robot, at the same time without that.
    pub before: f64,
}

/// What is done to the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setup {
    /// Nothing.
    AsItIs,
    /// It is turned by this rotation vector [rad], and what is around it stays.
    Turned(Vector3<f64>),
    /// This force is put on the platform [N].
    Loaded(Vector3<f64>),
}

/// Load [N]: the weight of 100 g.
const LOAD: f64 = 0.98;
/// Motors' speeds [rad/s].
const SPEED: f64 = 1.5;
const QUICK: f64 = 3.0;
/// Time that the robot is given to come to rest, and a long time [s].
const REST: f64 = 2.0;
const LONG: f64 = 60.0;
/// How far motors go back in a small reversal [rad].
const SMALL: f64 = 0.1;
/// How much further than recorded.
const FURTHER: f64 = 1.5;
/// Largest motor angle below which motors count as being at rest [rad].
const NO_TURN: f64 = 0.3;

/// All experiments at the ends of what was recorded, the simpler first; `angles` are those of recorded set-points [rad].
#[must_use]
pub fn menu(angles: &[[f64; 4]]) -> Vec<Plan> {
    let ends = ends(angles);
    let mut plans = Vec::new();
    for (words, setup) in setups() {
        plans.extend([[0.0; 4]].iter().chain(&ends).map(|end| {
            let way = to(*end);
            Plan {
                words: format!("{words}, the motors {}, and compare with before", told(end)),
                setup,
                at: way[way.len() - 1].0,
                before: way[way.len() - 1].0,
                way,
            }
        }));
    }
    let single = |i: usize| {
        let largest = ends.iter().map(|end| end[i]);
        let largest = largest.max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let mut one = [0.0; 4];
        one[i] = largest.unwrap_or(0.0);
        (moved(&one), one)
    };
    plans.extend(
        (0..4)
            .map(single)
            .filter(|(moves, _)| *moves)
            .map(|(_, one)| {
                let words = format!(
                    "turn one motor only, all {}, and compare with rest",
                    told(&one)
                );
                driven(words, to(one), 0, 0.0)
            }),
    );
    for end in &ends {
        plans.extend(alone(end));
    }
    plans
}

/// Experiments without help from outside, with the motors going to `end`.
fn alone(end: &[f64; 4]) -> [Plan; 6] {
    let [half, further] = [0.5, FURTHER].map(|share| end.map(|a| share * a));
    let largest = size(end);
    let back = end.map(|a| a * (1.0 - SMALL / largest));
    let held = to(*end);
    let arrived = held[1].0;
    let after = |way: Vec<(f64, [f64; 4])>, to: [f64; 4], speed: f64| {
        let (then, from) = way[way.len() - 1];
        let turn: [f64; 4] = std::array::from_fn(|i| to[i] - from[i]);
        let arrived = then + size(&turn) / speed;
        let mut way = way;
        way.extend([(arrived, to), (arrived + REST, to)]);
        way
    };
    let across = after(after(to(half), *end, SPEED), half, SPEED);
    let small = after(held.clone(), back, SPEED);
    let again = after(held.clone(), [0.0; 4], SPEED);
    // half-way at speed, against the same angles at rest
    let mut quick = after(to(half), [0.0; 4], SPEED);
    let (start, zero) = quick[quick.len() - 1];
    quick.extend([
        (start + 1e-3, zero),
        (start + size(&half) / QUICK, half),
        (start + size(end) / QUICK, *end),
    ]);
    let mut long = held.clone();
    long.push((arrived + LONG, *end));
    [
        driven(
            format!(
                "turn the motors further than recorded, all {}, and compare with rest",
                told(&further)
            ),
            to(further),
            0,
            0.0,
        ),
        driven(
            format!(
                "go to the motors {} from rest, and again from {}, and compare",
                told(&half),
                told(end).trim_start_matches("at ")
            ),
            across,
            0,
            to(half)[2].0,
        ),
        driven(
            format!(
                "hold the motors {} for {LONG:.0} s, and compare with {REST:.0} s after the start",
                told(end)
            ),
            long,
            0,
            arrived + REST,
        ),
        driven(
            format!(
                "turn the motors at {QUICK} rad/s from rest towards {}, and compare half-way with the same angles held",
                told(end).trim_start_matches("at ")
            ),
            quick,
            1,
            to(half)[2].0,
        ),
        driven(
            format!(
                "with the motors {}, turn them back by {SMALL} rad, and compare",
                told(end)
            ),
            small,
            0,
            arrived + REST,
        ),
        driven(
            format!(
                "go to the motors {} and back to zero, and compare with rest before",
                told(end)
            ),
            again,
            0,
            0.0,
        ),
    ]
}

/// An experiment by the motors alone, seen `early` points before the end of the way.
fn driven(words: String, way: Vec<(f64, [f64; 4])>, early: usize, before: f64) -> Plan {
    Plan {
        words,
        setup: Setup::AsItIs,
        at: way[way.len() - 1 - early].0,
        before,
        way,
    }
}

fn setups() -> [(String, Setup); 7] {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let turned = |words: &str, by| {
        (
            format!("{words}, what is around it staying"),
            Setup::Turned(by),
        )
    };
    let push = |along: &str, by| {
        let words = format!("push the platform along {along} by {LOAD} N (the weight of 100 g)");
        (words, Setup::Loaded(LOAD * by))
    };
    let pull = format!(
        "pull the platform away from the base by {LOAD} N along z (100 g hung from a robot that hangs down)"
    );
    [
        (pull, Setup::Loaded(LOAD * z)),
        push("x", x),
        push("y", y),
        turned(
            "turn the base by 180 degrees about the robot's axis",
            PI * z,
        ),
        turned(
            "tilt the whole robot by 90 degrees about its x axis",
            FRAC_PI_2 * x,
        ),
        turned(
            "tilt the whole robot by 90 degrees about its y axis",
            FRAC_PI_2 * y,
        ),
        turned("turn the whole robot upside down about its x axis", PI * x),
    ]
}

/// The set-points that reach furthest in length, in bending and in twist, of right-handed rods 1 and 3 and left-handed
/// rods 2 and 4.
fn ends(angles: &[[f64; 4]]) -> Vec<[f64; 4]> {
    let features: [fn(&[f64; 4]) -> f64; 3] = [
        |[a, b, c, d]| (a - b + c - d).abs(),
        |[a, b, c, d]| (a + b - c - d).hypot(a - b - c + d),
        |[a, b, c, d]| (a + b + c + d).abs(),
    ];
    let mut ends: Vec<[f64; 4]> = Vec::new();
    for feature in features {
        let furthest = angles
            .iter()
            .max_by(|a, b| feature(a).total_cmp(&feature(b)));
        let new = |end: &&[f64; 4]| moved(end) && !ends.contains(end);
        if let Some(end) = furthest.filter(new) {
            ends.push(*end);
        }
    }
    ends
}

/// Straight from zero to some angles, and a rest there.
fn to(angles: [f64; 4]) -> Vec<(f64, [f64; 4])> {
    let arrived = (size(&angles) / SPEED).max(1e-3);
    vec![(0.0, [0.0; 4]), (arrived, angles), (arrived + REST, angles)]
}

fn size(angles: &[f64; 4]) -> f64 {
    angles.iter().fold(0.0, |most, a| most.max(a.abs()))
}

fn moved(angles: &[f64; 4]) -> bool {
    size(angles) > NO_TURN
}

fn told(angles: &[f64; 4]) -> String {
    if !moved(angles) {
        return "at zero".into();
    }
    let degrees = angles.map(|a| format!("{:.0}", a.to_degrees()));
    format!("at {} degrees", degrees.join(", "))
}
