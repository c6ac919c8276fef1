//! What residuals do not determine, in words.

use nalgebra::DMatrix;

use crate::Parameter;

/// Eigenvalues of the curvature that are rounding beside the largest: differences know a Jacobian to some 1e-6.
pub(crate) const ROUNDING: f64 = 1e-13;
/// A direction is undetermined if going through whole ranges along it changes the residuals by less than this many
/// standard deviations.
const LEAST_EFFECT: f64 = 1.0;
/// Share of a direction's largest entry below which a parameter takes no part in it.
const NO_PART: f64 = 0.03;
/// How far from equal two relative changes may be to be called so.
const EQUAL: f64 = 0.05;

/// The condition number of the Jacobian (of shares of the ranges) and the directions without effect, in words.
pub(crate) fn report(
    parameters: &[Parameter],
    values: &[f64],
    jacobian: &DMatrix<f64>,
) -> (f64, Vec<String>) {
    let eigen = jacobian.tr_mul(jacobian).symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let least = eigen.eigenvalues.min().max(0.0);
    let condition = match least > ROUNDING * largest {
        true => (largest / least).sqrt(),
        false => f64::INFINITY,
    };
    let words = (0..eigen.eigenvalues.len()).filter_map(|k| {
        let effect = eigen.eigenvalues[k];
        let felt = effect > ROUNDING * largest && effect > LEAST_EFFECT * LEAST_EFFECT;
        (!felt).then(|| {
            let direction: Vec<f64> = eigen.eigenvectors.column(k).iter().copied().collect();
            in_words(parameters, values, &direction)
        })
    });
    (condition, words.collect())
}

/// A direction, given in shares of the ranges.
fn in_words(parameters: &[Parameter], values: &[f64], direction: &[f64]) -> String {
    let largest = direction.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
    let part: Vec<usize> = (0..direction.len())
        .filter(|j| direction[*j].abs() > NO_PART * largest)
        .collect();
    // as relative changes, which tell ratios and products
    let change = |j: usize| direction[j] * parameters[j].width() / values[j].abs();
    let name = |j: usize| parameters[j].name.as_str();
    match part.as_slice() {
        [j] => format!("{} is not determined", name(*j)),
        [a, b] if (change(*a) / change(*b) - 1.0).abs() < EQUAL => {
            format!("only the ratio {} / {} is determined", name(*a), name(*b))
        }
        [a, b] if (change(*a) / change(*b) + 1.0).abs() < EQUAL => {
            format!("only the product {} * {} is determined", name(*a), name(*b))
        }
        part => {
            let most = part
                .iter()
                .fold(0.0_f64, |most, j| most.max(change(*j).abs()));
            let sign = change(part[0]).signum();
            let changes = part
                .iter()
                .map(|j| format!("{} {:+.2} %", name(*j), sign * change(*j) / most * 10.0));
            format!(
                "changed together, these have next to no effect: {}",
                changes.collect::<Vec<_>>().join(", ")
            )
        }
    }
}
