//! What is written is read back as it was, and nothing is overwritten.

mod common;

use auxetica_recordings::{Error, Recording};
use common::small;

#[test]
fn what_is_written_is_read_back() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("small");
    let written = small();
    written.write(&path).unwrap();
    let read = Recording::read(&path).unwrap();
    let (before, after) = (
        written.mocap.as_ref().unwrap(),
        read.mocap.as_ref().unwrap(),
    );
    for body in auxetica_recordings::Body::ALL {
        let (before, after) = (before.track(body), after.track(body));
        assert_eq!(before.position, after.position);
        for (before, after) in before.rotation.iter().zip(&after.rotation) {
            assert!((before.coords - after.coords).norm() < 1e-15);
        }
    }
    assert_eq!(
        Recording {
            mocap: None,
            ..read
        },
        Recording {
            mocap: None,
            ..written
        }
    );
    assert_eq!(std::fs::read_dir(scratch.path()).unwrap().count(), 1);
}

#[test]
fn motion_capture_may_be_absent() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("small");
    let recording = Recording {
        mocap: None,
        ..small()
    };
    recording.write(&path).unwrap();
    assert_eq!(Recording::read(&path).unwrap(), recording);
}

#[test]
fn nothing_is_overwritten() {
    let scratch = tempfile::tempdir().unwrap();
    let error = small().write(scratch.path()).unwrap_err();
    assert!(matches!(error, Error::Exists { .. }), "{error}");
}

#[test]
fn what_could_not_be_read_back_is_not_written() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("small");
    let damages: [fn(&mut Recording); 4] = [
        |r| r.loads.truncate(23),
        |r| r.present[3][1] = f64::NAN,
        |r| r.time[5] = r.time[4],
        |r| r.mocap.as_mut().unwrap().ring.position[2].x = f64::INFINITY,
    ];
    for damage in damages {
        let mut recording = small();
        damage(&mut recording);
        let error = recording.write(&path).unwrap_err();
        assert!(matches!(error, Error::Inconsistent { .. }), "{error}");
        assert_eq!(std::fs::read_dir(scratch.path()).unwrap().count(), 0);
    }
}
