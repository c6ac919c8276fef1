//! A rod's uncertain numbers from its measured curves.

use super::{Bench, Beside, CharacteriseError, Comparison, Curves};
use crate::config::{Problems, Source};
use crate::identify::{Fit, Options, Parameter, Watch, fit};
use std::ops::ControlFlow;

/// Finds the values of `parameters`, numbers of the scenario `source` that `bench` has its rod from, for which the rod's
/// characteristics fit the measured curves best: the sum of the squares of the differences in units of the error bars
/// ([`Beside::residual`](super::Beside::residual)) is least.
///
/// # Errors
/// If the rod has no steady state at the scenario's values, or `watch` says to stop.
pub fn identify(
    source: &Source,
    bench: &Bench,
    curves: &Curves,
    parameters: &[Parameter],
    options: &Options,
    watch: &Watch<'_>,
) -> Result<Fit, CharacteriseError> {
    let residuals = |at: &[f64]| {
        let sets: Vec<_> = parameters
            .iter()
            .zip(at)
            .map(|(p, value)| p.set(*value))
            .collect();
        let problems = |e: Problems| e.to_string();
        residuals(&source.with(&sets).map_err(problems)?, bench, curves)
    };
    Ok(fit(parameters, &residuals, options, watch)?)
}

/// Simulated less measured in units of the error bars, point by point, for a version of the scenario that `bench` has its
/// rod from.
///
/// # Errors
/// In words, if the version is wrong, or the rod has no steady state at a point.
pub fn residuals(version: &Source, bench: &Bench, curves: &Curves) -> Result<Vec<f64>, String> {
    let beside = compared(version, bench, curves)?;
    let residual = |b: &Beside| b.residual().map_err(str::to_owned);
    beside.points.iter().map(residual).collect()
}

/// Measured points beside those of a version of the scenario that `bench` has its rod from.
///
/// # Errors
/// In words, if the version is wrong.
pub fn compared(version: &Source, bench: &Bench, curves: &Curves) -> Result<Comparison, String> {
    let rod = bench.with(version).map_err(|e| e.to_string())?;
    let found = rod.characterise(&curves.angles(), &mut |_| ControlFlow::Continue(()));
    Ok(Comparison::new(curves, &found.map_err(|e| e.to_string())?))
}
