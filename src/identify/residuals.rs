//! What a fit makes small.

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::Parameter;

/// Differences between model and measurement, in units of the measurement's standard deviation.
pub trait Residuals: Sync {
    /// The residuals for these values of the parameters, always as many.
    ///
    /// # Errors
    /// If the model has no answer there: in words why.
    fn residuals(&self, at: &[f64]) -> Result<Vec<f64>, String>;

    /// Derivatives of the residuals (rows) by the parameters (columns). `here` are the residuals at `at`.
    ///
    /// # Errors
    /// If the model has no answer near `at`.
    fn jacobian(
        &self,
        at: &[f64],
        here: &[f64],
        parameters: &[Parameter],
    ) -> Result<DMatrix<f64>, String> {
        central_differences(self, at, here, parameters)
    }
}

impl<F: Fn(&[f64]) -> Result<Vec<f64>, String> + Sync> Residuals for F {
    fn residuals(&self, at: &[f64]) -> Result<Vec<f64>, String> {
        self(at)
    }
}

/// Difference, as a share of a parameter's range: far above the noise of a steady state, far below its curvature.
const DIFFERENCE: f64 = 1e-4;

/// The Jacobian by central differences inside the ranges, in parallel; one-sided where the model has an answer on one
/// side only.
///
/// # Errors
/// If the model has an answer on neither side.
pub fn central_differences<R: Residuals + ?Sized>(
    residuals: &R,
    at: &[f64],
    here: &[f64],
    parameters: &[Parameter],
) -> Result<DMatrix<f64>, String> {
    let side = |(j, sign): (usize, f64)| {
        let parameter = &parameters[j];
        let mut there = at.to_vec();
        there[j] += sign * DIFFERENCE * parameter.width();
        there[j] = there[j].clamp(parameter.range.0, parameter.range.1);
        residuals.residuals(&there).map(|r| (there[j], r))
    };
    let sides: Vec<_> = (0..2 * at.len())
        .map(|k| (k / 2, if k % 2 == 0 { 1.0 } else { -1.0 }))
        .collect();
    let sides: Vec<_> = sides.into_par_iter().map(side).collect();
    let mut jacobian = DMatrix::zeros(here.len(), at.len());
    for (j, sides) in sides.chunks_exact(2).enumerate() {
        let centre = (at[j], here.to_vec());
        let (up, down) = match (&sides[0], &sides[1]) {
            (Err(e), Err(_)) => return Err(e.clone()),
            (up, down) => (
                up.as_ref().unwrap_or(&centre),
                down.as_ref().unwrap_or(&centre),
            ),
        };
        for i in 0..here.len() {
            jacobian[(i, j)] = (up.1[i] - down.1[i]) / (up.0 - down.0);
        }
    }
    Ok(jacobian)
}
