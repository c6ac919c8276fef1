//! Exponential damping of rates.

use auxetica_engine::elementary::exp;
use auxetica_engine::{Damping, RateSlices, RateView, ReadBody, Setting, Vec3, register};
use pulp::{Simd, WithSimd};
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
        let (rigid, rates) = (!body.is_rod(), body.slices());
        rates.arch.dispatch(Decay {
            damping: self,
            dt,
            rigid,
            rates,
        });
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

/// One step of damping of one body, compiled for the machine's vectors.
struct Decay<'a> {
    damping: &'a LinearDamping,
    dt: f64,
    rigid: bool,
    rates: RateSlices<'a>,
}

impl WithSimd for Decay<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (dt, rates) = (self.dt, self.rates);
        let (frames, nodes) = (rates.dilatation.len(), rates.mass.len());
        for j in 0..3 {
            let keep = exp(-self.damping.translational[j] * dt);
            for v in rates.velocity[j].iter_mut() {
                *v *= keep;
            }
            let (omega, inertia) = (&mut rates.omega[j][..frames], &rates.inertia[j][..frames]);
            let coefficient = -self.damping.rotational[j] * dt;
            if self.rigid {
                omega[0] *= exp(coefficient * rates.mass[0] / inertia[0]);
                continue;
            }
            let (before, after) = (&rates.mass[..frames], &rates.mass[1..=frames]);
            for e in 0..frames {
                let mass = (before[e] + after[e]) / 2.0;
                omega[e] *= exp(coefficient * mass / inertia[e] * rates.dilatation[e]);
            }
            // end nodes belong to one element only
            for (e, node) in [(0, 0), (frames - 1, nodes - 1)] {
                let mass = rates.mass[node] / 2.0;
                omega[e] *= exp(coefficient * mass / inertia[e] * rates.dilatation[e]);
            }
        }
    }
}
