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
            let run = Run::new(&source, samples, self.guides.get(r));
            let run = run.and_then(|mut run| run.all(samples));
            let (apart, guide) = run.map_err(|e| e.to_string())?;
            all.extend(whitened(&apart, samples));
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
            let run = Run::new(&source, samples, self.guides.get(r));
            let mut run = run.map_err(|e| e.to_string())?;
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
            let derived = run.derivatives(samples, pairs);
            let (apart, jacobian) = derived.map_err(|e| e.to_string())?;
            residuals.extend(whitened(&apart, samples));
            let ones = whitened(&vec![1.0; apart.len()], samples);
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
        let scaled = DMatrix::from_fn(linear.residuals.len(), n, |i, j| {
            linear.jacobian[(i, j)] * scales[j]
        });
        let (normal, slope) = (scaled.tr_mul(&scaled), scaled.tr_mul(&linear.residuals));
        let mut damped = normal.clone();
        let largest = normal.diagonal().amax().max(1e-300);
        for j in 0..n {
            damped[(j, j)] += damping * normal[(j, j)] + 1e-12 * largest;
        }
        let room = |j: usize| {
            let (least, most) = self.range(j);
            let to = |end: f64| (end - linear.at[j]) / scales[j];
            (to(least).min(0.0), to(most).max(0.0))
        };
        let change = bounded(&damped, &slope, &(0..n).map(room).collect::<Vec<_>>());
        let left = linear.chi2() + 2.0 * slope.dot(&change) + change.dot(&(&normal * &change));
        let change = change.iter().zip(&scales).map(|(c, s)| c * s).collect();
        (change, left.max(0.0))
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
            // where states are barely found, what was reached stands
            let Ok(next) = self.linear(&there, 0..n) else {
                break;
            };
            here = next;
            damping = (damping / 30.0).max(DAMPING);
        }
        Ok(here)
    }
}

/// Minimises `x A x / 2 + b x` between bounds that hold zero, by active sets: each step goes to the minimum over the free
/// values or to the first bound on the way, and a value is freed again where that would lower the function.
fn bounded(a: &DMatrix<f64>, b: &DVector<f64>, bounds: &[(f64, f64)]) -> DVector<f64> {
    let n = b.len();
    let mut x = DVector::zeros(n);
    let mut free = vec![true; n];
    for _ in 0..6 * n + 10 {
        let columns: Vec<usize> = (0..n).filter(|j| free[*j]).collect();
        let gradient = a * &x + b;
        let part = DMatrix::from_fn(columns.len(), columns.len(), |i, k| {
            a[(columns[i], columns[k])]
        });
        let down = DVector::from_fn(columns.len(), |k, _| -gradient[columns[k]]);
        let Some(factors) = part.cholesky() else {
            break;
        };
        let way = factors.solve(&down);
        let mut share = (1.0, None);
        for (k, &j) in columns.iter().enumerate() {
            let bound = if way[k] > 0.0 {
                bounds[j].1
            } else {
                bounds[j].0
            };
            if way[k] != 0.0 && (bound - x[j]) / way[k] < share.0 {
                share = (((bound - x[j]) / way[k]).max(0.0), Some((j, bound)));
            }
        }
        for (k, &j) in columns.iter().enumerate() {
            x[j] += share.0 * way[k];
        }
        if let Some((j, bound)) = share.1 {
            x[j] = bound;
            free[j] = false;
            continue;
        }
        let gradient = a * &x + b;
        // how fast the function falls if a held value leaves its bound
        let gain = |j: usize| {
            let inward = if x[j] <= bounds[j].0 {
                -gradient[j]
            } else {
                gradient[j]
            };
            inward / a[(j, j)].sqrt()
        };
        let freed = (0..n)
            .filter(|j| !free[*j] && bounds[*j].0 < bounds[*j].1)
            .map(|j| (gain(j), j))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match freed {
            Some((gain, j)) if gain > 1e-9 * b.amax() / a.diagonal().amax().sqrt() => {
                free[j] = true;
            }
            _ => break,
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::bounded;
    use nalgebra::{dmatrix, dvector};

    #[test]
    fn a_value_that_was_held_too_early_is_freed_again() {
        // the minimum over x >= -1, y >= -1 of a narrow valley whose free minimum is at (-4, 3)
        let a = dmatrix![1.0, 0.99; 0.99, 1.0];
        let b = -(&a * dvector![-4.0, 3.0]);
        let x = bounded(&a, &b, &[(-1.0, 5.0), (-1.0, 0.5)]);
        // on x = -1 the minimum is at y = 3 - 0.99 * 3 = 0.03
        approx::assert_relative_eq!(x, dvector![-1.0, 0.03], epsilon = 1e-12);
    }
}
