//! Inverse kinematics by Levenberg and Marquardt.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector, Matrix6xX};
use rayon::prelude::*;

use crate::guess::guess;
use crate::normal_equations::NormalEquations;
use crate::{Fit, Observed, Spcs, Weights};

/// Fits configurations to measured poses in the sense of least squares.
///
/// Levenberg's and Marquardt's method with the analytic Jacobian and bounds on the curvatures
/// and the twist, without which a fit may find a rod with an extra turn.
#[derive(Debug, Clone, PartialEq)]
pub struct LeastSquares {
    /// The rod.
    pub rod: Spcs,
    /// What counts how much; the paper's by default.
    pub weights: Weights,
    /// Largest `kx`, `ky` and `kz` (rad/m); 120 by default.
    pub max_curvature: f64,
    /// A fit has converged when its next step would change the weighted residuals, in the
    /// linear model, by less than this; 1e-11 by default.
    pub tolerance: f64,
    /// Most evaluations; 100 by default.
    pub max_evaluations: usize,
}

/// Marquardt's parameter at the beginning, and least: too small to be felt beside good data.
const LEAST_DAMPING: f64 = 1e-10;
/// Marquardt's parameter after the first step that failed.
const FIRST_DAMPING: f64 = 1e-3;

/// Turn between neighbouring points (rad) up to which its sense is beyond doubt.
const CLEAR_TURN: f64 = 2.5;

impl LeastSquares {
    /// Fits of this rod with the defaults.
    #[must_use]
    pub fn new(rod: Spcs) -> Self {
        Self {
            rod,
            weights: Weights::PAPER,
            max_curvature: 120.0,
            tolerance: 1e-11,
            max_evaluations: 100,
        }
    }

    /// Fits one sample, from `start` or else from what the strains between neighbouring points
    /// suggest, which sees no more than half a turn between two of them. Where it is nearly that,
    /// both ways round are tried.
    ///
    /// # Panics
    /// When the start's length is wrong, or there are not as many poses as arc lengths.
    #[must_use]
    pub fn fit(&self, observed: &Observed<'_>, start: Option<&[f64]>) -> Fit {
        if let Some(start) = start {
            return self.fit_from(observed, start);
        }
        let [near, far] = [PI, CLEAR_TURN].map(|turn| guess(&self.rod, observed, turn));
        let fit = self.fit_from(observed, &near);
        if near == far {
            return fit;
        }
        let other = self.fit_from(observed, &far);
        if other.cost < fit.cost { other } else { fit }
    }

    fn fit_from(&self, observed: &Observed<'_>, start: &[f64]) -> Fit {
        let dof = self.rod.dof();
        assert_eq!(start.len(), dof, "length of the start");
        let bounds = self.bounds();
        let mut q = DVector::from_column_slice(start);
        q[0] = observed.base_angle.unwrap_or(q[0]);
        q.zip_apply(&bounds, |q, bound| *q = q.clamp(-bound, bound));

        let mut jacobian = Matrix6xX::zeros(dof);
        let mut evaluate = |equations: &mut NormalEquations, q: &DVector<f64>| {
            equations.evaluate(
                &self.rod,
                observed,
                &self.weights,
                q.as_slice(),
                &mut jacobian,
            );
        };
        let mut here = NormalEquations::new(dof);
        evaluate(&mut here, &q);
        let mut there = here.clone();
        let mut damping = LEAST_DAMPING;
        let mut evaluations = 1;
        let (converged, free) = loop {
            // An entry at its bound that the cost pushes outwards stays there.
            let free: Vec<bool> = (0..dof)
                .map(|i| {
                    let held = q[i].abs() >= bounds[i] && q[i] * here.gradient[i] < 0.0;
                    !held && (i > 0 || observed.base_angle.is_none())
                })
                .collect();
            let Some(step) = step(&here, &free, damping) else {
                break (false, free);
            };
            if step.dot(&(&here.curvature * &step)).sqrt() < self.tolerance {
                break (true, free);
            }
            if evaluations >= self.max_evaluations {
                break (false, free);
            }
            let mut candidate = &q + step;
            candidate.zip_apply(&bounds, |q, bound| *q = q.clamp(-bound, bound));
            evaluate(&mut there, &candidate);
            evaluations += 1;
            if there.cost < here.cost {
                q = candidate;
                std::mem::swap(&mut here, &mut there);
                damping = (damping * 0.1).max(LEAST_DAMPING);
            } else {
                damping = (damping * 10.0).max(FIRST_DAMPING);
            }
        };
        Fit {
            configuration: q.as_slice().into(),
            cost: here.cost,
            evaluations,
            converged,
            information: here.curvature,
            free,
        }
    }

    /// Fits samples one after the other, each from the fit before: for series in time whose
    /// changes are small.
    #[must_use]
    pub fn fit_sequence(&self, samples: &[Observed<'_>]) -> Vec<Fit> {
        let mut fits: Vec<Fit> = Vec::with_capacity(samples.len());
        for sample in samples {
            let start = fits.last().map(|fit| fit.configuration.as_slice());
            fits.push(self.fit(sample, start));
        }
        fits
    }

    /// Fits samples in parallel, each for itself.
    #[must_use]
    pub fn fit_each(&self, samples: &[Observed<'_>]) -> Vec<Fit> {
        samples
            .par_iter()
            .map(|sample| self.fit(sample, None))
            .collect()
    }

    /// Largest size of each entry of the configuration.
    fn bounds(&self) -> DVector<f64> {
        let mut bounds = DVector::repeat(self.rod.dof(), f64::INFINITY);
        for columns in self.rod.columns() {
            for &column in columns[..3].iter().flatten() {
                bounds[column] = self.max_curvature;
            }
        }
        bounds
    }
}

/// Marquardt's step in the free entries of which the poses tell anything; `None` where the
/// equations are not finite.
fn step(equations: &NormalEquations, free: &[bool], damping: f64) -> Option<DVector<f64>> {
    let mut matrix: DMatrix<f64> = equations.curvature.clone();
    let mut step = -&equations.gradient;
    for i in 0..free.len() {
        if free[i] && matrix[(i, i)] != 0.0 {
            matrix[(i, i)] *= 1.0 + damping;
        } else {
            matrix.row_mut(i).fill(0.0);
            matrix.column_mut(i).fill(0.0);
            matrix[(i, i)] = 1.0;
            step[i] = 0.0;
        }
    }
    matrix.cholesky()?.solve_mut(&mut step);
    Some(step)
}
