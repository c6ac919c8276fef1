//! The table of a sweep: a row a job, state and marker.

use super::{Outcome, Plan, SweepError};
use crate::poses::Pose;
use crate::recorders::{Kind, ParquetFile, Value};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Columns after those of the parameters.
const RESULTS: [(&str, Kind); 15] = [
    ("status", Kind::Text),
    ("reason", Kind::Text),
    ("state", Kind::Text),
    ("time_s", Kind::Number),
    ("where", Kind::Text),
    ("position_x_m", Kind::Number),
    ("position_y_m", Kind::Number),
    ("position_z_m", Kind::Number),
    ("rotation_x_rad", Kind::Number),
    ("rotation_y_rad", Kind::Number),
    ("rotation_z_rad", Kind::Number),
    ("iterations", Kind::Whole),
    ("steps", Kind::Whole),
    ("seconds", Kind::Number),
    ("hash", Kind::Text),
];

/// Writes a Parquet table of all outcomes, in the order of the jobs: `job`, a column a parameter, then `status` (`good`
/// or `failed`), `reason`, and a row for each state that was reached and each marker in it, or one row without any.
/// `iterations` are those of the state, `steps` and `seconds` those of the job. But for `seconds` the table depends on
/// the plan alone.
///
/// # Errors
/// If it can't be written; a file that had the name then stays.
pub fn write_table(
    path: &Path,
    plan: &Plan,
    outcomes: &BTreeMap<usize, Outcome>,
) -> Result<PathBuf, SweepError> {
    let parameters = plan.columns().map(|name| (name, Kind::Number));
    let results = RESULTS.map(|(name, kind)| (name.to_owned(), kind));
    let columns: Vec<_> = std::iter::once(("job".to_owned(), Kind::Whole))
        .chain(parameters)
        .chain(results)
        .collect();
    let mut table = ParquetFile::create(path, &columns)?;
    for outcome in outcomes.values() {
        let states = outcome.states.iter();
        let mut places: Vec<_> = states
            .flat_map(|state| state.poses.iter().map(move |pose| Some((state, pose))))
            .collect();
        if places.is_empty() {
            places.push(None);
        }
        for place in places {
            let parameters = plan.row(outcome.job).iter().copied().map(Value::Number);
            let job = Value::Whole(outcome.job as i64);
            let (status, reason) = match &outcome.failure {
                None => (Value::Text("good"), Value::Missing),
                Some(reason) => (Value::Text("failed"), Value::Text(reason)),
            };
            let whole = |n: Option<u64>| n.map_or(Value::Missing, |n| Value::Whole(n as i64));
            let [time, name, iterations] = match place {
                None => [Value::Missing; 3],
                Some((state, _)) => [
                    Value::Number(state.time),
                    Value::Text(&state.name),
                    whole(state.iterations.map(|n| n as u64)),
                ],
            };
            let [marker, numbers @ ..] = pose(place.map(|(_, pose)| pose));
            let row = std::iter::once(job)
                .chain(parameters)
                .chain([status, reason, name, time, marker])
                .chain(numbers)
                .chain([iterations, whole(outcome.steps)])
                .chain([Value::Number(outcome.seconds), Value::Text(&outcome.hash)]);
            table.row(row)?;
        }
    }
    Ok(table.finish()?)
}

fn pose(pose: Option<&Pose>) -> [Value<'_>; 7] {
    let Some(pose) = pose else {
        return [Value::Missing; 7];
    };
    let ([x, y, z], [a, b, c]) = (
        pose.position.map(Value::Number),
        pose.turn.map(Value::Number),
    );
    [Value::Text(&pose.name), x, y, z, a, b, c]
}
