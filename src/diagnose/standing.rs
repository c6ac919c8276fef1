//! What a diagnosis has come to: the scenario with the effects that are named so far, fitted.

use super::forward::CHANNELS;
use super::samples::{KINDS, Samples};
use super::scores::Scores;
use super::search::{self, Candidate, Form};
use super::shared::{self, Shared};
use super::trial::{Linear, Trial};
use super::{DiagnoseError, LEFT, ODDS, unfit};
use crate::config::Source;
use crate::identify::{Effect, Variant};
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use statrs::statistics::{Data, Median};
use std::sync::Arc;

/// Share of chi2 that an effect must explain to be named, and a further one where little is left to explain.
pub(super) const GAIN: [f64; 2] = [0.25, 0.5];
/// The same where the calibrated scenario is far off: many things are missing then, none of which explains much.
const GAIN_FAR_OFF: f64 = 0.1;
/// How many effects are held against recordings held out before a search is given up.
const TRIED: usize = 3;
/// Shares of chi2 within which two effects can't be told apart, beside [`ODDS`].
const ALIKE: f64 = 0.1;
/// Times the least chi2 beyond which a candidate isn't among the best.
const PLAINLY_WORSE: f64 = 2.0;
/// Steps of the calibration, and of fits that begin near their end.
const STEPS: (usize, usize) = (12, 4);

/// What a search goes through.
pub(super) struct Among<'a, 'b> {
    /// All forms.
    pub(super) forms: &'a [Form],
    /// Their effects.
    pub(super) effects: &'b [Box<dyn Effect>],
    /// Whether causes are sought, or terms that only describe.
    pub(super) causes: bool,
}

impl Among<'_, '_> {
    fn is_cause(&self, form: usize) -> bool {
        self.effects[self.forms[form].effect].is_cause()
    }
}

/// A fitted model and what it was chosen among.
#[derive(Clone)]
pub(super) struct Standing<'a> {
    /// The model.
    pub(super) trial: Trial<'a>,
    /// Its fit.
    pub(super) fit: Linear,
    /// The fit that takes errors of mesh and recordings that samples share for noise: it says what they don't explain. The
    /// other one predicts better with the mesh that there is.
    pub(super) tolerant: Linear,
    /// Change of each fitted value with a finer mesh, to first order; zero where that can't be told.
    pub(super) with_mesh: Vec<f64>,
    /// How well it does.
    pub(super) scores: Scores,
    /// Forms that are named, and the probability of each among those that were tried.
    pub(super) named: Vec<(usize, f64)>,
    /// Effects that do as well as the last one that was named.
    pub(super) alternatives: Vec<Alternative<'a>>,
}

/// An effect that does as well as the last one that was named.
#[derive(Clone)]
pub(super) struct Alternative<'a> {
    /// Which effect.
    pub(super) effect: usize,
    /// The model with it, and the values that fit best.
    pub(super) model: (Trial<'a>, Vec<f64>),
}

/// The best of candidates.
struct Ranked<'c> {
    best: &'c Candidate,
    /// Chi2 that it leaves.
    left: f64,
    /// Its probability among the candidates.
    probability: f64,
    /// The best of other effects that do as well.
    alike: Vec<&'c Candidate>,
}

impl<'a> Standing<'a> {
    /// The scenario without effects, its own numbers fitted from their nominal values and from one place in their ranges.
    ///
    /// # Errors
    /// If the scenario has no steady state at a sample.
    pub(super) fn calibrated(
        empty: Trial<'a>,
        holdout: &[Samples],
        seed: u64,
    ) -> Result<Self, DiagnoseError> {
        let (empty, start) = nominal(empty)?;
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let elsewhere: Vec<f64> = (empty.own.iter())
            .map(|p| {
                let to = p.range.0 + random.random::<f64>() * p.width();
                p.nominal + 0.3 * (to - p.nominal)
            })
            .collect();
        let all = 0..elsewhere.len();
        let other = empty.start(&elsewhere, Some(&start));
        let fit = |start: Linear| empty.fit(start, all.clone(), STEPS.0);
        let (first, second) = rayon::join(|| fit(start), || other.map(fit));
        let fit = match second {
            Ok(second) if second.chi2() < first.chi2() - 1e-6 * first.chi2() => second,
            _ => first,
        };
        let (empty, fit) = settled(empty, fit);
        let scenario = empty.scenario(&fit.at).map_err(unfit)?;
        let (tolerant, with_mesh) = tolerant(&empty, &fit)?;
        Ok(Self {
            scores: Scores::of(&scenario, empty.data, holdout)?,
            tolerant,
            with_mesh,
            trial: empty,
            fit,
            named: Vec::new(),
            alternatives: Vec::new(),
        })
    }

    /// The scenario.
    pub(super) fn scenario(&self) -> Result<Source, DiagnoseError> {
        self.trial.scenario(&self.fit.at).map_err(unfit)
    }

    /// Squared residuals that shared errors don't explain, the mean over all measured numbers.
    pub(super) fn mean_square(&self) -> f64 {
        self.tolerant.chi2() / self.trial.measured()
    }

    /// Sum of the squared residuals beyond what noise and shared errors make.
    pub(super) fn beyond_noise(&self) -> f64 {
        (self.tolerant.chi2() - self.trial.measured()).max(0.0)
    }

    /// The same with one more form of those that `among` allows, if there is one that is worth it.
    ///
    /// # Errors
    /// If a scenario has no steady state at a sample.
    pub(super) fn grown(
        &self,
        among: &Among<'a, '_>,
        holdout: &[Samples],
        told: &(dyn Fn(f64) + Sync),
    ) -> Result<Option<Self>, DiagnoseError> {
        let forms = among.forms;
        let used = |group| self.named.iter().any(|(f, _)| forms[*f].group == group);
        let open = |f: &usize| !used(forms[*f].group) && among.is_cause(*f) == among.causes;
        let open = (0..forms.len()).filter(open).collect();
        let mut found = search::round(&self.trial, &self.fit, forms, open, told);
        let much = self.named.is_empty() || self.mean_square() > LEFT;
        let gain = match much {
            _ if self.trial.data[0].weighed() => GAIN_FAR_OFF,
            true => GAIN[0],
            false => GAIN[1],
        };
        for _ in 0..TRIED {
            let Some(ranked) = self.ranked(&self.tolerated(&found, forms)?, forms) else {
                break;
            };
            if ranked.left > (1.0 - gain) * self.tolerant.chi2() {
                break;
            }
            let refused = forms[ranked.best.form].group;
            let next = self.joined(&ranked, forms, holdout)?;
            // what is no cause has nothing to say for itself but that it does well throughout
            let does_well =
                |next: &Self| among.causes || next.scores.worsened(&self.scores).is_empty();
            if let Some(next) = next.filter(does_well) {
                return Ok(Some(next));
            }
            found.retain(|c| forms[c.form].group != refused);
        }
        Ok(None)
    }

    /// Those of the candidates that aren't plainly worse than the best, with the chi2 that is left where errors shared by
    /// samples are noise. The errors are those at the best candidate: what the mesh does depends little on which.
    fn tolerated<'c>(
        &self,
        found: &'c [Candidate],
        forms: &'a [Form],
    ) -> Result<Vec<(f64, &'c Candidate)>, DiagnoseError> {
        let Some(best) = found.first() else {
            return Ok(vec![]);
        };
        let with = |c: &Candidate| self.trial.with(&forms[c.form].variant);
        let (shared, _) = shared_errors(&with(best), &best.fit)?;
        // errors that are shared don't make up for a fit that is plainly worse
        let close = |c: &&Candidate| c.fit.chi2() <= PLAINLY_WORSE * best.fit.chi2();
        let shared = Arc::new(shared);
        let left = |candidate: &'c Candidate| {
            let fit = with(candidate).tolerating(&candidate.fit, shared.clone(), STEPS.1);
            (fit.chi2(), candidate)
        };
        Ok(found.par_iter().filter(close).map(left).collect())
    }

    /// The same with a form that was fitted, unless recordings held out refuse it.
    fn joined(
        &self,
        ranked: &Ranked<'_>,
        forms: &'a [Form],
        holdout: &[Samples],
    ) -> Result<Option<Self>, DiagnoseError> {
        let best = ranked.best;
        let mut named = self.named.clone();
        named.push((best.form, ranked.probability));
        let mut trial = self.trial.with(&forms[best.form].variant);
        let mut fit = best.fit.clone();
        drop_needless(&mut trial, &mut fit, &mut named);
        let (trial, fit) = settled(trial, fit);
        let scenario = trial.scenario(&fit.at).map_err(unfit)?;
        // a model that can't follow a recording held out is worse there
        let Ok(scores) = Scores::of(&scenario, trial.data, holdout) else {
            return Ok(None);
        };
        if scores.held_out_chi2() > self.scores.held_out_chi2() {
            return Ok(None);
        }
        let (tolerant, with_mesh) = tolerant(&trial, &fit)?;
        // what only helps beyond what is physical is not a further cause
        if named.len() > 1 && !trial.astray(&tolerant).is_empty() {
            return Ok(None);
        }
        let alternative = |c: &Candidate| {
            let Form {
                effect, variant, ..
            } = &forms[c.form];
            Alternative {
                effect: *effect,
                model: (self.trial.with(variant), c.fit.at.clone()),
            }
        };
        let alternatives = ranked.alike.iter().copied().map(alternative).collect();
        Ok(Some(Self {
            tolerant,
            with_mesh,
            fit,
            trial,
            scores,
            named,
            alternatives,
        }))
    }

    /// The best of fitted forms, its probability, and the effects that do as well.
    fn ranked<'c>(&self, found: &[(f64, &'c Candidate)], forms: &[Form]) -> Option<Ranked<'c>> {
        let measured = self.trial.measured();
        let least = found.iter().map(|c| c.0).min_by(f64::total_cmp)?;
        let scale = (least / measured).max(1.0);
        let cost = |(left, c): &(f64, &Candidate)| {
            left / scale + forms[c.form].variant.quantities.len() as f64 * measured.ln()
        };
        let mut ranked: Vec<_> = found.iter().map(|c| (cost(c), c.0, c.1)).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (best_cost, best_left, best) = ranked[0];
        let mut weights = Vec::new();
        let mut alike = Vec::new();
        for (cost, left, candidate) in &ranked {
            let Form { effect, group, .. } = forms[candidate.form];
            if weights.iter().any(|(g, _)| *g == group) {
                continue;
            }
            let same = cost - best_cost < ODDS || *left < (1.0 + ALIKE) * best_left;
            if same && effect != forms[best.form].effect {
                alike.push(*candidate);
            }
            // those that can't be told apart are as likely
            let weight = if same {
                1.0
            } else {
                (-(cost - best_cost) / 2.0).exp()
            };
            weights.push((group, weight));
        }
        let total: f64 = weights.iter().map(|(_, weight)| weight).sum();
        Some(Ranked {
            best,
            left: best_left,
            probability: 1.0 / total,
            alike,
        })
    }
}

/// The scenario's own numbers fitted from their nominal values.
///
/// # Errors
/// If the scenario has no steady state at a sample.
pub(super) fn fitted(empty: Trial<'_>) -> Result<(Trial<'_>, Linear), DiagnoseError> {
    let (empty, start) = nominal(empty)?;
    let all = 0..start.at.len();
    let fit = empty.fit(start, all, STEPS.0);
    Ok(settled(empty, fit))
}

/// The scenario at its nominal values, with the doubt that its residuals there tell.
fn nominal(empty: Trial<'_>) -> Result<(Trial<'_>, Linear), DiagnoseError> {
    let nominal: Vec<f64> = empty.own.iter().map(|p| p.nominal).collect();
    let mut start = empty.start(&nominal, None).map_err(unfit)?;
    Ok((empty.doubting(&mut start), start))
}

/// How many deviations each kind of channel is off: root mean squares of recordings, and of these the median.
pub(super) fn off(trial: &Trial<'_>, fit: &Linear) -> [f64; KINDS.len()] {
    let mut each: [Vec<f64>; KINDS.len()] = Default::default();
    let mut rest = fit.residuals.as_slice();
    for samples in trial.data {
        let (own, others) = rest.split_at(samples.list.len() * CHANNELS);
        rest = others;
        let mut squares = [0.0; KINDS.len()];
        for (i, r) in own.iter().enumerate() {
            squares[i % CHANNELS / 3] += r * r;
        }
        for (each, sum) in each.iter_mut().zip(squares) {
            each.push((sum * KINDS.len() as f64 / own.len() as f64).sqrt());
        }
    }
    each.map(|of_recordings| Data::new(of_recordings).median())
}

/// A fit continued as far as what is known beforehand must count otherwise now.
fn settled<'a>(trial: Trial<'a>, mut fit: Linear) -> (Trial<'a>, Linear) {
    let trial = trial.doubting(&mut fit);
    let all = 0..fit.at.len();
    let fit = trial.fit(fit, all, STEPS.1);
    (trial, fit)
}

/// Drops effects that were named earlier and that the last one makes needless.
fn drop_needless(trial: &mut Trial<'_>, fit: &mut Linear, named: &mut Vec<(usize, f64)>) {
    let measured = trial.measured();
    for k in (0..named.len() - 1).rev() {
        let numbers = |form: &Variant| form.quantities.len();
        let from = trial.own.len() + trial.forms[..k].iter().map(|f| numbers(f)).sum::<usize>();
        let gone = from..from + numbers(trial.forms[k]);
        let mut less = trial.clone();
        less.forms.remove(k);
        let mut at = fit.at.clone();
        at.drain(gone.clone());
        let Ok(start) = less.start(&at, Some(fit)) else {
            continue;
        };
        let all = 0..at.len();
        let without = less.fit(start, all, STEPS.1);
        let scale = (fit.chi2() / measured).max(1.0);
        let worth = gone.len() as f64 * measured.ln() + ODDS;
        if without.chi2() - fit.chi2() < worth * scale {
            (*trial, *fit) = (less, without);
            named.remove(k);
        }
    }
}

/// A fit continued with the errors that samples share, and what a finer mesh would do to its values.
fn tolerant(trial: &Trial<'_>, fit: &Linear) -> Result<(Linear, Vec<f64>), DiagnoseError> {
    let (shared, finer) = shared_errors(trial, fit)?;
    let still = || vec![0.0; fit.at.len()];
    let with_mesh = finer.map_or_else(still, |finer| trial.response(fit, &finer));
    Ok((trial.tolerating(fit, Arc::new(shared), STEPS.1), with_mesh))
}

/// Errors that samples share at a fit, and what a finer mesh does there; where another mesh has no steady states, its
/// difference isn't known.
fn shared_errors(
    trial: &Trial<'_>,
    fit: &Linear,
) -> Result<(Shared, Option<DVector<f64>>), DiagnoseError> {
    let source = trial.scenario(&fit.at).map_err(unfit)?;
    let biases = Shared::biases(trial.data);
    Ok(match shared::meshes(&source, trial.data) {
        Ok(meshes) => {
            let finer = meshes[0].clone();
            (biases.with(meshes), Some(finer))
        }
        Err(_) => (biases, None),
    })
}
