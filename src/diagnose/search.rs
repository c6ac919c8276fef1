//! The search for effects: screen all in one linearised pass, fit the best, keep what is worth it, begin again.

use super::forward::Shown;
use super::trial::{DAMPING, Linear, Slopes, Trial};
use crate::identify::{Effect, Robot, Variant};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// An effect in one of its forms.
pub struct Form {
    /// The effect.
    pub effect: usize,
    /// The form.
    pub variant: Variant,
    /// Forms of one group exclude each other: those of a cause, while each term of a law that only describes is for itself.
    pub group: (usize, usize),
}

/// All forms of the effects that can act on a robot.
#[must_use]
pub fn forms(effects: &[Box<dyn Effect>], robot: &Robot) -> Vec<Form> {
    let each = effects.iter().enumerate();
    each.flat_map(|(effect, e)| {
        let variants = e.variants(robot).into_iter().enumerate();
        variants.map(move |(which, variant)| Form {
            effect,
            variant,
            group: (effect, if e.is_cause() { 0 } else { which }),
        })
    })
    .collect()
}

/// A form that was fitted.
pub struct Candidate {
    /// Which form.
    pub form: usize,
    /// Chi2 that the linearised model promised.
    promised: f64,
    /// The fit: values of the scenario, of the forms before, and of this one.
    pub fit: Linear,
}

/// How many forms are fitted in a round, and how many of one group.
const FITTED: usize = 10;
const OF_GROUP: usize = 2;
/// Times the least promised chi2 beyond which forms are not fitted, but so many are in any case.
const POOR: f64 = 30.0;
const AT_LEAST: usize = 4;
/// Share of the present chi2 that is no gain.
const NO_GAIN: f64 = 0.9;
/// Forms that are screened at once.
const SCREENED: usize = 12;
/// Steps of the fits before the worse are given up, and how many times the least chi2 is too much then.
const HEATS: [(usize, f64); 3] = [(1, 12.0), (2, 5.0), (8, f64::INFINITY)];
/// Times the least chi2 that a form is let go on for which promised no more.
const SLOW: f64 = 3.0;
/// Shares of the way to the linearised optimum at which fits begin that can't begin there.
const ON_THE_WAY: [f64; 2] = [0.3, 0.08];
/// Times the present chi2 at which no fit begins.
const FAR: f64 = 20.0;

/// Fits those of the `open` forms that promise most when they are added to `base`, the best first.
pub fn round(
    base: &Trial<'_>,
    here: &Linear,
    forms: &[Form],
    open: Vec<usize>,
    told: &(dyn Fn(f64) + Sync),
) -> Vec<Candidate> {
    let promises = screen(base, here, forms, open, &|share| told(0.3 * share));
    let chosen = shortlist(promises, here, forms);
    let told = Counted::new(told, 0.3, 0.5);
    let begun = chosen.par_iter().filter_map(|promise| {
        let trial = base.with(&forms[promise.form].variant);
        let begun = begin(&trial, here, &promise.at);
        told.done(chosen.len());
        begun.map(|fit| Candidate {
            form: promise.form,
            promised: promise.left,
            fit,
        })
    });
    heats(base, here, forms, begun.collect(), &told)
}

/// Progress of things done side by side, between two shares of the whole.
struct Counted<'a> {
    told: &'a (dyn Fn(f64) + Sync),
    from: f64,
    to: f64,
    done: AtomicUsize,
}

impl<'a> Counted<'a> {
    fn new(told: &'a (dyn Fn(f64) + Sync), from: f64, to: f64) -> Self {
        Self {
            told,
            from,
            to,
            done: AtomicUsize::new(0),
        }
    }

    /// One more of `all` is done.
    fn done(&self, all: usize) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        (self.told)(self.from + (self.to - self.from) * done as f64 / all as f64);
    }
}

/// What forms promise to first order, the best first.
fn screen(
    base: &Trial<'_>,
    here: &Linear,
    forms: &[Form],
    open: Vec<usize>,
    told: &(dyn Fn(f64) + Sync),
) -> Vec<Promise> {
    let mut promises: Vec<Promise> = linearised(base, here, forms, open, told)
        .into_par_iter()
        .filter_map(|column| column.promise(here))
        .collect();
    promises.sort_by(|a, b| a.left.total_cmp(&b.left).then(a.form.cmp(&b.form)));
    promises
}

/// Forms, linearised at the present states, as many at once as share the states well.
fn linearised<'a>(
    base: &Trial<'a>,
    here: &Linear,
    forms: &'a [Form],
    open: Vec<usize>,
    told: &(dyn Fn(f64) + Sync),
) -> Vec<Column<'a>> {
    // those that remember take more states, which others need not pay for
    let remembers = |form: &usize| {
        let trial = base.with(&forms[*form].variant);
        let typical = trial.scenario(&trial.typical(&here.at));
        let shown = typical.map(|source| Shown::new(&source, &trial.data[0]));
        matches!(shown, Ok(Ok(shown)) if shown.remembers())
    };
    let (slow, fast): (Vec<usize>, Vec<usize>) = open.into_par_iter().partition(remembers);
    let chunks: Vec<&[usize]> = slow.chunks(SCREENED).chain(fast.chunks(SCREENED)).collect();
    let told = Counted::new(told, 0.0, 1.0);
    let columns = chunks.par_iter().flat_map(|chunk| {
        let columns = columns(base, here, forms, chunk);
        told.done(chunks.len());
        columns
    });
    columns.collect()
}

/// The best forms of each of the best groups.
fn shortlist(promises: Vec<Promise>, here: &Linear, forms: &[Form]) -> Vec<Promise> {
    let mut chosen: Vec<Promise> = Vec::new();
    for promise in promises {
        let same = |p: &&Promise| forms[p.form].group == forms[promise.form].group;
        let best = chosen.first().map_or(f64::INFINITY, |best| best.left);
        let poor = promise.left > (POOR * best).min(NO_GAIN * here.chi2());
        if poor && chosen.len() >= AT_LEAST {
            break;
        }
        if chosen.len() < FITTED && chosen.iter().filter(same).count() < OF_GROUP {
            chosen.push(promise);
        }
    }
    chosen
}

/// Fits in heats, after each of which the hopeless are given up.
fn heats(
    base: &Trial<'_>,
    here: &Linear,
    forms: &[Form],
    mut candidates: Vec<Candidate>,
    told: &Counted<'_>,
) -> Vec<Candidate> {
    for (heat, (steps, hopeless)) in HEATS.into_iter().enumerate() {
        let from = told.to + heat as f64 / 6.0;
        let (told, all) = (
            Counted::new(told.told, from, from + 1.0 / 6.0),
            candidates.len(),
        );
        let fit = |candidate: Candidate| {
            // what other numbers do changes little at first
            let known = if heat == 0 { here.at.len() } else { 0 };
            let fresh = known..candidate.fit.at.len();
            let trial = base.with(&forms[candidate.form].variant);
            let fit = trial.fit(candidate.fit, fresh, steps);
            told.done(all);
            Candidate { fit, ..candidate }
        };
        candidates = candidates.into_par_iter().map(fit).collect();
        let chi2 = |c: &Candidate| c.fit.chi2();
        candidates.sort_by(|a, b| chi2(a).total_cmp(&chi2(b)).then(a.form.cmp(&b.form)));
        let least = candidates.first().map_or(0.0, chi2);
        let most = (hopeless * least).min(NO_GAIN * here.chi2()).max(least);
        // some begin far from where they would end
        let promising = hopeless.min(SLOW) * least;
        candidates.retain(|c| chi2(c) <= most || c.promised <= promising);
    }
    candidates
}

/// What a form promises: what would be left of chi2 by the linearised model, and at which values.
struct Promise {
    form: usize,
    left: f64,
    at: Vec<f64>,
}

/// A form, linearised.
struct Column<'a> {
    form: usize,
    trial: Trial<'a>,
    /// Typical values.
    at: Vec<f64>,
    /// How residuals change to first order if the form had its typical values, and how that depends on them.
    changes: DMatrix<f64>,
}

/// Forms, linearised at the present states.
fn columns<'a>(
    trial: &Trial<'a>,
    here: &Linear,
    forms: &'a [Form],
    which: &[usize],
) -> Vec<Column<'a>> {
    let base = || trial.scenario(&here.at);
    let pairs = |form: usize| {
        let added = trial.with(&forms[form].variant);
        let typical = added.typical(&here.at);
        let mut pairs = vec![(0.5, [added.scenario(&typical)?, base()?])];
        for j in here.at.len()..typical.len() {
            pairs.push(added.pair(&typical, j)?);
        }
        Ok((added, typical, pairs))
    };
    let (mut each, mut all) = (Vec::new(), Vec::new());
    for &form in which {
        if let Ok::<_, String>((added, typical, pairs)) = pairs(form) {
            each.push((form, added, typical, all.len()..all.len() + pairs.len()));
            all.extend(pairs);
        }
    }
    let found =
        base().and_then(|base| trial.slopes(&base, &all, Some(&here.states), f64::INFINITY));
    let Ok(Slopes { slopes, .. }) = found else {
        // one of them can't be built or has no state: the others can
        return match which.split_at(which.len() / 2) {
            ([], _) => vec![],
            (some, others) => [some, others]
                .into_iter()
                .flat_map(|half| columns(trial, here, forms, half))
                .collect(),
        };
    };
    let column = |(form, trial, at, place)| Column {
        form,
        trial,
        at,
        changes: slopes.columns_range::<Range<usize>>(place).into_owned(),
    };
    each.into_iter().map(column).collect()
}

impl Column<'_> {
    /// What would be left with the best values.
    fn promise(self, here: &Linear) -> Option<Promise> {
        let (before, (measured, all)) = (here.at.len(), self.changes.shape());
        let mut full = here.extended(self.at);
        let mut rows = full.residuals.rows_mut(0, measured);
        rows += self.changes.column(0);
        (full.jacobian.view_mut((0, before), (measured, all - 1)))
            .copy_from(&self.changes.columns(1, all - 1));
        let (at, left) = self.trial.step(&full, DAMPING);
        left.is_finite().then_some(Promise {
            form: self.form,
            left,
            at,
        })
    }

    /// Share of its typical strength from which the form is noticed: calibrated, it leaves `most` more of chi2 than noise.
    fn noticed(&self, here: &Linear, most: f64) -> f64 {
        let mut change = DVector::zeros(here.residuals.len());
        change
            .rows_mut(0, self.changes.nrows())
            .copy_from(&self.changes.column(0));
        let hidden = here.jacobian.clone().svd(true, true);
        let best = hidden.solve(&change, 1e-9).expect("it has both bases");
        let seen = change - &here.jacobian * best;
        (most / seen.norm_squared()).sqrt()
    }
}

/// For each effect of these forms, the one that is noticed first, and the share of its typical strength from which it would be: the
/// squared residuals grow by `most` whatever the scenario's own numbers are.
pub fn noticeable(
    trial: &Trial<'_>,
    here: &Linear,
    forms: &[Form],
    which: Vec<usize>,
    most: f64,
) -> Vec<(usize, f64)> {
    let columns = linearised(trial, here, forms, which, &|_| ());
    let noticed = |column: &Column<'_>| (column.form, column.noticed(here, most));
    let mut found: Vec<(usize, f64)> = columns.par_iter().map(noticed).collect();
    found.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    let mut effects = Vec::new();
    found.retain(|(form, _)| {
        let new = !effects.contains(&forms[*form].effect);
        effects.push(forms[*form].effect);
        new
    });
    found
}

/// Begins at the linearised optimum, or, where that is too far for its states to be found or worse than nothing, at the
/// typical values or part of the way.
fn begin(trial: &Trial<'_>, here: &Linear, promised: &[f64]) -> Option<Linear> {
    let chi2 = here.chi2();
    let (before, all) = (here.at.len(), promised.len());
    let null = trial.without(&here.at);
    let starts = [promised.to_vec(), trial.typical(&here.at)]
        .into_iter()
        .chain(ON_THE_WAY.map(|share| trial.between(&null, promised, share)));
    let mut best: Option<Linear> = None;
    for start in starts {
        if let Ok(found) = trial.linear(&start, before..all, Some(here), FAR * chi2) {
            if best.as_ref().is_none_or(|best| found.chi2() < best.chi2()) {
                best = Some(found);
            }
            if best.as_ref().is_some_and(|best| best.chi2() < chi2) {
                break;
            }
        }
    }
    best
}
