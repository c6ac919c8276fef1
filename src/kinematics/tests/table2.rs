//! Table II of the paper.

mod common;

use auxetica_kinematics::table2::{RUNS, reproduce};
use common::Steady;

#[test]
fn full_table() {
    for run in RUNS {
        let Some(steady) = Steady::read(run.recording) else {
            return;
        };
        let start = std::time::Instant::now();
        let rows = reproduce(&steady.base_angles, &steady.poses, &steady.arc_lengths);
        println!("{} {:.1} s", run.name, start.elapsed().as_secs_f64());
        for (row, printed) in rows.iter().zip(&run.printed) {
            for (name, m) in [
                ("printed", printed),
                ("descent", &row.descent),
                ("optimum", &row.optimum),
                ("measured", &row.optimum_measured),
            ] {
                println!(
                    "  {:>2} {name:9} {:.4} {:.5} {:.5} {:.5} {:.5}",
                    row.dof,
                    1e3 * m.position,
                    m.quaternion,
                    m.euler.x,
                    m.euler.y,
                    m.euler.z
                );
            }
        }
    }
}
