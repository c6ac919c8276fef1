//! How far simulation and recording differ.

use super::simulated::BODIES;
use super::{Mode, Observed, SampleKind, Simulated};
use nalgebra::Vector3;
use serde::Serialize;

/// The difference between a simulation and a recording. Its JSON keys are stable.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name of the recording.
    pub recording: String,
    /// Name of the scenario.
    pub scenario: String,
    /// How the scenario was driven.
    pub mode: Mode,
    /// Which steady samples were taken.
    pub sample_kind: SampleKind,
    /// Where the recorded poses come from.
    pub origin: &'static str,
    /// Samples compared.
    pub samples: usize,
    /// Dwells of the recording that gave no sample.
    pub skipped: usize,
    /// Samples for which no steady state was found.
    pub unsolved: usize,
    /// The bodies.
    pub bodies: Vec<BodyMismatch>,
    /// Rows at the settled end of a dwell, if every row is compared.
    pub settled_samples: usize,
    /// The bodies at these.
    pub settled: Vec<BodyMismatch>,
    /// What is odd about the recording, in lines.
    pub audit: Vec<String>,
    /// Time the simulation took \[s\].
    pub seconds: f64,
}

/// The difference at one body: simulated less recorded.
#[derive(Clone, Debug, Serialize)]
pub struct BodyMismatch {
    /// `platform` or `ring`.
    pub name: &'static str,
    /// Root mean square of the marker point's distance \[mm\].
    pub position_rmse_mm: f64,
    /// Root mean square of the rotation angle between both \[mrad\].
    pub rotation_rmse_mrad: f64,
    /// Mean displacement \[mm\] in the base frame.
    pub position_bias_mm: [f64; 3],
    /// The sample that differs most in position.
    pub worst: Worst,
}

/// The sample that differs most.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// Number of the sample, from 0.
    pub sample: usize,
    /// Its time \[s\].
    pub time_s: f64,
    /// Its distance \[mm\].
    pub position_mm: f64,
}

impl Comparison {
    /// Measures the difference.
    pub fn new(
        scenario: &str,
        observed: &Observed,
        simulated: &Simulated,
        mode: Mode,
        sample_kind: SampleKind,
        seconds: f64,
    ) -> Self {
        let all: Vec<usize> = (0..observed.time.len()).collect();
        let body = |b: usize| BodyMismatch::new(b, observed, simulated, &all);
        let settled = |b: usize| BodyMismatch::new(b, observed, simulated, &observed.settled);
        Self {
            recording: observed.name.clone(),
            scenario: scenario.into(),
            mode,
            sample_kind,
            origin: observed.origin,
            samples: observed.time.len() - simulated.unsolved.len(),
            skipped: observed.skipped,
            unsolved: simulated.unsolved.len(),
            bodies: vec![body(0), body(1)],
            settled_samples: observed.settled.len(),
            settled: match &*observed.settled {
                [] => Vec::new(),
                _ => vec![settled(0), settled(1)],
            },
            audit: observed
                .audit
                .to_string()
                .lines()
                .map(str::to_owned)
                .collect(),
            seconds,
        }
    }
}

impl BodyMismatch {
    fn new(b: usize, observed: &Observed, simulated: &Simulated, samples: &[usize]) -> Self {
        let mut count = 0.0;
        let (mut squares, mut turns, mut sum) = (0.0, 0.0, Vector3::zeros());
        let mut worst = Worst {
            sample: 0,
            time_s: observed.time[0],
            position_mm: 0.0,
        };
        for &sample in samples {
            let recorded = &observed.poses[b][sample];
            let Some(shown) = &simulated.poses[b][sample] else {
                continue;
            };
            let apart = (shown.translation.vector - recorded.translation.vector) * 1e3;
            count += 1.0;
            sum += apart;
            squares += apart.norm_squared();
            turns += (shown.rotation.angle_to(&recorded.rotation) * 1e3).powi(2);
            if apart.norm() > worst.position_mm {
                worst = Worst {
                    sample,
                    time_s: observed.time[sample],
                    position_mm: apart.norm(),
                };
            }
        }
        let rms = |squares: f64| (squares / count).sqrt();
        Self {
            name: BODIES[b],
            position_rmse_mm: rms(squares),
            rotation_rmse_mrad: rms(turns),
            position_bias_mm: (sum / count).into(),
            worst,
        }
    }
}
