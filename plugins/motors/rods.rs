//! A robot's rods, and how a wish of its platform is shared among their motors.

use auxetica_engine::Finite;
use auxetica_hsa::Handedness;
use nalgebra::{DMatrix, Vector4};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::SQRT_2;

/// Where a rod stands around the robot's axis, and which way its motor winds it.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RodPlace {
    /// Angle about z from x [degrees].
    azimuth: Finite,
    /// Which way of turning lengthens the rod.
    handedness: Handedness,
}

/// What the platform is to do: bend about x, bend about y, twist, elongate. Of elongation 1 is all; a robot of balanced
/// rods can follow `|bend x| + |bend y| + |twist| + |elongation - 1/2| <= 1/2`. The paper's q_p is 4 times this times
/// the largest angle.
pub type Wish = Vector4<f64>;

/// Maps wishes to angles of one robot's motors.
pub struct Motors {
    /// Winding of each rod per wish.
    winding: DMatrix<f64>,
    /// Handedness of each rod.
    signs: Vec<f64>,
}

/// What is left of shares that should be equal or nothing, after all rounding.
const ROUNDING: f64 = 1e-13;

impl Motors {
    /// Motors of these rods; without any, of the paper's four: R, L, R, L at 45, 135, 225 and 315 degrees.
    pub fn new(rods: &[RodPlace]) -> Self {
        let given = rods.iter().map(|rod| (*rod.azimuth, rod.handedness));
        let mut rods: Vec<_> = given.collect();
        if rods.is_empty() {
            rods = vec![
                (45.0, Handedness::Right),
                (135.0, Handedness::Left),
                (225.0, Handedness::Right),
                (315.0, Handedness::Left),
            ];
        }
        // The actuation matrix H without its factor diag(h): windings to wishes (section II-E and Fig. 2).
        let columns: Vec<_> = rods
            .iter()
            .map(|(azimuth, handedness)| {
                let (sin, cos) = azimuth.to_radians().sin_cos();
                Wish::new(SQRT_2 * sin, -SQRT_2 * cos, handedness.sign(), 1.0)
            })
            .collect();
        let actuation = DMatrix::from_fn(4, rods.len(), |i, rod| columns[rod][i]);
        let inverse = actuation
            .pseudo_inverse(1e-9)
            .expect("the bound on singular values isn't negative");
        Self {
            winding: inverse * rods.len() as f64,
            signs: rods.iter().map(|(_, h)| h.sign()).collect(),
        }
    }

    /// Winding of each rod as a share of the largest: the pseudo-inverse of the actuation matrix times the wish, raised
    /// for all rods until none unwinds.
    pub fn shares(&self, wish: &Wish) -> Vec<f64> {
        // mirrored rods get equal shares to the last bit, so that a symmetric robot stays so
        let shares = &self.winding * wish;
        let rounded = shares.map(|share| (share / ROUNDING).round() * ROUNDING);
        let lift = (-rounded.min()).max(0.0);
        rounded.iter().map(|share| share + lift).collect()
    }

    /// Motor angles \[rad\] of these shares, 1 being `most`.
    pub fn angles(&self, shares: &[f64], most: f64) -> Vec<f64> {
        let signed = shares.iter().zip(&self.signs);
        signed.map(|(share, sign)| share * sign * most).collect()
    }
}
