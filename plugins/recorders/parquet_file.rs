//! Parquet files of any columns, row by row.

use crate::files;
use auxetica_engine::CallbackError;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::Result as Written;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Rows kept in memory before they are written together.
const GROUP: usize = 1 << 16;

/// What the values of a column are; each may be missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Doubles.
    Number,
    /// 64-bit integers.
    Whole,
    /// Strings.
    Text,
}

/// A value of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    /// Nothing, null in the file.
    Missing,
    /// For a column of numbers.
    Number(f64),
    /// For a column of whole numbers.
    Whole(i64),
    /// For a column of texts.
    Text(&'a str),
}

/// A Parquet file, compressed with Snappy, that appears when it is finished; until then a file of that name stays.
pub struct ParquetFile {
    path: PathBuf,
    writer: SerializedFileWriter<File>,
    columns: Vec<Column>,
    rows: usize,
}

/// Values not written yet.
struct Column {
    values: Values,
    /// One a row: 1 for a value, 0 for a gap.
    levels: Vec<i16>,
}

enum Values {
    Numbers(Vec<f64>),
    Wholes(Vec<i64>),
    Texts(Vec<ByteArray>),
}

impl Column {
    fn new(kind: Kind) -> Self {
        Self {
            values: match kind {
                Kind::Number => Values::Numbers(Vec::new()),
                Kind::Whole => Values::Wholes(Vec::new()),
                Kind::Text => Values::Texts(Vec::new()),
            },
            levels: Vec::new(),
        }
    }

    fn push(&mut self, value: Value<'_>) {
        match (&mut self.values, value) {
            (_, Value::Missing) => {}
            (Values::Numbers(values), Value::Number(value)) => values.push(value),
            (Values::Wholes(values), Value::Whole(value)) => values.push(value),
            (Values::Texts(values), Value::Text(value)) => values.push(value.into()),
            _ => panic!("a value is of its column's kind"),
        }
        self.levels.push((value != Value::Missing).into());
    }

    fn write(&mut self, group: &mut SerializedRowGroupWriter<'_, File>) -> Written<()> {
        match &mut self.values {
            Values::Numbers(values) => write::<DoubleType>(group, values, &self.levels)?,
            Values::Wholes(values) => write::<Int64Type>(group, values, &self.levels)?,
            Values::Texts(values) => write::<ByteArrayType>(group, values, &self.levels)?,
        }
        self.levels.clear();
        Ok(())
    }
}

fn write<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: &mut Vec<T::T>,
    levels: &[i16],
) -> Written<()> {
    let mut column = group.next_column()?.expect("as many as in the schema");
    column
        .typed::<T>()
        .write_batch(values, Some(levels), None)?;
    values.clear();
    column.close()
}

impl ParquetFile {
    /// Begins the file that [`ParquetFile::finish`] calls `path`, with the folders that it needs.
    ///
    /// # Errors
    /// If it can't be written, or another writer is at it.
    pub fn create(path: &Path, columns: &[(String, Kind)]) -> Result<Self, CallbackError> {
        let file = files::open_part(path)?;
        let properties = WriterProperties::builder().set_compression(Compression::SNAPPY);
        let writer = schema(columns)
            .and_then(|schema| {
                SerializedFileWriter::new(file, schema.into(), properties.build().into())
            })
            .map_err(|source| files::failed(path, source))?;
        Ok(Self {
            path: path.into(),
            writer,
            columns: columns.iter().map(|(_, kind)| Column::new(*kind)).collect(),
            rows: 0,
        })
    }

    /// Adds a row, one value a column.
    ///
    /// # Errors
    /// If the file can't be written.
    ///
    /// # Panics
    /// If a value is not of its column's kind.
    pub fn row<'a>(
        &mut self,
        values: impl IntoIterator<Item = Value<'a>>,
    ) -> Result<(), CallbackError> {
        let mut values = values.into_iter();
        for column in &mut self.columns {
            column.push(values.next().expect("one value a column"));
        }
        self.rows += 1;
        if self.rows < GROUP {
            return Ok(());
        }
        self.flush()
    }

    /// Writes the rows at hand.
    fn flush(&mut self) -> Result<(), CallbackError> {
        self.rows = 0;
        let mut written = || {
            let mut group = self.writer.next_row_group()?;
            for column in &mut self.columns {
                column.write(&mut group)?;
            }
            group.close().map(drop)
        };
        written().map_err(|source| files::failed(&self.path, source))
    }

    /// Writes what is left, and gives the file its name.
    ///
    /// # Errors
    /// If it can't be written; a file that had the name then stays.
    pub fn finish(mut self) -> Result<PathBuf, CallbackError> {
        if self.rows > 0 {
            self.flush()?;
        }
        let file = self
            .writer
            .into_inner()
            .map_err(|source| files::failed(&self.path, source))?;
        files::complete(file, &self.path)
    }
}

fn schema(columns: &[(String, Kind)]) -> Written<Type> {
    let mut fields = Vec::new();
    for (name, kind) in columns {
        let (physical, logical) = match kind {
            Kind::Number => (Physical::DOUBLE, None),
            Kind::Whole => (Physical::INT64, None),
            Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let column = Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical);
        fields.push(Arc::new(column.build()?));
    }
    Type::group_type_builder("schema")
        .with_fields(fields)
        .build()
}
