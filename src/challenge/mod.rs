//! Blind challenges: recordings with a concealed effect, and how well a diagnosis finds what they conceal.
//!
//! [`conceal`] draws cases from a [`Spec`] and simulates their recordings: another mesh, other values of the scenario's
//! uncertain numbers, noise, and an effect, two, none, or one that is in no library. What each conceals is sealed in
//! [`TRUTH`]; its hash stands beside the cases. [`score`] diagnoses every case first and opens the truth afterwards.

mod conceal;
mod draw;
mod score;
mod set_points;
mod spec;
mod spiked;
mod toured;
mod truth;

pub use conceal::conceal;
pub use score::{Result as CaseResult, Tally, score};
pub use spec::{Foreign, Onto, Recorded, Spec, Tours};
pub use truth::{Concealed, Truth};

/// File of what the cases conceal.
pub const TRUTH: &str = "truth.json";
/// File of the truth's SHA-256.
pub const SEAL: &str = "truth.sha256";
/// The scenario that cases are to be diagnosed with.
pub const NOMINAL: &str = "nominal.ron";
/// Simulated recordings of a case: two to train on, two to judge by.
pub const RECORDINGS: [&str; 4] = [
    "train_0_circle",
    "train_1_mix",
    "holdout_2_lemniscate",
    "holdout_3_mix",
];

/// Why there is no challenge, or no score.
#[derive(Debug, thiserror::Error)]
pub enum ChallengeError {
    /// The specification or its scenario is wrong.
    #[error(transparent)]
    Scenario(#[from] crate::config::Problems),
    /// A recording can't be written or read.
    #[error(transparent)]
    Recording(#[from] crate::recordings::Error),
    /// A case can't be diagnosed.
    #[error("case `{case}`: {source}")]
    Diagnosis {
        /// The case.
        case: String,
        /// Why.
        source: crate::diagnose::DiagnoseError,
    },
    /// A file can't be read or written.
    #[error("`{path}`: {source}")]
    File {
        /// The file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// What was asked makes no sense.
    #[error("{0}")]
    Unfit(String),
}

impl ChallengeError {
    fn file(path: &std::path::Path, source: std::io::Error) -> Self {
        Self::File {
            path: path.display().to_string(),
            source,
        }
    }
}

/// SHA-256 in hexadecimal.
fn hash(text: &str) -> String {
    use sha2::{Digest, Sha256};
    let digest = Sha256::digest(text.as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}
