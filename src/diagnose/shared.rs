//! Errors that samples share, so that many samples don't make them small: where motion capture is off throughout a
//! recording, and what the mesh does to the robot.

use super::forward::{CHANNELS, differences, whitened};
use super::samples::Samples;
use crate::compare::CompareError;
use crate::config::Source;
use nalgebra::{DMatrix, DVector, DVectorViewMut};
use rayon::prelude::*;

/// By how much a marker is off throughout a recording, a standard deviation: position [m], rotation [rad].
const BIAS: (f64, f64) = (2e-5, 2e-4);
/// Times as many elements of the meshes whose differences are taken for errors of the mesh, the finer one first; what they
/// do needn't be in proportion.
const MESHES: [f64; 2] = [2.0, 0.75];

/// Shared errors, each a direction of whitened residuals along which the error is one standard deviation.
#[derive(Default)]
pub struct Shared {
    directions: Vec<(DVector<f64>, f64)>,
}

impl Shared {
    /// What is off throughout each recording.
    pub fn biases(data: &[Samples]) -> Self {
        let mut shared = Self::default();
        let rows = data.iter().map(|s| s.list.len() * CHANNELS).sum();
        let mut from = 0;
        for samples in data {
            let ones = whitened(&vec![1.0; samples.list.len() * CHANNELS], samples);
            for channel in 0..CHANNELS {
                let size = if channel % 6 < 3 { BIAS.0 } else { BIAS.1 };
                let mut direction = DVector::zeros(rows);
                for row in (channel..ones.len()).step_by(CHANNELS) {
                    direction[from + row] = size * ones[row];
                }
                shared.add(direction);
            }
            from += ones.len();
        }
        shared
    }

    /// Whether samples share nothing.
    pub fn is_empty(&self) -> bool {
        self.directions.is_empty()
    }

    /// The same, and what the mesh does, as [`meshes`] has it.
    pub fn with(mut self, meshes: Vec<DVector<f64>>) -> Self {
        for change in meshes {
            self.add(change);
        }
        self
    }

    fn add(&mut self, direction: DVector<f64>) {
        let mut direction = DMatrix::from_columns(&[direction]);
        self.whiten(&mut direction);
        let direction = direction.column(0).into_owned();
        let square = direction.norm_squared();
        if square > 0.0 {
            // (I + u u') to the power of -1/2 is I - share u u'
            let share = (1.0 - 1.0 / (1.0 + square).sqrt()) / square;
            self.directions.push((direction, share));
        }
    }

    /// Whitens columns in whose covariance these errors are, beside a unit one.
    pub fn whiten(&self, columns: &mut DMatrix<f64>) {
        for mut column in columns.column_iter_mut() {
            let mut column: DVectorViewMut<'_, f64> = column.rows_mut(0, column.nrows());
            for (direction, share) in &self.directions {
                let part = direction.dot(&column);
                column.axpy(-share * part, direction, 1.0);
            }
        }
    }
}

/// Whitened changes of all residuals if the mesh of `source` were finer, and if it were coarser.
///
/// # Errors
/// If the scenario, or the same with another mesh, has no steady state at a sample.
pub fn meshes(source: &Source, data: &[Samples]) -> Result<Vec<DVector<f64>>, CompareError> {
    let all = |source: &Source| -> Result<DVector<f64>, CompareError> {
        let each = data.par_iter().map(|samples| {
            let apart = differences(source, samples)?;
            Ok(whitened(&apart, samples))
        });
        let each = each.collect::<Result<Vec<_>, CompareError>>()?;
        Ok(DVector::from_vec(each.concat()))
    };
    let own = all(source)?;
    let other = MESHES.par_iter().map(|times| {
        let mut sets = Vec::new();
        for group in 0.. {
            let path = format!("rods[{group}].elements");
            let Ok(elements) = source.number(&path) else {
                break;
            };
            sets.push(format!("{path}={:.0}", (times * elements).max(1.0)));
        }
        Ok(all(&source.with(&sets)?)? - &own)
    });
    other.collect()
}

#[cfg(test)]
mod tests {
    use super::Shared;
    use approx::assert_relative_eq;
    use nalgebra::{DMatrix, dvector};

    #[test]
    fn whitened_columns_have_a_unit_covariance() {
        let (u, v) = (dvector![2.0, 0.5, -1.0, 0.0], dvector![0.3, 4.0, 1.0, 1.0]);
        let covariance = DMatrix::identity(4, 4) + &u * u.transpose() + &v * v.transpose();
        let mut shared = Shared::default();
        shared.add(u);
        shared.add(v);
        let mut root = DMatrix::identity(4, 4);
        shared.whiten(&mut root);
        let white = &root * covariance * root.transpose();
        assert_relative_eq!(white, DMatrix::identity(4, 4), epsilon = 1e-12);
    }
}
