//! Stability of steady states: columns past Euler's load, the paper's robot in full twist, and its frequency.

mod common;

use auxetica::config::Source;
use auxetica::engine::{
    Branch, Inputs, Model, ReadBody, Series, Stability, SteadyOptions, SteadySolver,
};
use common::{model, tip};
use std::f64::consts::PI;
use std::path::Path;

/// A slender clamped column of bending rigidity 1, length 1 and mass 1, pressed by shares of Euler's load over time, and
/// pushed aside until time 1, from 2 on hardly.
fn column(shares: &[f64], aside: f64) -> (Model, SteadySolver) {
    let euler = PI.powi(2) / 4.0;
    let course: Vec<String> = (shares.iter().enumerate())
        .map(|(i, share)| format!("({i}, {:?})", share * euler))
        .collect();
    // a little is left, or a bent column could turn about its axis without resistance
    let left = aside / 50.0;
    let density = 1.0 / (PI * 0.005_f64.powi(2));
    let mut model = model(&format!(
        r#"(
            title: "column",
            rods: [(
                name: "rod", length: 1, elements: 30, radius: 0.005, density: {density:?},
                material: Rigidities(shear: 1e6, axial: 1e6, bending: 1, twist: 1),
            )],
            boundary: [(apply: Clamp(cell: Half))],
            forcing: [
                (apply: EndForce(force: (0, 0, -1), scale: Table([{}]))),
                (apply: EndForce(force: (1, 0, 0), scale: Table([(0, {aside:?}), (1, {aside:?}), (2, {left:?})]))),
            ],
            solver: Steady(),
        )"#,
        course.join(", ")
    ));
    let solver = SteadySolver::new(&mut model.system, SteadyOptions::default()).unwrap();
    (model, solver)
}

fn stability(model: &mut Model, solver: &mut SteadySolver, time: f64) -> Stability {
    let found = solver.advance(&mut model.system, time);
    found.unwrap_or_else(|e| panic!("{e}"));
    solver.stability(&mut model.system).unwrap()
}

#[test]
fn an_upright_column_is_unstable_beyond_eulers_load_and_a_bent_one_stable() {
    let (mut upright, mut solver) = column(&[0.0, 0.99, 1.01, 1.2], 0.0);
    let squares: Vec<f64> = (0..4)
        .map(|time| stability(&mut upright, &mut solver, f64::from(time)).least)
        .collect();
    println!("upright: least eigenvalues {squares:?} 1/s2");
    // unloaded: a cantilever's first frequency, 1.8751^2 for these numbers
    let unloaded = squares[0].sqrt() / 1.875_104_068_711_961_f64.powi(2) - 1.0;
    assert!(unloaded.abs() < 2e-3, "{unloaded}");
    assert!(squares[1] > 0.0 && squares[2] < 0.0 && squares[3] < squares[2]);

    let (mut bent, mut solver) = column(&[0.0, 1.2, 1.2], 0.05);
    stability(&mut bent, &mut solver, 1.0);
    let left_alone = stability(&mut bent, &mut solver, 2.0);
    assert!(left_alone.least > 1e-4, "{left_alone:?}");
    assert!(tip(&bent, "rod").x > 0.1, "it isn't bent");
    println!("bent: {left_alone:?}");
}

/// The paper's robot, its motors turned to `waypoints` at 1, 2, .. s.
fn robot(waypoints: &[[f64; 4]]) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot.ron");
    let source = Source::load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
    let motor = |i: usize| {
        let times = (0..=waypoints.len()).map(|t| t as f64).collect();
        let angles = std::iter::once(0.0).chain(waypoints.iter().map(|w| w[i]));
        let series = Series::new(times, angles.collect()).expect("points");
        (format!("motor_{}", i + 1), series)
    };
    let inputs = Inputs::new((0..4).map(motor).collect());
    Model::build(&source, Some(inputs)).unwrap_or_else(|e| panic!("{e}"))
}

/// Stability after the last of some waypoints.
fn at_last(waypoints: &[[f64; 4]]) -> Stability {
    let mut model = robot(waypoints);
    let mut solver = SteadySolver::new(&mut model.system, SteadyOptions::default()).unwrap();
    let each = (1..=waypoints.len()).map(|t| stability(&mut model, &mut solver, t as f64));
    each.last().expect("a waypoint")
}

#[test]
fn the_papers_robot_is_unstable_upright_in_full_twist_and_stable_leaning() {
    let u = 179.9_f64.to_radians();
    let twist = |share: f64| [share * u, 0.0, share * u, 0.0];
    let squares = [0.25, 0.5, 0.7, 1.0].map(|share| at_last(&[twist(share)]).least);
    println!("upright at 0.25, 0.5, 0.7, 1 of the angle: {squares:?} 1/s2");
    assert!(squares[0] > 0.0 && squares[1] > 0.0, "{squares:?}");
    assert!(squares[2] < 0.0 && squares[3] < 0.0, "{squares:?}");
    let leaning = at_last(&[[0.0, -0.2 * u, 0.2 * u, 0.0], twist(1.0)]);
    println!("leaning: {leaning:?}");
    assert!(leaning.is_stable());

    // let go, it finds that one itself
    let mut let_go = robot(&[twist(1.0)]);
    let options = SteadyOptions {
        branch: Branch::Stable,
        ..SteadyOptions::default()
    };
    let mut solver = SteadySolver::new(&mut let_go.system, options).unwrap();
    let report = solver.advance(&mut let_go.system, 1.0).unwrap();
    let found = solver.stability(&mut let_go.system).unwrap();
    let platform = let_go
        .system
        .body(let_go.system.find("platform").expect("a platform"));
    let lean = platform.director(0)[(2, 2)].acos().to_degrees();
    println!("let go: {found:?}, leaning by {lean:.2} degrees; {report:?}");
    assert!(report.settled > 0);
    assert!((found.least / leaning.least - 1.0).abs() < 1e-6);
    assert!((lean - 16.8).abs() < 0.05, "{lean}");
}
