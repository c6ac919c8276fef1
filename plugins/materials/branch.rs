//! What laws with a memory share: the strains of a rod one after the other, and loads in proportion to them.

use auxetica_engine::{Body, LawView, ReadBody};
use nalgebra::Vector3;

/// Numbers before the strains: whether there is a memory yet, and its time [s].
pub(crate) const HEAD: usize = 2;

/// How many numbers hold the time and all strains of a rod.
pub(crate) fn size(rod: &Body<'_>) -> usize {
    HEAD + 3 * (rod.elements() + rod.elements() + 1)
}

/// Adds `S f(sigma, memory)` to the stress of every element and `B f(kappa, memory)` to the couple of every cell.
/// `f` is told whether the strain is a curvature.
pub(crate) fn add_loads(rod: &mut LawView<'_>, f: impl Fn(f64, f64, bool) -> f64) {
    for e in 0..rod.elements() {
        let was = remembered(rod, e);
        let strain = rod.sigma(e).zip_map(&was, |now, was| f(now, was, false));
        rod.add_stress(e, rod.shear_stretch(e).component_mul(&strain));
    }
    for v in rod.cells() {
        let was = remembered(rod, rod.elements() + v);
        let strain = rod.kappa(v).zip_map(&was, |now, was| f(now, was, true));
        rod.add_couple(v, rod.bend_twist(v).component_mul(&strain));
    }
}

/// Replaces every remembered strain by `f(strain, memory)`.
pub(crate) fn update(rod: &mut LawView<'_>, time: f64, f: impl Fn(f64, f64, bool) -> f64) {
    for e in 0..rod.elements() {
        let was = remembered(rod, e);
        let strain = rod.sigma(e).zip_map(&was, |now, was| f(now, was, false));
        store(rod, e, strain);
    }
    for v in rod.cells() {
        let at = rod.elements() + v;
        let was = remembered(rod, at);
        let strain = rod.kappa(v).zip_map(&was, |now, was| f(now, was, true));
        store(rod, at, strain);
    }
    rod.memory_mut()[0] = 1.0;
    rod.memory_mut()[1] = time;
}

/// Time since the memory [s]; nothing before there is one.
pub(crate) fn since(rod: &LawView<'_>, time: f64) -> Option<f64> {
    (rod.memory()[0] > 0.0).then(|| (time - rod.memory()[1]).max(0.0))
}

fn remembered(rod: &LawView<'_>, i: usize) -> Vector3<f64> {
    let at = HEAD + 3 * i;
    Vector3::from_column_slice(&rod.memory()[at..at + 3])
}

fn store(rod: &mut LawView<'_>, i: usize, strain: Vector3<f64>) {
    let at = HEAD + 3 * i;
    rod.memory_mut()[at..at + 3].copy_from_slice(strain.as_slice());
}
