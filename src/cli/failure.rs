//! Failures and exit codes: 1 the work failed, 2 the input is wrong, 130 stopped by the user.

use crate::characterise::CharacteriseError;
use crate::compare::CompareError;
use crate::config::Problems;
use crate::engine::RunError;
use crate::identify::FitError;
use crate::reproduce::ReproduceError;
use crate::sweep::SweepError;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A scenario is wrong.
    #[error("{0}")]
    Scenario(Problems),
    /// A run failed.
    #[error(transparent)]
    Run(RunError),
    /// A recording, or its comparison, failed.
    #[error(transparent)]
    Compare(CompareError),
    /// Measured curves can't be used.
    #[error(transparent)]
    Curves(crate::characterise::BadCurves),
    /// Nothing could be fitted.
    #[error(transparent)]
    Fit(FitError),
    /// The user stopped work of which nothing is kept.
    #[error("stopped; nothing was written")]
    Stopped,
    /// A sweep was planned badly, or could not be kept.
    #[error(transparent)]
    Sweep(SweepError),
    /// Some jobs of a sweep failed.
    #[error("{failed} of {jobs} jobs failed; the column `reason` of the table tells why")]
    Jobs {
        /// How many.
        failed: usize,
        /// Of how many.
        jobs: usize,
    },
    /// Something of the paper could not be computed again.
    #[error(transparent)]
    Reproduce(ReproduceError),
    /// A file can't be written.
    #[error(
        "can't write {path}: {source}; check that the folder exists, has room and may be written to"
    )]
    Output {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// What was asked for doesn't exist.
    #[error("{0}")]
    Unknown(String),
}

impl From<Problems> for Failure {
    fn from(problems: Problems) -> Self {
        Self::Scenario(problems)
    }
}

impl From<RunError> for Failure {
    fn from(e: RunError) -> Self {
        Self::Run(e)
    }
}

impl From<CompareError> for Failure {
    fn from(e: CompareError) -> Self {
        match e {
            CompareError::Scenario(problems) => Self::Scenario(problems),
            CompareError::Run(e) => Self::Run(e),
            other => Self::Compare(other),
        }
    }
}

impl From<crate::diagnose::DiagnoseError> for Failure {
    fn from(e: crate::diagnose::DiagnoseError) -> Self {
        use crate::diagnose::DiagnoseError;
        match e {
            DiagnoseError::Scenario(problems) => Self::Scenario(problems),
            DiagnoseError::Recording(e) => e.into(),
            DiagnoseError::Curves(e) => e.into(),
            DiagnoseError::Unfit(e) => CompareError::Unfit(e).into(),
        }
    }
}

impl From<CharacteriseError> for Failure {
    fn from(e: CharacteriseError) -> Self {
        match e {
            CharacteriseError::Scenario(problems) => Self::Scenario(problems),
            CharacteriseError::Curves(bad) => Self::Curves(bad),
            CharacteriseError::Fit(FitError::Stopped) | CharacteriseError::Stopped => Self::Stopped,
            CharacteriseError::Fit(e) => Self::Fit(e),
        }
    }
}

impl From<SweepError> for Failure {
    fn from(e: SweepError) -> Self {
        match e {
            SweepError::Scenario(problems) => Self::Scenario(problems),
            other => Self::Sweep(other),
        }
    }
}

impl From<ReproduceError> for Failure {
    fn from(e: ReproduceError) -> Self {
        match e {
            ReproduceError::Scenario(problems) => Self::Scenario(problems),
            ReproduceError::Characterise(e) => e.into(),
            ReproduceError::Run(e) => Self::Run(e),
            other => Self::Reproduce(other),
        }
    }
}

impl Failure {
    pub(super) fn output(path: &Path, source: std::io::Error) -> Self {
        let path = path.into();
        Self::Output { path, source }
    }

    /// Tells the failure on stderr and gives the exit code.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Scenario(problems) => {
                eprintln!("{}", problems.render(std::io::stderr().is_terminal()));
            }
            other => eprintln!("error: {other}"),
        }
        ExitCode::from(match self {
            Self::Scenario(_) | Self::Compare(_) | Self::Curves(_) | Self::Unknown(_) => 2,
            Self::Run(RunError::Unstable { .. }) => 2,
            Self::Stopped
            | Self::Run(RunError::Interrupted { .. })
            | Self::Sweep(SweepError::Interrupted { .. })
            | Self::Reproduce(ReproduceError::Interrupted) => 130,
            Self::Sweep(
                SweepError::File { .. } | SweepError::Table(_) | SweepError::Missing { .. },
            ) => 1,
            Self::Sweep(_) | Self::Reproduce(_) => 2,
            Self::Run(_) | Self::Fit(_) | Self::Output { .. } | Self::Jobs { .. } => 1,
        })
    }
}

impl From<crate::challenge::ChallengeError> for Failure {
    fn from(e: crate::challenge::ChallengeError) -> Self {
        use crate::challenge::ChallengeError;
        match e {
            ChallengeError::Scenario(problems) => Self::Scenario(problems),
            ChallengeError::File { path, source } => {
                Self::output(std::path::Path::new(&path), source)
            }
            other => CompareError::Unfit(other.to_string()).into(),
        }
    }
}
