//! Steady states are those of beam theory: Timoshenko cantilevers, stretched rods, and PyElastica's own example.

mod common;

use common::{model, nodes, steady, tip};
use nalgebra::Vector3;

/// A cantilever along z of 1 m and rigidities that make shear matter, with a small transverse force at its tip.
const LOAD: f64 = 1e-4;
const SHEAR: f64 = 20.0;
const BENDING: f64 = 1.0;

fn deflection(elements: usize, cell: &str) -> f64 {
    let mut model = model(&format!(
        r#"(
            title: "cantilever",
            rods: [(
                name: "rod", length: 1, elements: {elements}, radius: 0.02, density: 1000,
                material: Rigidities(shear: {SHEAR}, axial: 1e4, bending: {BENDING}, twist: 1),
            )],
            boundary: [(apply: Clamp(cell: {cell}))],
            forcing: [(apply: EndForce(force: ({LOAD}, 0, 0)))],
            solver: Steady(),
        )"#
    ));
    steady(&mut model, 0.0);
    tip(&model, "rod").x
}

fn timoshenko() -> (f64, f64) {
    (LOAD / (3.0 * BENDING), LOAD / SHEAR)
}

/// Exact for n elements of length l: the couple at cell v is F l (n - v), so element e turns by the sum of
/// F l^2 (n - v) / B over cells 1 to e, and the tip moves by the sum of l times these angles and by F L / S:
/// w = F L^3 / (3 B) (1 - 1/n) (1 - 1/(2n)) + F L / S with the first element held. With a half cell before it, every
/// element turns by F L l / (2 B) more, which leaves F L^3 / (3 B) (1 + 1/(2n^2)) of bending.
#[test]
fn a_cantilever_bends_as_the_discrete_beam() {
    let (bending, shear) = timoshenko();
    for elements in [2, 5, 20, 50] {
        let n = elements as f64;
        let rigid = bending * (1.0 - 1.0 / n) * (1.0 - 0.5 / n) + shear;
        let half = bending * (1.0 + 0.5 / (n * n)) + shear;
        for (cell, exact) in [("Rigid", rigid), ("Half", half)] {
            let error = (deflection(elements, cell) / exact - 1.0).abs();
            println!("{elements} elements, {cell}: {error:.1e}");
            assert!(
                error < 1e-8,
                "{elements} elements, {cell}: off by {error:.1e}"
            );
        }
    }
}

#[test]
fn a_cantilever_converges_to_timoshenko_at_second_order_with_a_half_cell() {
    let (bending, shear) = timoshenko();
    for (cell, range) in [("Rigid", 0.9..1.1), ("Half", 1.9..2.1)] {
        let errors: Vec<f64> = [10, 20, 40, 80]
            .map(|n| (deflection(n, cell) / (bending + shear) - 1.0).abs())
            .into();
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            println!(
                "{cell}: {:.2e} -> {:.2e}, order {order:.3}",
                pair[0], pair[1]
            );
            assert!(range.contains(&order), "{cell}: order {order:.3}");
        }
    }
}

#[test]
fn a_pulled_rod_stretches_by_the_closed_form() {
    // The stress follows the undeformed section and the force the deformed one: F = S sigma / (1 + sigma).
    let axial = 50.0;
    for force in [-20.0, -1e-3, 1e-3, 10.0, 40.0] {
        let mut model = model(&format!(
            r#"(
                title: "pulled rod",
                rods: [(
                    name: "rod", length: 0.3, elements: 7, radius: 0.01, density: 1000,
                    material: Rigidities(shear: 20, axial: {axial}, bending: 100, twist: 1),
                )],
                boundary: [(apply: Clamp())],
                forcing: [(apply: EndForce(force: (0, 0, {force})))],
                solver: Steady(),
            )"#
        ));
        steady(&mut model, 0.0);
        let stretch = tip(&model, "rod").z / 0.3 - 1.0;
        let exact = force / (axial - force);
        assert!(
            (stretch / exact - 1.0).abs() < 1e-9,
            "{force} N: {stretch} instead of {exact}"
        );
    }
}

/// Largest distance [m] to PyElastica's Timoshenko example, settled with PyElastica 1.0. The example's "poisson ratio"
/// is 99 for its shearable and -0.7 for its unshearable beam.
fn pyelastica(file: &str, poisson: f64, y: f64) -> Option<f64> {
    let path = common::data(&format!("reference_simulations/pyelastica/{file}"))?;
    let rows = csv::Reader::from_path(path)
        .expect("the table can be opened")
        .into_deserialize();
    let reference = rows.map(|row| {
        let (_, x, y, z, ..): (u32, f64, f64, f64, f64, f64, f64) = row.expect("a row of numbers");
        Vector3::new(x, y, z)
    });
    let shear = 1e6 / (1.0 + poisson);
    let mut model = model(&format!(
        r#"(
            title: "PyElastica's example",
            rods: [(
                name: "beam", at: {{"rod": (0, {y}, 0)}}, normal: (0, 1, 0), length: 3, elements: 100, radius: 0.25,
                density: 5000, material: Moduli(youngs: 1e6, shear: {shear}),
            )],
            boundary: [(apply: Clamp())],
            forcing: [(apply: EndForce(force: (-15, 0, 0)))],
            solver: Steady(),
        )"#
    ));
    steady(&mut model, 0.0);
    let reference: Vec<_> = reference.collect();
    let own = nodes(&model, "rod");
    assert_eq!(own.len(), reference.len());
    let difference = own
        .iter()
        .zip(&reference)
        .map(|(a, b)| (a - b).norm())
        .fold(0.0, f64::max);
    println!("{file}: largest difference {difference:.2e} m");
    // Newton's last correction may be 3e-11 m here, and both tables carry the rounding of 100 elements.
    Some(difference)
}

#[test]
fn the_shearable_beam_is_where_pyelastica_has_it() {
    if let Some(difference) = pyelastica("timoshenko_steady_shearable_nodes_ea1.0.0.csv", 99.0, 0.0)
    {
        assert!(difference < 1e-11, "{difference:.2e} m");
    }
}

#[test]
fn the_unshearable_beam_is_where_pyelastica_has_it() {
    let file = "timoshenko_steady_unshearable_nodes_ea1.0.0.csv";
    if let Some(difference) = pyelastica(file, -0.7, -1.0) {
        assert!(difference < 1e-11, "{difference:.2e} m");
    }
}
