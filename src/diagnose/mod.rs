//! When simulation and recordings differ: where, and which physics was left out.
//!
//! Recordings are reduced to samples ([`samples`]), a scenario to residuals there ([`forward`]). The scenario's own
//! uncertain numbers are calibrated first, since they hide physics; then every effect that is linked into the program is
//! added in turn, linearised, and the best are fitted together with those numbers ([`search`]). An effect is named if it
//! explains enough on the recordings that are trained on, worsens none of them, and holds on recordings held out. What the
//! motors report as their loads is held against the model that explains the poses ([`loads`]).

mod alarms;
mod conclusion;
pub mod curves;
pub mod experiments;
pub mod forward;
mod loads;
mod locate;
mod motors;
mod oracle;
pub mod page;
mod pictures;
mod same_robot;
pub mod samples;
mod scores;
pub mod search;
mod shared;
mod standing;
pub mod trial;
pub mod verdict;

use crate::characterise::CharacteriseError;
use crate::compare::CompareError;
use crate::config::{Problems, Source};
use crate::identify::{Effect, Parameter, Robot};
pub use oracle::oracle;
use samples::{KINDS, Samples};
use standing::{Among, Standing};
use std::path::PathBuf;
use trial::Trial;
use verdict::Diagnosis;

/// Mean squared residual of poses up to which there is nothing to explain: what they are allowed for noise and mesh is more
/// than they need.
const SOUND: f64 = 1.0;
/// The same of loads and curves, which are allowed what was measured.
const SOUND_AS_MEASURED: f64 = 1.5;
/// Mean squared residual beyond which what is left is not explained, however much is.
const LEFT: f64 = 4.0;
/// Difference of scaled chi2 within which two effects can't be told apart: odds of 20 to 1.
const ODDS: f64 = 6.0;
/// Most effects that are named together.
const MOST: usize = 3;
/// Most searches for a further effect; one may make another needless.
const ROUNDS: usize = 4;
/// Most terms of a law that only describes.
const TERMS: usize = 3;
/// Mean squared residual of the calibrated scenario beyond which noise doesn't tell how much a channel counts.
const FAR_OFF: f64 = 500.0;
/// Samples of a recording that are enough then, since what is modelled badly shows in neighbours alike.
const ENOUGH: usize = 70;

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
    /// Measured curves can't be used.
    #[error(transparent)]
    Curves(#[from] CharacteriseError),
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
    let (mut train, mut holdout) = read(request)?;
    let effects = chosen(request.effects)?;
    let forms = search::forms(&effects, &Robot::of(request.source)?);
    let (in_loads, forms): (Vec<_>, Vec<_>) =
        (forms.into_iter()).partition(|form| effects[form.effect].in_loads());
    let mut weighed = false;
    let baseline = loop {
        let empty = Trial::new(request.source, &own, &train);
        let baseline = Standing::calibrated(empty, &holdout, request.seed)?;
        same_robot::after_calibration(&baseline.scores)?;
        if weighed || baseline.mean_square() < FAR_OFF {
            break baseline;
        }
        same_robot::motor_order(request.source, &train[0])?;
        let off = standing::off(&baseline.trial, &baseline.fit);
        weigh(off, [&mut train, &mut holdout], (request.source, &own))?;
        weighed = true;
    };
    told(0.1);
    let mut among = Among {
        forms: &forms,
        effects: &effects,
        causes: true,
    };
    let mut last = baseline.clone();
    for round in 0..ROUNDS {
        if last.mean_square() < SOUND || last.named.len() == MOST {
            break;
        }
        let share = |done: f64| told(0.1 + 0.6 * (round as f64 + done) / ROUNDS as f64);
        let Some(next) = last.grown(&among, &holdout, &share)? else {
            break;
        };
        last = next;
    }
    if last.mean_square() > LEFT {
        among.causes = false;
        let share = |done: f64| told(0.7 + 0.25 * done);
        last = described(&baseline, last, &among, &holdout, &share)?;
    }
    let mut augmented = last.scenario()?;
    let mut diagnosis = conclusion::conclude(&baseline, &last, &forms, &effects, &holdout);
    let heard = loads::heard(&augmented, [&train, &holdout], &in_loads, &effects)?;
    if let Some(heard) = heard {
        diagnosis = diagnosis.hearing(heard.loads, heard.named);
        augmented = heard.scenario;
    }
    diagnosis.seconds = start.elapsed().as_secs_f64();
    told(1.0);
    Ok((diagnosis, augmented))
}

/// Lets kinds of channels count by how far `off` they are, so that one that is modelled badly doesn't decide about all
/// others.
fn weigh(
    off: [f64; KINDS.len()],
    data: [&mut Vec<Samples>; 2],
    (source, own): (&Source, &[Parameter]),
) -> Result<(), DiagnoseError> {
    let [train, holdout] = data;
    for samples in train.iter_mut().chain(holdout.iter_mut()) {
        samples.thin(ENOUGH);
        samples.widen(off);
    }
    // what counts changes the fit, and that how far off they are
    let (trial, fit) = standing::fitted(Trial::new(source, own, train))?;
    let off = standing::off(&trial, &fit);
    for samples in train.iter_mut().chain(holdout) {
        samples.widen(off);
    }
    Ok(())
}

/// What is left described by a law, term by term, if that does better: on top of the causes that are named, or in place of
/// them, since several that explain little may imitate one law.
fn described<'a>(
    baseline: &Standing<'a>,
    last: Standing<'a>,
    among: &Among<'a, '_>,
    holdout: &[Samples],
    told: &(dyn Fn(f64) + Sync),
) -> Result<Standing<'a>, DiagnoseError> {
    let grown = |from: &Standing<'a>, least: f64, part: f64| {
        let mut now = from.clone();
        for term in 0..TERMS {
            let share = |done: f64| told(part + (term as f64 + done) / (2 * TERMS) as f64);
            let next = now.grown(among, holdout, &share)?;
            let Some(next) = next.filter(|next| next.mean_square() < least) else {
                break;
            };
            now = next;
            if now.mean_square() < SOUND {
                break;
            }
        }
        Ok::<_, DiagnoseError>(now)
    };
    if !last.named.is_empty() {
        let instead = grown(baseline, last.mean_square(), 0.0)?;
        if instead.mean_square() < SOUND {
            return Ok(instead);
        }
    }
    grown(&last, f64::INFINITY, 0.5)
}

/// Something that scenario and recordings can't do together.
fn unfit(e: String) -> DiagnoseError {
    DiagnoseError::Unfit(format!("the scenario can't follow these recordings: {e}"))
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
    same_robot::given_once(&[request.train, request.holdout].concat())?;
    let read = |folders: &[PathBuf]| -> Result<Vec<Samples>, DiagnoseError> {
        folders
            .iter()
            .map(|folder| Ok(Samples::read(folder)?))
            .collect()
    };
    let (mut train, mut holdout) = (read(request.train)?, read(request.holdout)?);
    for samples in train.iter_mut().chain(&mut holdout) {
        // a scenario without steady states is told when it is calibrated
        if let Ok(apart) = forward::differences(request.source, samples) {
            same_robot::before_calibration(request.source, &apart, samples)?;
            samples.leave_out_flips(&apart);
        }
    }
    Ok((train, holdout))
}

/// Effects of these identifiers, or all.
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
