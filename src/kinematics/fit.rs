//! The outcome of a fit.

use nalgebra::DMatrix;

/// Pivots of a scaled Cholesky factor, squared, below which they are rounding.
const SINGULAR: f64 = 1e-13;

/// A configuration fitted to measured poses.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The configuration `q`.
    pub configuration: Vec<f64>,
    /// Half the sum of the weighted squares that are left.
    pub cost: f64,
    /// How often the rod's poses were computed.
    pub evaluations: usize,
    /// Whether nothing was left to gain.
    pub converged: bool,
    /// Gauss-Newton's curvature of the cost there, `J^T J` with the weights in `J`.
    pub(crate) information: DMatrix<f64>,
    /// The entries of the configuration that could have changed: not those that were given or
    /// are held by a bound.
    pub(crate) free: Vec<bool>,
}

impl Fit {
    /// Covariance of the configuration when the weights are those of the measurements'
    /// deviations ([`Weights::from_deviations`](crate::Weights::from_deviations)): `(J^T J)^-1`,
    /// with zeros for entries that were given or are held by a bound.
    ///
    /// `None` where the poses do not determine the configuration.
    #[must_use]
    pub fn covariance(&self) -> Option<DMatrix<f64>> {
        let free: Vec<usize> = (0..self.free.len()).filter(|&i| self.free[i]).collect();
        // Scaled to a unit diagonal: rad/m and shears differ by orders of magnitude.
        let scale: Vec<f64> = (free.iter())
            .map(|&i| self.information[(i, i)].sqrt())
            .collect();
        let scaled = DMatrix::from_fn(free.len(), free.len(), |i, j| {
            self.information[(free[i], free[j])] / (scale[i] * scale[j])
        });
        let factor = scaled.cholesky()?;
        let pivots = factor.l_dirty().diagonal();
        if pivots.iter().any(|pivot| pivot * pivot < SINGULAR) {
            return None;
        }
        let inverse = factor.inverse();
        let mut covariance = DMatrix::zeros(self.free.len(), self.free.len());
        for (i, &row) in free.iter().enumerate() {
            for (j, &column) in free.iter().enumerate() {
                covariance[(row, column)] = inverse[(i, j)] / (scale[i] * scale[j]);
            }
        }
        Some(covariance)
    }
}
