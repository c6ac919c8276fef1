//! Nothing written is lost, and what can't be written is told before the run.

mod common;

use auxetica_engine::Callback;
use auxetica_recorders::{Csv, Npz, Parquet};
use common::{recorder, run};
use std::fs;

/// A recorder of each kind, to the file `name`.
fn recorders(name: &str) -> [Box<dyn Callback>; 3] {
    [
        Box::new(recorder::<Csv>(&format!("Csv(file: {name:?})"))),
        Box::new(recorder::<Npz>(&format!("Npz(file: {name:?})"))),
        Box::new(recorder::<Parquet>(&format!("Parquet(file: {name:?})"))),
    ]
}

#[test]
fn unwritable_files_are_told_at_the_start() {
    let out = tempfile::tempdir().unwrap();
    fs::write(out.path().join("note"), "not a folder").unwrap();
    fs::create_dir(out.path().join("folder")).unwrap();
    for name in ["note/table", "folder"] {
        for mut recorder in recorders(name) {
            let error = recorder.start(out.path(), &[]).unwrap_err();
            let path = out.path().join(name).display().to_string();
            assert!(
                error.what.starts_with(&format!("writing {path}")),
                "{error}"
            );
            assert!(recorder.finish().unwrap().is_empty());
        }
    }
    assert_eq!(
        fs::read_to_string(out.path().join("note")).unwrap(),
        "not a folder"
    );
}

#[test]
fn one_recorder_writes_a_file_at_a_time() {
    let out = tempfile::tempdir().unwrap();
    for (mut first, mut second) in recorders("same").into_iter().zip(recorders("same")) {
        run(&mut *first, out.path(), 2, |_| ());
        let error = second.start(out.path(), &[]).unwrap_err().to_string();
        assert!(error.contains("another recorder is writing it"), "{error}");
        first.finish().unwrap();
        let once = fs::read(out.path().join("same")).unwrap();
        // afterwards the file is replaced by the same
        run(&mut *second, out.path(), 2, |_| ());
        second.finish().unwrap();
        assert_eq!(fs::read(out.path().join("same")).unwrap(), once);
    }
}

#[test]
fn an_interrupted_table_of_text_keeps_its_rows() {
    let out = tempfile::tempdir().unwrap();
    let lines = || {
        let text = fs::read_to_string(out.path().join("rows.csv")).unwrap();
        assert!(text.ends_with('\n'));
        text.lines().count()
    };
    let mut recorder: Csv = recorder("Csv(file: \"rows.csv\")");
    let mut times = 0;
    run(&mut recorder, out.path(), 4, |seen| {
        times += 1;
        let rows: usize = seen
            .bodies
            .iter()
            .map(auxetica_engine::ReadBody::nodes)
            .sum();
        assert_eq!(lines(), 1 + times * rows);
    });
    let before = lines();
    drop(recorder);
    assert_eq!(lines(), before);
}

#[test]
fn an_interrupted_recording_leaves_the_older_file() {
    let out = tempfile::tempdir().unwrap();
    let [_, npz, parquet] = recorders("old");
    for mut recorder in [npz, parquet] {
        fs::write(out.path().join("old"), "complete").unwrap();
        run(&mut *recorder, out.path(), 2, |_| ());
        drop(recorder);
        assert_eq!(
            fs::read_to_string(out.path().join("old")).unwrap(),
            "complete"
        );
    }
}

#[test]
fn absolute_names_stay() {
    let (out, elsewhere) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let path = elsewhere.path().join("here");
    for mut recorder in recorders(path.to_str().unwrap()) {
        run(&mut *recorder, out.path(), 1, |_| ());
        assert_eq!(recorder.finish().unwrap(), [path.as_path()]);
    }
    assert_eq!(fs::read_dir(out.path()).unwrap().count(), 0);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_told() {
    let mut recorder: Csv = recorder("Csv(file: \"/dev/full\")");
    let error = recorder.start("/".as_ref(), &[]).unwrap_err();
    assert_eq!(error.what, "writing /dev/full");
}
