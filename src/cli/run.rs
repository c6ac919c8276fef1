//! `auxetica run`

use super::check::too_long;
use super::progress::Meter;
use super::states::States;
use super::{Failure, ScenarioArgs, print, write_whole};
use crate::config::Source;
use crate::engine::scenario::{Solver, StepSize, Watcher};
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
    if let Solver::Dynamic { .. } = model.solver
        && let Some(warning) = model
            .time_step()
            .map_err(|e| at_its_place(e, &source))?
            .warning()
        && !quiet
    {
        eprintln!("warning: {warning}");
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

fn at_its_place(error: RunError, source: &Source) -> Failure {
    match error {
        RunError::Unstable { .. } => Failure::Scenario(too_long(&error, source).into()),
        other => other.into(),
    }
}

fn describe(summary: &Summary) -> String {
    if let Some(cost) = summary.implicit {
        let halved = match cost.halved {
            0 => String::new(),
            n => format!(", {n} of them halved"),
        };
        return format!(
            "{} implicit steps of {:.4e} s{halved}; {} Newton iterations, {} tangents",
            cost.steps, summary.step.dt, cost.iterations, cost.factorisations
        );
    }
    if summary.steady.is_empty() {
        let StepSize { dt, limit } = summary.step;
        return format!(
            "{} steps of {dt:.4e} s, {:.2} of the stability limit of {limit:.4e} s at the start{}",
            summary.steps,
            dt / limit,
            summary
                .step
                .warning()
                .map_or("", |_| ": close to it, see `solver.dt`")
        );
    }
    let iterations: usize = summary.steady.iter().map(|(_, r, _)| r.iterations).sum();
    let residual = summary
        .steady
        .iter()
        .map(|(_, r, _)| r.residual)
        .fold(0.0, f64::max);
    let states = match summary.steady.len() {
        1 => "1 steady state".to_owned(),
        n => format!("{n} steady states"),
    };
    let unstable: Vec<String> = (summary.steady.iter())
        .filter(|(.., stability)| !stability.is_some_and(|s| s.is_stable()))
        .map(|(time, ..)| format!("{time:.3}"))
        .collect();
    let unstable = match &*unstable {
        [] => String::new(),
        times => format!("; not stable at t = {} s", times.join(", ")),
    };
    let settled: usize = summary.steady.iter().map(|(_, r, _)| r.settled).sum();
    let settled = match settled {
        0 => String::new(),
        1 => "; let go and come to rest once".to_owned(),
        n => format!("; let go and come to rest {n} times"),
    };
    format!(
        "{states}, {iterations} Newton iterations; largest force out of balance {residual:.1e} N{settled}{unstable}"
    )
}
