//! Implicit steps: order, vibrations, rest, and the explicit run at far fewer steps.

mod common;

use auxetica::config::Source;
use auxetica::engine::{
    Body, Damping, Forcing, ImplicitOptions, ImplicitSolver, LoadView, Model, Moment, NoStep,
    RateView, ReadBody,
};
use common::{model, nodes, tip};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::path::Path;

fn precise(spectral_radius: f64) -> ImplicitOptions {
    ImplicitOptions {
        spectral_radius,
        tolerance: 1e-11,
        ..ImplicitOptions::default()
    }
}

fn solver(model: &mut Model, options: ImplicitOptions) -> ImplicitSolver {
    ImplicitSolver::new(&mut model.system, options).unwrap_or_else(|e| panic!("{e}"))
}

/// Takes `count` steps to `time` \[s\] from 0.
fn steps(model: &mut Model, options: ImplicitOptions, time: f64, count: usize) {
    let mut solver = solver(model, options);
    for step in 1..=count {
        let to = time * step as f64 / count as f64;
        let moved = solver.advance(&mut model.system, to);
        moved.unwrap_or_else(|e| panic!("{e}"));
    }
}

fn off(a: &[Vector3<f64>], b: &[Vector3<f64>]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// A cantilever of 0.5 m that a growing force at its tip bends, twists and lets swing far.
fn swinging() -> Model {
    model(
        r#"(
            title: "swinging cantilever",
            rods: [(
                name: "rod", direction: (1, 0, 0), length: 0.5, elements: 10, radius: 0.01, density: 1000,
                material: Moduli(youngs: 1e6, shear: 4e5),
            )],
            boundary: [(apply: Clamp())],
            forcing: [
                (apply: EndForce(force: (0, 0.05, -0.1), scale: Ramp(to: 1, over: 0.4))),
                (apply: EndTorque(torque: (0, 0, 0.005), scale: Ramp(to: 1, over: 0.4))),
            ],
            solver: Dynamic(duration: 1),
        )"#,
    )
}

#[test]
fn steps_are_of_second_order_and_lead_where_explicit_ones_do() {
    const TIME: f64 = 0.4;
    let mut explicit = swinging();
    let count = 40_000;
    let advanced = explicit.system.advance(TIME / count as f64, count);
    advanced.unwrap_or_else(|e| panic!("{e}"));
    let exact = nodes(&explicit, "rod");
    let moved = off(&exact, &nodes(&swinging(), "rod"));
    assert!(moved > 0.05, "it hardly swings: {moved}");
    for radius in [0.5, 0.8, 1.0] {
        let errors = [100, 200, 400].map(|count| {
            let mut model = swinging();
            steps(&mut model, precise(radius), TIME, count);
            off(&nodes(&model, "rod"), &exact)
        });
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            println!(
                "radius {radius}: {:.2e} -> {:.2e} m, order {order:.3}",
                pair[0], pair[1]
            );
            assert!((1.8..2.2).contains(&order), "{order}");
        }
        assert!(errors[2] < 1e-3 * moved, "{}", errors[2]);
    }
}

/// Youngs modulus, density, radius and length of a slender cantilever.
const SLENDER: (f64, f64, f64, f64) = (1e7, 1000.0, 0.005, 0.5);

/// It is let go from a small bend; returns how much there is of the first mode after each of `count` steps.
fn vibrating(radius: f64, dt: f64, count: usize) -> Vec<f64> {
    let (youngs, density, section, length) = SLENDER;
    let mut model = model(&format!(
        r#"(
            title: "vibrating cantilever",
            rods: [(
                name: "rod", direction: (1, 0, 0), length: {length}, elements: 20, radius: {section}, density: {density},
                material: Moduli(youngs: {youngs}, shear: 4e6),
            )],
            boundary: [(apply: Clamp(cell: Half))],
            forcing: [(apply: EndForce(force: (0, 0, 1e-4), scale: Table([(0, 1), (1e-9, 0)])))],
            solver: Steady(),
        )"#
    ));
    common::steady(&mut model, 0.0);
    model.system.set_time(1e-9);
    let mut solver = solver(&mut model, precise(radius));
    let mut heights = Vec::new();
    for step in 1..=count {
        let moved = solver.advance(&mut model.system, 1e-9 + dt * step as f64);
        moved.unwrap_or_else(|e| panic!("{e}"));
        heights.push(first_mode(&nodes(&model, "rod")));
    }
    heights
}

/// Root of the cantilever's frequency equation `cos x cosh x = -1`.
const ROOT: f64 = 1.875_104_068_711_961;

/// Share that deflections along z have of a cantilever's first mode, which others have none of.
fn first_mode(nodes: &[Vector3<f64>]) -> f64 {
    let last = nodes.len() - 1;
    let ratio = (ROOT.sinh() - ROOT.sin()) / (ROOT.cosh() + ROOT.cos());
    let share = |(i, node): (usize, &Vector3<f64>)| {
        let x = ROOT * i as f64 / last as f64;
        let mode = x.cosh() - x.cos() - ratio * (x.sinh() - x.sin());
        let mass = if i == last { 0.5 } else { 1.0 };
        mass * mode * node.z
    };
    nodes.iter().enumerate().map(share).sum()
}

/// First angular frequency by Euler and Bernoulli.
fn first_frequency() -> f64 {
    let (youngs, density, section, length) = SLENDER;
    let speed = youngs * section.powi(2) / 4.0 / density;
    ROOT.powi(2) * speed.sqrt() / length.powi(2)
}

/// Times of the falling zeros of samples that are `dt` apart, the first at `dt`.
fn falls(heights: &[f64], dt: f64) -> Vec<f64> {
    let pairs = heights.windows(2).enumerate();
    let falling = pairs.filter(|(_, w)| w[0] > 0.0 && w[1] <= 0.0);
    falling
        .map(|(i, w)| dt * (i as f64 + 1.0 + w[0] / (w[0] - w[1])))
        .collect()
}

#[test]
fn a_cantilever_vibrates_at_its_first_frequency() {
    let omega = first_frequency();
    let dt = TAU / omega / 400.0;
    let zeros = falls(&vibrating(0.5, dt, 10 * 400), dt);
    let periods = (zeros.len() - 1) as f64;
    let found = TAU * periods / (zeros[zeros.len() - 1] - zeros[0]);
    let error = found / omega - 1.0;
    println!("first frequency {found:.4} rad/s, {error:+.2e} from Euler and Bernoulli");
    // 20 elements, shear and rotary inertia
    assert!(periods > 7.0 && error.abs() < 3e-3, "{error}");
}

/// Decay a step of an oscillator that turns by `phase` a step (Chung and Hulbert 1993).
fn decay(radius: f64, phase: f64) -> f64 {
    let m = (2.0 * radius - 1.0) / (radius + 1.0);
    let f = radius / (radius + 1.0);
    let gamma = 0.5 - m + f;
    let beta = (gamma + 0.5_f64).powi(2) / 4.0;
    let square = phase * phase;
    let (mut x, mut v, mut a) = (1.0, 0.0, -square);
    let mut course = Vec::new();
    for _ in 0..(20.0 * TAU / phase) as usize {
        let ahead = x + v + (0.5 - beta) * a;
        // (1 - m) a' + m a = -square ((1 - f) x' + f x)
        let next =
            -(m * a + square * ((1.0 - f) * ahead + f * x)) / (1.0 - m + square * (1.0 - f) * beta);
        x = ahead + beta * next;
        v += (1.0 - gamma) * a + gamma * next;
        a = next;
        course.push(x);
    }
    decay_of(&course, phase)
}

/// Decay a step from the largest of the first and of the last periods.
fn decay_of(heights: &[f64], phase: f64) -> f64 {
    let period = (TAU / phase).ceil() as usize;
    let largest = |range: &[f64]| {
        let top = (1..range.len() - 1)
            .max_by(|a, b| range[*a].total_cmp(&range[*b]))
            .expect("samples");
        let (l, m, r) = (range[top - 1], range[top], range[top + 1]);
        // the parabola's top
        (top, m + (l - r).powi(2) / (8.0 * (2.0 * m - l - r)))
    };
    let count = heights.len();
    let (early, late) = (
        &heights[period..2 * period + 2],
        &heights[count - period - 2..],
    );
    let ((i, a), (j, b)) = (largest(early), largest(late));
    let apart = (count - period - 2 + j) - (period + i);
    (b / a).powf(1.0 / apart as f64)
}

#[test]
fn vibrations_decay_as_the_spectral_radius_says() {
    let phase = TAU / 50.0;
    let dt = phase / first_frequency();
    for radius in [0.0, 0.5, 0.8, 1.0] {
        let heights = vibrating(radius, dt, 1000);
        let (found, wanted) = (decay_of(&heights, phase), decay(radius, phase));
        let loss = [found, wanted].map(|d| 1.0 - d);
        println!(
            "radius {radius}: loss a step {:.3e}, by theory {:.3e}",
            loss[0], loss[1]
        );
        assert!(
            (loss[0] - loss[1]).abs() < 0.02 * loss[1] + 1e-7,
            "{loss:?}"
        );
    }
}

/// The recorded robot while its motors turn within 2 s.
fn robot(solver: &str, angles: [f64; 4]) -> Model {
    let table = |angle: f64| format!("[(0, 0), (2, {angle:?})]");
    let sets: Vec<String> = (0..4)
        .map(|i| format!("boundary[{i}].apply.angle=Table({})", table(angles[i])))
        .chain([format!("solver={solver}"), "callbacks=[]".into()])
        .collect();
    Source::load(Path::new("scenarios/hsa_robot_recorded.ron"), &sets)
        .and_then(|source| Model::build(&source, None))
        .unwrap_or_else(|problems| panic!("{problems}"))
}

const ANGLES: [f64; 4] = [2.0, -0.5, 1.0, -1.5];

#[test]
fn a_robot_comes_to_rest_where_the_steady_solver_puts_it() {
    let (mut moved, mut rest) = (robot("Steady()", ANGLES), robot("Steady()", ANGLES));
    steps(&mut moved, ImplicitOptions::default(), 10.0, 200);
    common::steady(&mut rest, 2.0);
    for body in ["platform", "rod_1", "rod_3"] {
        let off = off(&nodes(&moved, body), &nodes(&rest, body)) / 0.0599;
        println!("{body}: {off:.1e} of a rod's length");
        assert!(off < 1e-8, "{body}: {off:.1e}");
    }
}

#[test]
fn a_robot_in_motion_is_that_of_the_explicit_run() {
    let mut explicit = robot("Dynamic(duration: 2)", ANGLES);
    let dt = explicit.time_step().unwrap_or_else(|e| panic!("{e}")).dt;
    let count = (0.2 / dt).ceil() as u64;
    let mut course = |_| {
        let advanced = explicit.system.advance(0.2 / count as f64, count);
        advanced.unwrap_or_else(|e| panic!("{e}"));
        nodes(&explicit, "platform")
    };
    let exact: Vec<_> = (0..10).map(&mut course).collect();
    let way = off(&exact[9], &nodes(&robot("Steady()", ANGLES), "platform"));
    for (each, bound) in [(10, 1e-5), (100, 1e-6)] {
        let mut implicit = robot("Steady()", ANGLES);
        let mut solver = solver(&mut implicit, ImplicitOptions::default());
        let mut worst = 0.0_f64;
        for (i, exact) in exact.iter().enumerate() {
            for step in 1..=each {
                let time = 0.2 * (i as f64 + f64::from(step) / f64::from(each));
                let moved = solver.advance(&mut implicit.system, time);
                moved.unwrap_or_else(|e| panic!("{e}"));
            }
            worst = worst.max(off(&nodes(&implicit, "platform"), exact));
        }
        println!("{each} steps for {count}: {worst:.2e} m of {way:.3} m");
        assert!(worst < bound, "{worst:e}");
    }
}

#[test]
fn damping_is_what_its_coefficient_says() {
    let errors = [10, 20, 40].map(|count| {
        let mut model = model(
            r#"(
                title: "a body slows down",
                cylinders: [(name: "body", centre: (0, 0, 0), radius: 0.1, thickness: 0.1, density: 100)],
                forcing: [(apply: Gravity(g: (0, 0, -1)))],
                damping: [(apply: LinearDamping(translational: (2, 2, 2), rotational: (0, 0, 0)))],
                solver: Dynamic(duration: 1),
            )"#,
        );
        steps(&mut model, precise(0.5), 1.0, count);
        let id = model.system.find("body").expect("the body");
        let exact = -(1.0 - (-2.0_f64).exp()) / 2.0;
        (model.system.body(id).velocity(0).z - exact).abs()
    });
    println!("velocity off by {errors:?} m/s");
    assert!(errors[2] < 2e-4);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.9..2.2).contains(&order), "order {order}");
    }
}

#[test]
fn threads_change_no_bit() {
    let rods: Vec<String> = (0..40)
        .map(|i| format!(r#""rod_{i}": ({i}, 0, 0)"#))
        .collect();
    let run = |threads: usize| {
        let mut model = model(&format!(
            r#"(
                title: "many rods",
                rods: [(
                    name: "rods", at: {{{}}}, length: 0.3, elements: 30, radius: 0.01, density: 1000,
                    material: Moduli(youngs: 1e6, shear: 3e5),
                )],
                boundary: [(apply: Clamp())],
                forcing: [(apply: EndForce(force: (0.02, 0.01, 0)))],
                damping: [(apply: LinearDamping(translational: (1, 2, 3), rotational: (1e-3, 0, 1e-3)))],
                solver: Dynamic(duration: 1),
            )"#,
            rods.join(", ")
        ));
        assert!(model.system.stations() > 2 * 512);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool")
            .install(|| steps(&mut model, ImplicitOptions::default(), 0.1, 5));
        let bits = |v: &Vector3<f64>| v.map(f64::to_bits);
        nodes(&model, "rod_39").iter().map(bits).collect::<Vec<_>>()
    };
    assert_eq!(run(1), run(2));
}

/// A force that is no number from a time on.
struct Breaks(f64);

impl Forcing for Breaks {
    fn apply(&self, now: &Moment<'_>, body: &mut LoadView<'_>) {
        if now.time > self.0 {
            body.add_force(3, Vector3::repeat(f64::NAN));
        }
    }
}

#[test]
fn where_no_step_leads_on_is_told() {
    let mut model = swinging();
    let id = model.system.find("rod").expect("the rod");
    let added = model
        .system
        .add_forcing(id, "the broken force", Box::new(Breaks(0.05)));
    added.expect("a force");
    let mut solver = solver(&mut model, ImplicitOptions::default());
    let failed: NoStep = (1..100)
        .find_map(|step| {
            let moved = solver.advance(&mut model.system, 0.01 * f64::from(step));
            moved.err()
        })
        .expect("the force is no number");
    assert!((failed.time - 0.05).abs() < 1e-6, "{failed}");
    assert!(failed.to_string().contains("the broken force"), "{failed}");
    assert!((model.system.time() - failed.time).abs() < 1e-12);
    assert!(tip(&model, "rod").iter().all(|x| x.is_finite()));
}

/// Drag with the square of the speed, from a plugin's point of view.
struct Drag;

impl Damping for Drag {
    fn damp(&self, dt: f64, body: &mut RateView<'_>) {
        let v = body.velocity(0);
        body.set_velocity(0, v / (1.0 + v.norm() * dt));
    }
}

#[test]
fn nonlinear_damping_needs_no_derivative_either() {
    let mut model = model(
        r#"(
            title: "a falling body",
            cylinders: [(name: "body", centre: (0, 0, 0), radius: 0.1, thickness: 0.1, density: 100)],
            forcing: [(apply: Gravity(g: (0, 0, -4)))],
            solver: Dynamic(duration: 1),
        )"#,
    );
    let id = model.system.find("body").expect("the body");
    let added = model.system.add_damping(id, "drag", Box::new(Drag));
    added.expect("a damping");
    steps(&mut model, ImplicitOptions::default(), 5.0, 500);
    // it falls as fast as drag balances weight: v^2 = g
    let body: Body<'_> = model.system.body(id);
    assert!(
        (body.velocity(0).z + 2.0).abs() < 1e-6,
        "{}",
        body.velocity(0)
    );
}
