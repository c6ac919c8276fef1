//! A mass carried along.

use auxetica_engine::{End, Place};
use auxetica_engine::{Finite, Forcing, LoadView, Moment, ReadBody, Vec3, Wrench, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// The weight of a mass fixed to a rigid body or to the tip of a rod.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Payload {
    /// Mass [kg]; negative for a body that is lighter than the scenario has it.
    mass: Finite,
    /// Its place from the body's centre, or from the far end of the rod's tip, in material components [m].
    #[serde(default)]
    at: Option<Vec3>,
    /// Acceleration, world frame [m/s2].
    #[serde(default)]
    g: Option<Vec3>,
}

register!(
    dyn Forcing: Payload,
    example = "Payload(mass: 0.1, at: (0.02, 0, 0), g: (0, 0, 9.81))",
    source = "weight",
);

impl Forcing for Payload {
    fn apply(&self, _now: &Moment<'_>, body: &mut LoadView<'_>) {
        let g = self
            .g
            .map_or(Vector3::new(0.0, 0.0, -9.80665), |g| Vector3::from(*g));
        let force = g * f64::from(self.mass);
        let at = self.at.map_or(Vector3::zeros(), |at| Vector3::from(*at));
        let last = body.directors() - 1;
        let torque = at.cross(&(body.director(last) * force));
        body.add_wrench(Place::End(End::Tip), &Wrench { force, torque });
    }
}
