//! Every shipped scenario loads, builds and solves its first steady state, or 50 steps of a run through time.

mod common;

use auxetica::config::Source;
use auxetica::engine::scenario::Solver;
use auxetica::engine::{ImplicitSolver, Model};
use std::path::Path;

const STEPS: usize = 50;

fn solve(file: &Path) -> Result<(), String> {
    let source = Source::load(file, &[]).map_err(|e| e.to_string())?;
    let mut model = Model::build(&source, None).map_err(|e| e.to_string())?;
    match model.solver.clone() {
        Solver::Steady { at, .. } => {
            let first = at
                .first()
                .map(|t| **t)
                .or(model.dwells.first().map(|dwell| dwell.time));
            common::steady(&mut model, first.unwrap_or(0.0));
        }
        Solver::Implicit { dt, .. } => {
            let options = model.solver.implicit_options();
            let mut solver =
                ImplicitSolver::new(&mut model.system, options).map_err(|e| e.to_string())?;
            for step in 1..=STEPS {
                let time = step as f64 * *dt;
                let moved = solver.advance(&mut model.system, time);
                moved.map_err(|e| e.to_string())?;
            }
        }
        Solver::Dynamic { .. } => {
            let dt = model.time_step().map_err(|e| e.to_string())?.dt;
            model.system.apply_boundaries();
            for _ in 0..STEPS {
                model.system.step(dt).map_err(|e| e.to_string())?;
            }
        }
    }
    Ok(())
}

#[test]
fn every_scenario_solves() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
    let entries = std::fs::read_dir(folder).expect("the scenarios are there");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("a file").path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "ron"));
    files.sort();
    assert!(files.len() >= 8, "only {} scenarios", files.len());
    let problems: Vec<String> = files
        .iter()
        .filter_map(|file| {
            let problem = solve(file).err()?;
            Some(format!("{}: {problem}", file.display()))
        })
        .collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
