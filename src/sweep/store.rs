//! The folder of a sweep: `scenario.ron`, `jobs.csv`, and one log `part-K-of-N.jsonl` a share.
//!
//! A log holds a line a finished job. A line is whole once it ends: a process that is killed leaves at most a last line
//! without an end, which counts as not written.

use super::{Outcome, Plan, SweepError};
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

const SCENARIO: &str = "scenario.ron";
const JOBS: &str = "jobs.csv";

/// A share of the jobs: share k of n holds the jobs k - 1, k - 1 + n, ..
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    k: usize,
    n: usize,
}

impl Shard {
    /// All jobs.
    pub const ALL: Self = Self { k: 1, n: 1 };

    fn holds(self, job: usize) -> bool {
        job % self.n == self.k - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/');
        let numbers =
            numbers.and_then(|(k, n)| Some((k.trim().parse().ok()?, n.trim().parse().ok()?)));
        match numbers {
            Some((k, n)) if (1..=n).contains(&k) => Ok(Self { k, n }),
            Some((_, n)) if n > 0 => Err(format!("shares of {n} are 1/{n} to {n}/{n}")),
            _ => Err("a share is k/n, such as 1/4, 2/4, 3/4 or 4/4".into()),
        }
    }
}

/// The folder of a sweep, opened to do a share of its jobs.
pub struct Store {
    path: PathBuf,
    log: File,
    done: BTreeMap<usize, Outcome>,
    shard: Shard,
    jobs: usize,
}

impl Store {
    /// Opens the folder of the plan, or makes it.
    ///
    /// # Errors
    /// If it holds another sweep, its logs are damaged, another process is at this share, or files can't be used.
    pub fn open(folder: &Path, plan: &Plan, shard: Shard) -> Result<Self, SweepError> {
        fs::create_dir_all(folder).map_err(|source| unusable(folder, source))?;
        claim(folder, SCENARIO, plan.scenario(), "another scenario")?;
        claim(folder, JOBS, &plan.to_csv(), "another list of jobs")?;
        let path = folder.join(format!("part-{}-of-{}.jsonl", shard.k, shard.n));
        let log = open_log(&path).map_err(|source| unusable(&path, source))?;
        Ok(Self {
            path,
            log,
            done: read_parts(folder, plan)?,
            shard,
            jobs: plan.jobs(),
        })
    }

    /// Jobs of the share that aren't done.
    pub fn todo(&self) -> Vec<usize> {
        let share = (0..self.jobs).filter(|job| self.shard.holds(*job));
        share.filter(|job| !self.done.contains_key(job)).collect()
    }

    /// Number of jobs of the share.
    pub fn share(&self) -> usize {
        (0..self.jobs).filter(|job| self.shard.holds(*job)).count()
    }

    /// Jobs of the share that are done and failed.
    pub fn failed(&self) -> usize {
        let share = self.done.values().filter(|o| self.shard.holds(o.job));
        share.filter(|o| o.failure.is_some()).count()
    }

    /// Adds a finished job to the log.
    pub(super) fn keep(&mut self, outcome: Outcome) -> Result<(), SweepError> {
        let mut line = serde_json::to_string(&outcome).expect("an outcome is plain data");
        line.push('\n');
        // in one write, so that a stop leaves all of it or a line without an end
        self.log
            .write_all(line.as_bytes())
            .map_err(|source| unusable(&self.path, source))?;
        self.done.insert(outcome.job, outcome);
        Ok(())
    }
}

/// The plan of the sweep in these folders, copies of one folder with different shares done, and all of its outcomes.
///
/// # Errors
/// If a folder is no sweep's or another's, a log is damaged, or jobs are missing.
pub fn collect(folders: &[PathBuf]) -> Result<(Plan, BTreeMap<usize, Outcome>), SweepError> {
    let first = &folders[0];
    let source = crate::config::Source::load(&first.join(SCENARIO), &[])?;
    let plan = Plan::list(&source, &first.join(JOBS))?;
    let mut done = BTreeMap::new();
    for folder in folders {
        for file in [SCENARIO, JOBS] {
            let [a, b] = [first, folder].map(|folder| {
                let path = folder.join(file);
                fs::read(&path).map_err(|source| unusable(&path, source))
            });
            if a? != b? {
                return Err(SweepError::Other {
                    folder: folder.clone(),
                    message: format!(
                        "it is the folder of another sweep than {}, their {file} differ; merge shares of one sweep",
                        first.display()
                    ),
                });
            }
        }
        for (_, outcome) in read_parts(folder, &plan)? {
            insert(&mut done, outcome, folder, 0)?;
        }
    }
    let missing = (0..plan.jobs()).filter(|job| !done.contains_key(job));
    match missing.clone().next() {
        None => Ok((plan, done)),
        Some(first) => Err(SweepError::Missing {
            missing: missing.count(),
            jobs: plan.jobs(),
            first,
        }),
    }
}

/// Writes what the folder is of, or finds it written.
fn claim(folder: &Path, file: &str, text: &str, other: &str) -> Result<(), SweepError> {
    let path = folder.join(file);
    let write = || -> io::Result<bool> {
        if !path.exists() {
            let mut part = tempfile::NamedTempFile::new_in(folder)?;
            part.write_all(text.as_bytes())?;
            // another share may have written it by now
            match part.persist_noclobber(&path) {
                Err(e) if e.error.kind() != io::ErrorKind::AlreadyExists => return Err(e.error),
                _ => {}
            }
        }
        Ok(fs::read(&path)? == text.as_bytes())
    };
    match write() {
        Ok(true) => Ok(()),
        Ok(false) => Err(SweepError::Other {
            folder: folder.into(),
            message: format!(
                "it holds the results of {other} ({file} differs), which are not to be mixed; give another `--out`, or \
                 delete the folder"
            ),
        }),
        Err(source) => Err(unusable(&path, source)),
    }
}

/// Opens the log behind its last whole line, for this process alone.
fn open_log(path: &Path) -> io::Result<File> {
    let log = OpenOptions::new().create(true).append(true).open(path)?;
    // file systems that have no locks go without
    if let Err(TryLockError::WouldBlock) = log.try_lock() {
        return Err(io::Error::other("another process is at this share"));
    }
    let text = fs::read(path)?;
    let whole = text
        .iter()
        .rposition(|byte| *byte == b'\n')
        .map_or(0, |end| end + 1);
    if whole < text.len() {
        log.set_len(whole as u64)?;
    }
    Ok(log)
}

/// All outcomes in the logs of a folder.
fn read_parts(folder: &Path, plan: &Plan) -> Result<BTreeMap<usize, Outcome>, SweepError> {
    let entries = fs::read_dir(folder).map_err(|source| unusable(folder, source))?;
    let mut parts: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    parts.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("part-") && name.ends_with(".jsonl")
    });
    parts.sort();
    let mut done = BTreeMap::new();
    for path in parts {
        let text = fs::read_to_string(&path).map_err(|source| unusable(&path, source))?;
        let lines = text
            .split_inclusive('\n')
            .filter(|line| line.ends_with('\n'));
        for (i, line) in lines.enumerate() {
            let damaged = |message: String| SweepError::Damaged {
                file: path.clone(),
                line: i + 1,
                message,
            };
            let outcome: Outcome =
                serde_json::from_str(line).map_err(|e| damaged(e.to_string()))?;
            if outcome.job >= plan.jobs() || outcome.hash != plan.hash(outcome.job) {
                return Err(damaged(format!("job {} is of another sweep", outcome.job)));
            }
            insert(&mut done, outcome, &path, i + 1)?;
        }
    }
    Ok(done)
}

fn insert(
    done: &mut BTreeMap<usize, Outcome>,
    outcome: Outcome,
    file: &Path,
    line: usize,
) -> Result<(), SweepError> {
    match done.get(&outcome.job) {
        Some(known) if !known.agrees(&outcome) => Err(SweepError::Damaged {
            file: file.into(),
            line,
            message: format!("job {} has two different results", outcome.job),
        }),
        _ => {
            done.entry(outcome.job).or_insert(outcome);
            Ok(())
        }
    }
}

fn unusable(path: &Path, source: io::Error) -> SweepError {
    let path = path.into();
    SweepError::File { path, source }
}
