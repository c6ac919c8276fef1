//! What a law of all rods makes of their curves. Rods' own numbers are calibrated by what the model gets right, so that
//! they can't hide what it gets wrong, and the effect's numbers, the same for all rods, by the quantity that it does.

use super::rod::{Added, Rod};
use crate::characterise::{Comparison, Curves, Point, Quantity};
use crate::identify::{Fit, Options, Parameter, Variant, fit};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// Figures that are left out together: those of a rod if there are several, or else those at an angle inside the range.
#[derive(Clone, Copy, Debug)]
pub(super) enum Group {
    Rod(usize),
    /// Twist angle \[rad\].
    Angle(f64),
}

impl Group {
    /// All of them.
    pub(super) fn all(rods: &[Rod], subject: Quantity) -> Vec<Self> {
        match rods {
            [rod] => {
                let angles = rod.curves.only(|p| p.quantity == subject).angles();
                let inside = angles.iter().skip(1).take(angles.len().saturating_sub(2));
                inside.map(|angle| Self::Angle(*angle)).collect()
            }
            rods => (0..rods.len()).map(Self::Rod).collect(),
        }
    }

    pub(super) fn holds(self, rod: usize, point: &Point) -> bool {
        match self {
            Self::Rod(held) => held == rod,
            Self::Angle(held) => held.total_cmp(&point.angle).is_eq(),
        }
    }
}

/// Steps that bring rods' own numbers back to the other quantities.
const STEPS: usize = 2;

/// An effect in a form, or none, on all rods.
pub(super) struct Hypothesis<'a> {
    pub(super) rods: &'a [Rod],
    /// The quantity that the model gets wrong.
    pub(super) subject: Quantity,
    /// The rods' own numbers, calibrated by the other quantities without an effect.
    pub(super) own: &'a [Vec<f64>],
    /// What brings them back to the other quantities ([`Rod::correction`]).
    pub(super) corrections: &'a [DMatrix<f64>],
    /// The form on each rod, none if there is no effect.
    pub(super) forms: Option<&'a [Variant]>,
}

impl Hypothesis<'_> {
    fn added<'v>(&'v self, rod: usize, values: &'v [f64]) -> Added<'v> {
        self.forms.map(|forms| (&forms[rod], values))
    }

    /// A rod's own numbers by the other quantities.
    pub(super) fn calibrated(&self, rod: usize, values: &[f64]) -> Result<Fit, String> {
        let (on, added) = (&self.rods[rod], self.added(rod, values));
        on.calibrated(&self.own[rod], added, &self.others(rod))
    }

    fn others(&self, rod: usize) -> Curves {
        let curves = &self.rods[rod].curves;
        curves.only(|p| p.quantity != self.subject)
    }

    /// Nearly the same numbers, by a few steps with the derivatives without an effect.
    fn brought_back(&self, rod: usize, values: &[f64]) -> Result<Vec<f64>, String> {
        let mut own = self.own[rod].clone();
        if self.forms.is_none() {
            return Ok(own);
        }
        let (on, added, others) = (&self.rods[rod], self.added(rod, values), self.others(rod));
        for _ in 0..STEPS {
            let residuals = DVector::from_vec(on.residuals(&own, added, &others)?);
            let change = &self.corrections[rod] * residuals;
            for ((value, change), p) in own.iter_mut().zip(&change).zip(&on.own) {
                *value = (*value + change).clamp(p.range.0, p.range.1);
            }
        }
        Ok(own)
    }

    /// The rod's figures that `keep` chooses, beside those of the bench.
    pub(super) fn compared(
        &self,
        rod: usize,
        values: &[f64],
        keep: &dyn Fn(&Point) -> bool,
    ) -> Result<Comparison, String> {
        let own = self.brought_back(rod, values)?;
        let (on, added) = (&self.rods[rod], self.added(rod, values));
        on.compared(&own, added, &on.curves.only(keep))
    }

    /// Residuals of the subject at the points that `keep` chooses, rod by rod.
    fn residuals(
        &self,
        values: &[f64],
        keep: &(dyn Fn(usize, &Point) -> bool + Sync),
    ) -> Result<Vec<f64>, String> {
        let of_rod = |rod: usize| {
            let keep = |p: &Point| p.quantity == self.subject && keep(rod, p);
            if !self.rods[rod].curves.points.iter().any(keep) {
                return Ok(Vec::new());
            }
            let beside = self.compared(rod, values, &keep)?;
            let each = beside.points.iter();
            each.map(|b| b.residual().map_err(str::to_owned)).collect()
        };
        let each = (0..self.rods.len()).into_par_iter().map(of_rod);
        Ok(each.collect::<Result<Vec<_>, String>>()?.concat())
    }

    /// Squared residuals of the subject.
    pub(super) fn chi2(&self, values: &[f64]) -> Result<f64, String> {
        let residuals = self.residuals(values, &|_, _| true)?;
        Ok(residuals.iter().map(|r| r * r).sum())
    }

    /// Squared residuals of the other quantities, by which rods' own numbers are calibrated.
    pub(super) fn rest(&self, values: &[f64]) -> Result<f64, String> {
        let rods = (0..self.rods.len()).into_par_iter();
        let others = |p: &Point| p.quantity != self.subject;
        rods.map(|rod| Ok(self.compared(rod, values, &others)?.chi2()))
            .sum()
    }

    /// The effect's numbers by the subject, all but those that are left out, beginning at some values.
    pub(super) fn fitted(&self, start: &[f64], without: Option<Group>) -> Result<Fit, String> {
        let quantities = self.forms.iter().flat_map(|forms| &forms[0].quantities);
        let parameters: Vec<_> = (quantities.zip(start))
            .map(|(q, at)| Parameter::new(&q.name, q.unit, *at, q.range))
            .collect();
        let options = Options {
            starts: 1,
            tolerance: 1e-4,
            most_iterations: 15,
            ..Options::default()
        };
        let keep = |rod: usize, p: &Point| without.is_none_or(|group| !group.holds(rod, p));
        let residuals = |at: &[f64]| self.residuals(at, &keep);
        let go_on = |_| ControlFlow::Continue(());
        fit(&parameters, &residuals, &options, &go_on).map_err(|e| e.to_string())
    }

    /// Residuals of the subject at a group, with numbers from all others.
    pub(super) fn held_out(&self, near: &[f64], group: Group) -> Result<Vec<f64>, String> {
        let values = match self.forms {
            None => Vec::new(),
            Some(_) => self.fitted(near, Some(group))?.values(),
        };
        self.residuals(&values, &|rod, p| group.holds(rod, p))
    }

    /// Whether an effect changes any figure of a rod at its typical values.
    pub(super) fn acts(&self) -> bool {
        let Some(forms) = self.forms else {
            return false;
        };
        let typical: Vec<f64> = forms[0].quantities.iter().map(|q| q.typical).collect();
        let changed = |rod: usize| {
            let (on, own) = (&self.rods[rod], &self.own[rod]);
            let with = on.residuals(own, self.added(rod, &typical), &on.curves);
            let (Ok(with), Ok(bare)) = (with, on.residuals(own, None, &on.curves)) else {
                return false;
            };
            with.iter().zip(bare).any(|(a, b)| (a - b).abs() > 1e-3)
        };
        (0..self.rods.len()).all(changed)
    }
}
