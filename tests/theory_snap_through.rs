//! Past limit points: a shallow truss of two bars (von Mises) snaps through to the state of theory.

mod common;

use auxetica::engine::{Model, SteadySolver};
use common::{model, tip};

/// Half the span, height, and axial rigidity.
const SPAN: f64 = 1.0;
const HEIGHT: f64 = 0.1;
const RIGIDITY: f64 = 1e3;

/// One of two bars that meet at the apex, the mirror image of the other, and its share of the load, which reaches `load`
/// at time 1 and is gone at time 2.
fn truss(load: f64, branch: &str) -> (Model, SteadySolver) {
    let length = SPAN.hypot(HEIGHT);
    let mut model = model(&format!(
        r#"(
            title: "half of a shallow truss",
            rods: [(
                name: "bar", direction: ({SPAN:?}, 0, {HEIGHT:?}), normal: (0, 1, 0), length: {length:?},
                elements: 6, radius: 0.01, density: 1000,
                material: Rigidities(shear: 1e3, axial: {RIGIDITY:?}, bending: 2, twist: 2),
            )],
            boundary: [
                (apply: Hold(end: Start, position: [X, Y, Z], rotation: [Y, Z])),
                (apply: Hold(end: Tip, position: [X, Y])),
            ],
            forcing: [(apply: EndForce(
                force: (0, 0, -1), scale: Table([(0, 0), (1, {load:?}), (2, 0)]),
            ))],
            solver: Steady(branch: {branch}),
        )"#
    ));
    let options = model.solver.steady_options();
    let solver = SteadySolver::new(&mut model.system, options).unwrap();
    (model, solver)
}

/// The load that holds the apex at a height: the engine's bars give EA (1 - L0 / L).
fn load(height: f64) -> f64 {
    let (rest, length) = (SPAN.hypot(HEIGHT), SPAN.hypot(height));
    RIGIDITY * (rest / length - 1.0) * height / length
}

#[test]
fn a_shallow_truss_snaps_through_to_its_other_side() {
    let heights = (0..100_000).map(|i| HEIGHT * f64::from(i) / 1e5);
    let limit = heights.map(load).fold(0.0, f64::max);

    let (mut below, mut solver) = truss(0.999 * limit, "Followed");
    solver.advance(&mut below.system, 1.0).unwrap();
    assert!(tip(&below, "bar").z > 0.5 * HEIGHT);

    let (mut stuck, mut solver) = truss(1.001 * limit, "Followed");
    let error = solver.advance(&mut stuck.system, 1.0).unwrap_err();
    assert!(error.to_string().contains("PastLimits"), "{error}");

    for (share, branch) in [(1.001, "PastLimits"), (1.5, "PastLimits"), (1.5, "Stable")] {
        let (mut truss, mut solver) = truss(share * limit, branch);
        let report = solver.advance(&mut truss.system, 1.0).unwrap();
        let height = tip(&truss, "bar").z;
        let off = load(height) / (share * limit) - 1.0;
        println!("{share} of the limit: {height} m, load off by {off:.1e}, {report:?}");
        assert!(height < -HEIGHT && off.abs() < 1e-8, "{height}: {off:e}");
        assert!(solver.stability(&mut truss.system).unwrap().is_stable());

        solver.advance(&mut truss.system, 2.0).unwrap();
        let left = tip(&truss, "bar").z + HEIGHT;
        assert!(left.abs() < 1e-9, "{left:e} m from its mirror image");
    }
}

/// Lee's frame: a column and a beam of length 1.2 m, hinged at their far ends, loaded at a fifth of the beam, in
/// `5 fifths` elements each. The load is the time [N].
fn frame(fifth: usize, branch: &str) -> (Model, SteadySolver) {
    let rod = |name: &str, at: &str, direction: &str, length: f64, elements: usize| {
        format!(
            r#"(
                name: "the {name}", at: {{"{name}": {at}}}, direction: {direction}, normal: (0, 1, 0),
                length: {length:?}, elements: {elements}, radius: 0.01, density: 1000,
                material: Rigidities(shear: 4e4, axial: 4320, bending: {BENDING:?}, twist: {BENDING:?}),
            )"#
        )
    };
    let mut model = model(&format!(
        r#"(
            title: "Lee's frame",
            rods: [{}, {}, {}],
            boundary: [
                (on: "column", apply: Hold(end: Start, position: [X, Y, Z], rotation: [Y, Z])),
                (on: "beam", apply: Hold(end: Tip, position: [X, Y, Z])),
            ],
            joints: [
                (between: ("column", "stub.start"), apply: SpringDamper(stiffness: 1e5, rotational_stiffness: 1e3)),
                (between: ("stub", "beam.start"), apply: SpringDamper(stiffness: 1e5, rotational_stiffness: 1e3)),
            ],
            forcing: [(on: "stub", apply: EndForce(force: (0, 0, -1), scale: Table([(0, 0), (9, 9)])))],
            solver: Steady(branch: {branch}),
        )"#,
        rod("column", "(0, 0, 0)", "(0, 0, 1)", LEG, 5 * fifth),
        rod("stub", "(0, 0, 1.2)", "(1, 0, 0)", LEG / 5.0, fifth),
        rod(
            "beam",
            "(0.24, 0, 1.2)",
            "(1, 0, 0)",
            LEG * 4.0 / 5.0,
            4 * fifth
        ),
    ));
    let options = model.solver.steady_options();
    let solver = SteadySolver::new(&mut model.system, options).unwrap();
    (model, solver)
}

/// Length and bending rigidity of the frame.
const LEG: f64 = 1.2;
const BENDING: f64 = 0.144;

/// The path of the frame turns back twice: at its limit load, and below none.
#[test]
fn lees_frame_has_its_limit_load_and_is_followed_past_it() {
    let unit = BENDING / LEG.powi(2);
    let limit = |fifth: usize| {
        let (mut least, mut most) = (17.0 * unit, 22.0 * unit);
        while most - least > 1e-3 * unit {
            let load = (least + most) / 2.0;
            let (mut frame, mut solver) = frame(fifth, "Followed");
            match solver.advance(&mut frame.system, load) {
                Ok(_) => least = load,
                Err(_) => most = load,
            }
        }
        least
    };
    let limits = [8, 16].map(|fifth| limit(fifth) / unit);
    // corners don't bend, which is of first order in an element
    let extrapolated = 2.0 * limits[1] - limits[0];
    println!("limit loads {limits:?}, extrapolated {extrapolated} EI/L2");
    // of Lee, Manuel and Rossow 1968, as it is commonly quoted
    assert!((extrapolated / 18.5 - 1.0).abs() < 0.004, "{extrapolated}");

    let load = 1.1 * limits[0] * unit;
    let (mut frame, mut solver) = frame(8, "PastLimits");
    let report = solver.advance(&mut frame.system, load).unwrap();
    let loaded = tip(&frame, "stub");
    println!("past it: {loaded:?}, {report:?}");
    assert!(report.residual < 1e-6 && loaded.y.abs() < 1e-6);
    assert!(loaded.z < 0.3 * LEG, "it hasn't snapped: {loaded}");
}
