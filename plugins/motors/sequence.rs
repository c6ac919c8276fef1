//! The actuation sequences of Stölzle et al. 2023, section IV-A.

use crate::defaults::{half_turn, hold, motors, ramp};
use crate::random::RandomWishes;
use crate::rods::{Motors, RodPlace, Wish};
use crate::visits::{Timing, Visit};
use auxetica_engine::{Actuation, Count, Dwell, Inputs, NonNegative, Positive, register};
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::{SQRT_2, TAU};

/// Wishes of the platform, one after the other.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Course {
    /// From rest to full elongation.
    Elongation {
        /// Number of samples; the authors' 100 if left out.
        #[serde(default = "hundred")]
        samples: Count,
    },
    /// Circles of bending at half the elongation, from 20 to 100 % of the largest that all azimuths allow.
    Circles {
        /// Number of azimuths on each circle, the last again the first; the authors' 15 if left out.
        #[serde(default = "fifteen")]
        azimuths: Count,
        /// Number of circles; the authors' 15 if left out.
        #[serde(default = "fifteen")]
        magnitudes: Count,
    },
    /// Bending along the lemniscate (sin t, sin 2t) at half the elongation.
    Lemniscate {
        /// Number of samples; the authors' 100 if left out.
        #[serde(default = "hundred")]
        samples: Count,
    },
    /// From full clockwise to full counter-clockwise twist.
    Twisting {
        /// Number of samples; the authors' 200 if left out.
        #[serde(default = "two_hundred")]
        samples: Count,
    },
    /// Elongation, bending and twist at random.
    Random {
        /// Number of samples; the authors' 500 if left out.
        #[serde(default = "five_hundred")]
        samples: Count,
        /// Seed of the generator, NumPy's `default_rng`; the authors' 101 if left out.
        #[serde(default = "authors_seed")]
        seed: u64,
    },
}

fn count(n: u32) -> Count {
    Count::new(n.into()).expect("defaults are counts")
}
fn hundred() -> Count {
    count(100)
}
fn fifteen() -> Count {
    count(15)
}
fn two_hundred() -> Count {
    count(200)
}
fn five_hundred() -> Count {
    count(500)
}
fn authors_seed() -> u64 {
    101
}

/// `n` numbers from `from` to `to`, both included; `to` alone if `n` is 1.
fn evenly(from: f64, to: f64, n: Count) -> impl Iterator<Item = f64> + Clone {
    let last = *n - 1;
    (0..*n).map(move |k| {
        if k == last {
            to
        } else {
            from + (to - from) * (k as f64 / last as f64)
        }
    })
}

impl Course {
    fn wishes(self) -> Vec<Wish> {
        let bent = |x: f64, y: f64| Wish::new(x, y, 0.0, 0.5);
        match self {
            Self::Elongation { samples } => evenly(0.0, 1.0, samples)
                .map(|e| Wish::new(0.0, 0.0, 0.0, e))
                .collect(),
            Self::Circles {
                azimuths,
                magnitudes,
            } => evenly(0.2, 1.0, magnitudes)
                .flat_map(|m| evenly(0.0, TAU, azimuths).map(move |azimuth| (m, azimuth)))
                .map(|(m, azimuth)| (m * SQRT_2 / 4.0, azimuth.sin_cos()))
                .map(|(m, (sin, cos))| bent(m * cos, m * sin))
                .collect(),
            Self::Lemniscate { samples } => evenly(0.0, TAU, samples)
                .map(|t| bent(t.sin() / 4.0, (2.0 * t).sin() / 4.0))
                .collect(),
            Self::Twisting { samples } => evenly(-0.5, 0.5, samples)
                .map(|twist| Wish::new(0.0, 0.0, twist, 0.5))
                .collect(),
            Self::Random { samples, seed } => RandomWishes::new(seed).take(*samples).collect(),
        }
    }
}

/// Takes the motors from rest through the samples of a sequence, with a wait at each. Where the rods can't follow, the
/// whole sequence is scaled down to the largest angle.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ActuationSequence {
    /// Samples in their order.
    course: Course,
    /// Rods in the order of their motors; without any those of the paper, R, L, R, L at 45, 135, 225, 315 degrees.
    #[serde(default)]
    rods: Vec<RodPlace>,
    /// Inputs are called this and the motor's number from 1.
    #[serde(default = "motors")]
    motors: String,
    /// Largest motor angle [degrees].
    #[serde(default = "half_turn")]
    angle: Positive,
    /// Time from one sample to the next [s].
    #[serde(default = "ramp")]
    ramp: Positive,
    /// Time spent at each [s].
    #[serde(default = "hold")]
    hold: NonNegative,
}

register!(
    dyn Actuation: ActuationSequence,
    example = "ActuationSequence(course: Circles(azimuths: 15, magnitudes: 15))",
    source = "Stölzle et al. 2023, section IV-A",
);

impl ActuationSequence {
    fn timing(&self) -> Timing {
        Timing {
            ramp: *self.ramp,
            hold: *self.hold,
            home: false,
        }
    }

    fn visits(&self) -> Vec<Visit> {
        let motors = Motors::new(&self.rods);
        let wishes = self.course.wishes();
        let shares: Vec<_> = wishes.iter().map(|wish| motors.shares(wish)).collect();
        let largest = shares.iter().flatten().copied().fold(1.0, f64::max);
        let most = self.angle.to_radians() / largest;
        let visit = |(k, shares): (usize, &Vec<f64>)| Visit {
            name: format!("sample {k}"),
            angles: motors.angles(shares, most),
        };
        shares.iter().enumerate().map(visit).collect()
    }
}

impl Actuation for ActuationSequence {
    fn inputs(&self) -> Result<Inputs, String> {
        self.timing().inputs(&self.visits(), &self.motors)
    }

    fn dwells(&self) -> Vec<Dwell> {
        self.timing().dwells(&self.visits())
    }
}
