//! What a least-squares fit of a recorded rod costs a sample on one core, each sample for itself and each from the one
//! before. The authors' descent takes 1.2 to 1.6 s a sample.

use auxetica::kinematics::table2::{RUNS, SELECTORS};
use auxetica::kinematics::{Fit, LeastSquares, Observed, Pose, Spcs};
use auxetica::recordings::{Error, PublishedTable, Recording, RobotGeometry};
use comfy_table::{CellAlignment, Table, presets};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Poses of the recorded rod at every steady sample of a run.
struct Samples {
    base_angles: Vec<f64>,
    poses: Vec<[Pose; 3]>,
    arc_lengths: [f64; 3],
}

impl Samples {
    fn read(folder: &Path) -> Result<Self, Error> {
        let geometry = RobotGeometry::default();
        let table = PublishedTable::read(folder.join("inverse_kinematics_results_spcs_n_S-2.npz"))?;
        let samples = table.samples(&Recording::read(folder)?, &geometry)?;
        let of_rod = |angles: &[f64; 4]| angles[geometry.ring_rod];
        Ok(Self {
            base_angles: samples.angles.iter().map(of_rod).collect(),
            poses: samples.rod_poses(&geometry),
            arc_lengths: samples.arc_lengths(&geometry),
        })
    }

    fn observed(&self) -> impl Iterator<Item = Observed<'_>> {
        let samples = self.base_angles.iter().zip(&self.poses);
        samples.map(|(angle, poses)| Observed {
            arc_lengths: &self.arc_lengths,
            poses,
            base_angle: Some(*angle),
        })
    }
}

/// Median time of a fit \[us\], mean number of evaluations, and fits that didn't converge; `warm` starts each at the fit
/// before.
fn cost(solver: &LeastSquares, samples: &Samples, warm: bool) -> [String; 3] {
    let mut before: Option<Fit> = None;
    let (mut times, mut evaluations, mut failed) = (Vec::new(), 0, 0);
    for sample in samples.observed() {
        let from = before.as_ref().map(|fit| fit.configuration.as_slice());
        let start = Instant::now();
        let fit = solver.fit(&sample, from.filter(|_| warm));
        times.push(start.elapsed().as_secs_f64() * 1e6);
        failed += usize::from(!fit.converged);
        evaluations += fit.evaluations;
        before = Some(fit);
    }
    times.sort_by(f64::total_cmp);
    let mean = evaluations as f64 / times.len() as f64;
    [
        format!("{:.1}", times[times.len() / 2]),
        format!("{mean:.1}"),
        failed.to_string(),
    ]
}

fn main() {
    let data = std::env::var_os("AUXETICA_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
        PathBuf::from,
    );
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_HORIZONTAL_ONLY)
        .set_header([
            "run",
            "DoF",
            "samples",
            "cold [us]",
            "evaluations",
            "failed",
            "warm [us]",
            "evaluations",
            "failed",
        ]);
    for run in RUNS {
        let folder = data.join("recordings").join(run.recording);
        let samples = match Samples::read(&folder) {
            Ok(samples) => samples,
            Err(e) => {
                eprintln!("{} is left out: {e}", run.name);
                continue;
            }
        };
        for selector in SELECTORS {
            let solver = LeastSquares::new(Spcs::uniform(selector, samples.arc_lengths[2], 2));
            let counts = [solver.rod.dof(), samples.poses.len()].map(|n| n.to_string());
            let costs = [false, true].map(|warm| cost(&solver, &samples, warm));
            let row = [run.name.to_owned()].into_iter().chain(counts);
            table.add_row(row.chain(costs.into_iter().flatten()));
        }
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    println!("median time of a fit\n{table}");
}
