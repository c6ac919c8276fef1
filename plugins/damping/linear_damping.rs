//! Exponential damping of rates.

use auxetica_engine::elementary::exp_of_each;
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

/// Elements whose exponentials are computed together.
const LANES: usize = 8;

impl WithSimd for Decay<'_> {
    type Output = ();

    #[allow(clippy::needless_range_loop)] // iterators needn't be inlined, which vectors need
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let mut exponents = [0.0; LANES];
        for j in 0..3 {
            exponents[j] = -self.damping.translational[j] * self.dt;
        }
        let keep = exp_of_each(&exponents);
        for j in 0..3 {
            for v in self.rates.velocity[j].iter_mut() {
                *v *= keep[j];
            }
        }
        let frames = self.rates.dilatation.len();
        let rest = frames % LANES;
        for first in (0..frames - rest).step_by(LANES) {
            self.damp_frames(first, LANES, 0);
        }
        match rest {
            0 => {}
            few if few == frames => self.damp_frames(0, few, 0),
            // whole blocks are vectors: the last one reaches back over frames that are damped already
            _ => self.damp_frames(frames - LANES, LANES, LANES - rest),
        }
    }
}

impl Decay<'_> {
    /// Damps the angular velocities of at most [`LANES`] frames but those that are done.
    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    fn damp_frames(&mut self, first: usize, count: usize, done: usize) {
        let RateSlices {
            omega,
            mass,
            inverse_inertia,
            dilatation,
            ..
        } = &mut self.rates;
        let frames = dilatation.len();
        let dilatation = &dilatation[first..][..count];
        // twice the mass of each frame
        let mut weight = [0.0; LANES];
        if self.rigid {
            weight[0] = 2.0 * mass[0];
        } else {
            let (before, after) = (&mass[first..][..count], &mass[first + 1..][..count]);
            for l in 0..count {
                weight[l] = before[l] + after[l];
            }
            // end nodes belong to one element only
            if first == 0 {
                weight[0] += mass[0];
            }
            if first + count == frames {
                weight[count - 1] += mass[frames];
            }
        }
        let (mut last, mut keep) = ([0.0_f64; LANES], [1.0; LANES]);
        for j in 0..3 {
            let coefficient = -self.damping.rotational[j] * self.dt / 2.0;
            let inverse = &inverse_inertia[j][first..][..count];
            let mut exponents = [0.0_f64; LANES];
            for l in 0..count {
                exponents[l] = coefficient * weight[l] * inverse[l] * dilatation[l];
            }
            // about d1 and d2 of a round section it is the same
            let mut different = 0;
            for l in 0..LANES {
                different |= exponents[l].to_bits() ^ last[l].to_bits();
            }
            if different != 0 {
                keep = exp_of_each(&exponents);
                last = exponents;
            }
            let omega = &mut omega[j][first..][..count];
            for l in done..count {
                omega[l] *= keep[l];
            }
        }
    }
}
