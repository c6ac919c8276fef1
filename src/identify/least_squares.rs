//! Levenberg's and Marquardt's method within bounds.
//!
//! Parameters are taken as shares of their ranges, 0 to 1, so that no other scaling is needed. The step comes of a
//! singular value decomposition: what the residuals do not determine stays where it is. (The fit of poses in
//! `auxetica-kinematics` works on normal equations with an analytic Jacobian that costs little more than the residuals;
//! here a Jacobian costs several simulations, and residuals are ill-conditioned as a rule.)

use nalgebra::{DMatrix, DVector};

use crate::{Parameter, Residuals};

/// Where a descent has ended, in shares of the ranges.
pub(crate) struct Descent {
    pub shares: DVector<f64>,
    /// Half the sum of squares, those of priors included.
    pub cost: f64,
    /// Residuals, then one row for each prior.
    pub residuals: DVector<f64>,
    /// Their derivatives by the shares.
    pub jacobian: DMatrix<f64>,
    /// Whether an entry could move: not held by a bound.
    pub free: Vec<bool>,
    pub converged: bool,
    pub evaluations: usize,
}

/// Damping at the beginning, as a share of the largest singular value squared.
const FIRST_DAMPING: f64 = 1e-3;
/// Damping, as such a share, at which no step is left to try.
const MOST_DAMPING: f64 = 1e10;
/// Share of the promised gain that a step must bring.
const LEAST_GAIN: f64 = 1e-4;

pub(crate) struct Problem<'a, R: ?Sized> {
    pub parameters: &'a [Parameter],
    pub residuals: &'a R,
    pub tolerance: f64,
    pub most_iterations: usize,
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

impl<R: Residuals + ?Sized> Problem<'_, R> {
    pub fn values(&self, shares: &DVector<f64>) -> Vec<f64> {
        let value = |(p, share): (&Parameter, &f64)| {
            (p.range.0 + share * p.width()).clamp(p.range.0, p.range.1)
        };
        self.parameters.iter().zip(shares).map(value).collect()
    }

    fn residuals(&self, shares: &DVector<f64>) -> Result<DVector<f64>, String> {
        let at = self.values(shares);
        let mut all = self.residuals.residuals(&at)?;
        let priors = self.parameters.iter().zip(&at).filter_map(|(p, at)| {
            let (mean, deviation) = p.prior?;
            Some((at - mean) / deviation)
        });
        all.extend(priors);
        match all.iter().all(|r| r.is_finite()) {
            true => Ok(DVector::from_vec(all)),
            false => Err("a residual is not a finite number".into()),
        }
    }

    fn jacobian(&self, shares: &DVector<f64>, here: &DVector<f64>) -> Result<DMatrix<f64>, String> {
        let at = self.values(shares);
        let priors: Vec<_> = (0..at.len())
            .filter(|j| self.parameters[*j].prior.is_some())
            .collect();
        let measured = here.len() - priors.len();
        let here = &here.as_slice()[..measured];
        let mut jacobian = self.residuals.jacobian(&at, here, self.parameters)?;
        jacobian = jacobian.resize_vertically(measured + priors.len(), 0.0);
        for (row, j) in priors.into_iter().enumerate() {
            let (_, deviation) = self.parameters[j].prior.expect("chosen so");
            jacobian[(measured + row, j)] = 1.0 / deviation;
        }
        for (j, p) in self.parameters.iter().enumerate() {
            jacobian.column_mut(j).scale_mut(p.width());
        }
        Ok(jacobian)
    }

    /// Descends from `shares`. An error if the model has no answer there.
    pub fn descend(&self, mut shares: DVector<f64>) -> Result<Descent, String> {
        let n = shares.len();
        let mut here = self.residuals(&shares)?;
        let mut evaluations = 1;
        let mut damping = FIRST_DAMPING;
        let mut iterations = 0;
        loop {
            let jacobian = self.jacobian(&shares, &here)?;
            evaluations += 2 * n;
            iterations += 1;
            let gradient = jacobian.tr_mul(&here);
            let cost = here.norm_squared() / 2.0;
            let free: Vec<bool> = (0..n)
                .map(|j| {
                    !(shares[j] <= 0.0 && gradient[j] > 0.0
                        || shares[j] >= 1.0 && gradient[j] < 0.0)
                })
                .collect();
            let mut movable = jacobian.clone();
            for j in (0..n).filter(|j| !free[*j]) {
                movable.column_mut(j).fill(0.0);
            }
            let svd = movable.svd(true, true);
            let (u, vt) = (
                svd.u.as_ref().expect("asked for"),
                svd.v_t.as_ref().expect("asked for"),
            );
            let along = u.tr_mul(&here);
            let largest = svd.singular_values.amax();
            let taken = loop {
                let scale = damping * largest * largest;
                let share = svd
                    .singular_values
                    .zip_map(&along, |s, r| match s > 1e-12 * largest {
                        true => -s * r / (s * s + scale),
                        false => 0.0,
                    });
                let there = (&shares + vt.tr_mul(&share)).map(|share| share.clamp(0.0, 1.0));
                let promised = cost - (&here + &jacobian * (&there - &shares)).norm_squared() / 2.0;
                if promised <= self.tolerance * (1.0 + cost) {
                    break Err(true);
                }
                let tried = self.residuals(&there);
                evaluations += 1;
                if let Ok(residuals) = tried {
                    let gain = (cost - residuals.norm_squared() / 2.0) / promised;
                    if gain > LEAST_GAIN {
                        damping *= (1.0 - (2.0 * gain - 1.0).powi(3)).clamp(0.1, 2.0);
                        break Ok((there, residuals));
                    }
                }
                damping *= 8.0;
                if damping > MOST_DAMPING || (self.stop)() {
                    break Err(false);
                }
            };
            match taken {
                Ok((there, residuals)) if iterations < self.most_iterations && !(self.stop)() => {
                    (shares, here) = (there, residuals);
                }
                Ok(_) | Err(_) => {
                    let converged = taken == Err(true);
                    return Ok(Descent {
                        shares,
                        cost,
                        residuals: here,
                        jacobian,
                        free,
                        converged,
                        evaluations,
                    });
                }
            }
        }
    }
}
