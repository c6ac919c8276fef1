//! What should make one doubt a fitted model.

use super::forward;
use super::samples::Samples;
use super::standing::Standing;
use super::trial::NEAR;
use crate::identify::{Parameter, Quantity};

/// Deviations from its prior beyond which a calibrated number is told.
const FAR: f64 = 2.5;

/// Numbers at an end of their range, or far from what was known beforehand.
pub(super) fn of_numbers(own: &[Parameter], at: &[f64]) -> Vec<String> {
    let alarm = |(p, value): (&Parameter, &f64)| {
        let near = |end: f64| (value - end).abs() < NEAR * p.width();
        if near(p.range.0) || near(p.range.1) {
            return Some(format!(
                "{} ended at an end of its range, {value:.4} {}: the range is too narrow, or the number stands for physics \
                 that is missing",
                p.name, p.unit
            ));
        }
        let (mean, deviation) = p.prior?;
        let away = (value - mean).abs() / deviation;
        (away > FAR).then(|| {
            format!(
                "{} is {value:.4} {}, {away:.1} deviations from what was known",
                p.name, p.unit
            )
        })
    };
    own.iter().zip(at).filter_map(alarm).collect()
}

/// Numbers of named effects that ended where what is physical ends.
pub(super) fn astray(last: &Standing<'_>) -> Vec<String> {
    let numbers = last.trial.astray(&last.tolerant).into_iter();
    let alarm = |(q, value): (&Quantity, f64)| {
        format!(
            "{} ended where what is physical ends, {value:.4} {}: something that is not known acts much like the effect",
            q.name, q.unit
        )
    };
    numbers.map(alarm).collect()
}

/// Recordings in which the scenario isn't stable, so that the robot may be in another state than the one that is followed.
pub(super) fn unstable(last: &Standing<'_>, data: [&[Samples]; 2]) -> Vec<String> {
    let Ok(source) = last.scenario() else {
        return vec![];
    };
    let alarm = |samples: &Samples| {
        let (times, all) = forward::unstable(&source, samples).ok()?;
        let first = times.first()?;
        Some(format!(
            "{}: the scenario is not stable at {} of {all} set-points, first at t = {first:.1} s; the robot may have gone to \
             another branch there (branch_switch): come to them from another side, and set `solver.branch` to `Stable`",
            samples.name,
            times.len()
        ))
    };
    data.into_iter().flatten().filter_map(alarm).collect()
}
