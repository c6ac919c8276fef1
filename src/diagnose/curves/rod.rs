//! A rod on the bench beside its measured curves.

use crate::characterise::{
    Bench, CharacteriseError, Comparison, Curves, Quantity, compared, residuals,
};
use crate::config::Source;
use crate::diagnose::trial::version;
use crate::identify::{Fit, Options, Parameter, Variant, central_differences, fit};
use nalgebra::DMatrix;
use std::ops::ControlFlow;

/// Least deviation of a figure, as a share of the largest that its quantity comes to (of lengths, of the extension):
/// figures are read off plots, and no law holds to less.
pub(super) const FLOOR: f64 = 0.02;
/// Force \[N\] that spring constants are found with.
pub(super) const PULL: f64 = 1.0;

/// Change of residuals across whole ranges of numbers that is no change.
const UNDETERMINED: f64 = 1e-3;

/// A form of an effect and the values of its numbers.
pub(super) type Added<'a> = Option<(&'a Variant, &'a [f64])>;

/// A rod and its curves.
pub struct Rod {
    /// What reports call it.
    pub(super) name: String,
    pub(super) source: Source,
    bench: Bench,
    /// Its figures, with error bars of [`FLOOR`] at least.
    pub(super) curves: Curves,
    /// What its scenario declares as uncertain.
    pub(super) own: Vec<Parameter>,
}

impl Rod {
    /// Puts the rod of a scenario on the bench.
    ///
    /// # Errors
    /// If the scenario is wrong, has several rods, or declares nothing under `uncertain`.
    pub(super) fn new(
        source: Source,
        mut curves: Curves,
        rows: Option<u32>,
    ) -> Result<Self, CharacteriseError> {
        let bench = Bench::new(&source, None, PULL)?;
        for quantity in Quantity::ALL {
            let values = curves.points.iter().filter(|p| p.quantity == quantity);
            let values: Vec<f64> = values.map(|p| p.value).collect();
            let from = match quantity {
                Quantity::MinimumEnergyLength => values.iter().copied().fold(f64::MAX, f64::min),
                _ => 0.0,
            };
            let largest = values.iter().fold(0.0_f64, |m, v| m.max((v - from).abs()));
            let points = curves.points.iter_mut().filter(|p| p.quantity == quantity);
            for point in points {
                let short = (FLOOR * largest - point.deviation()).max(0.0);
                point.error_minus += short;
                point.error_plus += short;
            }
        }
        Ok(Self {
            name: rows.map_or_else(|| bench.rod().to_owned(), |rows| format!("{rows} rows")),
            bench,
            own: Parameter::declared(&source)?,
            source,
            curves,
        })
    }

    /// The scenario at values of its own numbers, with an effect.
    pub(super) fn version(&self, own: &[f64], added: Added<'_>) -> Result<Source, String> {
        let (form, values) = added.unzip();
        let at = [own, values.unwrap_or(&[])].concat();
        version(&self.source, &self.own, form.as_slice(), &at)
    }

    /// Figures beside what the bench shows then.
    pub(super) fn compared(
        &self,
        own: &[f64],
        added: Added<'_>,
        curves: &Curves,
    ) -> Result<Comparison, String> {
        compared(&self.version(own, added)?, &self.bench, curves)
    }

    /// The same as differences in units of the error bars.
    pub(super) fn residuals(
        &self,
        own: &[f64],
        added: Added<'_>,
        curves: &Curves,
    ) -> Result<Vec<f64>, String> {
        residuals(&self.version(own, added)?, &self.bench, curves)
    }

    /// Fits its own numbers to figures, beginning at some values.
    pub(super) fn calibrated(
        &self,
        start: &[f64],
        added: Added<'_>,
        curves: &Curves,
    ) -> Result<Fit, String> {
        let mut parameters = self.own.clone();
        for (parameter, value) in parameters.iter_mut().zip(start) {
            parameter.nominal = *value;
        }
        let options = Options {
            starts: 1,
            tolerance: 1e-8,
            ..Options::default()
        };
        let residuals = |own: &[f64]| self.residuals(own, added, curves);
        let go_on = |_| ControlFlow::Continue(());
        fit(&parameters, &residuals, &options, &go_on).map_err(|e| e.to_string())
    }

    /// By how much its own numbers must change, to first order, for residuals of some figures to become least: a matrix
    /// to multiply those with.
    pub(super) fn correction(&self, own: &[f64], curves: &Curves) -> Result<DMatrix<f64>, String> {
        let residuals = |own: &[f64]| self.residuals(own, None, curves);
        let here = residuals(own)?;
        let mut slopes = central_differences(&residuals, own, &here, &self.own)?;
        for (mut column, p) in slopes.column_iter_mut().zip(&self.own) {
            column *= p.width();
        }
        let mut inverse = slopes.pseudo_inverse(UNDETERMINED).map_err(str::to_owned)?;
        for (mut row, p) in inverse.row_iter_mut().zip(&self.own) {
            row *= -p.width();
        }
        Ok(inverse)
    }

    /// The values that its scenario states.
    pub(super) fn stated(&self) -> Vec<f64> {
        self.own.iter().map(|p| p.nominal).collect()
    }
}
