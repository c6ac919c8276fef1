//! When simulation and recordings differ: where, and which physics was left out.
//!
//! Recordings are reduced to samples ([`samples`]), a scenario to residuals there ([`forward`]). The scenario's own
//! uncertain numbers are calibrated first, since they hide physics; then every effect that is linked into the program is
//! added in turn, linearised, and the best are fitted together with those numbers ([`search`]). An effect is named if it
//! explains enough on the recordings that are trained on, worsens none of them, and holds on recordings held out.

pub mod forward;
mod locate;
mod oracle;
pub mod page;
pub mod samples;
mod scores;
pub mod search;
pub mod trial;
pub mod verdict;

use crate::compare::CompareError;
use crate::config::{Problems, Source};
use crate::identify::{Effect, Parameter, Robot};
use forward::{CHANNELS, NUMERICS};
pub use oracle::oracle;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use samples::{Phase, Samples};
use scores::Scores;
use std::path::PathBuf;
use trial::{Linear, Trial};
use verdict::{Alternative, Diagnosis, Estimated, Experiment, Floor, Kind, Named};

/// Mean squared residual up to which there is nothing to explain.
const SOUND: f64 = 1.5;
/// Share of chi2 that the first effect must explain to be named, and each further one: what a mesh of another size does
/// to a stressed robot is explained in part by many.
const GAIN: [f64; 2] = [0.25, 0.5];
/// Most effects that are named together.
const MOST: usize = 3;
/// Share of the mismatch beyond noise that the named effects must explain.
const EXPLAINED: f64 = 0.6;
/// Shares of chi2 within which two effects can't be told apart, beside [`ODDS`].
const ALIKE: f64 = 0.1;
/// Difference of scaled chi2 within which two effects can't be told apart: odds of 20 to 1.
const ODDS: f64 = 6.0;
/// Deviations from its prior beyond which a calibrated number is told.
const FAR: f64 = 2.5;
/// Mean platform error [mm] of the calibrated scenario beyond which a recording is taken for that of another robot.
const OTHER_ROBOT: f64 = 40.0;

/// What is diagnosed and how.
pub struct Request<'a> {
    /// The scenario, which declares its uncertain numbers.
    pub source: &'a Source,
    /// Folders of the recordings to train on.
    pub train: &'a [PathBuf],
    /// Folders of the recordings to judge by.
    pub holdout: &'a [PathBuf],
    /// Identifiers of the effects to try; all if empty.
    pub effects: &'a [String],
    /// Seed of the second start of the calibration.
    pub seed: u64,
}

/// Why there is no diagnosis.
#[derive(Debug, thiserror::Error)]
pub enum DiagnoseError {
    /// The scenario is wrong, or declares nothing to calibrate.
    #[error(transparent)]
    Scenario(#[from] Problems),
    /// A recording can't be used.
    #[error(transparent)]
    Recording(#[from] CompareError),
    /// The request makes no sense.
    #[error("{0}")]
    Unfit(String),
}

/// Diagnoses. Returns the scenario with the named effects, too.
///
/// # Errors
/// If scenario or recordings can't be used, or have nothing to do with each other.
pub fn diagnose(
    request: &Request<'_>,
    told: &(dyn Fn(f64) + Sync),
) -> Result<(Diagnosis, Source), DiagnoseError> {
    let start = std::time::Instant::now();
    let own = Parameter::declared(request.source)?;
    let (train, holdout) = read(request)?;
    let effects = chosen(request.effects)?;
    let robot = Robot::of(request.source)?;
    let forms = search::forms(&effects, &robot);
    let unfit = |e: String| {
        DiagnoseError::Unfit(format!("the scenario can't follow these recordings: {e}"))
    };

    let empty = Trial {
        source: request.source,
        own: &own,
        forms: Vec::new(),
        data: &train,
        guides: &[],
    };
    let nominal: Vec<f64> = own.iter().map(|p| p.nominal).collect();
    let guides = empty.guides(&nominal).map_err(unfit)?;
    let guided = Trial {
        guides: &guides,
        ..empty.clone()
    };
    let baseline = calibrate(&guided, &nominal, request.seed).map_err(unfit)?;
    told(0.1);

    let calibrated = empty.scenario(&baseline.at).map_err(unfit)?;
    let before = Scores::of(&calibrated, &train, &holdout)?;
    let worst = before.train.iter().map(|s| s.rms.0).fold(0.0, f64::max);
    if worst > OTHER_ROBOT {
        return Err(DiagnoseError::Unfit(format!(
            "the calibrated scenario is {worst:.0} mm off on a recording: it is of another robot, or its motors are in \
             another order; give the scenario of the robot that was recorded"
        )));
    }
    let measured = count(&train);
    let mut here = baseline.clone();
    let mut trial = empty.clone();
    let mut scores = before.clone();
    let mut named: Vec<(usize, f64)> = Vec::new();
    // of the last effect that was named: others that do as well, and the probability of each
    let (mut alternatives, mut probability) = (Vec::new(), 0.0);
    for round in 0..MOST {
        if here.chi2() / measured < SOUND {
            break;
        }
        let guides = trial.guides(&here.at).map_err(unfit)?;
        let share = |done: f64| told(0.1 + 0.85 * (round as f64 + done) / MOST as f64);
        let used: Vec<usize> = named.iter().map(|(f, _)| forms[*f].effect).collect();
        let found = search::round(&trial, &here, &guides, &forms, &used, &share);
        let scale = found
            .first()
            .map_or(1.0, |c| (c.fit.chi2() / measured).max(1.0));
        let cost = |c: &search::Candidate| {
            c.fit.chi2() / scale + forms[c.form].variant.quantities.len() as f64 * measured.ln()
        };
        let mut ranked: Vec<_> = found.iter().map(|c| (cost(c), c)).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((best_cost, best)) = ranked.first() else {
            break;
        };
        if best.fit.chi2() > (1.0 - GAIN[round.min(1)]) * here.chi2() {
            break;
        }
        let added = trial.with(&forms[best.form].variant);
        let scenario = added.scenario(&best.fit.at).map_err(unfit)?;
        let with = Scores::of(&scenario, &train, &holdout)?;
        if with.worse_than(&scores) {
            break;
        }
        let mut rivals: Vec<(usize, f64)> = Vec::new();
        alternatives.clear();
        for (cost, candidate) in &ranked {
            let effect = forms[candidate.form].effect;
            if rivals.iter().any(|(e, _)| *e == effect) {
                continue;
            }
            let alike =
                cost - best_cost < ODDS || candidate.fit.chi2() < (1.0 + ALIKE) * best.fit.chi2();
            // those that can't be told apart are as likely
            let weight = if alike {
                alternatives.push(effect);
                1.0
            } else {
                (-(cost - best_cost) / 2.0).exp()
            };
            rivals.push((effect, weight));
        }
        let total: f64 = rivals.iter().map(|(_, weight)| weight).sum();
        // the best is the first of them
        alternatives.remove(0);
        probability = 1.0 / total;
        named.push((best.form, probability));
        here = best.fit.clone();
        trial = added;
        scores = with;
    }
    let augmented = trial.scenario(&here.at).map_err(unfit)?;
    let beyond = |chi2: f64| (chi2 - measured).max(0.0);
    let explained = match beyond(baseline.chi2()) {
        all if all > 0.0 => 1.0 - beyond(here.chi2()) / all,
        _ => 1.0,
    };
    let kind = kind(
        &baseline,
        measured,
        &named,
        explained,
        &alternatives,
        &forms,
        &effects,
    );
    let fitted = estimates(&trial, &here, measured);
    let effects_named = name_all(
        &named,
        &forms,
        &effects,
        &fitted,
        own.len(),
        (&before, &scores),
    );
    let discriminates: Vec<String> = (named.last().map(|(f, _)| forms[*f].effect).into_iter())
        .chain(alternatives.iter().copied())
        .map(|e| effects[e].id().to_owned())
        .collect();
    let experiment = (kind == Kind::Class || kind == Kind::Several && !alternatives.is_empty())
        .then(|| Experiment {
            words: named
                .last()
                .map_or("", |(f, _)| effects[forms[*f].effect].experiment())
                .to_owned(),
            discriminates: discriminates.clone(),
        });
    let floor = floor(&train);
    let diagnosis = Diagnosis {
        verdict: kind,
        words: sentence(kind, &effects_named, explained, &floor, &discriminates),
        effects: effects_named,
        alternatives: (alternatives.iter())
            .map(|e| Alternative {
                id: effects[*e].id().to_owned(),
                probability,
            })
            .collect(),
        experiment,
        location: locate::locate(&baseline.residuals.as_slice()[..measured as usize], &train),
        floor,
        baseline: before.fitted(
            estimates(&empty, &baseline, measured),
            baseline.chi2() / measured,
        ),
        augmented: scores.fitted(fitted[..own.len()].to_vec(), here.chi2() / measured),
        explained,
        alarms: alarms(&own, &here.at),
        audit: audit(&train, &holdout),
        seconds: start.elapsed().as_secs_f64(),
    };
    told(1.0);
    Ok((diagnosis, augmented))
}

fn read(request: &Request<'_>) -> Result<(Vec<Samples>, Vec<Samples>), DiagnoseError> {
    if request.train.len() < 2 || request.holdout.is_empty() {
        return Err(DiagnoseError::Unfit(format!(
            "a diagnosis trains on two recordings at least and is judged by one that it hasn't seen; {} and {} are \
             given: add --train DIR and --holdout DIR",
            request.train.len(),
            request.holdout.len()
        )));
    }
    let read = |folders: &[PathBuf]| -> Result<Vec<Samples>, DiagnoseError> {
        folders
            .iter()
            .map(|folder| Ok(Samples::read(folder)?))
            .collect()
    };
    let (train, holdout) = (read(request.train)?, read(request.holdout)?);
    if let Some(samples) = train.iter().find(|s| s.travel.iter().all(|t| *t < 0.05)) {
        return Err(DiagnoseError::Unfit(format!(
            "the motors of recording `{}` never turn, so it shows nothing of the robot; train on one in which they do",
            samples.name
        )));
    }
    Ok((train, holdout))
}

fn chosen(ids: &[String]) -> Result<Vec<Box<dyn Effect>>, DiagnoseError> {
    let mut effects = <dyn Effect>::all();
    if !ids.is_empty() {
        let known: Vec<&str> = effects.iter().map(|e| e.id()).collect();
        if let Some(unknown) = ids.iter().find(|id| !known.contains(&id.as_str())) {
            return Err(DiagnoseError::Unfit(format!(
                "there is no effect `{unknown}`; {}",
                crate::config::remedy(unknown, &known, "effects")
            )));
        }
        effects.retain(|e| ids.iter().any(|id| id == e.id()));
    }
    Ok(effects)
}

/// Fits the scenario's own numbers from their nominal values and from one place in their ranges.
fn calibrate(trial: &Trial<'_>, nominal: &[f64], seed: u64) -> Result<Linear, String> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let elsewhere: Vec<f64> = (trial.own.iter().zip(nominal))
        .map(|(p, n)| {
            let to = p.range.0 + random.random::<f64>() * p.width();
            n + 0.3 * (to - n)
        })
        .collect();
    let fit = |from: &[f64]| Ok::<_, String>(trial.fit(trial.start(from)?, 0..from.len(), 12));
    let (first, second) = rayon::join(|| fit(nominal), || fit(&elsewhere));
    let first = first?;
    Ok(match second {
        Ok(second) if second.chi2() < first.chi2() - 1e-6 * first.chi2() => second,
        _ => first,
    })
}

fn count(data: &[Samples]) -> f64 {
    data.iter().map(|s| s.list.len() * CHANNELS).sum::<usize>() as f64
}

fn kind(
    baseline: &Linear,
    measured: f64,
    named: &[(usize, f64)],
    explained: f64,
    alternatives: &[usize],
    forms: &[search::Form],
    effects: &[Box<dyn Effect>],
) -> Kind {
    let is_recording =
        |form: usize| effects[forms[form].effect].hook() == crate::identify::Hooked::Recording;
    match named {
        _ if baseline.chi2() / measured < SOUND => Kind::None,
        [] => Kind::Unexplained,
        _ if explained < EXPLAINED => Kind::Unexplained,
        [_] if !alternatives.is_empty() => Kind::Class,
        [(form, _)] if is_recording(*form) => Kind::Recording,
        [_] => Kind::Effect,
        _ => Kind::Several,
    }
}

/// Values with intervals from the curvature of chi2, widened where the fit is worse than the noise.
fn estimates(trial: &Trial<'_>, fit: &Linear, measured: f64) -> Vec<Estimated> {
    let scale = (fit.chi2() / measured).max(1.0);
    let covariance = trial.covariance(fit);
    let quantities = trial.forms.iter().flat_map(|form| &form.quantities);
    let names = (trial.own.iter().map(|p| (p.name.clone(), p.unit.clone())))
        .chain(quantities.map(|q| (q.name.clone(), q.unit.to_owned())));
    let estimate = |(j, (name, unit)): (usize, (String, String))| {
        let reach = 1.96 * (covariance[(j, j)] * scale).sqrt();
        let (least, most) = trial.range(j);
        let value = fit.at[j];
        let ci95 = [(value - reach).max(least), (value + reach).min(most)];
        Estimated {
            name,
            value,
            unit,
            ci95,
        }
    };
    names.enumerate().map(estimate).collect()
}

fn name_all(
    named: &[(usize, f64)],
    forms: &[search::Form],
    effects: &[Box<dyn Effect>],
    estimates: &[Estimated],
    own: usize,
    (before, after): (&Scores, &Scores),
) -> Vec<Named> {
    let mut at = own;
    let gain = before.train_mm() - after.train_mm();
    let name = |(form, probability): &(usize, f64)| {
        let (effect, variant) = (&effects[forms[*form].effect], &forms[*form].variant);
        let parameters = estimates[at..at + variant.quantities.len()].to_vec();
        at += variant.quantities.len();
        let words = match variant.name.as_str() {
            "" => effect.words().to_owned(),
            which => format!("{} ({which})", effect.words()),
        };
        Named {
            id: effect.id().to_owned(),
            words,
            equation: effect.equation().to_owned(),
            hook: effect.hook(),
            parameters,
            probability: *probability,
            gain_mm: gain,
        }
    };
    named.iter().map(name).collect()
}

/// Numbers at an end of their range, or far from what was known beforehand.
fn alarms(own: &[Parameter], at: &[f64]) -> Vec<String> {
    let alarm = |(p, value): (&Parameter, &f64)| {
        let near = |end: f64| (value - end).abs() < 1e-3 * p.width();
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

fn floor(data: &[Samples]) -> Floor {
    let settled = || {
        data.iter()
            .flat_map(|s| &s.list)
            .filter(|s| s.phase != Phase::Moving)
    };
    let mean = |squares: f64| (3.0 * squares / settled().count() as f64).sqrt() * 1e3;
    let position = |s: &samples::Sample| s.position_deviation[0].powi(2) + NUMERICS.0.powi(2);
    let rotation = |s: &samples::Sample| s.rotation_deviation[0].powi(2) + NUMERICS.1.powi(2);
    Floor {
        position_mm: mean(settled().map(position).sum()),
        rotation_mrad: mean(settled().map(rotation).sum()),
    }
}

fn audit(train: &[Samples], holdout: &[Samples]) -> Vec<String> {
    let line = |s: &Samples| {
        let count = |phase: Phase| s.list.iter().filter(|sample| sample.phase == phase).count();
        format!(
            "{}: {} set-points, {} samples on the way, noise {:.3} mm and {:.2} mrad a component",
            s.name,
            count(Phase::Settled),
            count(Phase::Moving),
            1e3 * s.noise.0,
            1e3 * s.noise.1
        )
    };
    train.iter().chain(holdout).map(line).collect()
}

fn sentence(
    kind: Kind,
    named: &[Named],
    explained: f64,
    floor: &Floor,
    class: &[String],
) -> String {
    let words: Vec<&str> = named.iter().map(|n| n.words.as_str()).collect();
    let share = 100.0 * explained;
    let all = words.join("; ");
    match kind {
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
        Kind::Unexplained => format!(
            "There is a mismatch that is not explained: the best that is known ({all}) accounts for {share:.0} % of it only."
        ),
    }
}
