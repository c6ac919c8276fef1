//! Everything that can be wrong with a recording, and what to do about it.

use std::io;
use std::path::PathBuf;

use crate::Body;

/// Why a recording or a published table could not be read, used or written.
///
/// Lines and columns count from one, as an editor shows them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The folder of the recording does not exist.
    #[error("{path:?}: no such folder; give the folder that holds the recording's CSV files")]
    MissingFolder {
        /// Folder that was asked for.
        path: PathBuf,
    },
    /// A file of the recording does not exist.
    #[error("{path:?}: file is missing; a recording needs it, restore it from the data set")]
    MissingFile {
        /// File that was expected.
        path: PathBuf,
    },
    /// The system refused to read a file.
    #[error("{path:?}: cannot be read ({source}); check that it is a file you may read")]
    Unreadable {
        /// File concerned.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A file holds no row.
    #[error("{path:?}: file is empty; restore it from the data set")]
    Empty {
        /// File concerned.
        path: PathBuf,
    },
    /// The last line has no line end, so that its last number may be cut.
    #[error(
        "{path:?}, line {line}: file is cut off, its last line has no line end; \
         restore the file, or add a line end if the line is complete"
    )]
    CutOff {
        /// File concerned.
        path: PathBuf,
        /// Last line.
        line: u64,
    },
    /// A line has too few or too many columns.
    #[error(
        "{path:?}, line {line}: {found} columns where {expected} are expected; \
         mend the line (columns are separated by commas, and there is no header line)"
    )]
    Columns {
        /// File concerned.
        path: PathBuf,
        /// Line concerned.
        line: u64,
        /// Columns of this file.
        expected: usize,
        /// Columns of this line.
        found: usize,
    },
    /// A field is not a number.
    #[error(
        "{path:?}, line {line}, column {column} ({field}): {found:?} is not a number; \
         mend the field (there is no header line)"
    )]
    NotANumber {
        /// File concerned.
        path: PathBuf,
        /// Line concerned.
        line: u64,
        /// Column concerned.
        column: usize,
        /// What the column holds.
        field: &'static str,
        /// What was found, at most its first 40 characters.
        found: String,
    },
    /// A field is infinite or not a number in the sense of IEEE 754.
    #[error(
        "{path:?}, line {line}, column {column} ({field}): {found} is not finite; \
         drop this row from every file of the recording"
    )]
    NotFinite {
        /// File concerned.
        path: PathBuf,
        /// Line concerned.
        line: u64,
        /// Column concerned.
        column: usize,
        /// What the column holds.
        field: &'static str,
        /// What was found.
        found: f64,
    },
    /// A file has another number of samples than the file of times.
    #[error(
        "{path:?}: {found} samples, but {expected} times; the files of a recording belong \
         together row by row: restore the cut one"
    )]
    RowCount {
        /// File concerned.
        path: PathBuf,
        /// Samples in the file of times.
        expected: usize,
        /// Samples in this file.
        found: usize,
    },
    /// Time stands still or runs backwards.
    #[error(
        "{path:?}, line {line}: time {found} s does not come after {previous} s; \
         drop or sort the rows, in every file of the recording alike"
    )]
    TimeNotIncreasing {
        /// File concerned.
        path: PathBuf,
        /// Line concerned.
        line: u64,
        /// Time of the line before (s).
        previous: f64,
        /// Time of this line (s).
        found: f64,
    },
    /// A motion-capture row belongs to no known body.
    #[error(
        "{path:?}, line {line}, column 2 (body): unknown body {found}; \
         bodies are 2 (base), 3 (platform) and 4 (ring)"
    )]
    UnknownBody {
        /// File concerned.
        path: PathBuf,
        /// Line concerned.
        line: u64,
        /// What was found.
        found: f64,
    },
    /// A frame has a body twice.
    #[error(
        "{path:?}, line {line}: the {body} comes twice in frame {frame}; \
         a frame has one row each of base, platform and ring: drop the surplus row"
    )]
    RepeatedBody {
        /// File concerned.
        path: PathBuf,
        /// Line of the second row.
        line: u64,
        /// Body concerned.
        body: Body,
        /// Number of the frame.
        frame: f64,
    },
    /// A frame lacks a body.
    #[error(
        "{path:?}, line {line}: frame {frame} ends here without the {body}; \
         a frame has one row each of base, platform and ring: restore the row, or drop the \
         sample from every file of the recording"
    )]
    MissingBody {
        /// File concerned.
        path: PathBuf,
        /// Last line of the frame.
        line: u64,
        /// Body concerned.
        body: Body,
        /// Number of the frame.
        frame: f64,
    },
    /// A quaternion is far from unit length.
    #[error(
        "{path:?}, line {line}, columns 3 to 6 (quaternion x y z w): length {norm} is not 1; \
         check the order of the columns"
    )]
    NotUnit {
        /// File concerned.
        path: PathBuf,
        /// Line concerned.
        line: u64,
        /// Length that was found.
        norm: f64,
    },
    /// Poses were asked of a recording without motion capture.
    #[error(
        "recording {recording}: has no motion capture; add mocap_frame_data_history.csv, \
         or take its poses from a published table"
    )]
    NoMocap {
        /// Name of the recording.
        recording: String,
    },
    /// A published table is damaged or of another kind.
    #[error(
        "{path:?}, array {array}: {reason}; give the .npz table of inverse kinematics results \
         that belongs to the data set"
    )]
    Table {
        /// File concerned.
        path: PathBuf,
        /// Array concerned.
        array: &'static str,
        /// What is wrong with it.
        reason: String,
    },
    /// A published table does not belong to the recording.
    #[error(
        "recording {recording}: the published table's sample {sample} does not belong to it \
         ({reason}); give the table of the same run"
    )]
    TableMismatch {
        /// Name of the recording.
        recording: String,
        /// Sample of the table, from zero.
        sample: usize,
        /// What disagrees.
        reason: String,
    },
    /// A recording in memory is not one that could be read back.
    #[error("recording {recording}: {reason}; mend this before the recording is written or used")]
    Inconsistent {
        /// Name of the recording.
        recording: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The folder to write exists already.
    #[error("{path:?}: exists already and is not overwritten; give a new folder or remove it")]
    Exists {
        /// Folder concerned.
        path: PathBuf,
    },
    /// The system refused to write.
    #[error("{path:?}: cannot be written ({source}); check the folder's rights and free space")]
    Unwritable {
        /// File or folder concerned.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}
