//! A force spread over a rod.

use auxetica_engine::{Forcing, LoadView, Moment, ReadBody, Setting, Vec3, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// A constant force per built length of a rod.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UniformForce {
    /// Force per length, world frame [N/m].
    force: Vec3,
}

register!(
    dyn Forcing: UniformForce,
    example = "UniformForce(force: (0, 0, -0.1))",
    source = "PyElastica UniformForces",
);

impl Forcing for UniformForce {
    fn apply(&self, _now: &Moment<'_>, body: &mut LoadView<'_>) {
        for e in 0..body.elements() {
            let half = Vector3::from(*self.force) * (body.reference_length(e) / 2.0);
            body.add_force(e, half);
            body.add_force(e + 1, half);
        }
    }

    fn check(&self, setting: &Setting<'_>) -> Result<(), String> {
        if setting.body.is_rod() {
            Ok(())
        } else {
            Err("a force per length needs a rod; use EndForce for a rigid body".into())
        }
    }
}
