//! The motion primitives of a robot of four handed shearing auxetics (Stölzle et al. 2023, Fig. 2).

use auxetica_engine::{Actuation, Dwell, Inputs, NonNegative, Positive, Series, register};
use nalgebra::{Matrix4, Vector4};
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
    /// Motor angles [rad] of rods of handedness R, L, R, L at 45, 135, 225 and 315 degrees, the largest being `most`:
    /// the platform wish (bend x, bend y, twist, elongation) mapped by the inverse of the paper's actuation matrix.
    pub fn angles(self, most: f64) -> [f64; 4] {
        let wish = match self {
            Self::Elongation => [0.0, 0.0, 0.0, 1.0],
            Self::BendNorth => [0.0, 0.5, 0.0, 0.5],
            Self::BendSouth => [0.0, -0.5, 0.0, 0.5],
            Self::BendWest => [-0.5, 0.0, 0.0, 0.5],
            Self::BendEast => [0.5, 0.0, 0.0, 0.5],
            Self::TwistClockwise => [0.0, 0.0, -0.5, 0.5],
            Self::TwistCounterclockwise => [0.0, 0.0, 0.5, 0.5],
        };
        // Rows are orthogonal with squared length 4, so the inverse is the transpose over 4; handedness comes after.
        #[rustfmt::skip]
        let winding = Matrix4::new(
             1.0,  1.0, -1.0, -1.0,
            -1.0,  1.0,  1.0, -1.0,
             1.0, -1.0,  1.0, -1.0,
             1.0,  1.0,  1.0,  1.0,
        )
        .tr_mul(&(Vector4::from(wish) * most));
        let handed = winding.component_mul(&Vector4::new(1.0, -1.0, 1.0, -1.0));
        handed.into()
    }
}

/// Goes through motion primitives one after the other: from rest to each, a wait, and back to rest. The inputs are
/// `motor_1` to `motor_4`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionPrimitives {
    /// Primitives in their order.
    sequence: Vec<Primitive>,
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

fn positive(value: f64) -> Positive {
    Positive::new(value).expect("defaults are positive")
}
fn half_turn() -> Positive {
    positive(179.9)
}
fn ramp() -> Positive {
    positive(5.0)
}
fn hold() -> NonNegative {
    NonNegative::new(10.0).expect("defaults aren't negative")
}

register!(
    dyn Actuation: MotionPrimitives,
    example = "MotionPrimitives(sequence: [Elongation, BendNorth])",
    source = "Stölzle et al. 2023, section II-E and Fig. 2",
);

impl MotionPrimitives {
    fn period(&self) -> f64 {
        2.0 * *self.ramp + *self.hold
    }
}

impl Actuation for MotionPrimitives {
    fn inputs(&self) -> Result<Inputs, String> {
        if self.sequence.is_empty() {
            return Err("the sequence is empty; name at least one primitive".into());
        }
        let motor = |i: usize| {
            let (mut times, mut values) = (vec![0.0], vec![0.0]);
            let mut start = 0.0;
            for primitive in &self.sequence {
                let angle = primitive.angles(self.angle.to_radians())[i];
                let held = start + *self.ramp + *self.hold;
                for (time, value) in [
                    (start + *self.ramp, angle),
                    (held, angle),
                    (start + self.period(), 0.0),
                ] {
                    if times.last().is_none_or(|last| time > *last) {
                        times.push(time);
                        values.push(value);
                    }
                }
                start += self.period();
            }
            Ok((format!("motor_{}", i + 1), Series::new(times, values)?))
        };
        let channels: Result<Vec<_>, String> = (0..4).map(motor).collect();
        Ok(Inputs::new(channels?))
    }

    fn dwells(&self) -> Vec<Dwell> {
        let dwell = |(k, primitive): (usize, &Primitive)| Dwell {
            time: k as f64 * self.period() + *self.ramp + *self.hold,
            name: format!("{primitive:?}"),
        };
        self.sequence.iter().enumerate().map(dwell).collect()
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
            for (angle, published) in primitive.angles(u).into_iter().zip(published) {
                assert!((angle - published).abs() < 1e-15, "{primitive:?}");
            }
        }
    }
}
