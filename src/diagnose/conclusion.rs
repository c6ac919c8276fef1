//! From fitted models to what a diagnosis says.

use super::alarms;
use super::experiments::{self, Member};
use super::forward::NUMERICS;
use super::locate;
use super::samples::{KINDS, Phase, Sample, Samples};
use super::search::{self, Form};
use super::standing::Standing;
use super::verdict::{
    Alternative, Diagnosis, Estimated, Experiment, Floor, Hidden, Kind, Named, Noticeable,
};
use super::{LEFT, MOST, SOUND};
use crate::identify::{Effect, Hooked, Quantity};

/// Share of the mismatch beyond noise that the named effects must explain.
const EXPLAINED: f64 = 0.6;
/// Times its typical strength from which on an effect that never shows is said to.
const NEVER: f64 = 1e6;

/// What a diagnosis says that began at `baseline` and ended at `last`.
pub(super) fn conclude(
    baseline: &Standing<'_>,
    last: &Standing<'_>,
    forms: &[Form],
    effects: &[Box<dyn Effect>],
    holdout: &[Samples],
) -> Diagnosis {
    let (train, own) = (baseline.trial.data, baseline.trial.own);
    let explained = match baseline.beyond_noise() {
        all if all > 0.0 => 1.0 - last.beyond_noise() / all,
        _ => 1.0,
    };
    let effect = |form: usize| &effects[forms[form].effect];
    let worsened = last.scores.worsened(&baseline.scores);
    let mut all: Vec<&dyn Effect> = last.named.iter().map(|(f, _)| &**effect(*f)).collect();
    all.dedup_by_key(|effect| effect.id());
    let astray = alarms::astray(last);
    let doubtful = !worsened.is_empty() || !astray.is_empty();
    let mut kind = kind(baseline, last, (explained, doubtful), &all);
    let noticeable = match kind {
        Kind::None => noticeable(baseline, forms, effects),
        _ => vec![],
    };
    if 2 * unseen(&noticeable) > noticeable.len() {
        kind = Kind::Insufficient;
    }
    let fitted = estimates(last);
    let named = name_all(last, forms, effects, &fitted[own.len()..], baseline);
    let alike: Vec<&dyn Effect> = (last.named.last().map(|(f, _)| effect(*f)).into_iter())
        .chain(last.alternatives.iter().map(|a| &effects[a.effect]))
        .map(|e| &**e)
        .collect();
    let ids: Vec<String> = alike.iter().map(|e| e.id().to_owned()).collect();
    let floor = floor(train);
    let experiment = match kind {
        Kind::Class | Kind::Several | Kind::Unexplained if !last.alternatives.is_empty() => {
            Some(experiment(last, &alike, &floor))
        }
        _ => None,
    };
    let probability = last.named.last().map_or(0.0, |(_, p)| *p);
    let alternatives = ids.iter().skip(1).map(|id| Alternative {
        id: id.clone(),
        probability,
    });
    let measured = last.trial.measured() as usize;
    Diagnosis {
        verdict: kind,
        words: sentence(
            kind,
            &named,
            (explained, last.mean_square()),
            &floor,
            &ids,
            &noticeable,
            &astray,
        ),
        effects: named,
        alternatives: alternatives.collect(),
        experiment,
        location: locate::locate(&baseline.fit.residuals.as_slice()[..measured], train),
        floor,
        baseline: (baseline.scores).fitted(estimates(baseline), baseline.mean_square()),
        augmented: (last.scores).fitted(fitted[..own.len()].to_vec(), last.mean_square()),
        explained,
        hidden: hidden(baseline, last),
        noticeable,
        alarms: [
            alarms::of_numbers(own, &last.fit.at),
            astray,
            worsened,
            alarms::unstable(last, [train, holdout]),
        ]
        .concat(),
        audit: audit(train, holdout),
        loads: None,
        traces: last.scores.traces(&baseline.scores, [train, holdout]),
        seconds: 0.0,
    }
}

/// What would tell effects apart of which the last that was named is the first.
fn experiment(last: &Standing<'_>, alike: &[&dyn Effect], floor: &Floor) -> Experiment {
    let samples = last.trial.data.iter().flat_map(|data| &data.list);
    let settled = samples.filter(|sample| sample.phase == Phase::Settled);
    let angles: Vec<[f64; 4]> = settled.map(|sample| sample.angles).collect();
    let open = last.trial.covariance(&last.tolerant) * last.mean_square().max(1.0);
    let named = Member::new(alike[0].id(), &last.trial, &last.fit.at, Some(&open));
    let others = (alike[1..].iter().zip(&last.alternatives))
        .map(|(effect, a)| Member::new(effect.id(), &a.model.0, &a.model.1, None));
    let members: Result<Vec<_>, _> = std::iter::once(named).chain(others).collect();
    let chosen =
        (members.ok()).and_then(|m| experiments::choose(&m, experiments::menu(&angles), floor));
    let discriminates = alike.iter().map(|e| e.id().to_owned()).collect();
    match chosen {
        Some(chosen) if chosen.decides() => Experiment {
            words: chosen.plan.words,
            discriminates,
            predictions: chosen.predictions,
            apart_floors: Some(chosen.apart),
        },
        best => {
            let words: Vec<&str> = alike.iter().map(|e| e.experiment()).collect();
            let apart = best.map_or(0.0, |best| best.apart);
            Experiment {
                words: format!(
                    "loads on the platform, other orientations and other motor angles would set these models no more than \
                     {apart:.1} floors apart; {}",
                    words.join("; ")
                ),
                discriminates,
                predictions: vec![],
                apart_floors: None,
            }
        }
    }
}

fn kind(
    baseline: &Standing<'_>,
    last: &Standing<'_>,
    (explained, doubtful): (f64, bool),
    named: &[&dyn Effect],
) -> Kind {
    let left = last.mean_square();
    match named {
        _ if baseline.mean_square() < SOUND => Kind::None,
        [] => Kind::Unexplained,
        // what is left is noise, however little there was to explain
        _ if explained < EXPLAINED && left >= SOUND => Kind::Unexplained,
        // a cause that makes a recording worse, or must be stronger than it can be, stands for another
        _ if doubtful || left > LEFT => Kind::Unexplained,
        // so many, and still not all of it: they imitate something else
        _ if named.len() == MOST && left >= SOUND => Kind::Unexplained,
        // what only describes explains nothing unless it leaves nothing
        _ if named.iter().any(|e| !e.is_cause()) && left >= SOUND => Kind::Unexplained,
        [_] if !last.alternatives.is_empty() => Kind::Class,
        [effect] if effect.hook() == Hooked::Recording => Kind::Recording,
        [_] => Kind::Effect,
        _ => Kind::Several,
    }
}

/// Values with intervals from the curvature of chi2, widened where the fit is worse than the noise, and by what a finer mesh
/// would do to the value. They are those of the fit that tolerates shared errors, and hold the values of the other one.
fn estimates(standing: &Standing<'_>) -> Vec<Estimated> {
    let (trial, fit) = (&standing.trial, &standing.tolerant);
    let scale = standing.mean_square().max(1.0);
    let covariance = trial.covariance(fit);
    let quantities = trial.forms.iter().flat_map(|form| &form.quantities);
    let names = (trial.own.iter().map(|p| (p.name.clone(), p.unit.clone())))
        .chain(quantities.map(|q| (q.name.clone(), q.unit.to_owned())));
    let estimate = |(j, (name, unit)): (usize, (String, String))| {
        let deviation = (covariance[(j, j)] * scale).sqrt();
        let reach = 1.96 * deviation.hypot(standing.with_mesh[j]);
        let (least, most) = trial.range(j);
        let (value, tolerant) = (standing.fit.at[j], fit.at[j]);
        let ci95 = [
            (tolerant - reach).max(least).min(value),
            (tolerant + reach).min(most).max(value),
        ];
        Estimated {
            name,
            value,
            unit,
            ci95,
        }
    };
    names.enumerate().map(estimate).collect()
}

/// The named effects; `estimates` are those of their numbers, one after the other. Terms of a law that only describes are
/// one effect.
fn name_all(
    last: &Standing<'_>,
    forms: &[Form],
    effects: &[Box<dyn Effect>],
    mut estimates: &[Estimated],
    baseline: &Standing<'_>,
) -> Vec<Named> {
    let gain = baseline.scores.train_mm() - last.scores.train_mm();
    let mut all: Vec<Named> = Vec::new();
    for (form, probability) in &last.named {
        let (effect, variant) = (&effects[forms[*form].effect], &forms[*form].variant);
        let parameters = estimates.split_off(..variant.quantities.len());
        let parameters = parameters.expect("each number has an estimate").to_vec();
        let mut named = Named::new(&**effect, variant, parameters, (*probability, gain));
        if !effect.is_cause() {
            if let Some(before) = all.pop_if(|before| before.id == named.id) {
                named.equation = before.equation + " +";
                named.probability = named.probability.min(before.probability);
                named.parameters.splice(0..0, before.parameters);
            }
            if let Some(p) = named.parameters.last() {
                named.equation += &format!(" {:.3e} {} * {}", p.value, p.unit, variant.name);
            }
            named.words = format!("{}: {}", effect.words(), named.equation);
        }
        all.push(named);
    }
    all
}

/// How much of the effects' mark the calibration had taken up, and which number most of it.
fn hidden(baseline: &Standing<'_>, last: &Standing<'_>) -> Option<Hidden> {
    if last.named.is_empty() {
        return None;
    }
    let (trial, own) = (&baseline.trial, baseline.trial.own);
    let bare = trial.linear(&last.fit.at[..own.len()], 0..0, None, f64::INFINITY);
    let beyond = |chi2: f64| (chi2 - trial.measured()).max(0.0);
    let (mark, seen) = (beyond(bare.ok()?.chi2()), beyond(baseline.fit.chi2()));
    let moved = |j: &usize| {
        let p = &own[*j];
        (baseline.fit.at[*j] - last.fit.at[*j]).abs() / p.deviation()
    };
    let j = (0..own.len()).max_by(|a, b| moved(a).total_cmp(&moved(b)))?;
    Some(Hidden {
        share: (1.0 - seen / mark.max(1e-300)).clamp(0.0, 1.0),
        parameter: own[j].name.clone(),
        values: [baseline.fit.at[j], last.fit.at[j]],
        unit: own[j].unit.clone(),
    })
}

/// How many effects would not have been noticed at their typical strength.
fn unseen(noticeable: &[Noticeable]) -> usize {
    noticeable.iter().filter(|n| n.share > 1.0).count()
}

/// From which value on each effect would have been noticed.
fn noticeable(
    baseline: &Standing<'_>,
    forms: &[Form],
    effects: &[Box<dyn Effect>],
) -> Vec<Noticeable> {
    let trial = &baseline.trial;
    // as much as noise leaves below what there is to explain
    let most = (SOUND - baseline.mean_square()) * trial.measured();
    let causes = (0..forms.len()).filter(|form| effects[forms[*form].effect].is_cause());
    let found = search::noticeable(trial, &baseline.fit, forms, causes.collect(), most);
    let notice = |(form, share): (usize, f64)| {
        let Form {
            effect, variant, ..
        } = &forms[form];
        let makes = |q: &&Quantity| q.absent_where_large() || (q.typical - q.null).abs() > 1e-12;
        let k = variant.quantities.iter().position(|q| makes(&q))?;
        let q = &variant.quantities[k];
        let place = trial.own.len() + k;
        let with = trial.with(variant);
        let value = with.part(place, (q.null, q.typical), share);
        Some(Noticeable {
            id: effects[*effect].id().to_owned(),
            form: variant.name.clone(),
            parameter: q.name.clone(),
            value: Some(value).filter(|v| q.range.0 <= *v && *v <= q.range.1),
            unit: q.unit.to_owned(),
            share: share.min(NEVER),
        })
    };
    found.into_iter().filter_map(notice).collect()
}

fn floor(data: &[Samples]) -> Floor {
    let settled = || {
        data.iter()
            .flat_map(|s| &s.list)
            .filter(|s| s.phase != Phase::Moving)
    };
    let mean = |squares: f64| (3.0 * squares / settled().count() as f64).sqrt() * 1e3;
    let position = |s: &Sample| s.position_deviation[0].powi(2) + NUMERICS.0.powi(2);
    let rotation = |s: &Sample| s.rotation_deviation[0].powi(2) + NUMERICS.1.powi(2);
    Floor {
        position_mm: mean(settled().map(position).sum()),
        rotation_mrad: mean(settled().map(rotation).sum()),
    }
}

fn audit(train: &[Samples], holdout: &[Samples]) -> Vec<String> {
    let line = |s: &Samples| {
        let flipped = match s.flipped {
            0 => String::new(),
            n => format!(
                "; {n} left out, at which motion capture has a body turned by more than a radian against the scenario"
            ),
        };
        let silent = match s.is_silent() {
            true => "; its motors report no loads, so none are looked at",
            false => "",
        };
        let count = |phase: Phase| s.list.iter().filter(|sample| sample.phase == phase).count();
        format!(
            "{}: {} set-points, {} samples on the way, noise {:.3} mm and {:.2} mrad a component{flipped}{silent}",
            s.name,
            count(Phase::Settled),
            count(Phase::Moving),
            1e3 * s.noise.0,
            1e3 * s.noise.1
        )
    };
    let mut lines: Vec<String> = train.iter().chain(holdout).map(line).collect();
    if train[0].weighed() {
        let each = KINDS.iter().zip(train[0].wider);
        let each: Vec<_> = each.map(|(kind, w)| format!("the {kind} {w:.1}")).collect();
        lines.push(format!(
            "the calibrated scenario is so far off that residuals count by how far off their kind is; over noise they are \
             taken to spread wider by {}",
            each.join(", ")
        ));
    }
    lines
}

fn sentence(
    kind: Kind,
    named: &[Named],
    (explained, left): (f64, f64),
    floor: &Floor,
    class: &[String],
    noticeable: &[Noticeable],
    astray: &[String],
) -> String {
    let words: Vec<&str> = named.iter().map(|n| n.words.as_str()).collect();
    let share = 100.0 * explained;
    let all = words.join("; ");
    match kind {
        Kind::Insufficient => format!(
            "These recordings show too little: nothing is missing above the floor of {:.2} mm and {:.1} mrad, but {} of \
             {} effects would not be noticed here at their typical strength. Let the motors turn further and in more \
             combinations, and hold longer.",
            floor.position_mm,
            floor.rotation_mrad,
            unseen(noticeable),
            noticeable.len()
        ),
        Kind::None => format!(
            "Nothing is missing above the floor of {:.2} mm and {:.1} mrad: the calibrated scenario explains the recordings.",
            floor.position_mm, floor.rotation_mrad
        ),
        Kind::Recording => format!(
            "The recording, not the robot: {all}. That explains {share:.0} % of the mismatch."
        ),
        Kind::Effect => {
            format!("What was left out: {all}. That explains {share:.0} % of the mismatch.")
        }
        Kind::Class => format!(
            "These recordings can't tell {} apart; the best of them ({all}) explains {share:.0} % of the mismatch.",
            class.join(" and ")
        ),
        Kind::Several => format!(
            "Several things were left out: {all}. Together they explain {share:.0} % of the mismatch."
        ),
        Kind::Unexplained if named.is_empty() => {
            "There is a mismatch, and none of the known effects explains it.".into()
        }
        Kind::Unexplained if !astray.is_empty() => format!(
            "There is a mismatch whose cause is not known. What is known ({all}) would account for {share:.0} % of it, but {}.",
            astray.join("; ")
        ),
        Kind::Unexplained => format!(
            "There is a mismatch that is not explained: what is known ({all}) accounts for {share:.0} % of it, and {left:.0} \
             times what noise makes is left."
        ),
    }
}
