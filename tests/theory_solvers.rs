//! Both solvers agree, the stability limit is that of linear theory, and threads change no bit.

mod common;

use auxetica::config::Source;
use auxetica::engine::{BlowUp, Model, ReadBody, RunError, System, stability};
use common::{model, nodes, steady};
use nalgebra::{DMatrix, SymmetricEigen, Vector3};
use std::ops::ControlFlow;
use std::path::Path;

fn run(model: &mut Model) -> Result<(), RunError> {
    let mut go_on = |_| ControlFlow::Continue(());
    model
        .run(Path::new("."), &mut go_on, &mut |_| ())
        .map(|_| ())
}

/// Largest distance between nodes of `rod` at rest by Newton's method and after the explicit run, over its length.
fn difference(steady_one: &mut Model, dynamic: &mut Model, time: f64, length: f64) -> f64 {
    steady(steady_one, time);
    run(dynamic).unwrap_or_else(|e| panic!("{e}"));
    let pairs = nodes(steady_one, "rod")
        .into_iter()
        .zip(nodes(dynamic, "rod"));
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / length
}

#[test]
fn a_cantilever_settles_where_the_steady_solver_puts_it() {
    let scenario = |solver: &str| {
        model(&format!(
            r#"(
                title: "cantilever with weight and end torque",
                rods: [(
                    name: "rod", direction: (1, 0, 0), length: 0.2, elements: 20, radius: 0.01, density: 1000,
                    material: Moduli(youngs: 1e6, shear: 3.5e5),
                )],
                boundary: [(apply: Clamp(cell: Half))],
                forcing: [(apply: Gravity()), (apply: EndTorque(torque: (0.01, 0, 0.03)))],
                damping: [(apply: LinearDamping(translational: (28, 28, 28), rotational: (1e-3, 1e-3, 1e-3)))],
                solver: {solver},
            )"#
        ))
    };
    let (mut newton, mut explicit) = (scenario("Steady()"), scenario("Dynamic(duration: 3)"));
    let difference = difference(&mut newton, &mut explicit, 0.0, 0.2);
    let end = common::tip(&newton, "rod");
    println!("cantilever: {difference:.1e} of its length; tip {end:?}");
    assert!(
        end.z < -0.02 && end.y > 0.02,
        "the loads hardly bend it: {end:?}"
    );
    assert!(difference < 1e-6, "{difference:.1e}");
}

#[test]
fn a_twisted_hsa_settles_where_the_steady_solver_puts_it() {
    let scenario = |solver: &str| {
        let sets = [
            "callbacks=[]",
            "boundary[0].apply.angle=Ramp(to: 1.5, over: 0.1)",
            "forcing=[(apply: EndForce(force: (0.02, 0, 0.5)))]",
            "damping=[(apply: LinearDamping(translational: (120, 120, 120), rotational: (0.01, 0.01, 0.01)))]",
            solver,
        ];
        Source::load(
            Path::new("scenarios/hsa_rod_8rows.ron"),
            &sets.map(String::from),
        )
        .and_then(|source| Model::build(&source, None))
        .unwrap_or_else(|problems| panic!("{problems}"))
    };
    let (mut newton, mut explicit) = (
        scenario("solver=Steady()"),
        scenario("solver=Dynamic(duration: 1)"),
    );
    let difference = difference(&mut newton, &mut explicit, 1.0, 0.1);
    let end = common::tip(&newton, "rod");
    println!("HSA: {difference:.1e} of its length; tip {end:?}");
    assert!(end.z > 0.105, "it doesn't lengthen: {end:?}");
    assert!(difference < 1e-6, "{difference:.1e}");
}

const FREE_ROD: (usize, f64, f64, f64) = (8, 0.4, 0.02, 1200.0);
const MODULI: (f64, f64) = (2e6, 7e5);

fn free_rod(solver: &str) -> Model {
    let ((n, length, radius, density), (youngs, shear)) = (FREE_ROD, MODULI);
    model(&format!(
        r#"(
            title: "free rod",
            rods: [(
                name: "rod", length: {length}, elements: {n}, radius: {radius}, density: {density},
                material: Moduli(youngs: {youngs}, shear: {shear}),
            )],
            solver: {solver},
        )"#
    ))
}

/// Largest angular frequency of masses `m` connected by springs: each takes the sum of its factors times the unknowns.
fn largest_frequency(m: &[f64], springs: &[(f64, Vec<(usize, f64)>)]) -> f64 {
    let mut k = DMatrix::<f64>::zeros(m.len(), m.len());
    for (stiffness, factors) in springs {
        for (i, a) in factors {
            for (j, b) in factors {
                k[(*i, *j)] += stiffness * a * b / (m[*i] * m[*j]).sqrt();
            }
        }
    }
    SymmetricEigen::new(k).eigenvalues.max().sqrt()
}

/// Linear vibrations of the free straight rod: stretching, twisting, and bending with shear.
fn highest_frequency() -> f64 {
    let ((n, length, radius, density), (youngs, shear)) = (FREE_ROD, MODULI);
    let l = length / n as f64;
    let area = std::f64::consts::PI * radius * radius;
    let inertia = area * radius * radius / 4.0;
    let node = |i: usize| density * area * l * if i == 0 || i == n { 0.5 } else { 1.0 };
    let nodes: Vec<f64> = (0..=n).map(node).collect();
    let between = |i: usize| vec![(i, -1.0), (i + 1, 1.0)];
    let stretch: Vec<_> = (0..n).map(|e| (youngs * area / l, between(e))).collect();
    let twist: Vec<_> = (0..n - 1)
        .map(|e| (2.0 * shear * inertia / l, between(e)))
        .collect();
    let mut bending: Vec<_> = (0..n - 1)
        .map(|e| {
            (
                youngs * inertia / l,
                vec![(n + 1 + e, -1.0), (n + 2 + e, 1.0)],
            )
        })
        .collect();
    let across = 27.0 / 28.0 * shear * area;
    bending.extend((0..n).map(|e| (across / l, vec![(e, -1.0), (e + 1, 1.0), (n + 1 + e, -l)])));
    let turning = vec![density * inertia * l; n];
    [
        largest_frequency(&nodes, &stretch),
        largest_frequency(&turning.iter().map(|j| 2.0 * j).collect::<Vec<_>>(), &twist),
        largest_frequency(&[nodes, turning].concat(), &bending),
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

#[test]
fn the_stability_limit_is_two_over_the_highest_frequency() {
    let mut model = free_rod("Dynamic(duration: 1)");
    let guess = stability::wave_time(&model.system);
    let limit = stability::limit(&mut model.system, guess);
    let theory = 2.0 / highest_frequency();
    println!(
        "limit {limit:.4e} s, 2/omega {theory:.4e} s: {:+.2} %",
        100.0 * (limit / theory - 1.0)
    );
    assert!((limit / theory - 1.0).abs() < 0.01);
}

#[test]
fn a_time_step_beyond_the_limit_is_refused_unless_asked_for() {
    let beyond = 1.1 * 2.0 / highest_frequency();
    match run(&mut free_rod(&format!(
        "Dynamic(duration: 1, dt: {beyond})"
    ))) {
        Err(RunError::Unstable { dt, limit }) => assert!(dt > limit && limit > 0.8 * beyond),
        other => panic!("{other:?}"),
    }
    // At rest nothing grows, so the run the user insists on goes through.
    let insisted = format!("Dynamic(duration: 0.01, dt: {beyond}, unstable: true)");
    run(&mut free_rod(&insisted)).unwrap_or_else(|e| panic!("{e}"));
}

/// 40 rods of 31 stations fill three groups; a plate may join rods of all of them.
fn many_rods(joined: bool) -> Model {
    let joints = if joined {
        r#"(between: ("rods", "plate"), apply: SpringDamper(stiffness: 1e3, rotational_stiffness: 0.1))"#
    } else {
        ""
    };
    let rods: Vec<String> = (0..40)
        .map(|i| format!(r#""rod_{i}": ({}, 0, 0)"#, 0.05 * i as f64))
        .collect();
    let forces: Vec<String> = (0..40)
        .map(|i| {
            format!(
                r#"(on: "rod_{i}", apply: EndForce(force: ({}, 0.01, 0)))"#,
                1e-3 * i as f64
            )
        })
        .collect();
    model(&format!(
        r#"(
            title: "many rods",
            rods: [(
                name: "rods", at: {{{}}}, length: 0.3, elements: 30, radius: 0.01, density: 1000,
                material: Moduli(youngs: 1e6, shear: 3e5),
            )],
            cylinders: [(name: "plate", centre: (1, 0, 0.31), radius: 1.1, thickness: 0.02, density: 10)],
            boundary: [(on: "rods", apply: Clamp())],
            forcing: [{}],
            joints: [{joints}],
            damping: [(on: "rods", apply: LinearDamping(translational: (1, 2, 3), rotational: (1e-3, 0, 1e-3)))],
            solver: Dynamic(duration: 1),
        )"#,
        rods.join(", "),
        forces.join(", ")
    ))
}

/// Everything that the state holds, to the bit.
fn bits(system: &System) -> Vec<Vector3<u64>> {
    let mut bits = Vec::new();
    for id in system.ids() {
        let body = system.body(*id);
        for i in 0..body.nodes() {
            bits.extend([body.position(i), body.velocity(i)].map(|v| v.map(f64::to_bits)));
        }
        for e in 0..body.directors() {
            bits.push(body.omega(e).map(f64::to_bits));
            let director = body.director(e).map(f64::to_bits);
            bits.extend(director.column_iter().map(|c| c.into_owned()));
        }
    }
    bits
}

/// Every rod's state after 200 steps taken as told, on some threads.
fn after_steps(joined: bool, threads: usize, go: impl Fn(&mut System) + Sync) -> Vec<Vector3<u64>> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("a pool");
    let mut model = many_rods(joined);
    assert!(
        model.system.stations() > 2 * 512,
        "everything is in two groups"
    );
    pool.install(|| go(&mut model.system));
    let last = model.system.find("rod_39").expect("the last rod");
    assert!(
        model.system.body(last).velocity(30).norm() > 1e-3,
        "nothing moves"
    );
    assert_eq!(model.system.steps(), 200);
    bits(&model.system)
}

fn one_by_one(system: &mut System) {
    for _ in 0..200 {
        system.step(1e-5).unwrap_or_else(|e| panic!("{e}"));
    }
}

fn at_once(system: &mut System) {
    let all = system.advance(1e-5, 200);
    all.unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn threads_change_no_bit() {
    for joined in [true, false] {
        let one = after_steps(joined, 1, one_by_one);
        assert_eq!(one, after_steps(joined, 2, one_by_one));
        assert_eq!(one, after_steps(joined, 1, at_once));
        assert_eq!(one, after_steps(joined, 2, at_once));
    }
}

#[test]
fn vector_instructions_change_no_bit() {
    let baseline = |system: &mut System| {
        system.use_baseline();
        at_once(system);
    };
    assert_eq!(
        after_steps(true, 1, baseline),
        after_steps(true, 1, one_by_one)
    );
}

#[test]
fn many_steps_at_once_blow_up_as_one_by_one() {
    let far_too_long = 2e-3;
    let failed = |go: &dyn Fn(&mut System) -> Result<(), BlowUp>| {
        let mut model = many_rods(false);
        let blow_up = go(&mut model.system).expect_err("unstable");
        (blow_up, model.system.time(), bits(&model.system))
    };
    let single = failed(&|s| (0..1000).try_for_each(|_| s.step(far_too_long)));
    assert!(single.0.step > 2, "{}", single.0);
    assert_eq!(single, failed(&|s| s.advance(far_too_long, 1000)));
}
