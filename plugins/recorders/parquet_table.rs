//! Long tables in columns.

use crate::files;
use crate::quantity::{Quantities, Quantity};
use crate::rows::{self, Row};
use auxetica_engine::{Body, Callback, CallbackError, Snapshot, register};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int32Type};
use parquet::errors::Result as Written;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use schemars::JsonSchema;
use serde::Deserialize;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Rows kept in memory before they are written together.
const GROUP: usize = 1 << 16;

/// Writes an Apache Parquet table with the rows and columns of `Csv`: `time_s` and components are doubles, `body` is a
/// string, `index` a 32-bit integer, and what doesn't exist is null. It is compressed with Snappy and needs little
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
    output: Option<Output>,
}

register!(
    dyn Callback: Parquet,
    example = r#"Parquet(file: "rods.parquet", quantities: [Position, Stress, Couple])"#,
    source = "Apache Parquet format 2; tidy data: Wickham 2014, doi:10.18637/jss.v059.i10",
);

struct Output {
    path: PathBuf,
    writer: SerializedFileWriter<File>,
    group: Group,
}

/// Rows not written yet, column by column.
#[derive(Default)]
struct Group {
    time: Vec<f64>,
    body: Vec<ByteArray>,
    index: Vec<i32>,
    components: Vec<Component>,
}

/// A column that may have gaps.
#[derive(Clone, Default)]
struct Component {
    values: Vec<f64>,
    /// One a row: 1 for a value, 0 for a gap.
    levels: Vec<i16>,
}

impl Group {
    fn push(&mut self, row: &Row<'_>) {
        self.time.push(row.time);
        self.body.push(row.body.into());
        self.index.push(row.index as i32);
        self.components
            .resize_with(row.values.len(), Component::default);
        for (component, value) in self.components.iter_mut().zip(row.values) {
            component.values.extend(*value);
            component.levels.push(value.is_some().into());
        }
    }

    fn write(&self, mut group: SerializedRowGroupWriter<'_, File>) -> Written<()> {
        write::<DoubleType>(&mut group, &self.time, None)?;
        write::<ByteArrayType>(&mut group, &self.body, None)?;
        write::<Int32Type>(&mut group, &self.index, None)?;
        for component in &self.components {
            write::<DoubleType>(&mut group, &component.values, Some(&component.levels))?;
        }
        group.close()?;
        Ok(())
    }
}

fn write<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Written<()> {
    let mut column = group.next_column()?.expect("as many as in the schema");
    column.typed::<T>().write_batch(values, levels, None)?;
    column.close()
}

impl Output {
    /// Writes the rows at hand.
    fn flush(&mut self) -> Written<()> {
        let group = std::mem::take(&mut self.group);
        group.write(self.writer.next_row_group()?)
    }

    /// Writes the last rows and the footer.
    fn close(mut self) -> Written<File> {
        if !self.group.time.is_empty() {
            self.flush()?;
        }
        self.writer.into_inner()
    }
}

fn schema(quantities: &[Quantity]) -> Written<Type> {
    let required = |name, physical, logical| {
        Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::REQUIRED)
            .with_logical_type(logical)
            .build()
    };
    let [time, body, index] = rows::KEYS;
    let mut fields = vec![
        required(time, Physical::DOUBLE, None)?,
        required(body, Physical::BYTE_ARRAY, Some(LogicalType::String))?,
        required(index, Physical::INT32, None)?,
    ];
    for name in rows::columns(quantities) {
        let component = Type::primitive_type_builder(&name, Physical::DOUBLE);
        fields.push(component.with_repetition(Repetition::OPTIONAL).build()?);
    }
    Type::group_type_builder("schema")
        .with_fields(fields.into_iter().map(Arc::new).collect())
        .build()
}

impl Callback for Parquet {
    fn start(&mut self, out: &Path, _bodies: &[Body<'_>]) -> Result<(), CallbackError> {
        let path = out.join(&self.file);
        let file = files::open_part(&path)?;
        let properties = WriterProperties::builder().set_compression(Compression::SNAPPY);
        let writer = schema(&self.quantities)
            .and_then(|schema| {
                SerializedFileWriter::new(file, schema.into(), properties.build().into())
            })
            .map_err(|source| files::failed(&path, source))?;
        self.output = Some(Output {
            path,
            writer,
            group: Group::default(),
        });
        Ok(())
    }

    fn record(&mut self, snapshot: &Snapshot<'_>) -> Result<(), CallbackError> {
        let output = self.output.as_mut().expect("started before the run");
        let written = rows::each(snapshot, &self.quantities, |row| {
            output.group.push(row);
            if output.group.time.len() < GROUP {
                return Ok(());
            }
            output.flush()
        });
        written.map_err(|source| files::failed(&output.path, source))
    }

    fn finish(&mut self) -> Result<Vec<PathBuf>, CallbackError> {
        let Some(output) = self.output.take() else {
            return Ok(Vec::new());
        };
        let path = output.path.clone();
        let file = output
            .close()
            .map_err(|source| files::failed(&path, source))?;
        Ok(vec![files::complete(file, &path)?])
    }
}
