//! The search for the effect that predicts figures that were left out.

use super::hypothesis::{Group, Hypothesis};
use super::rod::Rod;
use crate::config::Problems;
use crate::diagnose::ODDS;
use crate::identify::{Effect, Fit, Robot, Variant};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// An effect in one of its forms, on each rod.
pub(super) struct Form {
    pub(super) effect: usize,
    pub(super) variants: Vec<Variant>,
}

/// Share of chi2 that an effect must explain to be tried further, and, of figures held out, to be named.
const GAIN: f64 = 0.25;
/// Share by which the rest of the figures may get worse.
const WORSE: f64 = 0.05;
/// Most effects that are judged by what was left out.
const JUDGED: usize = 6;

/// All forms whose numbers can be the same on all rods.
pub(super) fn forms(effects: &[Box<dyn Effect>], rods: &[Rod]) -> Result<Vec<Form>, Problems> {
    let robots = rods.iter().map(|rod| Robot::of(&rod.source));
    let robots = robots.collect::<Result<Vec<_>, _>>()?;
    let mut forms = Vec::new();
    for (effect, known) in effects.iter().enumerate() {
        let of_rods: Vec<_> = robots.iter().map(|robot| known.variants(robot)).collect();
        for first in &of_rods[0] {
            let same = |v: &&Variant| v.name == first.name && v.quantities == first.quantities;
            let variants = of_rods.iter().map(|all| all.iter().find(same).cloned());
            if let Some(variants) = variants.collect() {
                forms.push(Form { effect, variants });
            }
        }
    }
    Ok(forms)
}

/// An effect that was judged by what was left out.
pub(super) struct Judged {
    pub(super) form: usize,
    /// Its numbers.
    pub(super) fit: Fit,
    /// Residuals of the figures left out, group by group.
    pub(super) held_out: Vec<Vec<f64>>,
    pub(super) probability: f64,
}

fn squares(residuals: &[Vec<f64>]) -> f64 {
    residuals.iter().flatten().map(|r| r * r).sum()
}

/// Residuals of all that is left out in turn.
pub(super) fn held_out(
    on: &Hypothesis<'_>,
    near: &[f64],
    groups: &[Group],
) -> Result<Vec<Vec<f64>>, String> {
    let each = groups.par_iter().map(|group| on.held_out(near, *group));
    each.collect()
}

/// Tries every form, and gives the effects that predict best what is left out, and about as well. `before` are the
/// residuals there without an effect.
pub(super) fn search(
    base: &Hypothesis<'_>,
    groups: &[Group],
    before: &[Vec<f64>],
    forms: &[Form],
    told: &(dyn Fn(f64) + Sync),
) -> Result<Vec<Judged>, String> {
    let done = AtomicUsize::new(0);
    let with = |form: usize| Hypothesis {
        forms: Some(&forms[form].variants),
        ..*base
    };
    let tried = (0..forms.len()).into_par_iter().filter_map(|form| {
        let on = with(form);
        let fit = on.acts().then(|| {
            let quantities = forms[form].variants[0].quantities.iter();
            on.fitted(&quantities.map(|q| q.typical).collect::<Vec<_>>(), None)
        });
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        told(0.7 * done as f64 / forms.len() as f64);
        Some((form, fit?.ok()?))
    });
    let mut tried: Vec<(usize, Fit)> = tried.collect();
    let none = base.chi2(&[])?;
    tried.retain(|(_, fit)| fit.chi2 < (1.0 - GAIN) * none);
    tried.sort_by(|a, b| a.1.chi2.total_cmp(&b.1.chi2));
    let mut seen = Vec::new();
    tried.retain(|(form, _)| {
        let new = !seen.contains(&forms[*form].effect);
        seen.push(forms[*form].effect);
        new
    });
    tried.truncate(JUDGED);
    let rest = base.rest(&[])?;
    let judged = tried.into_par_iter().filter_map(|(form, fit)| {
        let on = with(form);
        let values = fit.values();
        let spoilt = on.rest(&values).ok()? > (1.0 + WORSE) * rest;
        let held_out = held_out(&on, &values, groups).ok()?;
        let better = squares(&held_out) < (1.0 - GAIN) * squares(before);
        (better && !spoilt).then_some(Judged {
            form,
            fit,
            held_out,
            probability: 0.0,
        })
    });
    let mut alike: Vec<Judged> = judged.collect();
    told(1.0);
    alike.sort_by(|a, b| squares(&a.held_out).total_cmp(&squares(&b.held_out)));
    let Some(best) = alike.first().map(|best| squares(&best.held_out)) else {
        return Ok(alike);
    };
    let count = before.iter().flatten().count() as f64;
    let away = |j: &Judged| (squares(&j.held_out) - best) / (best / count).max(1.0);
    // those that can't be told apart are as likely
    let weight = |j: &Judged| match away(j) {
        away if away < ODDS => 1.0,
        away => (-away / 2.0).exp(),
    };
    let total: f64 = alike.iter().map(weight).sum();
    alike.retain(|j| away(j) < ODDS);
    for judged in &mut alike {
        judged.probability = 1.0 / total;
    }
    Ok(alike)
}
