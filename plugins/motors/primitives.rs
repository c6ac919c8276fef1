//! The motion primitives of a robot of handed shearing auxetics (Stölzle et al. 2023, Fig. 2).

use crate::defaults::{half_turn, hold, motors, ramp};
use crate::rods::{Motors, RodPlace, Wish};
use crate::visits::{Timing, Visit};
use auxetica_engine::{Actuation, Dwell, Inputs, NonNegative, Positive, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// What the platform is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum Primitive {
    /// All rods lengthen.
    Elongation,
    /// The platform bends north.
    BendNorth,
    /// The platform bends south.
    BendSouth,
    /// The platform bends west.
    BendWest,
    /// The platform bends east.
    BendEast,
    /// The platform twists clockwise.
    TwistClockwise,
    /// The platform twists counter-clockwise.
    TwistCounterclockwise,
}

impl Primitive {
    fn wish(self) -> Wish {
        match self {
            Self::Elongation => Wish::new(0.0, 0.0, 0.0, 1.0),
            Self::BendNorth => Wish::new(0.0, 0.5, 0.0, 0.5),
            Self::BendSouth => Wish::new(0.0, -0.5, 0.0, 0.5),
            Self::BendWest => Wish::new(-0.5, 0.0, 0.0, 0.5),
            Self::BendEast => Wish::new(0.5, 0.0, 0.0, 0.5),
            Self::TwistClockwise => Wish::new(0.0, 0.0, -0.5, 0.5),
            Self::TwistCounterclockwise => Wish::new(0.0, 0.0, 0.5, 0.5),
        }
    }

    /// Angles \[rad\] of the motors, that of the one which turns furthest being `most`; none if these rods can't.
    fn angles(self, motors: &Motors, most: f64) -> Option<Vec<f64>> {
        let mut shares = motors.shares(&self.wish());
        let largest = shares.iter().copied().fold(0.0, f64::max);
        shares.iter_mut().for_each(|share| *share /= largest);
        (largest > 0.0).then(|| motors.angles(&shares, most))
    }
}

/// Goes through motion primitives one after the other: from rest to each, a wait, and back to rest. In each the motor
/// that turns furthest turns by `angle`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionPrimitives {
    /// Primitives in their order.
    sequence: Vec<Primitive>,
    /// Rods in the order of their motors; without any those of the paper, R, L, R, L at 45, 135, 225, 315 degrees.
    #[serde(default)]
    rods: Vec<RodPlace>,
    /// Inputs are called this and the motor's number from 1.
    #[serde(default = "motors")]
    motors: String,
    /// Largest motor angle [degrees].
    #[serde(default = "half_turn")]
    angle: Positive,
    /// Time for the way there, and for the way back [s].
    #[serde(default = "ramp")]
    ramp: Positive,
    /// Time spent in each [s].
    #[serde(default = "hold")]
    hold: NonNegative,
}

register!(
    dyn Actuation: MotionPrimitives,
    example = "MotionPrimitives(sequence: [Elongation, BendNorth])",
    source = "Stölzle et al. 2023, section II-E and Fig. 2",
);

impl MotionPrimitives {
    fn timing(&self) -> Timing {
        Timing {
            ramp: *self.ramp,
            hold: *self.hold,
            home: true,
        }
    }

    fn visits(&self) -> Result<Vec<Visit>, String> {
        let motors = Motors::new(&self.rods);
        let visit = |primitive: &Primitive| {
            let angles = primitive.angles(&motors, self.angle.to_radians());
            let name = format!("{primitive:?}");
            let angles = angles.ok_or_else(|| {
                format!(
                    "{name} winds no rod of this robot; leave it out, or give rods of both hands"
                )
            })?;
            Ok(Visit { name, angles })
        };
        self.sequence.iter().map(visit).collect()
    }
}

impl Actuation for MotionPrimitives {
    fn inputs(&self) -> Result<Inputs, String> {
        if self.sequence.is_empty() {
            return Err("the sequence is empty; name at least one primitive".into());
        }
        self.timing().inputs(&self.visits()?, &self.motors)
    }

    fn dwells(&self) -> Vec<Dwell> {
        // what is wrong with the visits, `inputs` tells
        self.timing().dwells(&self.visits().unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_published_actuation_tables() {
        let u = 179.9_f64.to_radians();
        for (primitive, published) in [
            (Primitive::Elongation, [u, -u, u, -u]),
            (Primitive::BendNorth, [0.0, -u, u, 0.0]),
            (Primitive::TwistClockwise, [0.0, -u, 0.0, -u]),
            (Primitive::TwistCounterclockwise, [u, 0.0, u, 0.0]),
        ] {
            let angles = primitive.angles(&Motors::new(&[]), u).expect("it can");
            for (angle, published) in angles.into_iter().zip(published) {
                assert!((angle - published).abs() < 1e-15, "{primitive:?}");
            }
        }
    }
}
