//! Which rod of a table of curves a scenario is of.

use super::rod::Rod;
use crate::characterise::{BadCurves, Bench, CharacteriseError, Curves, Quantity};
use crate::config::Source;
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
    let curves = match rows {
        Some(_) => Curves::read(file, rows)?,
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
    Rod::new(source.with(&[])?, curves)
}

/// The curves of the rod that is as long as that of the scenario.
fn of_length(source: &Source, file: &Path) -> Result<Curves, CharacteriseError> {
    let here = Bench::new(source, None, 1.0)?
        .characterise(&[0.0], &mut |_| ControlFlow::Continue(()))?[0]
        .get(Quantity::MinimumEnergyLength)
        .map_err(|e| BadCurves {
            place: source.name().to_owned(),
            what: format!("the untwisted rod has no steady state ({e})"),
            remedy: "mend the scenario".into(),
        })?;
    let all = Curves::rows(file)?
        .into_iter()
        .map(|rows| Curves::read(file, rows))
        .collect::<Result<Vec<_>, _>>()?;
    let length = |curves: &Curves| {
        let lengths = curves.points.iter();
        let lengths = lengths.filter(|p| p.quantity == Quantity::MinimumEnergyLength);
        let untwisted = lengths.min_by(|a, b| a.angle.abs().total_cmp(&b.angle.abs()));
        untwisted.map(|p| p.value)
    };
    let off = |curves: &Curves| length(curves).map(|there| (there / here - 1.0).abs());
    let (known, unknown): (Vec<_>, Vec<_>) = all.into_iter().partition(|c| off(c).is_some());
    // a table of one rod need not tell its length
    if let ([], [_]) = (&known[..], &unknown[..]) {
        return Ok(unknown.into_iter().next().expect("there is one"));
    }
    let listed: Vec<String> = known
        .iter()
        .filter_map(|c| Some(format!("{:.1} mm ({})", 1e3 * length(c)?, c.origin)))
        .collect();
    let nearest = known.into_iter().min_by(|a, b| {
        off(a)
            .unwrap_or(f64::MAX)
            .total_cmp(&off(b).unwrap_or(f64::MAX))
    });
    match nearest {
        Some(curves) if off(&curves).is_some_and(|off| off < AS_LONG) => Ok(curves),
        _ => Err(CharacteriseError::Curves(BadCurves {
            place: file.display().to_string(),
            what: format!(
                "it holds no rod as long as that of {}, {:.1} mm untwisted; it has {}",
                source.name(),
                1e3 * here,
                match listed.as_slice() {
                    [] => "several rods, and no `minimum_energy_length` of them".to_owned(),
                    some => some.join(", "),
                }
            ),
            remedy: "give the scenario of a rod that was measured, or say which it is with --rows"
                .into(),
        })),
    }
}
