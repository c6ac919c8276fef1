//! `auxetica check`

use super::{Failure, print};
use crate::config::{Problem, Problems, Source};
use crate::engine::critical::critical;
use crate::engine::scenario::{Solver, StepSize};
use crate::engine::{Model, RunError};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Options {
    /// Scenario files.
    #[arg(required = true)]
    scenarios: Vec<PathBuf>,
    /// Replace a value in each, as in `rods[0].length=0.12`; may be given several times.
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
}

pub(super) fn run(options: &Options, quiet: bool) -> Result<(), Failure> {
    let mut problems = Problems::default();
    for path in &options.scenarios {
        let checked = Source::load(path, &options.set).and_then(|source| good(&source));
        if let Some(words) = problems.collect(checked)
            && !quiet
        {
            print(&format!("{}: good {words}", path.display()))?;
        }
    }
    Ok(problems.into_result()?)
}

/// What there is to say about a scenario that is good.
fn good(source: &Source) -> Result<String, Problems> {
    let mut model = Model::build(source, None)?;
    let (bodies, elements) = (model.system.ids().len(), model.system.elements());
    let words = format!("({}; bodies: {bodies}, elements: {elements})", model.title);
    let Solver::Dynamic { .. } = model.solver else {
        return Ok(words);
    };
    let StepSize { dt, limit } = model.time_step().map_err(|e| too_long(&e, source))?;
    let set_by = critical(&mut model.system, limit).map_or(String::new(), |c| {
        let percent = 100.0 * c.share;
        format!(", set by {} ({percent:.0} %), most in `{}`", c.what, c.body)
    });
    Ok(format!(
        "{words}\n  time step {dt:.3e} s, stability limit {limit:.3e} s{set_by}"
    ))
}

/// A time step that is too long is a problem of the scenario.
pub(super) fn too_long(error: &RunError, source: &Source) -> Problem {
    let message = error.to_string();
    let (what, remedy) = message.split_once("; ").unwrap_or((&message, ""));
    source.problem("solver.dt", what).with_hint(remedy)
}
