//! Long tables as text.

use crate::files;
use crate::quantity::Quantities;
use crate::rows;
use auxetica_engine::{Body, Callback, CallbackError, Snapshot, register};
use schemars::JsonSchema;
use serde::Deserialize;
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Writes a CSV table of one row a time, body and index: `time_s, body, index`, then one column a component with its
/// unit, as `position_x_m`. Index i is node i, element i (between nodes i and i + 1) and cell i (between elements
/// i - 1 and i); what doesn't exist there is empty. Every time recorded is in the file at once: an interrupted run
/// keeps its rows. A file of that name is replaced when the run starts.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Csv {
    /// File name, in the folder of results unless absolute.
    file: PathBuf,
    /// What to record; position and director unless named.
    #[serde(default)]
    quantities: Quantities,
    #[serde(skip)]
    output: Option<Output>,
}

register!(
    dyn Callback: Csv,
    example = r#"Csv(file: "platform.csv", quantities: [Position, Director])"#,
    source = "RFC 4180; tidy data: Wickham 2014, doi:10.18637/jss.v059.i10",
);

struct Output {
    path: PathBuf,
    file: File,
    /// Bytes of whole times.
    whole: u64,
}

impl Output {
    /// Writes the rows that `table` holds, all or none.
    fn write(&mut self, table: csv::Writer<Vec<u8>>) -> Result<(), CallbackError> {
        let text = table.into_inner().expect("memory takes all rows");
        if let Err(source) = self.file.write_all(&text) {
            // The error to report is the first.
            let _ = self
                .file
                .set_len(self.whole)
                .and_then(|()| self.file.seek(SeekFrom::Start(self.whole)));
            return Err(files::failed(&self.path, source));
        }
        self.whole += text.len() as u64;
        Ok(())
    }
}

fn table() -> csv::Writer<Vec<u8>> {
    csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new())
}

impl Callback for Csv {
    fn start(&mut self, out: &Path, _bodies: &[Body<'_>]) -> Result<(), CallbackError> {
        let path = out.join(&self.file);
        let file = files::open(&path)?;
        let mut header = table();
        let keys = rows::KEYS.into_iter().map(String::from);
        header
            .write_record(keys.chain(rows::columns(&self.quantities)))
            .map_err(|source| files::failed(&path, source))?;
        let output = self.output.insert(Output {
            path,
            file,
            whole: 0,
        });
        output.write(header)
    }

    fn record(&mut self, snapshot: &Snapshot<'_>) -> Result<(), CallbackError> {
        let output = self.output.as_mut().expect("started before the run");
        let mut table = table();
        rows::each(snapshot, &self.quantities, |row| table.serialize(row))
            .map_err(|source| files::failed(&output.path, source))?;
        output.write(table)
    }

    fn finish(&mut self) -> Result<Vec<PathBuf>, CallbackError> {
        Ok(self
            .output
            .take()
            .map(|output| output.path)
            .into_iter()
            .collect())
    }
}
