//! Derivatives held against those of whole new solutions.

use auxetica::config::Source;
use std::ops::Range;

/// A small robot of two handed rods under a platform, and what else a scenario says of it.
pub fn two_rods(rest: &str, sets: &[String]) -> Source {
    let text = format!(
        r#"(
            title: "two rods under a platform",
            rods: [(
                name: "hsa", at: {{"right": (0.02, 0, 0), "left": (-0.02, 0.001, 0)}}, length: 0.06, elements: 6,
                radius: 0.0127, wall: 0.0024, density: 1050,
                material: Rigidities(shear: 100, axial: 150, bending: 0.02, twist: 0.01),
            )],
            cylinders: [(name: "platform", centre: (0, 0, 0.065), radius: 0.04, thickness: 0.007, mass: 0.05)],
            {rest}
        )"#
    );
    Source::from_text("robot", &text, sets).unwrap_or_else(|e| panic!("{e}"))
}

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
