//! Where scenarios differ from measured curves.

use super::hypothesis::Group;
use super::rod::Rod;
use super::verdict::{CurvesLocation, QuantityShare};
use crate::characterise::{Beside, Comparison, Point, Quantity};

/// Share of the mismatch of a quantity that its region of twist holds at least.
const MOST: f64 = 0.8;

/// Squared residuals by quantity, of all rods.
fn by_quantity(all: &[Comparison]) -> [f64; 4] {
    let mismatches = all.iter().flat_map(|beside| &beside.mismatches);
    mismatches.fold([0.0; 4], |mut sums, m| {
        sums[m.quantity as usize] += m.chi2;
        sums
    })
}

/// The quantity that differs most with the values that the scenarios state, which are those of the law's authors or the
/// maker's: calibration spreads a mismatch over all quantities.
pub(super) fn subject(stated: &[Comparison]) -> Quantity {
    let sums = by_quantity(stated);
    let most = |a: &Quantity, b: &Quantity| sums[*a as usize].total_cmp(&sums[*b as usize]);
    let all = Quantity::ALL.into_iter();
    all.max_by(most).expect("there are quantities")
}

/// Locates the mismatch: with stated values, with calibrated ones, and of the `subject` as the other quantities let expect
/// it.
pub(super) fn locate(
    stated: &[Comparison],
    calibrated: &[Comparison],
    expected: &[Comparison],
    subject: Quantity,
) -> CurvesLocation {
    let (before, after) = (by_quantity(stated), by_quantity(calibrated));
    let share = |sums: &[f64; 4], q: Quantity| {
        sums[q as usize] / sums.iter().sum::<f64>().max(f64::MIN_POSITIVE)
    };
    let mut quantities: Vec<_> = Quantity::ALL
        .into_iter()
        .map(|q| QuantityShare {
            quantity: q.name().to_owned(),
            share: share(&before, q),
            calibrated: share(&after, q),
        })
        .collect();
    quantities.sort_by(|a, b| b.share.total_cmp(&a.share));
    let points = || {
        let all = expected.iter().flat_map(|beside| &beside.points);
        all.filter(|b| b.measured.quantity == subject)
    };
    let square = |b: &Beside| b.residual().map_or(0.0, |r| r * r);
    let (from, to) = region(
        &points()
            .map(|b| (b.measured.angle, square(b)))
            .collect::<Vec<_>>(),
    );
    let inside = || points().filter(|b| (from..=to).contains(&b.measured.angle));
    let excess = inside().filter_map(|b| Some(b.simulated.as_ref().ok()? - b.measured.value));
    let off = excess.sum::<f64>() / inside().map(|b| b.measured.value).sum::<f64>();
    let region = [from, to].map(f64::to_degrees);
    let lies: f64 = inside().map(square).sum::<f64>() / points().map(square).sum::<f64>();
    let place = match region {
        [from, to] if to > from => format!("between {from:.0} and {to:.0} degrees"),
        [from, _] => format!("at {from:.0} degrees"),
    };
    CurvesLocation {
        state: format!(
            "{:.0} % of the mismatch is in the {subject} with the values that the scenarios state; calibrated by the other \
             quantities they expect it {:.0} % too {} {place}, where {:.0} % of its mismatch is",
            100.0 * share(&before, subject),
            100.0 * off.abs(),
            if off > 0.0 { "high" } else { "low" },
            100.0 * lies
        ),
        quantities,
        twist_angles_deg: region,
    }
}

/// The shortest range of angles that holds [`MOST`] of what belongs to them.
fn region(squares: &[(f64, f64)]) -> (f64, f64) {
    let total: f64 = squares.iter().map(|(_, square)| square).sum();
    let ends = squares
        .iter()
        .flat_map(|(from, _)| squares.iter().map(|(to, _)| (*from, *to)));
    let holds = |from: f64, to: f64| {
        let inside = squares.iter().filter(|(at, _)| (from..=to).contains(at));
        inside.map(|(_, square)| square).sum::<f64>() >= MOST * total
    };
    ends.filter(|(from, to)| from <= to && holds(*from, *to))
        .min_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))
        .unwrap_or((0.0, 0.0))
}

/// What was measured and which of it is left out in turn, rod by rod.
pub(super) fn audit(rods: &[Rod], groups: &[Group], subject: Quantity) -> Vec<String> {
    let line = |(r, rod): (usize, &Rod)| {
        let held = |p: &Point| p.quantity == subject && groups.iter().any(|g| g.holds(r, p));
        let angles = rod.curves.only(held).angles();
        let angles = angles.iter().map(|a| format!("{:.0}", a.to_degrees()));
        format!(
            "{}: {} figures; left out {}: the {subject} at {} degrees",
            rod.name,
            rod.curves.points.len(),
            if rods.len() == 1 {
                "one after the other"
            } else {
                "with the rod"
            },
            angles.collect::<Vec<_>>().join(", ")
        )
    };
    rods.iter().enumerate().map(line).collect()
}
