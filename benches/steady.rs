//! What the paper's robot costs: its 100 steady states in elongation, and one state from rest.
//! The authors' simulator takes about 275 s for each of these states (15 s at 4e-5 s a step, one run to rest).

use auxetica::config::Source;
use auxetica::engine::{Inputs, Model, Series, SteadyOptions, SteadySolver};
use criterion::{BatchSize, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use std::path::Path;
use std::time::{Duration, Instant};

/// The authors' largest motor angle [rad].
const MOST: f64 = 3.139_846_324_338_117;
/// The authors' samples.
const STATES: usize = 100;

/// The robot with all rods wound up to `angle` over 1 s.
fn robot(angle: f64) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot.ron");
    let source = Source::load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
    let motor = |(i, handed): (usize, f64)| {
        let series = Series::new(vec![0.0, 1.0], vec![0.0, handed * angle]);
        (format!("motor_{}", i + 1), series.expect("two points"))
    };
    let motors = [1.0, -1.0, 1.0, -1.0].into_iter().enumerate().map(motor);
    Model::build(&source, Some(Inputs::new(motors.collect()))).unwrap_or_else(|e| panic!("{e}"))
}

/// Follows the steady states at `times` and counts Newton iterations.
fn follow(model: &mut Model, times: impl Iterator<Item = f64>) -> usize {
    let mut solver = SteadySolver::new(&mut model.system, SteadyOptions::default())
        .unwrap_or_else(|e| panic!("{e}"));
    let mut state = |time| {
        let report = solver.advance(&mut model.system, time);
        report.unwrap_or_else(|e| panic!("{e}")).iterations
    };
    times.map(&mut state).sum()
}

fn samples() -> impl Iterator<Item = f64> {
    (0..STATES).map(|k| k as f64 / (STATES - 1) as f64)
}

fn steady(c: &mut Criterion) {
    let mut group = c.benchmark_group("steady");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.measurement_time(Duration::from_secs(5));

    let start = Instant::now();
    let iterations = follow(&mut robot(MOST), samples());
    println!(
        "{STATES} steady states in elongation, scenario read included: {:.2} s, {iterations} Newton iterations",
        start.elapsed().as_secs_f64()
    );
    group.throughput(Throughput::Elements(STATES as u64));
    group.bench_function("100 states in elongation", |b| {
        b.iter_batched_ref(
            || robot(MOST),
            |m| follow(m, samples()),
            BatchSize::PerIteration,
        );
    });
    group.throughput(Throughput::Elements(1));
    group.bench_function("one state from rest", |b| {
        let once = |m: &mut Model| follow(m, std::iter::once(1.0));
        b.iter_batched_ref(|| robot(MOST), once, BatchSize::PerIteration);
    });
    group.finish();
}

criterion_group!(benches, steady);
criterion_main!(benches);
