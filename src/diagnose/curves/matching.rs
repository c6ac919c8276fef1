//! Which rod of a table of curves a scenario is of.

use super::rod::{PULL, Rod};
use crate::characterise::{BadCurves, Bench, CharacteriseError, Curves, Quantity};
use crate::config::{Problem, Problems, Source};
use crate::identify::Robot;
use std::ops::ControlFlow;
use std::path::Path;

/// Share by which a scenario's untwisted rod may be longer or shorter than the measured one.
const AS_LONG: f64 = 0.05;
/// Fewest quantities and fewest angles that say anything of a law.
const FEWEST: (usize, usize) = (2, 4);

/// The scenario's rod beside its curves in `file`: those of `rows` rows, or else those of a rod of its length.
///
/// # Errors
/// If scenario or file can't be used, or the file has no such rod or too few figures of it.
pub(super) fn matched(
    source: &Source,
    file: &Path,
    rows: Option<u32>,
) -> Result<Rod, CharacteriseError> {
    if Robot::of(source)?.rods.len() > 1 {
        let several = Problem::new(format!("{} has several rods", source.name()));
        let hint = "curves are of single rods: give a scenario of one, such as hsa_rod_8rows.ron";
        return Err(Problems::from(several.with_hint(hint)).into());
    }
    let (rows, curves) = match rows {
        Some(_) => (rows, Curves::read(file, rows)?),
        None => of_length(source, file)?,
    };
    let mut quantities: Vec<Quantity> = curves.points.iter().map(|p| p.quantity).collect();
    quantities.sort_unstable();
    quantities.dedup();
    let angles = curves.angles().len();
    if quantities.len() < FEWEST.0 || angles < FEWEST.1 {
        return Err(CharacteriseError::Curves(BadCurves {
            what: format!(
                "{} quantities at {angles} angles are too few to tell anything",
                quantities.len()
            ),
            remedy: format!(
                "measure {} quantities at {} angles at least",
                FEWEST.0, FEWEST.1
            ),
            place: curves.origin,
        }));
    }
    Rod::new(source.with(&[])?, curves, rows)
}

/// The curves of the rod that is as long as that of the scenario, and its rows.
fn of_length(source: &Source, file: &Path) -> Result<(Option<u32>, Curves), CharacteriseError> {
    let bad = |place: String, what: String, remedy: &str| {
        let remedy = remedy.to_owned();
        CharacteriseError::Curves(BadCurves {
            place,
            what,
            remedy,
        })
    };
    let all = Curves::rows(file)?.into_iter();
    let all = all.map(|rows| Ok((rows, Curves::read(file, rows)?)));
    let mut all = all.collect::<Result<Vec<_>, BadCurves>>()?;
    let length = |curves: &Curves| {
        let lengths = curves.points.iter();
        let lengths = lengths.filter(|p| p.quantity == Quantity::MinimumEnergyLength);
        let untwisted = lengths.min_by(|a, b| a.angle.abs().total_cmp(&b.angle.abs()));
        untwisted.map(|p| p.value)
    };
    // a table of one rod need not tell its length
    if let [(_, only)] = &all[..]
        && length(only).is_none()
    {
        return Ok(all.remove(0));
    }
    let here = Bench::new(source, None, PULL)?
        .characterise(&[0.0], &mut |_| ControlFlow::Continue(()))?[0]
        .get(Quantity::MinimumEnergyLength)
        .map_err(|e| {
            let what = format!("the untwisted rod has no steady state ({e})");
            bad(source.name().to_owned(), what, "mend the scenario")
        })?;
    let lengths = all.iter().enumerate();
    let lengths: Vec<_> = lengths
        .filter_map(|(i, (_, curves))| Some((i, length(curves)?)))
        .collect();
    let off = |(_, there): &(usize, f64)| (there / here - 1.0).abs();
    let nearest = lengths.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    match nearest.filter(|nearest| off(nearest) < AS_LONG) {
        Some((i, _)) => Ok(all.remove(*i)),
        None => {
            let listed = lengths.iter().map(|(_, l)| format!("{:.1} mm", 1e3 * l));
            let listed = listed.collect::<Vec<_>>().join(", ");
            let what = format!(
                "it holds no rod as long as that of {}, {:.1} mm untwisted; lengths: {}",
                source.name(),
                1e3 * here,
                if listed.is_empty() { "none" } else { &listed }
            );
            let remedy =
                "give the scenario of a rod that was measured, or say which rod it is with --rows";
            Err(bad(file.display().to_string(), what, remedy))
        }
    }
}
