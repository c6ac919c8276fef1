//! What a job of a sweep costs beside its simulation, that the cost is linear in jobs, and what a second thread brings.
//! Each job is one steady state of a small clamped rod.

use auxetica::config::Source;
use auxetica::sweep::{Plan, Range, Shard, Store, run};
use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

const SCENARIO: &str = r#"(
    title: "small",
    rods: [(
        name: "rod", length: 0.1, elements: 10, radius: 0.01, density: 1000,
        material: Moduli(youngs: 1e6, shear: 4e5),
    )],
    boundary: [(apply: Clamp())],
    forcing: [(apply: EndForce(force: (0.01, 0, 0)))],
    solver: Steady(),
)"#;

fn plan(jobs: usize) -> Plan {
    let source = Source::from_text("bench", SCENARIO, &[]).unwrap_or_else(|e| panic!("{e}"));
    let range = format!("forcing[0].apply.force[0]=0..0.02:{jobs}");
    let range = Range::read(&range).unwrap_or_else(|e| panic!("{e}"));
    Plan::grid(&source, vec![range]).unwrap_or_else(|e| panic!("{e}"))
}

fn sweep(c: &mut Criterion) {
    let mut group = c.benchmark_group("sweep");
    group.sample_size(10);
    for (jobs, threads) in [(100, 1), (400, 1), (1600, 1), (1600, 2)] {
        let plan = plan(jobs);
        let threads = NonZeroUsize::new(threads).expect("a thread");
        let store = || {
            let folder = tempfile::tempdir().expect("a folder");
            let store = Store::open(folder.path(), &plan, Shard::ALL);
            (store.unwrap_or_else(|e| panic!("{e}")), folder)
        };
        group.throughput(Throughput::Elements(jobs as u64));
        let name = BenchmarkId::new(format!("{jobs} jobs, threads"), threads);
        group.bench_function(name, |b| {
            b.iter_batched_ref(
                store,
                |(store, _)| {
                    run(&plan, store, threads, &mut |_| ControlFlow::Continue(()))
                        .unwrap_or_else(|e| panic!("{e}"));
                },
                BatchSize::PerIteration,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, sweep);
criterion_main!(benches);
