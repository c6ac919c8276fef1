//! Arrays for NumPy.

use crate::files;
use crate::layout::Layout;
use crate::quantity::Quantities;
use auxetica_engine::{Body, Callback, CallbackError, ReadBody, Snapshot, register};
use npyz::WriterBuilder;
use npyz::npz::NpzWriter;
use npyz::zip::{CompressionMethod, DateTime, write::FileOptions};
use schemars::JsonSchema;
use serde::Deserialize;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

/// Writes an NPZ archive of float64 arrays: `time` in s of shape (T), and `<body>.<quantity>` for every body and
/// quantity, as `rod_1.position` of shape (T, nodes, 3). The second axis counts nodes, elements or frames; that of a
/// cell quantity has one place a node, NaN where no cell is (the ends, unless a wall holds them). Vectors add an axis
/// of 3, frames (3, 3) with the directors as rows. Rigid bodies have no element and cell quantities. All is kept in
/// memory (8 bytes a number) and written at the end, also of a run that fails; until then a file of that name stays.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Npz {
    /// File name, in the folder of results unless absolute.
    file: PathBuf,
    /// What to record; position and director unless named.
    #[serde(default)]
    quantities: Quantities,
    #[serde(skip)]
    output: Option<Output>,
}

register!(
    dyn Callback: Npz,
    example = r#"Npz(file: "rods.npz", quantities: [Position, Kappa])"#,
    source = "NumPy enhancement proposal 1",
);

struct Output {
    path: PathBuf,
    file: File,
    time: Vec<f64>,
    arrays: Vec<Array>,
}

/// One quantity of one body over time.
struct Array {
    name: String,
    /// Which of the bodies watched.
    body: usize,
    layout: Layout,
    /// Length of the second axis.
    end: usize,
    values: Vec<f64>,
}

impl Array {
    /// One for every body and every quantity that it has.
    fn all(bodies: &[Body<'_>], quantities: &Quantities) -> Vec<Self> {
        let of = |(index, body): (usize, &Body<'_>)| {
            let layouts = quantities.iter().map(|quantity| Layout::from(*quantity));
            layouts
                .filter(|layout| layout.end(body) > 0)
                .map(|layout| Self {
                    name: format!("{}.{}", body.name(), layout.name),
                    body: index,
                    layout,
                    end: layout.end(body),
                    values: Vec::new(),
                })
                .collect::<Vec<_>>()
        };
        bodies.iter().enumerate().flat_map(of).collect()
    }

    fn record(&mut self, body: &Body<'_>) {
        let mut values = Vec::new();
        for index in 0..self.end {
            self.layout.append(body, index, &mut values);
        }
        let values = values.into_iter().map(|value| value.unwrap_or(f64::NAN));
        self.values.extend(values);
    }

    fn shape(&self, times: usize) -> Vec<u64> {
        let axes = [times as u64, self.end as u64];
        axes.iter().chain(self.layout.shape()).copied().collect()
    }
}

impl Output {
    fn write(&self) -> io::Result<()> {
        let mut archive = NpzWriter::new(BufWriter::new(&self.file));
        let times = self.time.len();
        write(&mut archive, "time", &[times as u64], &self.time)?;
        for array in &self.arrays {
            write(
                &mut archive,
                &array.name,
                &array.shape(times),
                &array.values,
            )?;
        }
        archive.zip_writer().finish()?.into_inner()?;
        Ok(())
    }
}

fn write(
    archive: &mut NpzWriter<BufWriter<&File>>,
    name: &str,
    shape: &[u64],
    values: &[f64],
) -> io::Result<()> {
    // As NumPy does: not compressed, of any size, the same bytes whenever written.
    let options = FileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .large_file(true)
        .last_modified_time(DateTime::default());
    let mut array = archive
        .array(name, options)?
        .default_dtype()
        .shape(shape)
        .begin_nd()?;
    array.extend(values)?;
    array.finish()
}

impl Callback for Npz {
    fn start(&mut self, out: &Path, _bodies: &[Body<'_>]) -> Result<(), CallbackError> {
        let path = out.join(&self.file);
        let file = files::open_part(&path)?;
        self.output = Some(Output {
            path,
            file,
            time: Vec::new(),
            arrays: Vec::new(),
        });
        Ok(())
    }

    fn record(&mut self, snapshot: &Snapshot<'_>) -> Result<(), CallbackError> {
        let output = self.output.as_mut().expect("started before the run");
        if output.time.is_empty() {
            output.arrays = Array::all(&snapshot.bodies, &self.quantities);
        }
        output.time.push(snapshot.time);
        for array in &mut output.arrays {
            array.record(&snapshot.bodies[array.body]);
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<Vec<PathBuf>, CallbackError> {
        let Some(output) = self.output.take() else {
            return Ok(Vec::new());
        };
        output
            .write()
            .map_err(|source| files::failed(&output.path, source))?;
        Ok(vec![files::complete(output.file, &output.path)?])
    }
}
