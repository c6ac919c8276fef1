//! How well a scenario does on recordings, and whether it does worse than another.

use super::forward::{CHANNELS, differences, platform_rms, whitened};
use super::samples::Samples;
use super::verdict::{Estimated, Fitted, Scored, Trace};
use crate::compare::CompareError;
use crate::config::Source;
use nalgebra::Vector3;

/// How far chi2 of a single recording, trained on or held out, may grow when an effect is added: a share of itself, or of
/// what is gained on all.
const WORSE: [f64; 2] = [0.05, 0.1];

/// How well a scenario does, recording by recording.
#[derive(Clone)]
pub(super) struct Scores {
    train: Vec<Score>,
    holdout: Vec<Score>,
}

#[derive(Clone)]
struct Score {
    name: String,
    /// Root mean squares of the platform: position [mm], rotation [mrad].
    rms: (f64, f64),
    /// Distance of the platform at each sample [mm].
    apart_mm: Vec<f64>,
    chi2: f64,
}

impl Scores {
    pub(super) fn of(
        source: &Source,
        train: &[Samples],
        holdout: &[Samples],
    ) -> Result<Self, CompareError> {
        let score = |samples: &Samples| -> Result<Score, CompareError> {
            let apart = differences(source, samples)
                .map_err(|e| CompareError::Unfit(format!("recording `{}`: {e}", samples.name)))?;
            let white = whitened(&apart, samples);
            Ok(Score {
                name: samples.name.clone(),
                rms: platform_rms(&apart, samples),
                apart_mm: (apart.chunks_exact(CHANNELS))
                    .map(|apart| 1e3 * Vector3::from_column_slice(&apart[..3]).norm())
                    .collect(),
                chi2: white.iter().map(|r| r * r).sum(),
            })
        };
        let all = |data: &[Samples]| data.iter().map(score).collect::<Result<Vec<_>, _>>();
        Ok(Self {
            train: all(train)?,
            holdout: all(holdout)?,
        })
    }

    /// Recordings, trained on or held out, that are done worse than before, in words.
    pub(super) fn worsened(&self, before: &Self) -> Vec<String> {
        let now = || self.train.iter().chain(&self.holdout);
        let pairs = || now().zip(before.train.iter().chain(&before.holdout));
        let gain: f64 = pairs().map(|(now, then)| then.chi2 - now.chi2).sum();
        let most = |then: &Score| (WORSE[0] * then.chi2).max(WORSE[1] * gain);
        let worse = pairs().filter(|(now, then)| now.chi2 - then.chi2 > most(then));
        let words = |(now, then): (&Score, &Score)| {
            format!(
                "what is named makes recording {} worse, from {:.3} mm and {:.2} mrad to {:.3} mm and {:.2} mrad: more is \
                 missing, or something else",
                now.name, then.rms.0, then.rms.1, now.rms.0, now.rms.1
            )
        };
        worse.map(words).collect()
    }

    /// Sum of the squared residuals of recordings held out.
    pub(super) fn held_out_chi2(&self) -> f64 {
        self.holdout.iter().map(|s| s.chi2).sum()
    }

    pub(super) fn fitted(&self, parameters: Vec<Estimated>, reduced_chi2: f64) -> Fitted {
        let scored = |role: &'static str| {
            move |s: &Score| Scored {
                name: s.name.clone(),
                role: role.to_owned(),
                position_rmse_mm: s.rms.0,
                rotation_rmse_mrad: s.rms.1,
            }
        };
        let recordings = self
            .train
            .iter()
            .map(scored("train"))
            .chain(self.holdout.iter().map(scored("holdout")));
        Fitted {
            parameters,
            recordings: recordings.collect(),
            reduced_chi2,
        }
    }

    /// The platform's error over time, without and with the effects that are named; `data` are the recordings of both.
    pub(super) fn traces(&self, before: &Self, data: [&[Samples]; 2]) -> Vec<Trace> {
        let winding = |[a, b, c, d]: [f64; 4]| ((a - b + c - d) / 4.0).to_degrees();
        let trace = |role: &str, samples: &Samples, before: &Score, after: &Score| Trace {
            recording: samples.name.clone(),
            role: role.to_owned(),
            time: samples.list.iter().map(|s| s.time).collect(),
            winding_deg: samples.list.iter().map(|s| winding(s.angles)).collect(),
            before_mm: before.apart_mm.clone(),
            after_mm: after.apart_mm.clone(),
        };
        let roles = [
            ("train", data[0], &before.train, &self.train),
            ("holdout", data[1], &before.holdout, &self.holdout),
        ];
        let each = roles.into_iter().flat_map(|(role, data, before, after)| {
            let pairs = data.iter().zip(before.iter().zip(after));
            pairs.map(move |(samples, (before, after))| trace(role, samples, before, after))
        });
        each.collect()
    }

    /// The recording with the largest root mean square of position errors, and that [mm].
    pub(super) fn worst(&self) -> (&str, f64) {
        let all = self.train.iter().chain(&self.holdout);
        let worst = all.max_by(|a, b| a.rms.0.total_cmp(&b.rms.0));
        worst.map_or(("", 0.0), |s| (&s.name, s.rms.0))
    }

    /// Root mean square of the position errors on training recordings [mm].
    pub(super) fn train_mm(&self) -> f64 {
        mean_mm(&self.train)
    }

    /// The same on those held out.
    pub(super) fn held_out_mm(&self) -> f64 {
        mean_mm(&self.holdout)
    }
}

fn mean_mm(scores: &[Score]) -> f64 {
    (scores.iter().map(|s| s.rms.0.powi(2)).sum::<f64>() / scores.len() as f64).sqrt()
}
