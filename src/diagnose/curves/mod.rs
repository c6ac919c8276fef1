//! What a scenario of a rod lacks by its measured curves.
//!
//! The quantity is found that the scenarios, as they stand, get wrong. Rods' own numbers are calibrated by the other
//! quantities; then every effect that changes the curves is added with the same numbers on all rods, which are fitted to
//! that quantity. Effects are judged by rods that were left out, each in turn, or, of a single rod, by angles.

mod conclusion;
mod hypothesis;
mod locate;
mod matching;
mod rod;
mod search;
pub mod verdict;

use super::{DiagnoseError, SOUND_AS_MEASURED, chosen};
use crate::config::Source;
use conclusion::conclude;
use hypothesis::{Group, Hypothesis};
use rayon::prelude::*;
use rod::Rod;
use std::path::Path;
use verdict::CurvesDiagnosis;

/// What is diagnosed and how.
pub struct CurvesRequest<'a> {
    /// The scenarios, one a rod, which declare their uncertain numbers.
    pub scenarios: &'a [Source],
    /// A CSV file of measured curves.
    pub file: &'a Path,
    /// The rods' numbers of rows in the file, in the scenarios' order; found by their lengths if empty.
    pub rows: &'a [u32],
    /// Identifiers of the effects to try; all if empty.
    pub effects: &'a [String],
}

/// Diagnoses by measured curves. Returns the scenarios with the named effect, too.
///
/// # Errors
/// If scenarios or curves can't be used, or have nothing to do with each other.
pub fn diagnose_curves(
    request: &CurvesRequest<'_>,
    told: &(dyn Fn(f64) + Sync),
) -> Result<(CurvesDiagnosis, Vec<Source>), DiagnoseError> {
    let start = std::time::Instant::now();
    let rods = rods(request)?;
    let mut effects = chosen(request.effects)?;
    // a law that only describes is for robots, and no motor's load is on a curve
    effects.retain(|effect| effect.is_cause() && !effect.in_loads());
    let all = |rod: &Rod, own: &[f64]| rod.compared(own, None, &rod.curves);
    let free = each(&rods, |_, rod| {
        rod.calibrated(&rod.stated(), None, &rod.curves)
    })?;
    told(0.05);
    let calibrated = each(&rods, |r, rod| all(rod, &free[r].values()))?;
    // where a scenario can't be solved with the values that it states, those calibrated say where it fails
    let stated = each(&rods, |_, rod| all(rod, &rod.stated()));
    let stated = stated.unwrap_or_else(|_| calibrated.clone());
    let subject = locate::subject(&stated);
    let but_subject = |rod: &Rod| rod.curves.only(|p| p.quantity != subject);
    let others = each(&rods, |_, rod| {
        rod.calibrated(&rod.stated(), None, &but_subject(rod))
    })?;
    let own: Vec<_> = others.iter().map(crate::identify::Fit::values).collect();
    let corrections = each(&rods, |r, rod| rod.correction(&own[r], &but_subject(rod)))?;
    let base = Hypothesis {
        rods: &rods,
        subject,
        own: &own,
        corrections: &corrections,
        forms: None,
    };
    let groups = Group::all(&rods, subject);
    if groups.is_empty() {
        return Err(DiagnoseError::Unfit(format!(
            "the {subject} differs most, and its figures are too few to leave one out: measure it at three angles at least"
        )));
    }
    told(0.1);
    let squares: f64 = free.iter().map(|fit| fit.chi2).sum();
    let degrees: usize = free.iter().map(|fit| fit.degrees_of_freedom).sum();
    let sound = squares < SOUND_AS_MEASURED * degrees.max(1) as f64;
    let forms = search::forms(&effects, &rods)?;
    let held_out = search::held_out(&base, &[], &groups).map_err(unsolved)?;
    let found = match sound {
        true => Vec::new(),
        false => {
            let told = |share: f64| told(0.1 + 0.85 * share);
            search::search(&base, &groups, &held_out, &forms, &told).map_err(unsolved)?
        }
    };
    let seen = conclusion::Seen {
        base: &base,
        groups: &groups,
        held_out: &held_out,
        stated: &stated,
        calibrated: &calibrated,
        free: &free,
        others: &others,
        sound,
    };
    let (mut diagnosis, augmented) = conclude(&seen, &found, &forms, &effects)?;
    diagnosis.seconds = start.elapsed().as_secs_f64();
    told(1.0);
    Ok((diagnosis, augmented))
}

fn rods(request: &CurvesRequest<'_>) -> Result<Vec<Rod>, DiagnoseError> {
    let (scenarios, rows) = (request.scenarios, request.rows);
    if !rows.is_empty() && rows.len() != scenarios.len() {
        return Err(DiagnoseError::Unfit(format!(
            "--rows names {} rods, and there are {} scenarios: name one for each, in their order",
            rows.len(),
            scenarios.len()
        )));
    }
    let rod = |(i, source)| matching::matched(source, request.file, rows.get(i).copied());
    let rods: Vec<Rod> = (scenarios.iter().enumerate().map(rod)).collect::<Result<_, _>>()?;
    for (i, rod) in rods.iter().enumerate() {
        if let Some(first) = rods[..i].iter().position(|other| other.name == rod.name) {
            return Err(DiagnoseError::Unfit(format!(
                "{} and {} are both taken for the rod of {}: give one scenario a rod, or say which they are with --rows",
                scenarios[first].name(),
                scenarios[i].name(),
                rod.name
            )));
        }
    }
    Ok(rods)
}

fn unsolved(e: String) -> DiagnoseError {
    DiagnoseError::Unfit(format!("a rod can't be put on the bench: {e}"))
}

/// Something of each rod.
fn each<T: Send>(
    rods: &[Rod],
    of: impl Fn(usize, &Rod) -> Result<T, String> + Sync,
) -> Result<Vec<T>, DiagnoseError> {
    let of = |(r, rod): (usize, &Rod)| {
        of(r, rod).map_err(|e| DiagnoseError::Unfit(format!("{}: {e}", rod.source.name())))
    };
    rods.par_iter().enumerate().map(of).collect()
}
