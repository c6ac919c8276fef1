//! What the paper shows, computed again and put beside its figures: Stölzle et al. 2023
//! ([10.1109/RoboSoft55895.2023.10121989](https://doi.org/10.1109/RoboSoft55895.2023.10121989)), one file an item.

mod data;
mod fig2;
mod fig3;
mod fig5;
mod fig7;
mod reference_set;
mod robot;
mod rods;
mod table1;
mod table2;

pub use data::Data;

use crate::config::Problems;
use crate::engine::RunError;
use crate::report::Picture;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// A figure or table of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Item {
    /// Figure 2: the robot in its seven motion primitives.
    Fig2,
    /// Table I: parameters of the five rods.
    Table1,
    /// Figure 3: characteristics of the five rods against the twist angle.
    Fig3,
    /// Figure 5: kinematic models of one to five segments of the simulated rods.
    Fig5,
    /// Table II: kinematic models of the recorded rod.
    Table2,
    /// Figure 7: stills of the recorded rod.
    Fig7,
}

impl Item {
    /// All items, in the order of the paper.
    pub const ALL: [Self; 6] = [
        Self::Fig2,
        Self::Table1,
        Self::Fig3,
        Self::Fig5,
        Self::Table2,
        Self::Fig7,
    ];

    /// Name on the command line, in JSON and of files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fig2 => "fig2",
            Self::Table1 => "table1",
            Self::Fig3 => "fig3",
            Self::Fig5 => "fig5",
            Self::Table2 => "table2",
            Self::Fig7 => "fig7",
        }
    }

    /// Computes it.
    pub fn reproduce(self, data: &Data, ticker: Ticker<'_>) -> Result<Shown, ReproduceError> {
        match self {
            Self::Fig2 => fig2::reproduce(ticker),
            Self::Table1 => table1::reproduce(),
            Self::Fig3 => fig3::reproduce(data, ticker),
            Self::Fig5 => fig5::reproduce(data, ticker),
            Self::Table2 => table2::reproduce(data, ticker),
            Self::Fig7 => fig7::reproduce(data, ticker),
        }
    }
}

/// Told the share that is done, says whether to go on; called from any thread.
pub type Ticker<'a> = &'a (dyn Fn(f64) -> ControlFlow<()> + Sync);

/// An item computed again.
pub struct Shown {
    /// What it is.
    pub title: &'static str,
    /// Its figures beside the paper's.
    pub tables: Vec<Table>,
    /// What is to be said about them.
    pub notes: Vec<String>,
    /// The same for programs.
    pub json: serde_json::Value,
    /// Pictures and the names of their files.
    pub pictures: Vec<(String, Picture)>,
}

/// A table for people.
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Headers of its columns.
    pub header: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
}

/// Why an item could not be computed.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// Data that it needs are absent.
    #[error(
        "{} is not there; download the public data set github.com/tud-cor-sr/hsa-kinematic-model and set AUXETICA_DATA \
         to the folder that holds its `recordings/` and `reference_simulations/`",
        path.display()
    )]
    Missing {
        /// What was looked for.
        path: PathBuf,
    },
    /// A recording can't be used.
    #[error(transparent)]
    Recording(#[from] crate::recordings::Error),
    /// Another file of the data can't be used.
    #[error("{}: {reason}; download it again from github.com/tud-cor-sr/hsa-kinematic-model", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A scenario is wrong.
    #[error("{0}")]
    Scenario(#[from] Problems),
    /// A rod could not be characterised.
    #[error(transparent)]
    Characterise(#[from] crate::characterise::CharacteriseError),
    /// A simulation failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The user stopped it.
    #[error("interrupted")]
    Interrupted,
}

/// Jobs of known size, done in parallel: tells the share that is done.
struct Tally<'a> {
    done: std::sync::Mutex<f64>,
    all: f64,
    ticker: Ticker<'a>,
}

impl<'a> Tally<'a> {
    fn new(all: f64, ticker: Ticker<'a>) -> Self {
        Self {
            done: std::sync::Mutex::new(0.0),
            all,
            ticker,
        }
    }

    /// Counts a finished job of this size.
    fn add(&self, size: f64) -> Result<(), ReproduceError> {
        let mut done = self.done.lock().unwrap_or_else(|e| e.into_inner());
        *done += size;
        match (self.ticker)(*done / self.all) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(ReproduceError::Interrupted),
        }
    }
}
