//! Long tables in columns.

use crate::parquet_file::{Kind, ParquetFile, Value};
use crate::quantity::Quantities;
use crate::rows;
use auxetica_engine::{Body, Callback, CallbackError, Snapshot, register};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Writes an Apache Parquet table with the rows and columns of `Csv`: `time_s` and components are doubles, `body` is a
/// string, `index` a 64-bit integer, and what doesn't exist is null. It is compressed with Snappy and needs little
/// memory. The file appears when it is whole, at the end of the run, also of one that fails; until then a file of that
/// name stays. Of a process that is killed nothing is left: record a `Csv` where that may happen.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parquet {
    /// File name, in the folder of results unless absolute.
    file: PathBuf,
    /// What to record; position and director unless named.
    #[serde(default)]
    quantities: Quantities,
    #[serde(skip)]
    output: Option<ParquetFile>,
}

register!(
    dyn Callback: Parquet,
    example = r#"Parquet(file: "rods.parquet", quantities: [Position, Stress, Couple])"#,
    source = "Apache Parquet format 2; tidy data: Wickham 2014, doi:10.18637/jss.v059.i10",
);

impl Callback for Parquet {
    fn start(&mut self, out: &Path, _bodies: &[Body<'_>]) -> Result<(), CallbackError> {
        let keys = rows::KEYS.map(String::from);
        let kinds = [Kind::Number, Kind::Text, Kind::Whole];
        let components = rows::columns(&self.quantities).map(|name| (name, Kind::Number));
        let columns: Vec<_> = keys.into_iter().zip(kinds).chain(components).collect();
        self.output = Some(ParquetFile::create(&out.join(&self.file), &columns)?);
        Ok(())
    }

    fn record(&mut self, snapshot: &Snapshot<'_>) -> Result<(), CallbackError> {
        let output = self.output.as_mut().expect("started before the run");
        rows::each(snapshot, &self.quantities, |row| {
            let keys = [
                Value::Number(row.time),
                Value::Text(row.body),
                Value::Whole(row.index as i64),
            ];
            let components = row.values.iter();
            output.row(
                keys.into_iter()
                    .chain(components.map(|v| v.map_or(Value::Missing, Value::Number))),
            )
        })
    }

    fn finish(&mut self) -> Result<Vec<PathBuf>, CallbackError> {
        let finished = self.output.take().map(ParquetFile::finish);
        Ok(finished.transpose()?.into_iter().collect())
    }
}
