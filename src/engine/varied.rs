//! A number of a scenario, a little larger and a little smaller.

use crate::inputs::Inputs;
use crate::scenario::Model;
use auxetica_config::{Problems, Source};
use nalgebra::DMatrix;

/// Step of the differences, as a share of the number; of a number that is zero, in its own unit.
const STEP: f64 = 1e-4;

/// A number of a scenario.
pub(crate) struct Varied {
    pub(crate) step: f64,
    /// The scenarios in which it is larger and smaller by the step.
    pub(crate) models: [Model; 2],
}

impl Varied {
    /// The numbers at `paths`, which are those of `--set`; a path that means several places is one number, the value that
    /// all of them have.
    ///
    /// # Errors
    /// If a path means no number, or different ones, or one that can't be varied.
    pub(crate) fn all(
        source: &Source,
        inputs: Option<&Inputs>,
        paths: &[&str],
    ) -> Result<Vec<Self>, Problems> {
        let stations = Model::build(source, inputs.cloned())?.system.stations();
        let mut problems = Problems::default();
        let mut all = Vec::new();
        for path in paths {
            let varied = Self::new(source, inputs, path, stations);
            all.extend(problems.collect(varied));
        }
        problems.into_result()?;
        Ok(all)
    }

    /// Derivatives of outputs from their values where the number is larger and smaller.
    pub(crate) fn slopes(&self, more: &[f64], less: &[f64]) -> Vec<f64> {
        let slope = |(m, l): (&f64, &f64)| (m - l) / (2.0 * self.step);
        more.iter().zip(less).map(slope).collect()
    }

    fn new(
        source: &Source,
        inputs: Option<&Inputs>,
        path: &str,
        stations: usize,
    ) -> Result<Self, Problems> {
        let problem = |message: String, hint: &str| -> Problems {
            source.problem(path, message).with_hint(hint).into()
        };
        let value = source.number(path).map_err(|e| {
            let (what, remedy) = e.split_once("; ").unwrap_or((&e, ""));
            problem(what.to_owned(), remedy)
        })?;
        let step = if value == 0.0 {
            STEP
        } else {
            STEP * value.abs()
        };
        let build = |value: f64| {
            let varied = source.with(&[format!("{path}={value:?}")]);
            let built = varied.and_then(|source| Model::build(&source, inputs.cloned()));
            let model = built.map_err(|problems| {
                let why = problems.0.first().map_or("", |p| &p.message);
                problem(
                    format!("`{path}` can't be varied: {value} is refused ({why})"),
                    "derivatives need numbers that may be a little larger and smaller",
                )
            })?;
            if model.system.stations() == stations {
                Ok(model)
            } else {
                Err(problem(
                    format!("`{path}` changes how many nodes there are"),
                    "derivatives need numbers that may be a little larger and smaller",
                ))
            }
        };
        Ok(Self {
            step,
            models: [build(value + step)?, build(value - step)?],
        })
    }
}

/// Derivatives of outputs (rows) by numbers (columns).
pub(crate) fn matrix(columns: &[Vec<f64>]) -> DMatrix<f64> {
    let rows = columns.first().map_or(0, Vec::len);
    DMatrix::from_iterator(rows, columns.len(), columns.iter().flatten().copied())
}
