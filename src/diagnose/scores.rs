//! How well a scenario does on recordings, and whether it does worse than another.

use super::forward::{differences, platform_rms, whitened};
use super::samples::Samples;
use super::verdict::{Estimated, Fitted, Scored};
use crate::compare::CompareError;
use crate::config::Source;

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

    /// The largest root mean square of the position errors on a training recording [mm].
    pub(super) fn worst_mm(&self) -> f64 {
        self.train.iter().map(|s| s.rms.0).fold(0.0, f64::max)
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
