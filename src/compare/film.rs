//! What a recording would show of a scenario.

use super::simulated::{markers, pose};
use super::{CompareError, motor_inputs, turns};
use crate::config::Source;
use crate::engine::{Model, RunError, SteadySolver};
use crate::recordings::Pose;

/// Smallest share of the way from one row to the next that is solved at once.
const SMALLEST: f64 = 1.0 / 8.0;

/// What a recording would show, row by row.
pub struct Film {
    /// Poses of platform and ring in the base frame, as motion capture sees them.
    pub poses: Vec<[Pose; 2]>,
    /// The motors' loads; zero if the scenario doesn't say what they report.
    pub loads: Vec<[f64; 4]>,
}

/// Steady states at these times \[s\] under these motor angles \[rad\], one after the other.
///
/// # Errors
/// If the scenario can't be built, or has no steady state at one of the times.
pub fn film(source: &Source, times: &[f64], angles: &[[f64; 4]]) -> Result<Film, CompareError> {
    let inputs = motor_inputs(times, angles).map_err(CompareError::Unfit)?;
    let mut model = Model::build(source, Some(inputs))?;
    let markers = markers(&model)?;
    let mut options = model.solver.steady_options();
    options.smallest_increment = options.smallest_increment.max(SMALLEST);
    let system = &mut model.system;
    system.set_time(times.first().copied().unwrap_or(0.0));
    let mut solver = SteadySolver::new(system, options).map_err(RunError::from)?;
    let turns = turns(times, angles);
    let (mut poses, mut loads) = (Vec::new(), Vec::new());
    for (row, time) in times.iter().enumerate() {
        solver
            .advance(&mut model.system, *time)
            .map_err(RunError::from)?;
        poses.push([0, 1].map(|b| pose(&model, &markers[b], None)));
        let torques = model.motor_torques();
        let reading = |i: usize| {
            let motors = model.motor_loads.as_ref();
            motors.map_or(0.0, |motors| motors.reading(i, torques[i], turns[row][i]))
        };
        loads.push(std::array::from_fn(reading));
    }
    Ok(Film { poses, loads })
}
