//! Fitting parameters, and how well they are known afterwards.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::{DMatrix, DVector};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::identifiability;
use crate::least_squares::{Descent, Problem};
use crate::{Parameter, Residuals};

/// Told now and then how much is done (0 to 1), it says whether to go on.
pub type Watch<'a> = dyn Fn(f64) -> ControlFlow<()> + Sync + 'a;

/// How a fit is done.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Descents: the first from the nominal values, the others from places in the ranges that the seed chooses.
    pub starts: usize,
    /// Seed of the other starts.
    pub seed: u64,
    /// A descent has converged when its next step promises less than this, as a share of the sum of squares.
    pub tolerance: f64,
    /// Most steps of a descent.
    pub most_iterations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            starts: 5,
            seed: 1,
            tolerance: 1e-10,
            most_iterations: 60,
        }
    }
}

/// Why nothing was fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// There are no parameters.
    #[error("no parameter is uncertain; name at least one")]
    NoParameters,
    /// The model has no answer at any start.
    #[error("the model has no answer at the nominal values: {0}")]
    NoAnswer(String),
    /// The user stopped the fit.
    #[error("the fit was stopped")]
    Stopped,
}

/// One parameter after a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The parameter.
    pub parameter: Parameter,
    /// Value that fits best.
    pub value: f64,
    /// Standard deviation; none for a parameter at a bound, or of which nothing is known.
    pub deviation: Option<f64>,
    /// Values that the residuals allow with 95 % confidence, cut to the range.
    pub interval: (f64, f64),
    /// Whether the range ends where the fit does: it wants to go on.
    pub at_bound: bool,
}

/// Parameters that fit best.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The parameters, in their order.
    pub estimates: Vec<Estimate>,
    /// Sum of the squares of the residuals at the nominal values; none if the model has no answer there.
    pub chi2_before: Option<f64>,
    /// That sum after the fit, without the priors' part.
    pub chi2: f64,
    /// Residuals and priors less parameters that could move; 0 if there are not more.
    pub degrees_of_freedom: usize,
    /// Correlations of the estimates; 0 for those at a bound.
    pub correlation: DMatrix<f64>,
    /// Ratio of the largest to the smallest effect of a direction in parameter space on the residuals, without priors;
    /// infinite if there is one without effect.
    pub condition: f64,
    /// In words, what the residuals do not determine.
    pub undetermined: Vec<String>,
    /// Whether the best descent converged.
    pub converged: bool,
    /// Evaluations of the residuals, of all descents together.
    pub evaluations: usize,
    /// Descents that the model had an answer for, and those of them that ended at the best.
    pub starts: (usize, usize),
}

impl Fit {
    /// The values, in the order of the parameters.
    pub fn values(&self) -> Vec<f64> {
        self.estimates
            .iter()
            .map(|estimate| estimate.value)
            .collect()
    }

    /// The changes of the scenario that give the parameters their values, as `--set` takes them.
    pub fn sets(&self) -> Vec<String> {
        self.estimates
            .iter()
            .map(|e| e.parameter.set(e.value))
            .collect()
    }

    /// Variance of the residuals: chi2 over degrees of freedom. Near 1 if the model is right and the error bars are; a
    /// larger one widens deviations and intervals by its root (Birge's ratio).
    pub fn variance(&self) -> f64 {
        self.chi2 / self.degrees_of_freedom.max(1) as f64
    }
}

/// Difference of costs, as a share, below which two descents have ended alike.
const ALIKE: f64 = 1e-4;
/// Confidence of intervals.
const CONFIDENCE: f64 = 0.95;

/// Finds the values of `parameters` for which residuals and priors are least, within the ranges.
///
/// # Errors
/// If there are no parameters, the model has no answer at any start, or `watch` said to stop.
pub fn fit<R: Residuals + ?Sized>(
    parameters: &[Parameter],
    residuals: &R,
    options: &Options,
    watch: &Watch<'_>,
) -> Result<Fit, FitError> {
    if parameters.is_empty() {
        return Err(FitError::NoParameters);
    }
    let ended = AtomicUsize::new(0);
    let stop = || watch(ended.load(Ordering::Relaxed) as f64 / options.starts as f64).is_break();
    let problem = Problem {
        parameters,
        residuals,
        tolerance: options.tolerance,
        most_iterations: options.most_iterations,
        stop: &stop,
    };
    let nominal: Vec<_> = parameters.iter().map(|p| p.nominal).collect();
    let before = residuals.residuals(&nominal);
    let descents: Vec<_> = starts(parameters, options)
        .into_par_iter()
        .map(|start| {
            let descent = problem.descend(start);
            ended.fetch_add(1, Ordering::Relaxed);
            descent
        })
        .collect();
    if stop() {
        return Err(FitError::Stopped);
    }
    let (mut ended, mut reasons) = (Vec::new(), Vec::new());
    for descent in descents {
        match descent {
            Ok(descent) => ended.push(descent),
            Err(reason) => reasons.push(reason),
        }
    }
    let evaluations = 1 + ended.iter().map(|d| d.evaluations).sum::<usize>();
    let best = ended.iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
    let best = best.ok_or_else(|| FitError::NoAnswer(reasons.swap_remove(0)))?;
    let alike = ended
        .iter()
        .filter(|d| d.cost <= best.cost * (1.0 + ALIKE) + ALIKE)
        .count();
    let chi2_before = before.ok().map(|r| r.iter().map(|r| r * r).sum());
    Ok(Fit {
        chi2_before,
        evaluations,
        starts: (ended.len(), alike),
        ..summary(&problem, best)
    })
}

/// Where descents begin, in shares of the ranges.
fn starts(parameters: &[Parameter], options: &Options) -> Vec<DVector<f64>> {
    let share = |p: &Parameter| (p.nominal - p.range.0) / p.width();
    let nominal = DVector::from_iterator(parameters.len(), parameters.iter().map(share));
    let mut random = Pcg64Mcg::seed_from_u64(options.seed);
    // 53 random bits fill the mantissa of a number between 0 and 1
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let others = (1..options.starts).map(|_| DVector::from_fn(parameters.len(), |_, _| uniform()));
    let others: Vec<_> = others.collect();
    std::iter::once(nominal).chain(others).collect()
}

fn summary<R: Residuals + ?Sized>(problem: &Problem<'_, R>, best: &Descent) -> Fit {
    let parameters = problem.parameters;
    let n = parameters.len();
    let priors = parameters.iter().filter(|p| p.prior.is_some()).count();
    let measured = best.residuals.len() - priors;
    let chi2 = best.residuals.rows(0, measured).norm_squared();
    let free: Vec<usize> = (0..n).filter(|j| best.free[*j]).collect();
    let degrees_of_freedom = best.residuals.len().saturating_sub(free.len());
    let variance = (chi2 / degrees_of_freedom.max(1) as f64).max(1.0);

    let covariance = covariance(&best.jacobian, &free) * variance;
    let values = problem.values(&best.shares);
    let reach = match degrees_of_freedom {
        0 => f64::INFINITY,
        dof => StudentsT::new(0.0, 1.0, dof as f64)
            .expect("degrees of freedom are positive")
            .inverse_cdf((1.0 + CONFIDENCE) / 2.0),
    };
    let estimates = (0..n).map(|j| {
        let p = &parameters[j];
        let deviation = covariance[(j, j)].sqrt() * p.width();
        let deviation = (best.free[j] && deviation.is_finite()).then_some(deviation);
        let reach = deviation.map_or(f64::INFINITY, |deviation| reach * deviation);
        Estimate {
            parameter: p.clone(),
            value: values[j],
            deviation,
            interval: (
                (values[j] - reach).max(p.range.0),
                (values[j] + reach).min(p.range.1),
            ),
            at_bound: !best.free[j],
        }
    });
    let (condition, undetermined) = identifiability::report(
        parameters,
        &values,
        &best.jacobian.rows(0, measured).into_owned(),
    );
    Fit {
        estimates: estimates.collect(),
        chi2_before: None,
        chi2,
        degrees_of_freedom,
        correlation: DMatrix::from_fn(n, n, |i, j| match i == j {
            true => 1.0,
            false => {
                let scale = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
                if scale > 0.0 && scale.is_finite() {
                    covariance[(i, j)] / scale
                } else {
                    0.0
                }
            }
        }),
        condition,
        undetermined,
        converged: best.converged,
        evaluations: 0,
        starts: (0, 0),
    }
}

/// Covariance of the shares for residuals of unit variance: that of the `free` ones, others 0. Infinite where nothing
/// is known.
fn covariance(jacobian: &DMatrix<f64>, free: &[usize]) -> DMatrix<f64> {
    let n = jacobian.ncols();
    let mut covariance = DMatrix::zeros(n, n);
    if free.is_empty() {
        return covariance;
    }
    let eigen = jacobian
        .select_columns(free)
        .tr_mul(&jacobian.select_columns(free))
        .symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    for (a, &i) in free.iter().enumerate() {
        for (b, &j) in free.iter().enumerate() {
            covariance[(i, j)] = (0..free.len())
                .map(|k| {
                    let share = eigen.eigenvectors[(a, k)] * eigen.eigenvectors[(b, k)];
                    let known = eigen.eigenvalues[k] > identifiability::ROUNDING * largest;
                    match known {
                        true => share / eigen.eigenvalues[k],
                        false if share.abs() < 1e-6 => 0.0,
                        false => f64::INFINITY.copysign(share),
                    }
                })
                .sum();
        }
    }
    covariance
}
