//! Identification of a scenario's uncertain numbers from measurements.
//!
//! A [`Parameter`] is a number that a scenario leaves uncertain, within a range and perhaps with a prior. [`fit`] finds
//! the values for which weighted residuals are least, by Levenberg's and Marquardt's method within the ranges, from
//! several starts; its [`Fit`] tells how well the residuals determine them: intervals, correlations, and in words what
//! they do not determine.
//!
//! Residuals are differences between model and measurement in units of the measurement's standard deviation. Any
//! function of the parameters that gives them is [`Residuals`]; a type that knows derivatives, too, overrides
//! [`Residuals::jacobian`].
//!
//! ```
//! use auxetica_identify::{Options, Parameter, fit};
//! use std::ops::ControlFlow;
//!
//! let times = [0.0, 1.0, 2.0, 3.0];
//! let measured = [2.0, 1.2, 0.75, 0.44];
//! let residuals = |at: &[f64]| {
//!     let model = times.map(|t: f64| at[0] * (-at[1] * t).exp());
//!     Ok(std::array::from_fn::<_, 4, _>(|i| (model[i] - measured[i]) / 0.02).to_vec())
//! };
//! let parameters = [
//!     Parameter::new("amplitude", "", 1.0, (0.1, 10.0)),
//!     Parameter::new("rate", "1/s", 1.0, (0.1, 5.0)),
//! ];
//! let fit = fit(&parameters, &residuals, &Options::default(), &|_| ControlFlow::Continue(()))?;
//! assert!(fit.converged && (fit.estimates[1].value - 0.5).abs() < 0.02);
//! # Ok::<(), auxetica_identify::FitError>(())
//! ```

mod effect;
mod fit;
mod identifiability;
mod least_squares;
mod parameter;
mod residuals;

pub use effect::{Effect, Hooked, Quantity, Robot, Variant};
pub use fit::{Estimate, Fit, FitError, Options, Watch, fit};
pub use parameter::Parameter;
pub use residuals::{Residuals, central_differences};
