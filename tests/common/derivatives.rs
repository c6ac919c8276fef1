//! Derivatives held against those of whole new solutions.

use std::ops::Range;

/// Derivatives of outputs by a number, by differences of fourth order, so that the reference is no coarser than what it
/// judges; `outputs` are those for a value.
pub fn by_differences(value: f64, step: f64, outputs: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| outputs(value + k * step));
    (0..a.len())
        .map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * step))
        .collect()
}

/// Outputs of a kind are judged together, since a component may vanish: they are off by this share of their size at most, or
/// by what is rounding.
pub fn hold(
    what: &str,
    kinds: &[Range<usize>],
    found: &[f64],
    wanted: &[f64],
    (share, rounding): (f64, f64),
) {
    for kind in kinds {
        let size =
            |v: &dyn Fn(usize) -> f64| kind.clone().map(|i| v(i).powi(2)).sum::<f64>().sqrt();
        let wanted_size = size(&|i| wanted[i]);
        let off = size(&|i| found[i] - wanted[i]);
        println!(
            "{what:38} {kind:?}: {wanted_size:10.3e}, off by {:.1e} of it",
            off / wanted_size
        );
        assert!(
            off <= share * wanted_size || off < rounding,
            "{what}, outputs {kind:?}: off by {off:e} of {wanted_size:e}"
        );
    }
}
