//! `auxetica check`

use super::{Failure, print};
use crate::config::{Problems, Source};
use crate::engine::Model;
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
        let checked =
            Source::load(path, &options.set).and_then(|source| Model::build(&source, None));
        if let Some(model) = problems.collect(checked)
            && !quiet
        {
            let system = &model.system;
            print(&format!(
                "{}: good ({}; bodies: {}, elements: {})",
                path.display(),
                model.title,
                system.ids().len(),
                system.elements()
            ))?;
        }
    }
    Ok(problems.into_result()?)
}
