//! Time that a fit takes.

mod common;

use std::time::Instant;

use auxetica_kinematics::table2::{RUNS, SELECTORS};
use auxetica_kinematics::{LeastSquares, Spcs};

use common::Steady;

#[test]
fn a_sample_takes_microseconds() {
    for run in RUNS {
        let Some(steady) = Steady::read(run.recording) else {
            return;
        };
        for selector in SELECTORS {
            let solver = LeastSquares::new(Spcs::uniform(selector, steady.arc_lengths[2], 2));
            let mut times: Vec<f64> = (steady.observed().iter())
                .map(|sample| {
                    let start = Instant::now();
                    assert!(solver.fit(sample, None).converged);
                    1e6 * start.elapsed().as_secs_f64()
                })
                .collect();
            times.sort_by(f64::total_cmp);
            let median = times[times.len() / 2];
            println!(
                "{}, {} DoF: median {median:.1} us a sample",
                run.name,
                solver.rod.dof()
            );
            assert!(cfg!(debug_assertions) || median < 50.0, "{median} us");
        }
    }
}
