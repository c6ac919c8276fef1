//! A CSV file of finite numbers, as wide as it should be.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::Error;
use crate::files::File;

/// Rows of `N` finite numbers, each with the line it came from.
pub(crate) struct Table<const N: usize> {
    pub path: PathBuf,
    pub rows: Vec<[f64; N]>,
    pub lines: Vec<u64>,
}

impl<const N: usize> Table<N> {
    /// Reads `file` of `folder`.
    pub fn read(folder: &Path, file: &File) -> Result<Self, Error> {
        let path = folder.join(file.name);
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(source) if source.kind() == io::ErrorKind::NotFound => {
                return Err(Error::MissingFile { path });
            }
            Err(source) => return Err(Error::Unreadable { path, source }),
        };
        let mut table = Self {
            path,
            rows: Vec::new(),
            lines: Vec::new(),
        };
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .quoting(false)
            .from_reader(bytes.as_slice());
        for record in reader.byte_records() {
            let record = record.map_err(|error| Error::Unreadable {
                path: table.path.clone(),
                source: error.into(),
            })?;
            let line = record.position().map_or(0, csv::Position::line);
            let row = table.row(&record, line, file.fields)?;
            table.rows.push(row);
            table.lines.push(line);
        }
        // Without this, a number cut short in the last column would pass for a whole one.
        match (table.lines.last(), bytes.last()) {
            (None, _) | (_, None) => Err(Error::Empty { path: table.path }),
            (Some(_), Some(b'\n')) => Ok(table),
            (Some(&line), Some(_)) => Err(Error::CutOff {
                path: table.path,
                line,
            }),
        }
    }

    fn row(
        &self,
        record: &csv::ByteRecord,
        line: u64,
        fields: &'static [&'static str],
    ) -> Result<[f64; N], Error> {
        if record.len() != N {
            return Err(Error::Columns {
                path: self.path.clone(),
                line,
                expected: N,
                found: record.len(),
            });
        }
        let mut row = [0.0_f64; N];
        for (index, (value, bytes)) in row.iter_mut().zip(record).enumerate() {
            let (column, field) = (index + 1, fields[index]);
            let text = String::from_utf8_lossy(bytes);
            *value = text.trim().parse().map_err(|_| Error::NotANumber {
                path: self.path.clone(),
                line,
                column,
                field,
                found: text.chars().take(40).collect(),
            })?;
            if !value.is_finite() {
                return Err(Error::NotFinite {
                    path: self.path.clone(),
                    line,
                    column,
                    field,
                    found: *value,
                });
            }
        }
        Ok(row)
    }

    /// Checks that this file has as many samples as the file of times.
    pub fn expect_rows(self, expected: usize) -> Result<Vec<[f64; N]>, Error> {
        if self.rows.len() == expected {
            Ok(self.rows)
        } else {
            Err(Error::RowCount {
                found: self.rows.len(),
                path: self.path,
                expected,
            })
        }
    }
}
