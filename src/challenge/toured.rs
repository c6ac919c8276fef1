//! Simulated recordings: the motors' way, steady states, and what motion capture makes of them.

use super::spec::Tours;
use super::{ChallengeError, RECORDINGS, set_points};
use crate::compare::{Film, film};
use crate::config::Source;
use crate::recordings::{Pose, RADIANS_PER_TICK, Recording, RobotGeometry};
use nalgebra::{UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use statrs::distribution::{ContinuousCDF, Normal};

/// Deviation of what motors report as their loads.
const LOAD_NOISE: f64 = 2.0;

/// Standard normal draws.
pub(super) fn normal(random: &mut Pcg64Mcg) -> f64 {
    Normal::standard().inverse_cdf(random.random_range(1e-12..1.0 - 1e-12))
}

impl Tours {
    /// Recordings of a scenario whose rods are handed so.
    ///
    /// # Errors
    /// If it has no steady state at a row.
    pub(super) fn recordings(
        &self,
        source: &Source,
        handed: &[f64],
        random: &mut Pcg64Mcg,
    ) -> Result<Vec<Recording>, ChallengeError> {
        let one = |name: &&str| self.recording(name, source, handed, random);
        RECORDINGS.iter().map(one).collect()
    }

    fn recording(
        &self,
        name: &str,
        source: &Source,
        handed: &[f64],
        random: &mut Pcg64Mcg,
    ) -> Result<Recording, ChallengeError> {
        let geometry = RobotGeometry::default();
        let azimuths = geometry.rods.map(|[x, y]| f64::atan2(y, x));
        let kind = name.rsplit('_').next().unwrap_or_default();
        let points = set_points::set_points(kind, self, &azimuths, random);
        let (times, wound, goals) = set_points::rows(&points, self);
        let ticks = |wound: &[f64]| -> [f64; 4] {
            std::array::from_fn(|i| (handed[i] * wound[i] / RADIANS_PER_TICK).round())
        };
        let present: Vec<[f64; 4]> = wound.iter().map(|w| ticks(w)).collect();
        let goal: Vec<[f64; 4]> = goals.iter().map(|k| ticks(&points[*k])).collect();
        let angles: Vec<[f64; 4]> =
            (present.iter().map(|row| row.map(|t| t * RADIANS_PER_TICK))).collect();
        let Film { poses, loads } =
            film(source, &times, &angles).map_err(|e| ChallengeError::Unfit(e.to_string()))?;

        let vector =
            |size: f64, random: &mut Pcg64Mcg| Vector3::from_fn(|_, _| size * normal(random));
        let bias = [0, 1].map(|_| (vector(*self.bias.0, random), vector(*self.bias.1, random)));
        let mut seen = |b: usize, pose: &Pose| {
            let shift = bias[b].0 + vector(*self.noise.0, random);
            let turn = UnitQuaternion::from_scaled_axis(bias[b].1 + vector(*self.noise.1, random));
            let moved = pose.translation.vector + shift;
            Pose::from_parts(moved.into(), turn * pose.rotation)
        };
        let poses: Vec<[Pose; 2]> = (poses.iter())
            .map(|[platform, ring]| [seen(0, platform), seen(1, ring)])
            .collect();
        let late = *self.jitter / 2.0_f64.sqrt();
        let most = 0.4 / *self.rate;
        let time = (times.iter())
            .map(|t| 1.0 + t + (late * normal(random)).clamp(-most, most))
            .collect();
        // draws of their own, so that others don't depend on whether loads are reported
        let mut apart = Pcg64Mcg::seed_from_u64(random.clone().random());
        let silent = loads.iter().flatten().all(|load| *load == 0.0);
        let noise = if silent { 0.0 } else { LOAD_NOISE };
        let mut report = |load: f64| (load + noise * normal(&mut apart)).round();
        let loads = loads.into_iter().map(|row| row.map(&mut report)).collect();
        Ok(Recording::simulated(
            name,
            time,
            goal,
            (present, loads),
            &poses,
        ))
    }
}
