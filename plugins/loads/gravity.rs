//! Weight.

use auxetica_engine::{End, Forcing, LoadView, Moment, Place, ReadBody, Vec3, Wrench, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Uniform gravity on nodes, rigid ends and rigid bodies.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gravity {
    /// Acceleration, world frame [m/s2].
    #[serde(default = "down")]
    g: Vec3,
}

fn down() -> Vec3 {
    Vec3::new([0.0, 0.0, -9.80665]).expect("gravity is finite")
}

register!(
    dyn Forcing: Gravity,
    example = "Gravity(g: (0, 0, -9.81))",
    source = "PyElastica GravityForces",
);

impl Forcing for Gravity {
    fn apply(&self, _now: &Moment<'_>, body: &mut LoadView<'_>) {
        let g = Vector3::from(*self.g);
        for i in 0..body.nodes() {
            let weight = g * body.mass(i);
            body.add_force(i, weight);
        }
        // The node's mass includes its rigid end, whose weight acts at the middle of it: half as far as its end.
        for end in [End::Start, End::Tip] {
            let cap = body.cap(end);
            if cap.mass > 0.0 {
                let weight = g * (cap.mass / 2.0);
                let node = if end == End::Start {
                    0
                } else {
                    body.nodes() - 1
                };
                body.add_force(node, -weight);
                let at_far_end = Wrench {
                    force: weight,
                    torque: Vector3::zeros(),
                };
                body.add_wrench(Place::End(end), &at_far_end);
            }
        }
    }
}
