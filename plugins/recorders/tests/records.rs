//! What is recorded is read back as it was.

mod common;

use auxetica_engine::{Callback, ReadBody, Snapshot};
use auxetica_recorders::{Csv, Npz, Parquet};
use common::{COLUMNS, ELEMENTS, expected_row, recorder, run, snapshot, system};
use npyz::npz::NpzArchive;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::fs::File;
use std::path::Path;

const QUANTITIES: &str = "[Position, Director, Dilatation, Kappa, Torque]";

type Rows = Vec<(f64, String, usize, Vec<Option<f64>>)>;

fn add_rows(rows: &mut Rows, seen: &Snapshot<'_>) {
    for body in &seen.bodies {
        for i in 0..body.nodes() {
            rows.push((seen.time, body.name().into(), i, expected_row(body, i)));
        }
    }
}

/// Records three times into `out/deep/file` and returns the rows expected.
fn record<T: Callback + serde::de::DeserializeOwned>(kind: &str, out: &Path) -> Rows {
    let mut recorder: T = recorder(&format!(
        "{kind}(file: \"deep/file\", quantities: {QUANTITIES})"
    ));
    let mut rows = Rows::new();
    run(&mut recorder, out, 3, |seen| add_rows(&mut rows, seen));
    assert_eq!(recorder.finish().unwrap(), [out.join("deep/file")]);
    assert!(!out.join("deep/file.part").exists());
    assert_eq!(rows.len(), 3 * (ELEMENTS + 1 + 1));
    assert_ne!(rows[0].3, rows[5].3, "the rod moves");
    rows
}

#[test]
fn csv_holds_the_long_table() {
    let out = tempfile::tempdir().unwrap();
    let expected = record::<Csv>("Csv", out.path());
    let mut reader = csv::Reader::from_path(out.path().join("deep/file")).unwrap();
    assert_eq!(reader.headers().unwrap(), &COLUMNS[..]);
    let rows: Result<Rows, _> = reader.deserialize().collect();
    assert_eq!(rows.unwrap(), expected);
}

#[test]
fn parquet_holds_the_long_table() {
    let out = tempfile::tempdir().unwrap();
    let expected = record::<Parquet>("Parquet", out.path());
    let file = File::open(out.path().join("deep/file")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let number = |field: &Field| match field {
        Field::Double(value) => Some(*value),
        Field::Null => None,
        other => panic!("{other:?} is no number"),
    };
    let mut rows = Rows::new();
    for row in reader.get_row_iter(None).unwrap() {
        let (names, fields): (Vec<_>, Vec<_>) = row.unwrap().into_columns().into_iter().unzip();
        assert_eq!(names, COLUMNS);
        let [time, Field::Str(body), Field::Long(index), values @ ..] = &fields[..] else {
            panic!("{fields:?}");
        };
        let values = values.iter().map(number).collect();
        rows.push((number(time).unwrap(), body.clone(), *index as usize, values));
    }
    assert_eq!(rows, expected);
}

#[test]
fn parquet_writes_many_groups() {
    let out = tempfile::tempdir().unwrap();
    let mut recorder: Parquet = recorder("Parquet(file: \"long\")");
    let system = system();
    recorder.start(out.path(), &[]).unwrap();
    let times = 70_000 / (ELEMENTS + 2);
    for _ in 0..times {
        recorder.record(&snapshot(&system)).unwrap();
    }
    recorder.finish().unwrap();
    let reader = SerializedFileReader::new(File::open(out.path().join("long")).unwrap()).unwrap();
    let groups = reader.metadata().row_groups();
    let rows: Vec<_> = groups.iter().map(|group| group.num_rows()).collect();
    assert_eq!(rows, [65_536, 70_000 - 65_536]);
}

#[test]
fn npz_holds_one_array_a_body_and_quantity() {
    let out = tempfile::tempdir().unwrap();
    let expected = record::<Npz>("Npz", out.path());
    let mut archive = NpzArchive::open(out.path().join("deep/file")).unwrap();
    let names: Vec<_> = archive.array_names().map(String::from).collect();
    assert_eq!(names.len(), 1 + 5 + 3, "no elements or cells of the plate");
    let mut array = |name: &str, shape: &[u64]| {
        let array = archive.by_name(name).unwrap().expect(name);
        assert_eq!((array.shape(), array.order()), (shape, npyz::Order::C));
        array.into_vec::<f64>().unwrap()
    };
    let n = ELEMENTS as u64;
    let mut times: Vec<_> = expected.iter().map(|row| row.0).collect();
    times.dedup();
    assert_eq!(array("time", &[3]), times);
    // body, quantity, shape, its columns among the values of a row
    for (body, quantity, shape, columns) in [
        ("rod", "position", &[3, n + 1, 3][..], 0..3),
        ("rod", "director", &[3, n, 3, 3], 3..12),
        ("rod", "dilatation", &[3, n], 12..13),
        ("rod", "torque", &[3, n, 3], 16..19),
        ("plate, top", "position", &[3, 1, 3], 0..3),
        ("plate, top", "director", &[3, 1, 3, 3], 3..12),
        ("plate, top", "torque", &[3, 1, 3], 16..19),
    ] {
        let rows = expected.iter().filter(|row| row.1 == body);
        let values: Vec<_> = rows
            .flat_map(|row| row.3[columns.clone()].iter().flatten())
            .copied()
            .collect();
        assert_eq!(array(&format!("{body}.{quantity}"), shape), values);
    }
    let kappa = array("rod.kappa", &[3, n + 1, 3]);
    let rows = expected.iter().filter(|row| row.1 == "rod");
    for (found, expected) in kappa.iter().zip(rows.flat_map(|row| &row.3[13..16])) {
        match expected {
            Some(expected) => assert_eq!(found.to_bits(), expected.to_bits()),
            None => assert!(found.is_nan(), "no cell at the free end"),
        }
    }
}
