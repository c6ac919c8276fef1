//! The search for effects: screen all in one linearised pass, fit the best, keep what is worth it, begin again.

use super::forward::Guide;
use super::trial::{Linear, Trial};
use crate::identify::{Effect, Robot, Variant};
use rayon::prelude::*;

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

/// How many forms are fitted in a round, of different effects.
const FITTED: usize = 8;
/// Steps after which forms whose chi2 is so many times the least are given up, and steps of the others from there.
const FIRST_STEPS: usize = 3;
const HOPELESS: f64 = 4.0;
const STEPS: usize = 10;

/// Fits the forms that promise most when they are added to `base`, the best first.
pub fn round(
    base: &Trial<'_>,
    here: &Linear,
    guides: &[Guide],
    forms: &[Form],
    used: &[usize],
    told: &(dyn Fn(f64) + Sync),
) -> Vec<Candidate> {
    let with = |form: &usize| {
        let mut trial = base.clone();
        trial.forms.push(&forms[*form].variant);
        trial.guides = guides;
        trial
    };
    let open: Vec<usize> = (0..forms.len())
        .filter(|f| !used.contains(&forms[*f].effect))
        .collect();
    let done = std::sync::atomic::AtomicUsize::new(0);
    let tick = |all: usize, from: f64, to: f64| {
        let done = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
        told(from + (to - from) * done as f64 / all as f64);
    };
    let mut promises: Vec<(f64, usize, Vec<f64>)> = open
        .par_iter()
        .filter_map(|form| {
            let promise = promise(&with(form), here);
            tick(open.len(), 0.0, 0.5);
            promise.map(|(left, at)| (left, *form, at))
        })
        .collect();
    promises.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    // the best two forms of each of the best effects
    let mut chosen: Vec<(usize, Vec<f64>)> = Vec::new();
    let of_effect = |chosen: &[(usize, Vec<f64>)], effect: usize| {
        chosen
            .iter()
            .filter(|(f, _)| forms[*f].effect == effect)
            .count()
    };
    for (_, form, at) in promises {
        if chosen.len() < FITTED + 4 && of_effect(&chosen, forms[form].effect) < 2 {
            chosen.push((form, at));
        }
    }
    done.store(0, std::sync::atomic::Ordering::Relaxed);
    let first: Vec<Candidate> = chosen
        .par_iter()
        .filter_map(|(form, at)| {
            let trial = with(form);
            // the linearised optimum may be far; the typical value is always a state that was found
            let starts = [at.clone(), trial.typical(&here.at)].map(|start| {
                let left = trial.evaluate(&start).map(|(r, _)| r.norm_squared());
                (left.unwrap_or(f64::INFINITY), start)
            });
            let start = usize::from(starts[1].0 < starts[0].0);
            let fit = trial.fit(&starts[start].1, FIRST_STEPS);
            tick(chosen.len(), 0.5, 0.8);
            let fit = fit.ok()?;
            Some(Candidate { form: *form, fit })
        })
        .collect();
    let least = first
        .iter()
        .map(|c| c.fit.chi2())
        .fold(f64::INFINITY, f64::min);
    done.store(0, std::sync::atomic::Ordering::Relaxed);
    let mut fitted: Vec<Candidate> = first
        .into_par_iter()
        .filter(|c| c.fit.chi2() < HOPELESS * least)
        .map(|c| {
            let fit = with(&c.form).fit(&c.fit.at, STEPS);
            tick(chosen.len(), 0.8, 1.0);
            Candidate {
                fit: fit.unwrap_or(c.fit),
                ..c
            }
        })
        .collect();
    fitted.sort_by(|a, b| {
        a.fit
            .chi2()
            .total_cmp(&b.fit.chi2())
            .then(a.form.cmp(&b.form))
    });
    fitted
}

/// What would be left of chi2 by the linearised model around the form's typical values, and at which values.
fn promise(trial: &Trial<'_>, here: &Linear) -> Option<(f64, Vec<f64>)> {
    let at = trial.typical(&here.at);
    let (before, all) = (here.at.len(), at.len());
    let new = trial.linear(&at, before..all).ok()?;
    let mut jacobian = nalgebra::DMatrix::zeros(new.residuals.len(), all);
    jacobian.columns_mut(0, before).copy_from(&here.jacobian);
    jacobian
        .columns_mut(before, all - before)
        .copy_from(&new.jacobian);
    let full = Linear {
        at,
        residuals: new.residuals,
        jacobian,
    };
    let (change, left) = trial.step(&full, 1e-6);
    let to = full.at.iter().zip(&change).map(|(a, c)| a + c);
    Some((left, to.collect()))
}
