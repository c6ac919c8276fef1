//! Exponential damping of rates.

use auxetica_engine::{Damping, RateView, ReadBody, Setting, Vec3, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Multiplies rates by decaying exponentials, direction by direction: velocities by `exp(-c dt)` along the world's
/// axes, angular velocities by `exp(-c m dt / J)` to the power of the dilatation about the element's directors, with
/// the element's mass `m` and inertia `J`. It acts on rods and rigid bodies.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearDamping {
    /// Coefficients c of the velocities along world x, y, z [1/s].
    translational: Vec3,
    /// Coefficients c of the angular velocities about `d1, d2, d3` [m2/s].
    rotational: Vec3,
}

register!(
    dyn Damping: LinearDamping,
    example = "LinearDamping(translational: (10, 10, 10), rotational: (1e-2, 1e-2, 1e-2))",
    source = "HSA-PyElastica, per direction; PyElastica AnalyticalLinearDamper",
);

impl Damping for LinearDamping {
    fn damp(&self, dt: f64, body: &mut RateView<'_>) {
        let keep = Vector3::from(*self.translational).map(|c| (-c * dt).exp());
        for i in 0..body.nodes() {
            let velocity = body.velocity(i);
            body.set_velocity(i, velocity.component_mul(&keep));
        }
        for e in 0..body.directors() {
            let mass = if body.is_rod() {
                // end nodes belong to one element only
                let share = |i: usize| {
                    if i == 0 || i == body.elements() {
                        1.0
                    } else {
                        0.5
                    }
                };
                body.mass(e) * share(e) + body.mass(e + 1) * share(e + 1)
            } else {
                body.mass(0)
            };
            let (inertia, stretch) = (body.inertia(e), body.dilatation(e));
            let mut omega = body.omega(e);
            for j in 0..3 {
                omega[j] *= (-self.rotational[j] * dt * mass / inertia[j] * stretch).exp();
            }
            body.set_omega(e, omega);
        }
    }

    fn check(&self, _setting: &Setting<'_>) -> Result<(), String> {
        let coefficients = self.translational.iter().chain(self.rotational.iter());
        match coefficients.copied().find(|c| *c < 0.0) {
            Some(c) => Err(format!(
                "damping coefficients can't be negative, one is {c}; give 0 or more"
            )),
            None => Ok(()),
        }
    }
}
