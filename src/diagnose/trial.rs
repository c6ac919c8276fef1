//! A scenario with effects, fitted to recordings by Gauss's and Newton's method.

use super::forward::{CHANNELS, Guide, Run, Shown};
use super::samples::Samples;
use super::shared::Shared;
use crate::compare::CompareError;
use crate::config::Source;
use crate::identify::{Parameter, Quantity, Variant};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

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
    /// Errors that samples share; residuals and derivatives are whitened of them.
    pub shared: Arc<Shared>,
    /// How many deviations residuals have where physics is missing: what is known beforehand counts as much against them
    /// as it would against noise.
    pub doubt: f64,
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
    /// The states of every recording.
    pub states: Arc<Vec<Guide>>,
}

impl Linear {
    /// Sum of squares, priors included.
    pub fn chi2(&self) -> f64 {
        self.residuals.norm_squared()
    }

    /// The same with further values, which change nothing.
    pub fn extended(&self, at: Vec<f64>) -> Self {
        let jacobian = self.jacobian.clone();
        Self {
            jacobian: jacobian.resize_horizontally(at.len(), 0.0),
            at,
            residuals: self.residuals.clone(),
            states: self.states.clone(),
        }
    }

    /// The same with errors that samples share taken out of the first `measured` rows.
    pub fn whitened(&self, shared: &Shared, measured: usize) -> Self {
        let mut all = self.jacobian.rows(0, measured).into_owned();
        all = all.insert_column(0, 0.0);
        all.column_mut(0)
            .copy_from(&self.residuals.rows(0, measured));
        shared.whiten(&mut all);
        let mut white = self.clone();
        white
            .residuals
            .rows_mut(0, measured)
            .copy_from(&all.column(0));
        let columns = all.columns(1, self.at.len());
        white.jacobian.rows_mut(0, measured).copy_from(&columns);
        white
    }
}

/// A value as the search counts it: its inverse if the effect is absent where the value is large, since the robot
/// depends on that more evenly.
struct Coordinate {
    inverse: bool,
    at: f64,
    /// Change of the value with the coordinate.
    slope: f64,
    /// A size that matters.
    scale: f64,
    range: (f64, f64),
}

impl Coordinate {
    fn value(&self, at: f64) -> f64 {
        if self.inverse { 1.0 / at } else { at }
    }
}

/// Residuals without priors, derivatives, and the states of every recording.
pub struct Slopes {
    /// Whitened residuals.
    pub residuals: Vec<f64>,
    /// A column for each number.
    pub slopes: DMatrix<f64>,
    /// States from which others are found faster.
    pub states: Vec<Guide>,
}

/// Times chi2 that squared residuals are let grow to in a step.
const MUCH: f64 = 4.0;
/// Share of a range within which a value is at its end.
pub const NEAR: f64 = 1e-3;
/// Fall of chi2 beyond the end of a range that noise makes once in twenty times.
const BEYOND: f64 = 3.84;
/// Least damping of the steps.
pub const DAMPING: f64 = 1e-6;

/// A scenario at some values: those of its own numbers, then those of each form.
///
/// # Errors
/// In words, if it has no place for them.
pub fn version(
    source: &Source,
    own: &[Parameter],
    forms: &[&Variant],
    at: &[f64],
) -> Result<Source, String> {
    let (values, mut rest) = at.split_at(own.len());
    let sets: Vec<_> = own.iter().zip(values).map(|(p, v)| p.set(*v)).collect();
    let mut source = source.with(&sets).map_err(|e| e.to_string())?;
    for form in forms {
        let (values, others) = rest.split_at(form.quantities.len());
        source = form.apply(&source, values).map_err(|e| e.to_string())?;
        rest = others;
    }
    Ok(source)
}

impl<'a> Trial<'a> {
    /// The scenario alone: no effects, no errors that samples share, no doubt.
    pub fn new(source: &'a Source, own: &'a [Parameter], data: &'a [Samples]) -> Self {
        Self {
            source,
            own,
            forms: Vec::new(),
            data,
            shared: Arc::default(),
            doubt: 1.0,
        }
    }

    /// Numbers that are measured.
    pub fn measured(&self) -> f64 {
        let samples = self.data.iter().map(|s| s.list.len());
        (samples.sum::<usize>() * CHANNELS) as f64
    }

    /// The same with the doubt that the residuals of `fit` tell, which is put in there, too.
    pub fn doubting(&self, fit: &mut Linear) -> Self {
        let (measured, all) = (self.measured() as usize, fit.residuals.len());
        let square = fit.residuals.rows(0, measured).norm_squared() / self.measured();
        let doubt = square.sqrt().max(1.0);
        let more = doubt / self.doubt;
        let mut priors = fit.residuals.rows_mut(measured, all - measured);
        priors *= more;
        let mut priors = fit.jacobian.rows_mut(measured, all - measured);
        priors *= more;
        Self {
            doubt,
            ..self.clone()
        }
    }

    /// The same with another form.
    pub fn with(&self, form: &'a Variant) -> Self {
        let mut with = self.clone();
        with.forms.push(form);
        with
    }

    /// The scenario at some values: its own numbers, then those of each form.
    ///
    /// # Errors
    /// In words, if it has no place for them.
    pub fn scenario(&self, at: &[f64]) -> Result<Source, String> {
        version(self.source, self.own, &self.forms, at)
    }

    /// Values at which the last form is not there, after those of everything before it.
    pub fn without(&self, before: &[f64]) -> Vec<f64> {
        self.followed(before, |q| q.null)
    }

    /// Values at which the last form is plainly there, after those of everything before it.
    pub fn typical(&self, before: &[f64]) -> Vec<f64> {
        self.followed(before, |q| q.typical)
    }

    fn followed(&self, before: &[f64], value: fn(&Quantity) -> f64) -> Vec<f64> {
        let last = self.forms.last().into_iter();
        let last = last.flat_map(|form| &form.quantities).map(value);
        before.iter().copied().chain(last).collect()
    }

    /// Values on the way from some to others, at a share of the way.
    pub fn between(&self, from: &[f64], to: &[f64], share: f64) -> Vec<f64> {
        let between = |(j, (from, to)): (usize, (&f64, &f64))| self.part(j, (*from, *to), share);
        from.iter().zip(to).enumerate().map(between).collect()
    }

    /// Value `j` at a share of the way between two, as the search counts it.
    pub fn part(&self, j: usize, (from, to): (f64, f64), share: f64) -> f64 {
        let (a, b) = (self.coordinate(j, from), self.coordinate(j, to));
        a.value(a.at + share * (b.at - a.at))
    }

    /// Range of value `j`.
    pub fn range(&self, j: usize) -> (f64, f64) {
        match j.checked_sub(self.own.len()) {
            None => self.own[j].range,
            Some(k) => self.quantity(k).range,
        }
    }

    /// Numbers of the forms that would go on if what is physical didn't end there, with their values: chi2 would fall by
    /// more than noise makes it. What is absent at an end of its range, or zero there, may well stand there.
    pub fn astray(&self, fit: &Linear) -> Vec<(&Quantity, f64)> {
        let noise = (fit.chi2() / self.measured()).max(1.0);
        let own = self.own.len();
        let astray = |j: usize| {
            let (q, value) = (self.quantity(j - own), fit.at[j]);
            let near = NEAR * (q.range.1 - q.range.0);
            let at_end = [q.range.0, q.range.1].iter().any(|end| {
                (value - end).abs() < near && end.abs() > near && (q.null - end).abs() > near
            });
            let gain = || self.step(fit, DAMPING).1 - self.step_past_end(fit, j);
            (at_end && gain() > BEYOND * noise).then_some((q, value))
        };
        (own..fit.at.len()).filter_map(astray).collect()
    }

    fn quantity(&self, k: usize) -> &Quantity {
        let mut quantities = self.forms.iter().flat_map(|form| &form.quantities);
        quantities
            .nth(k)
            .expect("there is a value for each quantity")
    }

    /// How the search counts value `j`, which is `value` now.
    fn coordinate(&self, j: usize, value: f64) -> Coordinate {
        let (least, most) = self.range(j);
        let size = match j.checked_sub(self.own.len()) {
            None => 0.1 * self.own[j].width(),
            Some(k) => {
                let q = self.quantity(k);
                if q.absent_where_large() {
                    return Coordinate {
                        inverse: true,
                        at: 1.0 / value,
                        slope: -value * value,
                        scale: 1.0 / q.typical - 1.0 / q.null,
                        range: (1.0 / most, 1.0 / least),
                    };
                }
                (q.typical - q.null).abs().max(0.1 * q.typical.abs())
            }
        };
        Coordinate {
            inverse: false,
            at: value,
            slope: 1.0,
            scale: if size > 0.0 {
                size
            } else {
                0.05 * (most - least)
            },
            range: (least, most),
        }
    }

    fn priors(&self, at: &[f64]) -> Vec<f64> {
        let prior =
            |(p, v): (&Parameter, &f64)| p.prior.map(|(mean, sd)| self.doubt * (v - mean) / sd);
        self.own.iter().zip(at).filter_map(prior).collect()
    }

    /// Residuals and derivatives by the values `fresh`; those by others are as in `near`, from whose states these are
    /// found. Without, it takes as long as it takes.
    ///
    /// # Errors
    /// In words, if a sample has no steady state or a singular one, or if it has residuals beyond `most`, as
    /// [`Self::slopes`] says.
    pub fn linear(
        &self,
        at: &[f64],
        fresh: Range<usize>,
        near: Option<&Linear>,
        most: f64,
    ) -> Result<Linear, String> {
        let source = self.scenario(at)?;
        let pairs = fresh.clone().map(|j| self.pair(at, j));
        let pairs = pairs.collect::<Result<Vec<_>, String>>()?;
        let guides = near.map(|near| &near.states[..]);
        let Slopes {
            mut residuals,
            slopes,
            states,
        } = self.slopes(&source, &pairs, guides, most)?;
        let measured = residuals.len();
        residuals.extend(self.priors(at));
        let known = near.map_or(DMatrix::zeros(0, 0), |near| near.jacobian.clone());
        let mut jacobian = known.resize(residuals.len(), at.len(), 0.0);
        jacobian
            .view_mut((0, fresh.start), slopes.shape())
            .copy_from(&slopes);
        let mut row = measured;
        for (j, p) in self.own.iter().enumerate() {
            if let Some((_, sd)) = p.prior {
                jacobian[(row, j)] = self.doubt / sd;
                row += 1;
            }
        }
        Ok(Linear {
            at: at.to_vec(),
            residuals: DVector::from_vec(residuals),
            jacobian,
            states: Arc::new(states),
        })
    }

    /// A small step of value `j`, and the scenarios in which it is larger and smaller by that.
    ///
    /// # Errors
    /// In words, if the scenario has no place for them.
    pub fn pair(&self, at: &[f64], j: usize) -> Result<(f64, [Source; 2]), String> {
        let moved = |step: f64| {
            let mut there = at.to_vec();
            there[j] += step;
            self.scenario(&there)
        };
        let coordinate = self.coordinate(j, at[j]);
        let step = 1e-3 * (coordinate.scale * coordinate.slope).abs();
        // at the end of its range a value goes one way only
        let (least, most) = self.range(j);
        let up = if at[j] + step <= most { step } else { 0.0 };
        let down = if at[j] - step >= least { step } else { 0.0 };
        Ok(((up + down) / 2.0, [moved(up)?, moved(-down)?]))
    }

    /// Residuals of a scenario, priors left out, and derivatives by numbers of which `pairs` has the steps and the
    /// scenarios with larger and smaller ones. States are found from those of `guides`.
    ///
    /// # Errors
    /// In words, if a sample has no steady state or a singular one, or if the squared residuals of a recording are more than
    /// `most` before shared errors are taken out.
    pub fn slopes(
        &self,
        source: &Source,
        pairs: &[(f64, [Source; 2])],
        guides: Option<&[Guide]>,
        most: f64,
    ) -> Result<Slopes, String> {
        let of_recording = |(r, samples): (usize, &Samples)| {
            let mut run = Run::new(source, samples, guides.map(|guides| &guides[r]))?;
            let shown = |(step, [a, b]): &(f64, [Source; 2])| {
                Ok((*step, [Shown::new(a, samples)?, Shown::new(b, samples)?]))
            };
            let shown = pairs.iter().map(shown);
            let shown = shown.collect::<Result<_, CompareError>>()?;
            run.derivatives(samples, shown, most)
        };
        let each = self.data.par_iter().enumerate().map(of_recording);
        let each = each
            .collect::<Result<Vec<_>, CompareError>>()
            .map_err(|e| e.to_string())?;
        let rows = each.iter().map(|(r, ..)| r.len()).sum();
        let mut all = DMatrix::zeros(rows, 1 + pairs.len());
        let mut row = 0;
        for (residuals, slopes, _) in &each {
            let mut block = all.rows_mut(row, residuals.len());
            block.column_mut(0).copy_from_slice(residuals);
            block.columns_mut(1, pairs.len()).copy_from(slopes);
            row += residuals.len();
        }
        self.shared.whiten(&mut all);
        let residuals = all.column(0).as_slice().to_vec();
        Ok(Slopes {
            residuals,
            slopes: all.remove_column(0),
            states: each.into_iter().map(|(.., states)| states).collect(),
        })
    }

    /// How the search counts all values, and the derivatives by that, each over its size.
    fn scaled(&self, linear: &Linear) -> (Vec<Coordinate>, DMatrix<f64>) {
        let along: Vec<Coordinate> = (linear.at.iter().enumerate())
            .map(|(j, value)| self.coordinate(j, *value))
            .collect();
        let scaled = DMatrix::from_fn(linear.residuals.len(), along.len(), |i, j| {
            linear.jacobian[(i, j)] * along[j].slope * along[j].scale
        });
        (along, scaled)
    }

    /// The values that make the linearised residuals least, within the ranges, and what is left of chi2 then.
    pub fn step(&self, linear: &Linear, damping: f64) -> (Vec<f64>, f64) {
        self.step_along(linear, self.scaled(linear), damping)
    }

    /// What would be left of chi2 if value `j` had no range.
    fn step_past_end(&self, linear: &Linear, j: usize) -> f64 {
        let (mut along, scaled) = self.scaled(linear);
        along[j].range = (f64::NEG_INFINITY, f64::INFINITY);
        self.step_along(linear, (along, scaled), DAMPING).1
    }

    /// [`Self::step`] from what [`Self::scaled`] gives.
    fn step_along(
        &self,
        linear: &Linear,
        (along, scaled): (Vec<Coordinate>, DMatrix<f64>),
        damping: f64,
    ) -> (Vec<f64>, f64) {
        let (normal, slope) = (scaled.tr_mul(&scaled), scaled.tr_mul(&linear.residuals));
        let mut damped = normal.clone();
        let largest = normal.diagonal().amax().max(1e-300);
        for j in 0..along.len() {
            damped[(j, j)] += damping * normal[(j, j)] + 1e-12 * largest;
        }
        let room = |c: &Coordinate| {
            let to = |end: f64| (end - c.at) / c.scale;
            (to(c.range.0).min(0.0), to(c.range.1).max(0.0))
        };
        let change = bounded(&damped, &slope, &along.iter().map(room).collect::<Vec<_>>());
        let left = linear.chi2() + 2.0 * slope.dot(&change) + change.dot(&(&normal * &change));
        let moved = |(c, change): (&Coordinate, &f64)| {
            c.value((c.at + change * c.scale).clamp(c.range.0, c.range.1))
        };
        let to = along.iter().zip(&change).map(moved).collect();
        // what is not a number stays none
        (to, if left < 0.0 { 0.0 } else { left })
    }

    /// Covariance of the values for residuals of unit variance.
    pub fn covariance(&self, fit: &Linear) -> DMatrix<f64> {
        let (along, scaled) = self.scaled(fit);
        let scales = DVector::from_iterator(along.len(), along.iter().map(|c| c.slope * c.scale));
        inverse(&scaled).component_mul(&(&scales * scales.transpose()))
    }

    /// Change of the fitted values, to first order, if measured residuals changed by this.
    pub fn response(&self, fit: &Linear, change: &DVector<f64>) -> Vec<f64> {
        let (along, scaled) = self.scaled(fit);
        let slope = scaled.rows(0, change.len()).tr_mul(change);
        let steps = inverse(&scaled) * slope;
        let steps = along.iter().zip(&steps);
        steps.map(|(c, step)| -c.slope * c.scale * step).collect()
    }

    /// Residuals and all derivatives.
    ///
    /// # Errors
    /// In words, if a sample has no steady state or a singular one.
    pub fn start(&self, at: &[f64], near: Option<&Linear>) -> Result<Linear, String> {
        self.linear(at, 0..at.len(), near, f64::INFINITY)
    }

    /// A fit continued, in at most so many steps, with errors that samples share.
    pub fn tolerating(&self, fit: &Linear, shared: Arc<Shared>, iterations: usize) -> Linear {
        let start = fit.whitened(&shared, self.measured() as usize);
        let trial = Self {
            shared,
            ..self.clone()
        };
        let all = 0..start.at.len();
        trial.fit(start, all, iterations)
    }

    /// Fits all values from `here`, in at most `iterations` steps, after each of which derivatives by `fresh` are
    /// computed again; others stay.
    pub fn fit(&self, mut here: Linear, fresh: Range<usize>, iterations: usize) -> Linear {
        let mut damping = DAMPING;
        // beyond this it isn't better, unless samples share what it is off by
        let most = |chi2: f64| match self.shared.is_empty() {
            true => MUCH * chi2,
            false => f64::INFINITY,
        };
        for _ in 0..iterations {
            let mut better = None;
            for _ in 0..6 {
                let (there, promised) = self.step(&here, damping);
                if here.chi2() - promised < 0.2 + 1e-5 * here.chi2() {
                    break;
                }
                match self.linear(&there, fresh.clone(), Some(&here), most(here.chi2())) {
                    Ok(next) if next.chi2() < here.chi2() => {
                        better = Some(next);
                        break;
                    }
                    _ => damping = (damping * 30.0).max(1e-3),
                }
            }
            let Some(next) = better else { break };
            here = next;
            damping = (damping / 30.0).max(DAMPING);
        }
        here
    }
}

/// Pseudo-inverse of the normal matrix of a Jacobian.
fn inverse(jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let normal = jacobian.tr_mul(jacobian);
    let least = 1e-12 * normal.diagonal().amax();
    let inverse = normal.pseudo_inverse(least);
    inverse.expect("the tolerance is not negative")
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
