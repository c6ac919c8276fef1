//! A rod's uncertain numbers from its measured curves.

use super::{Bench, CharacteriseError, Comparison, Curves};
use crate::config::Source;
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
    let mut angles: Vec<f64> = curves.points.iter().map(|point| point.angle).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    let residuals = |at: &[f64]| {
        let sets: Vec<_> = parameters
            .iter()
            .zip(at)
            .map(|(p, value)| p.set(*value))
            .collect();
        let problems = |e: crate::config::Problems| e.to_string();
        let rod = source
            .with(&sets)
            .and_then(|source| bench.with(&source))
            .map_err(problems)?;
        let found = rod.characterise(&angles, &mut |_| ControlFlow::Continue(()));
        let beside = Comparison::new(curves, &found.map_err(|e| e.to_string())?);
        let residual = |b: &super::Beside| b.residual().map_err(str::to_owned);
        beside.points.iter().map(residual).collect()
    };
    Ok(fit(parameters, &residuals, options, watch)?)
}
