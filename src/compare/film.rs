//! What motion capture would see of a scenario.

use super::CompareError;
use super::simulated::{markers, pose};
use crate::config::Source;
use crate::engine::{Inputs, Model, RunError, SteadySolver};
use crate::recordings::Pose;

/// Smallest share of the way from one row to the next that is solved at once.
const SMALLEST: f64 = 1.0 / 8.0;

/// Poses of both markers in the base frame as motion capture sees them, in steady states one after the other.
///
/// # Errors
/// If the scenario can't be built, or has no steady state at one of the times.
pub fn film(
    source: &Source,
    inputs: Inputs,
    times: &[f64],
) -> Result<Vec<[Pose; 2]>, CompareError> {
    let mut model = Model::build(source, Some(inputs))?;
    let markers = markers(&model)?;
    let mut options = model.solver.steady_options();
    options.smallest_increment = options.smallest_increment.max(SMALLEST);
    let system = &mut model.system;
    system.set_time(times.first().copied().unwrap_or(0.0));
    let mut solver = SteadySolver::new(system, options).map_err(RunError::from)?;
    let mut poses = Vec::with_capacity(times.len());
    for time in times {
        solver
            .advance(&mut model.system, *time)
            .map_err(RunError::from)?;
        poses.push([0, 1].map(|b| pose(&model, &markers[b], None)));
    }
    Ok(poses)
}
