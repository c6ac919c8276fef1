//! From fitted curves to what a diagnosis says.

use super::hypothesis::{Group, Hypothesis};
use super::locate;
use super::rod::FLOOR;
use super::search::{Form, Judged};
use super::verdict::{CurvesDiagnosis, FittedRods, NamedOfRods, OfRod, ScoredQuantity};
use super::{DiagnoseError, each};
use crate::characterise::{Comparison, Quantity};
use crate::config::Source;
use crate::diagnose::LEFT;
use crate::diagnose::verdict::{Alternative, Estimated, Experiment, Kind};
use crate::identify::{Effect, Estimate, Fit, Parameter};

/// Deviations by which calibrations with and without a quantity must differ to be told.
const FAR: f64 = 3.0;

/// What is known when the search has ended.
pub(super) struct Seen<'a> {
    /// The rods without an effect.
    pub(super) base: &'a Hypothesis<'a>,
    /// What is left out in turn.
    pub(super) groups: &'a [Group],
    /// Residuals there without an effect, group by group.
    pub(super) held_out: &'a [Vec<f64>],
    /// Figures beside the scenarios with the values that they state.
    pub(super) stated: &'a [Comparison],
    /// The same with values calibrated by all quantities.
    pub(super) calibrated: &'a [Comparison],
    /// Those calibrations.
    pub(super) free: &'a [Fit],
    /// Calibrations by all quantities but the subject.
    pub(super) others: &'a [Fit],
    /// Whether calibrated scenarios are within the error bars.
    pub(super) sound: bool,
}

/// The diagnosis, and the scenarios with the named effect.
pub(super) fn conclude(
    seen: &Seen<'_>,
    found: &[Judged],
    forms: &[Form],
    effects: &[Box<dyn Effect>],
) -> Result<(CurvesDiagnosis, Vec<Source>), DiagnoseError> {
    let base = seen.base;
    let best = found.first();
    let effect = |form: usize| &effects[forms[form].effect];
    let ids: Vec<String> = (found.iter())
        .map(|judged| effect(judged.form).id().to_owned())
        .collect();
    let verdict = match found.len() {
        _ if seen.sound => Kind::None,
        0 => Kind::Unexplained,
        1 => Kind::Effect,
        _ => Kind::Class,
    };
    let with = Hypothesis {
        forms: best.map(|best| &forms[best.form].variants[..]),
        ..*base
    };
    let values = best.map_or_else(Vec::new, |best| best.fit.values());
    let own = match best {
        // nothing is in doubt, so that all quantities may speak
        None if seen.sound => seen.free.to_vec(),
        None => seen.others.to_vec(),
        Some(_) => each(base.rods, |r, _| with.calibrated(r, &values))?,
    };
    let versions = each(base.rods, |r, rod| {
        let added = with.forms.map(|forms| (&forms[r], &values[..]));
        rod.version(&own[r].values(), added)
    })?;
    let expected = each(base.rods, |r, _| base.compared(r, &[], &|_| true))?;
    let baseline = fitted(base, &expected, seen.others, seen.groups, seen.held_out);
    let augmented = match best {
        None => baseline.clone(),
        Some(best) => {
            let beside = each(base.rods, |r, _| with.compared(r, &values, &|_| true))?;
            fitted(&with, &beside, &own, seen.groups, &best.held_out)
        }
    };
    let location = locate::locate(seen.stated, seen.calibrated, &expected, base.subject);
    let (before, after) = (baseline.reduced_chi2, augmented.reduced_chi2);
    let effects = best.map(|best| {
        let (effect, variant) = (effect(best.form), &forms[best.form].variants[0]);
        let words = match variant.name.as_str() {
            "" => effect.words().to_owned(),
            which => format!("{} ({which})", effect.words()),
        };
        NamedOfRods {
            id: effect.id().to_owned(),
            words,
            equation: effect.equation().to_owned(),
            hook: effect.hook(),
            parameters: best.fit.estimates.iter().map(estimated).collect(),
            probability: best.probability,
        }
    });
    let experiment = best.filter(|_| ids.len() > 1).map(|best| Experiment {
        words: effect(best.form).experiment().to_owned(),
        discriminates: ids.clone(),
        predictions: vec![],
        apart_floors: None,
    });
    let alternatives = found.iter().zip(&ids).skip(1);
    let diagnosis = CurvesDiagnosis {
        verdict,
        words: sentence(verdict, base, effects.as_ref(), &ids, (before, after)),
        effects: effects.into_iter().collect(),
        alternatives: alternatives
            .map(|(judged, id)| Alternative {
                id: id.clone(),
                probability: judged.probability,
            })
            .collect(),
        experiment,
        location,
        floor: FLOOR,
        explained: match before > 1.0 {
            true => 1.0 - (after - 1.0).max(0.0) / (before - 1.0),
            false => 1.0,
        },
        baseline,
        augmented,
        alarms: if seen.sound { vec![] } else { alarms(seen) },
        audit: locate::audit(base.rods, seen.groups, base.subject),
        seconds: 0.0,
    };
    Ok((diagnosis, versions))
}

fn estimated(e: &Estimate) -> Estimated {
    Estimated {
        name: e.parameter.name.clone(),
        value: e.value,
        unit: e.parameter.unit.clone(),
        ci95: [e.interval.0, e.interval.1],
    }
}

/// Fitted scenarios: their numbers, how well they do where they were fitted, and the subject where it was held out.
fn fitted(
    on: &Hypothesis<'_>,
    beside: &[Comparison],
    own: &[Fit],
    groups: &[Group],
    held_out: &[Vec<f64>],
) -> FittedRods {
    let mut figures = Vec::new();
    let mut all = Vec::new();
    for ((r, rod), beside) in on.rods.iter().enumerate().zip(beside) {
        for m in &beside.mismatches {
            // without an effect nothing is fitted to the subject
            if m.quantity != on.subject || on.forms.is_some() {
                let bars = m.rms_in_bars();
                figures.push(scored(&rod.name, m.quantity, "train", (m.rms, bars)));
            }
        }
        let mut of_rod = Vec::new();
        for (group, residuals) in groups.iter().zip(held_out) {
            let points = beside.points.iter();
            let points =
                points.filter(|b| b.measured.quantity == on.subject && group.holds(r, &b.measured));
            // a group of a rod is of one rod, and one of an angle where there is one rod
            of_rod.extend(points.map(|b| b.deviation).zip(residuals.iter().copied()));
        }
        figures.push(scored(&rod.name, on.subject, "holdout", rms(&of_rod)));
        all.extend(of_rod);
    }
    if on.rods.len() > 1 {
        figures.push(scored("all", on.subject, "holdout", rms(&all)));
    }
    let own = on.rods.iter().zip(own).map(|(rod, fit)| OfRod {
        rod: rod.name.clone(),
        numbers: fit.estimates.iter().map(estimated).collect(),
    });
    FittedRods {
        parameters: own.collect(),
        figures,
        reduced_chi2: rms(&all).1.powi(2),
    }
}

/// Root mean squares of differences, given as deviations and residuals in units of those: in SI units and in theirs.
fn rms(each: &[(f64, f64)]) -> (f64, f64) {
    let mean = |of: fn(&(f64, f64)) -> f64| {
        let squares = each.iter().map(|pair| of(pair).powi(2));
        (squares.sum::<f64>() / each.len() as f64).sqrt()
    };
    (mean(|(d, r)| d * r), mean(|(_, r)| *r))
}

fn scored(rod: &str, quantity: Quantity, role: &str, (rms, bars): (f64, f64)) -> ScoredQuantity {
    ScoredQuantity {
        rod: rod.to_owned(),
        quantity: quantity.name().to_owned(),
        role: role.to_owned(),
        rmse: rms / quantity.in_si(),
        unit: quantity.unit().to_owned(),
        rms_in_bars: bars,
    }
}

/// Numbers at an end of their range, and numbers that the subject pulls away from what the other quantities say.
fn alarms(seen: &Seen<'_>) -> Vec<String> {
    let mut alarms = Vec::new();
    for ((rod, free), others) in seen.base.rods.iter().zip(seen.free).zip(seen.others) {
        for (a, b) in free.estimates.iter().zip(&others.estimates) {
            let Parameter { name, unit, .. } = &a.parameter;
            if b.at_bound {
                alarms.push(format!(
                    "{}: {name} ended at an end of its range, {:.4e} {unit}: the range is too narrow, or the number stands \
                     for physics that is missing",
                    rod.name,
                    b.value
                ));
            }
            let Some((da, db)) = a.deviation.zip(b.deviation) else {
                continue;
            };
            let away = (a.value - b.value).abs() / da.hypot(db);
            if away > FAR {
                alarms.push(format!(
                    "{}: {name} is {:.4e} {unit} by the other quantities and {:.4e} {unit} if it may follow the {}, {away:.1} \
                     deviations apart",
                    rod.name,
                    b.value,
                    a.value,
                    seen.base.subject
                ));
            }
        }
    }
    alarms
}

fn sentence(
    verdict: Kind,
    base: &Hypothesis<'_>,
    named: Option<&NamedOfRods>,
    class: &[String],
    (before, after): (f64, f64),
) -> String {
    let subject = base.subject;
    let what = named.map_or("", |named| named.words.as_str());
    let (from, to) = (before.sqrt(), after.sqrt());
    let left_out = match base.rods {
        [_] => "at angles",
        _ => "of rods",
    };
    let predicted = format!(
        "The {subject} {left_out} that were left out is predicted within {to:.1} error bars instead of {from:.1} (-{:.0} %)",
        100.0 * (1.0 - to / from)
    );
    let left = match after {
        after if after > LEFT => format!(
            "; {after:.1} times what the error bars allow is left, so that this is not all of it"
        ),
        _ => String::new(),
    };
    match verdict {
        Kind::None => {
            "Nothing is missing beyond the error bars: the calibrated scenarios explain the curves."
                .into()
        }
        Kind::Class => format!(
            "The {subject} contradicts the other quantities, and what was left out is one of {}, which these curves can't \
             tell apart; the best of them is that {what}. {predicted}{left}.",
            class.join(", ")
        ),
        Kind::Effect => format!(
            "The {subject} contradicts the other quantities, and what was left out is that {what}. {predicted}{left}."
        ),
        _ => format!(
            "The {subject} contradicts the other quantities, and none of the known effects predicts it where it was left out."
        ),
    }
}
