//! Stretches of a recording during which the motors' goals stand still.

use std::ops::Range;

use crate::Recording;

/// The dwells among `rows`: the longest ranges of rows with the same goals.
#[expect(clippy::float_cmp, reason = "goals are copied, not computed")]
pub(crate) fn dwells(recording: &Recording, rows: Range<usize>) -> Vec<Range<usize>> {
    let mut end = rows.start;
    recording.goal[rows]
        .chunk_by(|a, b| a == b)
        .map(|dwell| {
            let start = end;
            end += dwell.len();
            start..end
        })
        .collect()
}
