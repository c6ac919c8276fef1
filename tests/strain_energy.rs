//! The law of a stored energy: its stresses and couples do the work that the energy says, however the rod is deformed.

mod common;

use auxetica::engine::{BoundaryCondition, Moment, PoseView, RateView, ReadBody, rotation};
use common::{deform, model};
use nalgebra::{Matrix3, Vector3};

/// Puts the rod into a wavy pose, and moves it from there along a direction of all its nodes and frames.
struct Deform {
    along: f64,
}

impl BoundaryCondition for Deform {
    fn rates(&self, _now: &Moment<'_>, _body: &mut RateView<'_>) {}

    fn values(&self, _now: &Moment<'_>, body: &mut PoseView<'_>) {
        let (mut frame, mut point) = (Matrix3::identity(), Vector3::zeros());
        body.set_position(0, point);
        for e in 0..body.elements() {
            let s = e as f64;
            let turn = Vector3::new((1.3 * s).sin(), (0.7 * s).cos(), 0.8);
            let more = Vector3::new(s.cos(), (0.4 * s).sin(), (0.9 * s).cos()) * self.along;
            frame = rotation::turned(&frame, &(turn * 0.2 + more));
            let strain = Vector3::new(0.05 * (2.1 * s).sin(), 0.03, 1.1 + 0.1 * s.cos());
            let more = Vector3::new((1.7 * s).sin(), s.cos(), (0.6 * s).sin()) * self.along;
            point += frame.tr_mul(&(strain + more)) * body.reference_length(e);
            body.set_director(e, frame);
            body.set_position(e + 1, point);
        }
    }
}

/// Rigidities of the rod.
const SHEAR_STRETCH: [f64; 3] = [80.0, 80.0, 200.0];
const BEND_TWIST: [f64; 3] = [2.0, 2.0, 1.1];
/// Coefficients and powers of shear, elongation, curvature and twist.
const TERMS: [(f64, [i32; 4]); 7] = [
    (30.0, [0, 3, 0, 0]),
    (-4.0, [2, 1, 0, 0]),
    (0.7, [0, 1, 0, 2]),
    (0.05, [0, 0, 2, 2]),
    (-0.3, [0, 0, 0, 3]),
    (0.02, [2, 2, 4, 1]),
    (0.4, [0, 0, 0, 1]),
];

/// Strains, lengths and loads of the deformed rod: of elements, then of cells.
type Strained = [Vec<(Vector3<f64>, f64, Vector3<f64>)>; 2];

fn strained(along: f64) -> Strained {
    let term = |(c, [shear, elongation, curvature, twist]): &(f64, [i32; 4])| {
        format!(
            "(coefficient: {c}, shear: {shear}, elongation: {elongation}, curvature: {curvature}, twist: {twist})"
        )
    };
    let terms = TERMS.iter().map(term).collect::<Vec<_>>().join(", ");
    let [shear, _, axial] = SHEAR_STRETCH;
    let [bending, _, twist] = BEND_TWIST;
    let mut model = model(&format!(
        r#"(
            title: "free rod",
            rods: [(
                name: "rod", length: 0.6, elements: 6, radius: 0.03, density: 1000,
                material: Rigidities(shear: {shear}, axial: {axial}, bending: {bending}, twist: {twist}),
            )],
            laws: [(apply: StrainEnergy(terms: [{terms}]))],
            solver: Dynamic(duration: 1),
        )"#
    ));
    let id = deform(&mut model, Box::new(Deform { along }));
    let body = model.system.body(id);
    let element = |e| (body.sigma(e), body.rest_length(e), body.stress(e));
    let cell = |v| (body.kappa(v), body.rest_voronoi(v), body.couple(v));
    [
        (0..body.elements()).map(element).collect(),
        body.cells().map(cell).collect(),
    ]
}

/// Elastic energy and that of all terms \[J\].
fn energy([elements, cells]: &Strained) -> f64 {
    let elastic = |strain: &Vector3<f64>, rigidity: [f64; 3]| {
        (0..3)
            .map(|i| rigidity[i] * strain[i] * strain[i] / 2.0)
            .sum::<f64>()
    };
    let monomial = |powers: [i32; 4], sigma: Vector3<f64>, kappa: Vector3<f64>| {
        let sizes = [sigma.xy().norm(), sigma.z, kappa.xy().norm(), kappa.z];
        let factors = sizes.iter().zip(powers).map(|(x, power)| x.powi(power));
        factors.product::<f64>()
    };
    let mut all = 0.0;
    for (sigma, length, _) in elements {
        all += length * elastic(sigma, SHEAR_STRETCH);
        for (c, powers) in TERMS {
            if powers[2..] == [0, 0] {
                all += length * c * monomial(powers, *sigma, Vector3::zeros());
            }
        }
    }
    for (v, (kappa, length, _)) in cells.iter().enumerate() {
        all += length * elastic(kappa, BEND_TWIST);
        let sigma = (elements[v].0 + elements[v + 1].0) / 2.0;
        for (c, powers) in TERMS {
            if powers[2..] != [0, 0] {
                all += length * c * monomial(powers, sigma, *kappa);
            }
        }
    }
    all
}

#[test]
fn loads_are_the_derivative_of_the_energy() {
    let step = 1e-5;
    let [back, here, forth] = [-step, 0.0, step].map(strained);
    let change = energy(&forth) - energy(&back);
    let mut work = 0.0;
    for kind in [0, 1] {
        for ((before, now), after) in back[kind].iter().zip(&here[kind]).zip(&forth[kind]) {
            let (_, length, load) = now;
            work += length * load.dot(&(after.0 - before.0));
        }
    }
    let sizes: f64 = here.iter().flatten().map(|(_, l, n)| l * n.norm()).sum();
    println!("work {work:e} J, change of energy {change:e} J");
    assert!(
        change.abs() > 0.1 * step * sizes,
        "nothing changes: {change}"
    );
    assert!(
        (work - change).abs() < 1e-7 * change.abs(),
        "work {work}, change of energy {change}"
    );
}

#[test]
fn odd_powers_of_shear_or_curvature_are_refused() {
    for (term, words) in [
        (
            "coefficient: 1, shear: 1",
            "give an even power of 8 at most",
        ),
        ("coefficient: 1, curvature: 3", "terms[0].curvature is 3"),
        ("coefficient: 1, twist: 9", "give a power of 8 at most"),
        ("coefficient: 1", "terms[0] depends on no strain"),
    ] {
        let text = format!(
            r#"(
                title: "rod",
                rods: [(
                    name: "rod", length: 0.1, elements: 4, radius: 0.01, density: 1000,
                    material: Rigidities(shear: 80, axial: 200, bending: 2, twist: 1),
                )],
                laws: [(apply: StrainEnergy(terms: [({term})]))],
                solver: Steady(),
            )"#
        );
        let source = auxetica::config::Source::from_text("rod", &text, &[]);
        let refused = source.and_then(|source| auxetica::engine::Model::build(&source, None));
        let Err(told) = refused else {
            panic!("{term} was taken");
        };
        assert!(told.to_string().contains(words), "{told}");
    }
}
