//! The command line. Results go to stdout, everything else to stderr.

mod challenge;
mod characterise;
mod check;
mod compare;
mod default_job;
mod diagnose;
mod failure;
mod plugins;
mod progress;
mod reproduce;
mod run;
mod states;
mod sweep;
mod table;

use clap::{Args, Parser, Subcommand};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub use failure::Failure;

/// Simulates slender soft robots and shows how far a simulation is from a real recording.
///
/// Without a command it runs the main job: the 4-rod robot of handed shearing auxetics under the motor angles of a
/// real recording, body by body.
#[derive(Parser)]
#[command(version, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// No progress and no hints.
    #[arg(long, short, global = true)]
    quiet: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Solve a scenario and keep what its callbacks write.
    Run(run::Options),
    /// Say everything that is wrong with scenarios, without solving them.
    Check(check::Options),
    /// List the plugins, or explain one: parameters, units, source.
    Plugins(plugins::Options),
    /// Run a scenario under a recording's motor angles and show how far both differ, body by body.
    Compare(compare::Options),
    /// Show the holding torque, length, spring constant and blocked force of a rod against its twist angle.
    Characterise(characterise::Options),
    /// Run a scenario with many parameters and put all that comes of it into one table.
    Sweep(sweep::Options),
    /// Make the table of a sweep whose shares were done apart.
    Merge(sweep::MergeOptions),
    /// Say which physics a scenario lacks, from recordings of the real robot, and write the scenario that has it.
    Diagnose(diagnose::Options),
    /// Make recordings with hidden effects, to test a diagnosis.
    Conceal(challenge::ConcealOptions),
    /// Diagnose such recordings blindly, then count what was found.
    Score(challenge::ScoreOptions),
    /// Compute figures and tables of the paper again, beside what it prints.
    Reproduce(reproduce::Options),
}

/// A scenario file and what is changed in it.
#[derive(Args)]
struct ScenarioArgs {
    /// Scenario file.
    scenario: PathBuf,
    /// Replace a value, as in `rods[0].length=0.12` or `laws[*].apply.factor=0.009`; may be given several times.
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
}

impl ScenarioArgs {
    fn load(&self) -> Result<crate::config::Source, Failure> {
        Ok(crate::config::Source::load(&self.scenario, &self.set)?)
    }
}

/// Runs the command line of this process: the whole `main` of a program with plugins of its own.
pub fn main() -> ExitCode {
    main_with(std::env::args_os())
}

/// Runs a command line given as arguments, the program's name first.
pub fn main_with(arguments: impl IntoIterator<Item = std::ffi::OsString>) -> ExitCode {
    let cli = Cli::parse_from(arguments);
    let quiet = cli.quiet;
    let done = match &cli.command {
        None => default_job::run(quiet),
        Some(Command::Run(options)) => run::run(options, quiet),
        Some(Command::Check(options)) => check::run(options, quiet),
        Some(Command::Plugins(options)) => plugins::run(options),
        Some(Command::Compare(options)) => compare::run(options, quiet),
        Some(Command::Characterise(options)) => characterise::run(options, quiet),
        Some(Command::Sweep(options)) => sweep::run(options, quiet),
        Some(Command::Merge(options)) => sweep::merge(options),
        Some(Command::Diagnose(options)) => diagnose::run(options, quiet),
        Some(Command::Conceal(options)) => challenge::conceal(options, quiet),
        Some(Command::Score(options)) => challenge::score(options, quiet),
        Some(Command::Reproduce(options)) => reproduce::run(options, quiet),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// Prints to stdout; a reader that has left is no error.
fn print(text: &str) -> Result<(), Failure> {
    use std::io::Write;
    match writeln!(std::io::stdout().lock(), "{text}") {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::Output {
            path: "stdout".into(),
            source: e,
        }),
        _ => Ok(()),
    }
}

/// Writes beside the file first, so that it is whole or as it was.
fn write_whole(path: &Path, text: &str) -> Result<(), Failure> {
    let mut part = path.as_os_str().to_owned();
    part.push(".part");
    let part = Path::new(&part);
    std::fs::write(part, text)
        .and_then(|()| std::fs::rename(part, path))
        .map_err(|source| {
            let _ = std::fs::remove_file(part); // the first failure is the one to tell
            Failure::output(path, source)
        })
}
