//! Broken recordings: each is refused with an error that names the place, and none panics.

mod common;

use std::fs;
use std::path::Path;

use auxetica_recordings::{Body, Error, Recording};
use common::small;

const TIME: &str = "experiment_time_history.csv";
const PRESENT: &str = "present_positions_history.csv";
const MOCAP: &str = "mocap_frame_data_history.csv";

/// Reads the small recording with the text of one file changed.
fn read_with(file: &str, change: impl FnOnce(String) -> String) -> Error {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("broken");
    small().write(&folder).unwrap();
    let path = folder.join(file);
    let text = change(fs::read_to_string(&path).unwrap());
    fs::write(&path, text).unwrap();
    let error = Recording::read(&folder).unwrap_err();
    if !matches!(error, Error::RowCount { .. }) {
        assert!(error.to_string().contains(file), "{error}");
    }
    error
}

/// Changes one line, counted from one.
fn line(number: usize, change: impl Fn(&str) -> String) -> impl FnOnce(String) -> String {
    move |text| {
        (text.lines().enumerate())
            .map(|(index, line)| match index + 1 == number {
                true => change(line),
                false => format!("{line}\n"),
            })
            .collect()
    }
}

macro_rules! assert_error {
    ($error:expr, $pattern:pat $(if $guard:expr)?) => {
        let error = $error;
        assert!(matches!(&error, $pattern $(if $guard)?), "{error:?}");
    };
}

#[test]
fn missing_folder() {
    let error = Recording::read("no/such/folder").unwrap_err();
    assert_error!(error, Error::MissingFolder { .. });
}

#[test]
fn missing_file() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("broken");
    small().write(&folder).unwrap();
    fs::remove_file(folder.join(PRESENT)).unwrap();
    let error = Recording::read(&folder).unwrap_err();
    assert_error!(error, Error::MissingFile { path } if path.ends_with(PRESENT));
}

#[test]
fn unreadable_file() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("broken");
    small().write(&folder).unwrap();
    fs::remove_file(folder.join(PRESENT)).unwrap();
    fs::create_dir(folder.join(PRESENT)).unwrap();
    let error = Recording::read(&folder).unwrap_err();
    assert_error!(error, Error::Unreadable { path, .. } if path.ends_with(PRESENT));
}

#[test]
fn empty_file() {
    assert_error!(read_with(TIME, |_| String::new()), Error::Empty { .. });
    assert_error!(read_with(MOCAP, |_| "\n\n".into()), Error::Empty { .. });
}

#[test]
fn wrong_columns() {
    let error = read_with(PRESENT, line(4, |line| format!("{line},7\n")));
    assert_error!(
        error,
        Error::Columns {
            line: 4,
            expected: 4,
            found: 5,
            ..
        }
    );
    let error = read_with(MOCAP, line(2, |_| "1,3,0\n".into()));
    assert_error!(
        error,
        Error::Columns {
            line: 2,
            expected: 9,
            found: 3,
            ..
        }
    );
}

#[test]
fn header_line() {
    let error = read_with(PRESENT, |text| format!("a,b,c,d\n{text}"));
    assert_error!(error, Error::NotANumber { line: 1, column: 1, found, .. } if found == "a");
}

#[test]
fn not_a_number() {
    let error = read_with(PRESENT, line(9, |_| "1,2,three,4\n".into()));
    assert_error!(
        error,
        Error::NotANumber {
            line: 9,
            column: 3,
            field: "motor 3",
            ..
        }
    );
}

#[test]
fn not_finite() {
    let error = read_with(PRESENT, line(3, |_| "1,NaN,3,4\n".into()));
    assert_error!(
        error,
        Error::NotFinite {
            line: 3,
            column: 2,
            ..
        }
    );
    let error = read_with(TIME, line(24, |_| "1e999\n".into()));
    assert_error!(
        error,
        Error::NotFinite {
            line: 24,
            column: 1,
            field: "time",
            ..
        }
    );
}

#[test]
fn unequal_rows() {
    let error = read_with(PRESENT, line(24, |_| String::new()));
    assert_error!(
        error,
        Error::RowCount {
            expected: 24,
            found: 23,
            ..
        }
    );
    let error = read_with(MOCAP, |text| {
        text.lines()
            .take(69)
            .map(|line| format!("{line}\n"))
            .collect()
    });
    assert_error!(
        error,
        Error::RowCount {
            expected: 24,
            found: 23,
            ..
        }
    );
}

#[test]
fn cut_number() {
    let error = read_with(PRESENT, |text| text[..text.len() - 2].into());
    assert_error!(error, Error::CutOff { line: 24, .. });
}

#[test]
fn time_not_increasing() {
    let error = read_with(TIME, line(7, |_| "1.54\n".into()));
    assert_error!(error, Error::TimeNotIncreasing { line: 7, .. });
}

#[test]
fn unknown_body() {
    let error = read_with(MOCAP, line(5, |line| line.replacen(",3,", ",7,", 1) + "\n"));
    assert_error!(error, Error::UnknownBody { line: 5, .. });
}

#[test]
fn repeated_body() {
    let error = read_with(MOCAP, line(5, |line| line.replacen(",3,", ",2,", 1) + "\n"));
    assert_error!(
        error,
        Error::RepeatedBody {
            line: 5,
            body: Body::Base,
            ..
        }
    );
}

#[test]
fn missing_body() {
    let error = read_with(MOCAP, line(6, |_| String::new()));
    assert_error!(
        error,
        Error::MissingBody {
            line: 5,
            body: Body::Ring,
            ..
        }
    );
}

#[test]
fn quaternion_off_unit() {
    let error = read_with(MOCAP, line(8, |_| "3,3,0,0,0,1.01,0,0,0\n".into()));
    assert_error!(error, Error::NotUnit { line: 8, .. });
}

#[test]
fn small_deviation_from_unit_is_removed() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("odd");
    small().write(&folder).unwrap();
    let text = fs::read_to_string(folder.join(MOCAP)).unwrap();
    let text = line(8, |_| "3,3,0,0,0,-1.0005,0,0,0\n".into())(text);
    fs::write(folder.join(MOCAP), text).unwrap();
    let platform = Recording::read(&folder).unwrap().mocap.unwrap().platform;
    // The sign is continuous as well: the frame before and after have w > 0.
    assert!((platform.rotation[2].w - 1.0).abs() < 1e-15);
    assert_eq!(platform.sign_flips, 2);
}

#[test]
fn every_truncation_is_noticed() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("broken");
    small().write(&folder).unwrap();
    for file in [TIME, PRESENT, MOCAP] {
        let path = folder.join(file);
        let bytes = fs::read(&path).unwrap();
        for length in 0..bytes.len() {
            fs::write(&path, &bytes[..length]).unwrap();
            let read = Recording::read(&folder);
            assert!(read.is_err(), "{file} cut to {length} bytes passes");
        }
        fs::write(&path, &bytes).unwrap();
    }
}

#[test]
fn arbitrary_bytes_do_not_panic() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("broken");
    small().write(&folder).unwrap();
    let path = folder.join(MOCAP);
    let bytes = fs::read(&path).unwrap();
    // A small linear congruential generator: the same bytes in every run.
    let mut state = 1_u64;
    let mut random = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        usize::try_from(state >> 40).unwrap()
    };
    for _ in 0..500 {
        let mut damaged = bytes.clone();
        for _ in 0..=random() % 4 {
            let place = random() % damaged.len();
            damaged[place] = u8::try_from(random() % 256).unwrap();
        }
        use_if_read(&folder, &path, &damaged);
    }
}

/// Whatever is read must be fit for use.
fn use_if_read(folder: &Path, path: &Path, bytes: &[u8]) {
    use auxetica_recordings::{Audit, RobotGeometry, SettleRule, authors_samples};
    fs::write(path, bytes).unwrap();
    if let Ok(recording) = Recording::read(folder) {
        let geometry = RobotGeometry::default();
        let _ = Audit::new(&recording);
        let _ = SettleRule::default().samples(&recording, &geometry);
        let _ = authors_samples(&recording, &geometry);
    }
}

#[test]
fn a_single_row_is_enough_to_read_and_too_few_to_use() {
    use auxetica_recordings::{Audit, MotorAngles, RobotGeometry, SettleRule, authors_samples};
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("short");
    let whole = small();
    let recording = Recording {
        time: whole.time[..1].into(),
        goal: whole.goal[..1].into(),
        present: whole.present[..1].into(),
        velocities: whole.velocities[..1].into(),
        loads: whole.loads[..1].into(),
        mocap: None,
        ..whole
    };
    recording.write(&folder).unwrap();
    let recording = Recording::read(&folder).unwrap();
    let geometry = RobotGeometry::default();
    assert_error!(
        Audit::new(&recording).unwrap_err(),
        Error::Inconsistent { .. }
    );
    assert_error!(
        SettleRule::default()
            .samples(&recording, &geometry)
            .unwrap_err(),
        Error::NoMocap { .. }
    );
    assert_error!(
        authors_samples(&recording, &geometry).unwrap_err(),
        Error::NoMocap { .. }
    );
    assert_eq!(MotorAngles::new(&recording).present, [[0.0; 4]]);
}
