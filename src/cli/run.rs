//! `auxetica run`

use super::progress::Meter;
use super::table::table;
use super::{Failure, ScenarioArgs, print, write_whole};
use crate::config::Source;
use crate::engine::scenario::Watcher;
use crate::engine::{
    Body, Callback, CallbackError, End, Model, Place, ReadBody, RunError, Snapshot, Summary,
};
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
    let mut states = Vec::new();
    let mut meter = Meter::new("solving", quiet);
    let summary = {
        let outcome = model.run(&out, &mut |done| meter.update(done), &mut |model| {
            states.extend(state_rows(model));
        });
        drop(meter);
        outcome.map_err(|e| at_its_place(e, &source))?
    };
    print(&format!("{}\n", model.title))?;
    print(&table(
        &[
            "where",
            "t [s]",
            "x [mm]",
            "y [mm]",
            "z [mm]",
            "turned by [deg]",
        ],
        states,
    ))?;
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

/// Where the markers are, or without any the tips of all bodies.
fn state_rows(model: &Model) -> Vec<Vec<String>> {
    let time = model.system.time();
    let row = |name: &str, position: nalgebra::Vector3<f64>, frame: nalgebra::Matrix3<f64>| {
        // rows of a frame are directors: its transpose is the rotation from the world's axes
        let turn = crate::engine::rotation::log(&frame.transpose()).map(|v| v.to_degrees());
        let mm = position * 1e3;
        vec![
            name.to_owned(),
            format!("{time:.3}"),
            format!("{:.3}", mm.x),
            format!("{:.3}", mm.y),
            format!("{:.3}", mm.z),
            format!("{:.2} {:.2} {:.2}", turn.x, turn.y, turn.z),
        ]
    };
    let markers: Vec<_> = model
        .markers
        .iter()
        .filter_map(|m| model.marker_pose(m).map(|(r, q)| row(&m.name, r, q)))
        .collect();
    if !markers.is_empty() {
        return markers;
    }
    let bodies = model.system.ids().iter().map(|id| {
        let site = model.system.site(*id, Place::End(End::Tip));
        row(model.system.body(*id).name(), site.position, site.director)
    });
    bodies.collect()
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
    format!(
        "{} steady states, {iterations} Newton iterations; largest force out of balance {residual:.1e} N",
        summary.steady.len()
    )
}
