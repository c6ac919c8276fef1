//! A simulation beside a recording: the scenario runs under the recorded motor angles, and its markers are held
//! against the recorded bodies.
//!
//! Marker frames sit on their bodies a little off and at arbitrary angles, so both sides are referred to the rest
//! pose: rotations count from it, and the simulated marker point is moved to where the recorded one was at rest.

mod film;
mod made;
mod mismatch;
mod observed;
mod simulated;
mod turns;

pub use film::{Film, film};
pub use made::make_recording;
pub use mismatch::{BodyMismatch, Comparison, Worst};
pub(crate) use observed::TABLE;
pub use observed::{Observed, SampleKind, motor_inputs, published};
pub use simulated::{Mode, Simulated};
pub(crate) use simulated::{markers, pose, seen};
pub use turns::turns;

use crate::config::{Problems, Source};
use crate::engine::RunError;
use crate::engine::run::Progress;

/// Why no comparison came about.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// The recording can't be used.
    #[error(transparent)]
    Recording(#[from] crate::recordings::Error),
    /// The scenario is wrong.
    #[error(transparent)]
    Scenario(#[from] Problems),
    /// The scenario lacks something that the comparison needs.
    #[error("{0}")]
    Unfit(String),
    /// The simulation failed.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Runs the scenario under the recorded motor angles (inputs `motor_1` to `motor_4`) and measures how far its markers
/// `platform` and `ring` are from the recorded bodies. `until` \[s\] ends a long recording early.
pub fn compare(
    source: &Source,
    folder: &std::path::Path,
    mode: Mode,
    kind: SampleKind,
    until: Option<f64>,
    progress: &mut Progress<'_>,
) -> Result<Comparison, CompareError> {
    let mut observed = Observed::read(folder, mode, kind)?;
    if let Some(until) = until {
        observed.end_at(until);
    }
    let start = std::time::Instant::now();
    let simulated = Simulated::run(source, &observed, mode, progress)?;
    Ok(Comparison::new(
        source.name(),
        &observed,
        &simulated,
        mode,
        kind,
        start.elapsed().as_secs_f64(),
    ))
}
