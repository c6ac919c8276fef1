//! Characteristics and fits with stable keys, SI units.

use crate::characterise::{Bench, Beside, Characteristics, Comparison, Mismatch, Quantity};
use crate::identify::{Estimate, Fit};
use serde_json::{Map, Value, json};

pub(super) fn states(scenario: &str, bench: &Bench, found: &[Characteristics]) -> Value {
    let state = |at: &Characteristics| {
        let mut state = json!({ "twist_angle_rad": at.angle });
        for q in Quantity::ALL {
            state[key(q)] = json!(at.get(q).ok());
        }
        state["missing"] = Quantity::ALL
            .into_iter()
            .filter_map(|q| Some((q.name().to_owned(), at.get(q).err()?.into())))
            .collect::<Map<_, _>>()
            .into();
        state
    };
    json!({
        "scenario": scenario,
        "rod": bench.rod(),
        "pull_n": bench.pull(),
        "sense": bench.sense(),
        "states": found.iter().map(state).collect::<Vec<_>>(),
    })
}

/// A quantity with its SI unit.
fn key(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::HoldingTorque => "holding_torque_n_m",
        Quantity::MinimumEnergyLength => "minimum_energy_length_m",
        Quantity::SpringConstant => "spring_constant_n_per_m",
        Quantity::BlockedForce => "blocked_force_n",
    }
}

pub(super) fn beside(beside: &Comparison) -> Value {
    let point = |b: &Beside| {
        json!({
            "quantity": b.measured.quantity,
            "twist_angle_rad": b.measured.angle,
            "value": b.measured.value,
            "error_minus": b.measured.error_minus,
            "error_plus": b.measured.error_plus,
            "deviation": b.deviation,
            "simulated": b.simulated.as_ref().ok(),
            "inside": b.inside(),
        })
    };
    let mismatch = |m: &Mismatch| {
        json!({
            "quantity": m.quantity,
            "points": m.points,
            "unsolved": m.unsolved,
            "inside": m.inside,
            "rms": m.rms,
            "rms_in_bars": m.rms_in_bars(),
            "chi2": m.chi2,
        })
    };
    json!({
        "origin": beside.origin,
        "units": "SI",
        "chi2": beside.chi2(),
        "points": beside.points.iter().map(point).collect::<Vec<_>>(),
        "quantities": beside.mismatches.iter().map(mismatch).collect::<Vec<_>>(),
    })
}

pub(super) fn fit(fit: &Fit, before: &Comparison, used: &[Quantity]) -> Value {
    let estimate = |e: &Estimate| {
        json!({
            "name": e.parameter.name,
            "path": e.parameter.path,
            "unit": e.parameter.unit,
            "nominal": e.parameter.nominal,
            "range": e.parameter.range,
            "prior": e.parameter.prior,
            "value": e.value,
            "deviation": e.deviation,
            "interval_95": e.interval,
            "at_bound": e.at_bound,
        })
    };
    let rows = fit.correlation.row_iter();
    json!({
        "fitted_to": used,
        "parameters": fit.estimates.iter().map(estimate).collect::<Vec<_>>(),
        "chi2_before": fit.chi2_before,
        "chi2": fit.chi2,
        "degrees_of_freedom": fit.degrees_of_freedom,
        "correlation": rows.map(|row| row.iter().copied().collect::<Vec<_>>()).collect::<Vec<_>>(),
        "condition": fit.condition.is_finite().then_some(fit.condition),
        "undetermined": fit.undetermined,
        "converged": fit.converged,
        "evaluations": fit.evaluations,
        "descents": fit.starts.0,
        "descents_alike": fit.starts.1,
        "before": beside(before),
    })
}
