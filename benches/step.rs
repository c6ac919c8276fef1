//! What a step costs: by element, by thread, by size, and for the paper's robot with all that acts on it.
//!
//! The table at first gives least times of many tries, which other work on the machine hardly changes; criterion's
//! figures follow.

mod robot;

use auxetica::config::Source;
use auxetica::engine::{
    ImplicitOptions, ImplicitSolver, Inputs, Model, MotionSensitivities, Series,
};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use robot::{NUMBERS, scenario};
use std::time::{Duration, Instant};

/// Rods of 1 cm an element, clamped, damped, with a force at the tip.
fn rods(rods: usize, elements: usize) -> Model {
    let at: String = (0..rods)
        .map(|i| format!("\"rod_{i}\": ({i}, 0, 0),"))
        .collect();
    let length = elements as f64 * 0.01;
    let text = format!(
        r#"(
            title: "rods",
            rods: [(
                name: "rods", at: {{{at}}}, length: {length:?}, elements: {elements}, radius: 0.01, density: 1000,
                material: Moduli(youngs: 1e7, shear: 4e6),
            )],
            boundary: [(apply: Clamp())],
            forcing: [(apply: EndForce(force: (0.1, 0, 0)))],
            damping: [(apply: LinearDamping(translational: (10, 10, 10), rotational: (1e-2, 1e-2, 1e-2)))],
            solver: Dynamic(duration: 1, dt: 1e-5),
        )"#
    );
    let source = Source::from_text("rods.ron", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
    Model::build(&source, None).unwrap_or_else(|e| panic!("{e}"))
}

/// Inputs that turn the robot's motors.
fn inputs() -> Inputs {
    let motor = |(i, handed): (usize, f64)| {
        let series = Series::new(vec![0.0, 1e3], vec![0.0, handed * 3.1]);
        (format!("motor_{}", i + 1), series.expect("two points"))
    };
    let motors = [1.0, -1.0, 1.0, -1.0].into_iter().enumerate().map(motor);
    Inputs::new(motors.collect())
}

/// The paper's robot while its motors turn.
fn robot() -> Model {
    Model::build(&scenario(), Some(inputs())).unwrap_or_else(|e| panic!("{e}"))
}

fn advance(model: &mut Model, count: u64) {
    let stepped = model.system.advance(1e-5, count);
    stepped.unwrap_or_else(|e| panic!("{e}"));
}

/// Least time of a step \[s\] over tries of `count` steps for 2 s.
fn least(model: &mut Model, count: u64) -> f64 {
    advance(model, count);
    let begin = Instant::now();
    let mut least = f64::INFINITY;
    while begin.elapsed() < Duration::from_secs(2) {
        let start = Instant::now();
        advance(model, count);
        least = least.min(start.elapsed().as_secs_f64() / count as f64);
    }
    least
}

fn threads(count: usize) -> rayon::ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    pool.expect("a pool of threads")
}

/// Prints the least time of an element-step.
fn report(what: &str, model: &mut Model, steps: u64) {
    let time = least(model, steps) / model.system.elements() as f64;
    println!("{what:50} {:8.2} ns an element-step", time * 1e9);
}

fn table(_: &mut Criterion) {
    report("1 rod of 1000", &mut rods(1, 1000), 10);
    let mut baseline = rods(1, 1000);
    baseline.system.use_baseline();
    report("1 rod of 1000, baseline instructions", &mut baseline, 10);
    for count in [1, 2] {
        let what = format!("100 rods of 50, {count} threads");
        threads(count).install(|| report(&what, &mut rods(100, 50), 20));
    }
    threads(1).install(|| {
        for count in [1, 10, 100, 1000, 10_000] {
            let what = format!("{count} rods of 100, 1 thread");
            let steps = (2000 / count as u64).clamp(16, 100);
            report(&what, &mut rods(count, 100), steps);
        }
        // several steps at once, as all others take
        report("1 rod of 1000000", &mut rods(1, 1_000_000), 4);
    });
    let mut model = None;
    let memory = allocation_counter::measure(|| model = Some(rods(1, 100_000)));
    println!("{} bytes an element", memory.bytes_current / 100_000);
    drop(model);
    let time = least(&mut robot(), 10);
    println!("the paper's robot {:.3} us a step", time * 1e6);
    println!("the same, implicit {:.3} us a step", implicit(&[]) * 1e6);
    let time = threads(1).install(|| implicit(&NUMBERS));
    println!("the same with ten derivatives {:.3} us a step", time * 1e6);
}

/// Mean time of an implicit step of 0.02 s of the robot while its motors turn, with derivatives by some numbers \[s\].
fn implicit(numbers: &[&str]) -> f64 {
    const STEPS: u32 = 2000;
    let mut model = robot();
    let options = ImplicitOptions::default();
    let mut solver = ImplicitSolver::new(&mut model.system, options).expect("a robot");
    let sensitivities = MotionSensitivities::new(&solver, &scenario(), Some(&inputs()), numbers);
    let mut sensitivities = sensitivities.unwrap_or_else(|e| panic!("{e}"));
    let start = Instant::now();
    for step in 1..=STEPS {
        let (system, time) = (&mut model.system, 0.02 * f64::from(step));
        let moved = if numbers.is_empty() {
            solver.advance(system, time)
        } else {
            sensitivities.advance(&mut solver, system, time)
        };
        moved.unwrap_or_else(|e| panic!("{e}"));
    }
    start.elapsed().as_secs_f64() / f64::from(STEPS)
}

fn step(c: &mut Criterion) {
    let mut group = c.benchmark_group("element-step");
    for (count, elements, steps) in [(1, 1000, 100), (100, 50, 20)] {
        let mut model = rods(count, elements);
        group.throughput(Throughput::Elements((count * elements) as u64 * steps));
        let id = BenchmarkId::new("rods", format!("{count} x {elements}"));
        group.bench_function(id, |b| b.iter(|| advance(&mut model, steps)));
    }
    group.finish();
    let mut group = c.benchmark_group("step");
    group.throughput(Throughput::Elements(100));
    let mut model = robot();
    group.bench_function("robot", |b| b.iter(|| advance(&mut model, 100)));
    group.finish();
}

criterion_group!(benches, table, step);
criterion_main!(benches);
