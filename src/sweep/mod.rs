//! Ensembles: one scenario, many parameters, one table.
//!
//! A [`Plan`] is the list of jobs: a grid, a Latin hypercube, or the rows of a file. Jobs know nothing of each other;
//! each has a number, its index in the list, and a hash of its scenario and parameters. A [`Store`] is the folder that
//! keeps them as they finish: one log a share of the list, so that several processes, on several machines, may work at
//! one folder. What is kept is not done again. [`write_table`] makes one Parquet table of all.

mod job;
mod plan;
mod pool;
mod range;
mod store;
mod table;

pub use job::{Outcome, State};
pub use plan::Plan;
pub use pool::run;
pub use range::Range;
pub use store::{Shard, Store, collect};
pub use table::write_table;

use crate::config::{Problem, Problems};
use crate::engine::CallbackError;
use std::path::PathBuf;

/// Why a sweep could not be planned, kept or finished. A job that fails is no such error but a row of the table.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// Paths, ranges or the scenario are wrong.
    #[error("{0}")]
    Scenario(#[from] Problems),
    /// A list of jobs is wrong.
    #[error(
        "list of jobs {file}: {message}; give a CSV file with paths in its header and a job's numbers in each row"
    )]
    List {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// Nobody wants that many.
    #[error("{jobs} jobs are too many; a sweep takes {most} at most, give fewer values")]
    TooMany {
        /// How many.
        jobs: String,
        /// How many are allowed.
        most: usize,
    },
    /// A folder holds something else than is wanted of it.
    #[error("{folder}: {message}")]
    Other {
        /// The folder.
        folder: PathBuf,
        /// What it holds, and what to do.
        message: String,
    },
    /// A log is damaged.
    #[error(
        "{file}, line {line}: {message}; delete this line and sweep again, which does its job anew"
    )]
    Damaged {
        /// The log.
        file: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        message: String,
    },
    /// Some jobs aren't done yet.
    #[error(
        "{missing} of {jobs} jobs aren't done, the first is job {first}; give the command of the sweep again, which goes on"
    )]
    Missing {
        /// How many aren't.
        missing: usize,
        /// Of how many.
        jobs: usize,
        /// The first.
        first: usize,
    },
    /// A file of the sweep can't be read or written.
    #[error(
        "can't use {path}: {source}; check that the folder has room and may be read and written"
    )]
    File {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// The table can't be written.
    #[error(transparent)]
    Table(#[from] CallbackError),
    /// The user stopped the sweep.
    #[error("the sweep was stopped with {left} of {jobs} jobs left; the same command goes on")]
    Interrupted {
        /// Jobs still to do.
        left: usize,
        /// Jobs of this process, those kept from before included.
        jobs: usize,
    },
}

impl From<Problem> for SweepError {
    fn from(problem: Problem) -> Self {
        Self::Scenario(problem.into())
    }
}
