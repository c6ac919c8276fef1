//! A scenario with effects, fitted to recordings by Gauss's and Newton's method.

use super::forward::{Guide, Run, Shown, whitened};
use super::samples::Samples;
use crate::config::Source;
use crate::identify::{Parameter, Variant};
use nalgebra::{DMatrix, DVector};

/// A model under trial: a scenario, its own uncertain numbers, and forms of effects with theirs.
#[derive(Clone)]
pub struct Trial<'a> {
    /// The scenario without effects.
    pub source: &'a Source,
    /// Its uncertain numbers.
    pub own: &'a [Parameter],
    /// Forms of effects, applied one after the other.
    pub forms: Vec<&'a Variant>,
    /// What it is fitted to.
    pub data: &'a [Samples],
    /// What no model is asked to explain: position [m], rotation [rad].
    pub floor: (f64, f64),
    /// States of another trial of the same samples, one guide a recording; empty if there are none.
    pub guides: &'a [Guide],
}

/// Residuals and their derivatives at some values.
#[derive(Clone)]
pub struct Linear {
    /// Values: the scenario's own numbers, then those of each form.
    pub at: Vec<f64>,
    /// Whitened residuals, then one for each prior.
    pub residuals: DVector<f64>,
    /// Their derivatives, a column for each value.
    pub jacobian: DMatrix<f64>,
}

impl Linear {
    /// Sum of squares, priors included.
    pub fn chi2(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

/// Least damping of the steps.
const DAMPING: f64 = 1e-6;

impl<'a> Trial<'a> {
    /// The scenario at some values: its own numbers, then those of each form.
    ///
    /// # Errors
    /// In words, if it has no place for them.
    pub fn scenario(&self, at: &[f64]) -> Result<Source, String> {
        let (own, mut rest) = at.split_at(self.own.len());
        let sets: Vec<_> = self.own.iter().zip(own).map(|(p, v)| p.set(*v)).collect();
        let mut source = self.source.with(&sets).map_err(|e| e.to_string())?;
        for form in &self.forms {
            let (values, others) = rest.split_at(form.quantities.len());
            source = form.apply(&source, values).map_err(|e| e.to_string())?;
            rest = others;
        }
        Ok(source)
    }

    /// Values at which the last form is plainly there, after those of everything before it.
    pub fn typical(&self, before: &[f64]) -> Vec<f64> {
        let last = self
            .forms
            .last()
            .into_iter()
            .flat_map(|form| &form.quantities);
        before
            .iter()
            .copied()
            .chain(last.map(|q| q.typical))
            .collect()
    }

    /// Range of value `j`.
    pub fn range(&self, j: usize) -> (f64, f64) {
        match j.checked_sub(self.own.len()) {
            None => self.own[j].range,
            Some(k) => self.quantity(k).range,
        }
    }

    fn quantity(&self, k: usize) -> &crate::identify::Quantity {
        let mut quantities = self.forms.iter().flat_map(|form| &form.quantities);
        quantities
            .nth(k)
            .expect("there is a value for each quantity")
    }

    /// A size of value `j` that matters.
    fn scale(&self, j: usize) -> f64 {
        match j.checked_sub(self.own.len()) {
            None => 0.1 * self.own[j].width(),
            Some(k) => {
                let q = self.quantity(k);
                let size = (q.typical - q.null).abs().max(0.1 * q.typical.abs());
                if size > 0.0 {
                    size
                } else {
                    0.05 * (q.range.1 - q.range.0)
                }
            }
        }
    }

    fn priors(&self, at: &[f64]) -> Vec<f64> {
        let prior = |(p, v): (&Parameter, &f64)| p.prior.map(|(mean, sd)| (v - mean) / sd);
        self.own.iter().zip(at).filter_map(prior).collect()
    }

    /// Whitened residuals, priors last.
    ///
    /// # Errors
    /// In words, if a sample has no steady state.
    pub fn evaluate(&self, at: &[f64]) -> Result<(DVector<f64>, Vec<Guide>), String> {
        let source = self.scenario(at)?;
        let (mut all, mut guides) = (Vec::new(), Vec::new());
        for (r, samples) in self.data.iter().enumerate() {
            let run = Run::new(&source, samples);
            let run = run.and_then(|mut run| run.all(samples, self.guides.get(r)));
            let (apart, guide) = run.map_err(|e| e.to_string())?;
            all.extend(whitened(&apart, samples, self.floor));
            guides.push(guide);
        }
        all.extend(self.priors(at));
        Ok((DVector::from_vec(all), guides))
    }

    /// Residuals and derivatives by the values `columns`.
    ///
    /// # Errors
    /// In words, if a sample has no steady state or a singular one.
    pub fn linear(&self, at: &[f64], columns: std::ops::Range<usize>) -> Result<Linear, String> {
        let source = self.scenario(at)?;
        let moved = |j: usize, step: f64| {
            let mut there = at.to_vec();
            there[j] += step;
            self.scenario(&there)
        };
        let steps: Vec<f64> = columns.clone().map(|j| 1e-3 * self.scale(j)).collect();
        let (mut residuals, mut slopes) = (Vec::new(), Vec::new());
        for (r, samples) in self.data.iter().enumerate() {
            let run = |source: &Source| Run::new(source, samples).map_err(|e| e.to_string());
            let mut pairs = Vec::new();
            for (j, step) in columns.clone().zip(&steps) {
                // at the end of its range a value goes one way only
                let (least, most) = self.range(j);
                let up = if at[j] + step <= most { *step } else { 0.0 };
                let down = if at[j] - step >= least { *step } else { 0.0 };
                let shown =
                    |step: f64| Shown::new(&moved(j, step)?, samples).map_err(|e| e.to_string());
                let runs = [shown(up)?, shown(-down)?];
                pairs.push(((up + down) / 2.0, runs));
            }
            let derived = run(&source)?.derivatives(samples, self.guides.get(r), pairs);
            let (apart, jacobian) = derived.map_err(|e| e.to_string())?;
            residuals.extend(whitened(&apart, samples, self.floor));
            let ones = whitened(&vec![1.0; apart.len()], samples, self.floor);
            slopes.push(DMatrix::from_fn(apart.len(), columns.len(), |i, j| {
                jacobian[(i, j)] * ones[i]
            }));
        }
        let measured = residuals.len();
        residuals.extend(self.priors(at));
        let mut jacobian = DMatrix::zeros(residuals.len(), columns.len());
        let mut row = 0;
        for block in slopes {
            jacobian.rows_mut(row, block.nrows()).copy_from(&block);
            row += block.nrows();
        }
        row = measured;
        for (j, p) in self.own.iter().enumerate() {
            if let Some((_, sd)) = p.prior {
                if columns.contains(&j) {
                    jacobian[(row, j - columns.start)] = 1.0 / sd;
                }
                row += 1;
            }
        }
        Ok(Linear {
            at: at.to_vec(),
            residuals: DVector::from_vec(residuals),
            jacobian,
        })
    }

    /// The change of the values that makes the linearised residuals least, within the ranges, and what is left then.
    pub fn step(&self, linear: &Linear, damping: f64) -> (Vec<f64>, f64) {
        let n = linear.at.len();
        let scales: Vec<f64> = (0..n).map(|j| self.scale(j)).collect();
        let mut free = vec![true; n];
        let mut fixed = vec![0.0; n];
        loop {
            let columns: Vec<usize> = (0..n).filter(|j| free[*j]).collect();
            let scaled = DMatrix::from_fn(linear.residuals.len(), columns.len(), |i, c| {
                linear.jacobian[(i, columns[c])] * scales[columns[c]]
            });
            let mut rest = linear.residuals.clone();
            for j in (0..n).filter(|j| !free[*j]) {
                rest += linear.jacobian.column(j) * fixed[j];
            }
            let mut normal = scaled.tr_mul(&scaled);
            let largest = normal.diagonal().amax().max(1e-300);
            for k in 0..columns.len() {
                normal[(k, k)] += damping * normal[(k, k)] + 1e-12 * largest;
            }
            let gradient = scaled.tr_mul(&rest);
            let change = match normal.cholesky() {
                Some(factors) => -factors.solve(&gradient),
                None => DVector::zeros(columns.len()),
            };
            // hold at its bound the value that goes furthest beyond
            let mut worst = (0.0, None);
            for (k, &j) in columns.iter().enumerate() {
                let (least, most) = self.range(j);
                let to = linear.at[j] + change[k] * scales[j];
                let over = (to - most).max(least - to) / scales[j];
                if over > worst.0 {
                    worst = (over, Some((j, to.clamp(least, most) - linear.at[j])));
                }
            }
            if let (_, Some((j, by))) = worst {
                free[j] = false;
                fixed[j] = by;
                continue;
            }
            let left = (&rest + &scaled * &change).norm_squared();
            for (k, &j) in columns.iter().enumerate() {
                fixed[j] = change[k] * scales[j];
            }
            return (fixed, left);
        }
    }

    /// Covariance of the values for residuals of unit variance.
    pub fn covariance(&self, fit: &Linear) -> DMatrix<f64> {
        let n = fit.at.len();
        let scales: Vec<f64> = (0..n).map(|j| self.scale(j)).collect();
        let scaled = DMatrix::from_fn(fit.residuals.len(), n, |i, j| {
            fit.jacobian[(i, j)] * scales[j]
        });
        let normal = scaled.tr_mul(&scaled);
        let least = 1e-12 * normal.diagonal().amax();
        let inverse = normal
            .pseudo_inverse(least)
            .expect("the tolerance is not negative");
        DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * scales[i] * scales[j])
    }

    /// Fits all values from `start`, in at most `iterations` steps.
    ///
    /// # Errors
    /// In words, if there is no steady state at the start.
    pub fn fit(&self, start: &[f64], iterations: usize) -> Result<Linear, String> {
        let n = start.len();
        let mut here = self.linear(start, 0..n)?;
        let mut damping = DAMPING;
        for _ in 0..iterations {
            let mut better = None;
            for _ in 0..6 {
                let (change, promised) = self.step(&here, damping);
                if here.chi2() - promised < 0.2 + 1e-5 * here.chi2() {
                    break;
                }
                let there: Vec<f64> = here.at.iter().zip(&change).map(|(a, c)| a + c).collect();
                match self.evaluate(&there) {
                    Ok((r, _)) if r.norm_squared() < here.chi2() => {
                        better = Some(there);
                        break;
                    }
                    _ => damping = (damping * 30.0).max(1e-3),
                }
            }
            let Some(there) = better else { break };
            here = self.linear(&there, 0..n)?;
            damping = (damping / 30.0).max(DAMPING);
        }
        Ok(here)
    }
}
