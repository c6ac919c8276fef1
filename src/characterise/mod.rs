//! Mechanical characteristics of single rods, as they are measured of real ones: holding torque, minimum energy length,
//! spring constant and blocked force against the twist angle (Stölzle et al. 2023, section II-C and Fig. 3; Good et al.
//! 2022), and measured curves beside them.

mod bench;
mod comparison;
mod curves;
mod identify;
mod quantity;

pub use bench::{Bench, Experiment, Measured};
pub use comparison::{Beside, Comparison, LEAST_DEVIATION, Mismatch};
pub use curves::{BadCurves, Curves, Point};
pub use identify::{compared, identify, residuals};
pub use quantity::Quantity;

use crate::config::Problems;
use crate::engine::run::Progress;
use crate::engine::{Model, SteadySolver};
use rayon::prelude::*;

/// Why a rod was not characterised.
#[derive(Debug, thiserror::Error)]
pub enum CharacteriseError {
    /// The scenario is wrong.
    #[error(transparent)]
    Scenario(#[from] Problems),
    /// Measured curves can't be used.
    #[error(transparent)]
    Curves(#[from] BadCurves),
    /// Nothing could be fitted.
    #[error(transparent)]
    Fit(#[from] crate::identify::FitError),
    /// The user stopped the work.
    #[error("stopped; nothing was written")]
    Stopped,
}

/// The characteristics of a rod at one twist angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Characteristics {
    /// Twist angle \[rad\], positive the way that winds the rod.
    pub angle: f64,
    /// In the order of [`Quantity::ALL`], SI units; or why there is none.
    values: [Result<f64, String>; 4],
}

impl Characteristics {
    /// A quantity in SI units, or why there is none.
    pub fn get(&self, quantity: Quantity) -> Result<f64, &str> {
        self.values[quantity as usize]
            .as_ref()
            .copied()
            .map_err(String::as_str)
    }
}

impl Bench {
    /// The characteristics at `angles` \[rad\], in their order, as steady states. Each experiment follows its branch from
    /// rest through the wound angles and then, from rest again, through the unwound ones; the experiments run in
    /// parallel.
    ///
    /// # Errors
    /// If the rod's law or material can't be built alone, or `progress` says to stop. An angle without a steady state is
    /// no error: its characteristics say why they are missing.
    pub fn characterise(
        &self,
        angles: &[f64],
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Characteristics>, CharacteriseError> {
        let mut order: Vec<usize> = (0..angles.len()).collect();
        order.sort_by(|a, b| angles[*a].abs().total_cmp(&angles[*b].abs()));
        let mut found = vec![None; angles.len()];
        let mut done = 0;
        for unwound in [false, true] {
            let mut tests = [Experiment::Free, Experiment::Pulled, Experiment::Blocked]
                .map(|experiment| self.model(experiment).map(Test::new));
            if let Some(Err(problems)) = tests.iter_mut().find(|test| test.is_err()) {
                return Err(problems.clone().into());
            }
            for &i in order.iter().filter(|i| (angles[**i] < 0.0) == unwound) {
                let seen: Vec<_> = tests
                    .par_iter_mut()
                    .flatten()
                    .map(|test| test.at(angles[i]))
                    .collect();
                found[i] = Some(self.characteristics(angles[i], &seen));
                done += 1;
                if progress(done as f64 / angles.len() as f64).is_break() {
                    return Err(CharacteriseError::Stopped);
                }
            }
        }
        Ok(found
            .into_iter()
            .map(|found| found.expect("every angle is wound or unwound"))
            .collect())
    }

    fn characteristics(&self, angle: f64, seen: &[Result<Measured, String>]) -> Characteristics {
        let [free, pulled, blocked] = [&seen[0], &seen[1], &seen[2]];
        let value = |state: &Result<Measured, String>, of: &dyn Fn(&Measured) -> f64| {
            state.as_ref().map(of).map_err(String::clone)
        };
        let spring = match (free, pulled) {
            (Ok(free), Ok(pulled)) => Ok(self.pull() / (pulled.length - free.length)),
            (Err(e), _) | (_, Err(e)) => Err(e.clone()),
        };
        Characteristics {
            angle,
            values: [
                value(free, &|seen| self.sense() * seen.torque),
                value(free, &|seen| seen.length),
                spring,
                value(blocked, &|seen| seen.push),
            ],
        }
    }
}

/// An experiment under way.
struct Test {
    model: Model,
    solver: Result<SteadySolver, String>,
}

impl Test {
    fn new(mut model: Model) -> Self {
        let options = model.solver.steady_options();
        let solver = SteadySolver::new(&mut model.system, options).map_err(|e| e.reason);
        Self { model, solver }
    }

    /// What is measured at a twist angle \[rad\].
    fn at(&mut self, angle: f64) -> Result<Measured, String> {
        let solver = self.solver.as_mut().map_err(|reason| reason.clone())?;
        solver
            .advance(&mut self.model.system, angle)
            .map_err(|e| e.reason)?;
        self.model.system.evaluate();
        Ok(Measured::of(&self.model))
    }
}
