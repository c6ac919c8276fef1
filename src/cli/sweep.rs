//! `auxetica sweep` and `auxetica merge`

use super::progress::Meter;
use super::{Failure, ScenarioArgs, print};
use crate::config::Problems;
use crate::sweep::{self, Plan, Range, Shard, Store};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

const TABLE: &str = "table.parquet";

#[derive(clap::Args)]
pub(super) struct Options {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Vary a number, as in `rods[0].length=0.08..0.12:5`; several make all combinations. `path, path=..` ties paths to
    /// one value. With `--latin` without the count.
    #[arg(long, value_name = "PATH=A..B:N", required_unless_present = "list")]
    over: Vec<String>,
    /// Sample the ranges by a Latin hypercube of this many jobs.
    #[arg(long, value_name = "N", requires = "over")]
    latin: Option<NonZeroUsize>,
    /// Seed of the Latin hypercube.
    #[arg(long, default_value_t = 0, requires = "latin")]
    seed: u64,
    /// Take the jobs from the rows of a CSV file whose header names paths.
    #[arg(long, value_name = "FILE", conflicts_with = "over")]
    list: Option<PathBuf>,
    /// Simulations at a time, one a thread; by default one a processor.
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Do share k of n only; `auxetica merge` makes the table once all are done.
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Folder for results; by default `out/` and the scenario's name with `_sweep`. A sweep that is there goes on.
    #[arg(long)]
    out: Option<PathBuf>,
}

#[derive(clap::Args)]
pub(super) struct MergeOptions {
    /// Folders of one sweep, where its shares were done.
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// The table; by default `table.parquet` in the first folder.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(super) fn run(options: &Options, quiet: bool) -> Result<(), Failure> {
    let source = options.scenario.load()?;
    let plan = match &options.list {
        Some(file) => Plan::list(&source, file)?,
        None => {
            let mut problems = Problems::default();
            let ranges = options.over.iter().map(|text| Range::read(text));
            let ranges = ranges.filter_map(|range| problems.collect(range)).collect();
            problems.into_result()?;
            match options.latin {
                Some(jobs) => Plan::latin(&source, ranges, jobs.get(), options.seed)?,
                None => Plan::grid(&source, ranges)?,
            }
        }
    };
    plan.check()?;
    let out = options.out.clone().unwrap_or_else(|| {
        let mut name = options
            .scenario
            .scenario
            .file_stem()
            .unwrap_or_default()
            .to_owned();
        name.push("_sweep");
        Path::new("out").join(name)
    });
    let mut store = Store::open(&out, &plan, options.shard.unwrap_or(Shard::ALL))?;
    let before = store.share() - store.todo().len();
    if before > 0 && !quiet {
        let jobs = store.share();
        eprintln!("{before} of {jobs} jobs were done before and are kept");
    }
    let threads = options
        .jobs
        .unwrap_or_else(|| std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN));
    let mut meter = Meter::new("sweeping", quiet);
    sweep::run(&plan, &mut store, threads, &mut |done| meter.update(done))?;
    drop(meter);
    if options.shard.is_some() {
        let (failed, jobs) = (store.failed(), store.share());
        print(&format!(
            "{jobs} jobs of this share: {} good, {failed} failed",
            jobs - failed
        ))?;
        return all_good(failed, jobs);
    }
    table(&[out], None)
}

pub(super) fn merge(options: &MergeOptions) -> Result<(), Failure> {
    table(&options.folders, options.out.as_deref())
}

fn table(folders: &[PathBuf], path: Option<&Path>) -> Result<(), Failure> {
    let (plan, outcomes) = sweep::collect(folders)?;
    let path = path.map_or_else(|| folders[0].join(TABLE), PathBuf::from);
    let path = sweep::write_table(&path, &plan, &outcomes)?;
    let failed = outcomes.values().filter(|o| o.failure.is_some()).count();
    let jobs = plan.jobs();
    print(&format!(
        "{jobs} jobs: {} good, {failed} failed",
        jobs - failed
    ))?;
    print(&format!("written: {}", path.display()))?;
    all_good(failed, jobs)
}

fn all_good(failed: usize, jobs: usize) -> Result<(), Failure> {
    match failed {
        0 => Ok(()),
        _ => Err(Failure::Jobs { failed, jobs }),
    }
}
