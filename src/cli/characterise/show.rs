//! Characteristics and fits for people.

use crate::characterise::{Bench, Characteristics, Comparison, LEAST_DEVIATION, Quantity};
use crate::cli::table::table;
use crate::identify::Fit;
use std::collections::BTreeMap;

/// Digits that show a value and not its noise.
fn digits(value: f64) -> String {
    // adding zero drops the sign of what rounds to zero
    format!("{:.3}", (value * 1e3).round() / 1e3 + 0.0)
}

/// The characteristics for people.
pub(super) fn states(scenario: &str, bench: &Bench, found: &[Characteristics]) -> String {
    let mut header = vec!["twist angle [deg]".to_owned()];
    header.extend(Quantity::ALL.map(|q| format!("{q} [{}]", q.unit())));
    let header: Vec<_> = header.iter().map(String::as_str).collect();
    let rows = found.iter().map(|at| {
        let mut row = vec![digits(at.angle.to_degrees())];
        row.extend(Quantity::ALL.map(|q| match at.get(q) {
            Ok(value) => digits(value / q.in_si()),
            Err(_) => "no steady state".to_owned(),
        }));
        row
    });
    let mut text = format!(
        "{scenario}, rod `{}`, pulled with {} N for its spring constant\n{}",
        bench.rod(),
        bench.pull(),
        table(&header, rows)
    );
    for (reason, places) in missing(found) {
        text += &format!("\nno steady state for the {}: {reason}", places.join(", "));
    }
    text
}

/// What has no steady state, by its reason.
fn missing(found: &[Characteristics]) -> BTreeMap<&str, Vec<String>> {
    let mut missing: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for at in found {
        for q in Quantity::ALL {
            if let Err(reason) = at.get(q) {
                let angle = digits(at.angle.to_degrees());
                missing
                    .entry(reason)
                    .or_default()
                    .push(format!("{q} at {angle} degrees"));
            }
        }
    }
    missing
}

/// Measured points beside simulated ones, for people.
pub(super) fn beside(beside: &Comparison) -> String {
    let points = beside.points.iter().map(|b| {
        let (point, q) = (b.measured, b.measured.quantity);
        let shown = |value: f64| digits(value / q.in_si());
        vec![
            format!("{q} [{}]", q.unit()),
            digits(point.angle.to_degrees()),
            format!(
                "{} -{} +{}",
                shown(point.value),
                shown(point.error_minus),
                shown(point.error_plus)
            ),
            b.simulated
                .as_ref()
                .map_or("-".into(), |value| shown(*value)),
            b.residual().map_or("-".into(), |r| format!("{r:+.1}")),
            if b.inside() { "inside" } else { "outside" }.into(),
        ]
    });
    let header = [
        "quantity",
        "angle [deg]",
        "measured",
        "simulated",
        "off by [bars]",
        "error bar",
    ];
    let points = table(&header, points);
    let quantities = beside.mismatches.iter().map(|m| {
        let q = m.quantity;
        vec![
            format!("{q} [{}]", q.unit()),
            format!("{} of {}", m.inside, m.points + m.unsolved),
            digits(m.rms / q.in_si()),
            format!("{:.2}", m.rms_in_bars()),
            format!("{:.1}", m.chi2),
        ]
    });
    let header = ["quantity", "inside their bars", "RMS", "RMS [bars]", "chi2"];
    format!(
        "\nmeasured: {} (a bar is the mean of both halves of the error bar, at least {} % of the largest value)\n{points}\n\n{}",
        beside.origin,
        LEAST_DEVIATION * 100.0,
        table(&header, quantities)
    )
}

/// How strong a correlation is told.
const STRONG: f64 = 0.9;

/// What a fit has found, and how far the rod is from the measurements before and after.
pub(super) fn fit(fit: &Fit, before: &Comparison, after: &Comparison, used: &[Quantity]) -> String {
    let number = |value: f64| format!("{value:.4e}");
    let rows = fit.estimates.iter().map(|e| {
        let p = &e.parameter;
        vec![
            if p.unit.is_empty() {
                p.name.clone()
            } else {
                format!("{} [{}]", p.name, p.unit)
            },
            number(p.nominal),
            number(e.value),
            e.deviation.map_or("-".into(), number),
            match e.at_bound {
                true => "at the end of its range".into(),
                false => format!("{} .. {}", number(e.interval.0), number(e.interval.1)),
            },
        ]
    });
    let header = ["fitted", "scenario", "fit", "deviation", "95 % interval"];
    let mut text = format!("\n{}\n", table(&header, rows));
    let per_degree = fit.variance();
    text += &format!(
        "chi2 {} -> {:.1} with {} degrees of freedom, {per_degree:.1} each",
        fit.chi2_before
            .map_or("-".into(), |chi2| format!("{chi2:.1}")),
        fit.chi2,
        fit.degrees_of_freedom,
    );
    if per_degree > 1.0 {
        text += &format!(
            ": the model does not reach the error bars, so deviations and intervals are {:.1} times as wide as the \
             bars alone would make them",
            per_degree.sqrt()
        );
    }
    text += &format!(
        "\n{} of {} descents ended here, {} evaluations{}\n",
        fit.starts.1,
        fit.starts.0,
        fit.evaluations,
        if fit.converged {
            ""
        } else {
            "; it has NOT converged"
        }
    );
    for (i, e) in fit.estimates.iter().enumerate() {
        for (j, other) in fit.estimates.iter().enumerate().take(i) {
            let r = fit.correlation[(i, j)];
            if r.abs() > STRONG {
                let (a, b) = (&other.parameter.name, &e.parameter.name);
                text += &format!("{a} and {b} are correlated by {r:+.3}\n");
            }
        }
    }
    for what in &fit.undetermined {
        text += &format!("{what}\n");
    }
    let rows = before
        .mismatches
        .iter()
        .zip(&after.mismatches)
        .map(|(before, after)| {
            let q = before.quantity;
            let si = q.in_si();
            let all = before.points + before.unsolved;
            vec![
                format!("{q} [{}]", q.unit()),
                if used.contains(&q) { "yes" } else { "no" }.into(),
                format!("{} -> {} of {all}", before.inside, after.inside),
                format!("{} -> {}", digits(before.rms / si), digits(after.rms / si)),
                format!("{:.2} -> {:.2}", before.rms_in_bars(), after.rms_in_bars()),
            ]
        });
    let header = [
        "quantity",
        "fitted to",
        "inside their bars",
        "RMS",
        "RMS [bars]",
    ];
    text + &table(&header, rows)
}
