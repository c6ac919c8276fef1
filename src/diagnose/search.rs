//! The search for effects: screen all in one linearised pass, fit the best, keep what is worth it, begin again.

use super::forward::{Guide, Shown};
use super::trial::{DAMPING, Linear, Trial};
use crate::identify::{Effect, Robot, Variant};
use rayon::prelude::*;
use std::ops::Range;

/// An effect in one of its forms.
pub struct Form {
    /// The effect.
    pub effect: usize,
    /// The form.
    pub variant: Variant,
}

/// All forms of the effects that can act on a robot.
#[must_use]
pub fn forms(effects: &[Box<dyn Effect>], robot: &Robot) -> Vec<Form> {
    let each = effects.iter().enumerate();
    each.flat_map(|(effect, e)| {
        let variants = e.variants(robot).into_iter();
        variants.map(move |variant| Form { effect, variant })
    })
    .collect()
}

/// A form that was fitted.
pub struct Candidate {
    /// Which form.
    pub form: usize,
    /// The fit: values of the scenario, of the forms before, and of this one.
    pub fit: Linear,
}

/// How many forms are fitted in a round, and how many of one effect.
const FITTED: usize = 10;
const OF_EFFECT: usize = 2;
/// Times the least promised chi2 beyond which forms are not fitted, but so many are in any case.
const POOR: f64 = 30.0;
const AT_LEAST: usize = 6;
/// Forms that are screened at once.
const SCREENED: usize = 12;
/// Steps of the fits before the worse are given up, and how many times the least chi2 is too much then.
const HEATS: [(usize, f64); 3] = [(1, 12.0), (2, 5.0), (8, f64::INFINITY)];
/// Times the present chi2 at which no fit begins.
const FAR: f64 = 20.0;

/// Fits the forms that promise most when they are added to `base`, the best first.
pub fn round(
    base: &Trial<'_>,
    here: &Linear,
    guides: &[Guide],
    forms: &[Form],
    used: &[usize],
    told: &(dyn Fn(f64) + Sync),
) -> Vec<Candidate> {
    let guided = Trial {
        guides,
        ..base.clone()
    };
    let with = |form: usize| guided.with(&forms[form].variant);
    let open: Vec<usize> = (0..forms.len())
        .filter(|f| !used.contains(&forms[*f].effect))
        .collect();
    let done = std::sync::atomic::AtomicUsize::new(0);
    let tick = |all: usize, from: f64, to: f64| {
        let done = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
        told(from + (to - from) * done as f64 / all as f64);
    };
    // those that remember take more states, which others need not pay for
    let remembers = |form: &usize| {
        let trial = with(*form);
        let typical = trial.scenario(&trial.typical(&here.at));
        let shown = typical.map(|source| Shown::new(&source, &trial.data[0]));
        matches!(shown, Ok(Ok(shown)) if shown.remembers())
    };
    let (slow, fast): (Vec<usize>, Vec<usize>) = open.into_par_iter().partition(remembers);
    let chunks: Vec<&[usize]> = slow.chunks(SCREENED).chain(fast.chunks(SCREENED)).collect();
    let screened = chunks.par_iter().flat_map(|chunk| {
        let some = screen(&guided, here, forms, chunk);
        tick(chunks.len(), 0.0, 0.3);
        some
    });
    let mut promises: Vec<Promise> = screened.collect();
    promises.sort_by(|a, b| a.left.total_cmp(&b.left).then(a.form.cmp(&b.form)));
    // the best forms of each of the best effects
    let mut chosen: Vec<Promise> = Vec::new();
    for promise in promises {
        let same = |p: &&Promise| forms[p.form].effect == forms[promise.form].effect;
        let poor = promise.left > POOR * chosen.first().map_or(f64::INFINITY, |best| best.left);
        if poor && chosen.len() >= AT_LEAST {
            break;
        }
        if chosen.len() < FITTED && chosen.iter().filter(same).count() < OF_EFFECT {
            chosen.push(promise);
        }
    }
    done.store(0, std::sync::atomic::Ordering::Relaxed);
    let begun = chosen.par_iter().filter_map(|promise| {
        let begun = begin(&with(promise.form), here, &promise.at);
        tick(chosen.len(), 0.3, 0.5);
        begun.map(|fit| Candidate {
            form: promise.form,
            fit,
        })
    });
    let mut fitted: Vec<Candidate> = begun.collect();
    for (heat, (steps, hopeless)) in HEATS.into_iter().enumerate() {
        done.store(0, std::sync::atomic::Ordering::Relaxed);
        let all = fitted.len();
        let fit = |candidate: Candidate| {
            let trial = with(candidate.form);
            // what other numbers do changes little at first
            let fresh = match heat {
                0 => here.at.len(),
                _ => 0,
            };
            let fresh = fresh..candidate.fit.at.len();
            let fit = trial.fit(candidate.fit, fresh, steps);
            let from = 0.5 + heat as f64 / 6.0;
            tick(all, from, from + 1.0 / 6.0);
            Candidate { fit, ..candidate }
        };
        fitted = fitted.into_par_iter().map(fit).collect();
        let chi2 = |c: &Candidate| c.fit.chi2();
        fitted.sort_by(|a, b| chi2(a).total_cmp(&chi2(b)).then(a.form.cmp(&b.form)));
        let least = fitted.first().map_or(0.0, chi2);
        fitted.retain(|c| chi2(c) <= hopeless * least);
    }
    fitted
}

/// What a form promises: what would be left of chi2 by the linearised model, and at which values.
struct Promise {
    form: usize,
    left: f64,
    at: Vec<f64>,
}

/// Forms, linearised: how the present states would change to first order if a form had its typical values, and how that
/// depends on them.
fn screen(trial: &Trial<'_>, here: &Linear, forms: &[Form], which: &[usize]) -> Vec<Promise> {
    let pairs = |form: usize| {
        let added = trial.with(&forms[form].variant);
        let typical = added.typical(&here.at);
        let mut pairs = vec![(0.5, [added.scenario(&typical)?, trial.scenario(&here.at)?])];
        for j in here.at.len()..typical.len() {
            pairs.push(added.pair(&typical, j)?);
        }
        Ok((added, typical, pairs))
    };
    let (mut each, mut all, mut places) = (Vec::new(), Vec::new(), Vec::new());
    for &form in which {
        let Ok::<_, String>((added, typical, pairs)) = pairs(form) else {
            continue;
        };
        places.push(all.len()..all.len() + pairs.len());
        all.extend(pairs);
        each.push((form, added, typical));
    }
    let base = trial.scenario(&here.at);
    let Ok((residuals, slopes)) = base.and_then(|b| trial.slopes(&b, &all, f64::INFINITY)) else {
        // one of them can't be built or has no state: the others can
        return match which.split_at(which.len() / 2) {
            ([], _) => vec![],
            halves => [halves.0, halves.1]
                .into_iter()
                .flat_map(|half| screen(trial, here, forms, half))
                .collect(),
        };
    };
    let promise = |((form, added, at), place): ((usize, Trial<'_>, Vec<f64>), Range<usize>)| {
        let columns = slopes.columns_range(place);
        let mut full = here.extended(at, &residuals);
        let (before, measured) = (here.at.len(), residuals.len());
        let mut rows = full.residuals.rows_mut(0, measured);
        rows += columns.column(0);
        let new = columns.ncols() - 1;
        (full.jacobian.view_mut((0, before), (measured, new))).copy_from(&columns.columns(1, new));
        let (at, left) = added.step(&full, DAMPING);
        left.is_finite().then_some(Promise { form, left, at })
    };
    each.into_iter().zip(places).filter_map(promise).collect()
}

/// Begins at the linearised optimum, or at the typical values, which may be better where the optimum is far.
fn begin(trial: &Trial<'_>, here: &Linear, promised: &[f64]) -> Option<Linear> {
    let chi2 = here.chi2();
    let linear = |at: &[f64]| {
        trial
            .linear(at, here.at.len()..at.len(), &here.jacobian, FAR * chi2)
            .ok()
    };
    let first = linear(promised);
    match &first {
        Some(there) if there.chi2() < chi2 => first,
        _ => {
            let second = linear(&trial.typical(&here.at));
            let starts = first.into_iter().chain(second);
            starts.min_by(|a, b| a.chi2().total_cmp(&b.chi2()))
        }
    }
}
