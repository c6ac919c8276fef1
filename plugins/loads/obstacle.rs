//! Something in the way.

use auxetica_engine::{
    Direction, End, Forcing, LoadView, Moment, NonNegative, Place, Site, Vec3, Wrench, register,
};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// A smooth plane that the tip of a rod or the centre of a rigid body can't pass, by a penalty that grows from
/// nothing: `stiffness depth`, quadratic in the first 0.2 mm.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// A point of the plane, world frame [m].
    point: Vec3,
    /// Direction out of the obstacle.
    normal: Direction,
    /// Contact stiffness [N/m].
    stiffness: NonNegative,
}

register!(
    dyn Forcing: Obstacle,
    example = "Obstacle(point: (0.02, 0, 0.1), normal: (-1, 0, 0), stiffness: 500)",
    source = "penalty contact",
);

/// Depth within which the force is quadratic [m], so that Newton's method meets no kink.
const SOFTNESS: f64 = 2e-4;

impl Forcing for Obstacle {
    fn apply(&self, _now: &Moment<'_>, body: &mut LoadView<'_>) {
        let place = Place::End(End::Tip);
        let normal = Vector3::from(*self.normal);
        let from = Site::of(&body.read(), place).position - Vector3::from(*self.point);
        let depth = -normal.dot(&from);
        if depth <= 0.0 {
            return;
        }
        let eased = if depth < SOFTNESS {
            depth * depth / (2.0 * SOFTNESS)
        } else {
            depth - SOFTNESS / 2.0
        };
        let wrench = Wrench {
            force: normal * (*self.stiffness * eased),
            torque: Vector3::zeros(),
        };
        body.add_wrench(place, &wrench);
    }
}
