//! `auxetica run`

use super::progress::Meter;
use super::states::States;
use super::{Failure, ScenarioArgs, print, write_whole};
use crate::config::Source;
use crate::engine::scenario::Watcher;
use crate::engine::{Body, Callback, CallbackError, Model, RunError, Snapshot, Summary};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(super) struct Options {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Folder for results; by default `out/` and the scenario's name.
    #[arg(long)]
    out: Option<PathBuf>,
}

pub(super) fn run(options: &Options, quiet: bool) -> Result<(), Failure> {
    let source = options.scenario.load()?;
    let mut model = Model::build(&source, None)?;
    let out = options.out.clone().unwrap_or_else(|| {
        let stem = options.scenario.scenario.file_stem().unwrap_or_default();
        PathBuf::from("out").join(stem)
    });
    if !model.watchers.is_empty() || options.out.is_some() {
        // The resolved text stands alone: whoever finds the results can make them again.
        let keeper = Watcher {
            name: "scenario".into(),
            every: f64::INFINITY,
            bodies: Vec::new(),
            callback: Box::new(KeepScenario(source.text().to_owned())),
        };
        model.watchers.insert(0, keeper);
    }
    let mut states = States::new(&model);
    let mut meter = Meter::new("solving", quiet);
    let summary = {
        let outcome = model.run(&out, &mut |done| meter.update(done), &mut |model| {
            states.push(model);
        });
        drop(meter);
        outcome.map_err(|e| at_its_place(e, &source))?
    };
    print(&format!("{}\n", model.title))?;
    print(&states.table())?;
    print(&describe(&summary))?;
    for file in &summary.files {
        print(&format!("written: {}", file.display()))?;
    }
    Ok(())
}

/// Writes the scenario beside its results.
struct KeepScenario(String);

impl Callback for KeepScenario {
    fn start(&mut self, out: &Path, _bodies: &[Body<'_>]) -> Result<(), CallbackError> {
        let path = out.join("scenario.ron");
        std::fs::create_dir_all(out)
            .map_err(|source| Failure::output(out, source))
            .and_then(|()| write_whole(&path, &self.0))
            .map_err(|failure| CallbackError {
                what: "keeping the scenario".into(),
                source: failure.into(),
            })
    }

    fn record(&mut self, _snapshot: &Snapshot<'_>) -> Result<(), CallbackError> {
        Ok(())
    }
}

/// A time step that is too long is a problem of the scenario.
fn at_its_place(error: RunError, source: &Source) -> Failure {
    let RunError::Unstable { .. } = error else {
        return error.into();
    };
    let message = error.to_string();
    let (what, remedy) = message.split_once("; ").unwrap_or((&message, ""));
    let problem = source.problem("solver.dt", what).with_hint(remedy);
    Failure::Scenario(problem.into())
}

fn describe(summary: &Summary) -> String {
    if summary.steady.is_empty() {
        return format!(
            "{} steps of {:.4e} s (the stability limit at the start is {:.4e} s)",
            summary.steps, summary.dt, summary.stability_limit
        );
    }
    let iterations: usize = summary.steady.iter().map(|(_, r)| r.iterations).sum();
    let residual = summary
        .steady
        .iter()
        .map(|(_, r)| r.residual)
        .fold(0.0, f64::max);
    let states = match summary.steady.len() {
        1 => "1 steady state".to_owned(),
        n => format!("{n} steady states"),
    };
    format!(
        "{states}, {iterations} Newton iterations; largest force out of balance {residual:.1e} N"
    )
}
