//! Settled samples: of a made-up recording, the real runs and the simulated ones.

mod common;

use auxetica_recordings::{MarkerFrame, OffsetZ, Recording, RobotGeometry, SettleRule};
use common::{RUNS, WITHOUT_MOCAP, data, small};
use nalgebra::Vector3;

#[test]
fn made_up_recording_settles_twice() {
    let recording = small();
    let geometry = RobotGeometry::default();
    let samples = SettleRule::default()
        .samples(&recording, &geometry)
        .unwrap();
    assert_eq!((samples.len(), samples.skipped), (2, 0));
    assert_eq!(samples.row, [11, 23]);
    let angle = 600.0 * auxetica_recordings::RADIANS_PER_TICK;
    for (angle, expected) in samples.angles[1].iter().zip([angle, 0.0, angle, 0.0]) {
        assert!((angle - expected).abs() < 1e-12);
    }
    let rise = samples.platform[1].translation.vector - samples.platform[0].translation.vector;
    assert!((rise - Vector3::new(0.0, 0.0, 0.003)).norm() < 1e-6);
    assert!((samples.platform[1].rotation.angle() - 0.03).abs() < 1e-9);
    assert!(
        (samples.platform[0].translation.vector - Vector3::new(0.003, -0.001, 0.120)).norm() < 1e-6
    );

    // A simulated platform that moves alike shows its markers where they were recorded.
    let at_rest = Vector3::new(0.0, 0.0, 0.1125);
    let frame = MarkerFrame::new(&samples.reference.platform, &at_rest, OffsetZ::Reference);
    assert!((frame.offset - Vector3::new(0.003, -0.001, 0.0075)).norm() < 1e-6);
    let given = MarkerFrame::new(&samples.reference.platform, &at_rest, OffsetZ::Given(0.007));
    assert!((frame.offset - given.offset - Vector3::z() * 5e-4).norm() < 1e-6);
    let mut body = samples.platform[0];
    body.translation = at_rest.into();
    let shown = frame.marker_pose(&body).translation.vector;
    assert!((shown - samples.platform[0].translation.vector).norm() < 1e-6);
}

#[test]
fn a_swapped_marker_does_no_harm() {
    let mut recording = small();
    let geometry = RobotGeometry::default();
    let clean = SettleRule::default()
        .samples(&recording, &geometry)
        .unwrap();
    let ring = &mut recording.mocap.as_mut().unwrap().ring;
    ring.position[22] += Vector3::new(4e-4, 0.0, 0.0);
    ring.rotation[22] = nalgebra::UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 2.8);
    let swapped = SettleRule::default()
        .samples(&recording, &geometry)
        .unwrap();
    let (clean, swapped) = (clean.ring[1], swapped.ring[1]);
    assert!((clean.translation.vector - swapped.translation.vector).norm() < 1e-6);
    assert!(clean.rotation.angle_to(&swapped.rotation) < 1e-6);
}

#[test]
fn dwells_that_never_settle_are_counted() {
    let mut recording = small();
    recording.velocities[22] = [0.0, 20.0, 0.0, 0.0];
    let samples = (SettleRule::default().samples(&recording, &RobotGeometry::default())).unwrap();
    assert_eq!((samples.len(), samples.skipped), (1, 1));
}

#[test]
fn real_runs_settle_in_most_dwells() {
    let Some(folder) = data("recordings") else {
        return;
    };
    let geometry = RobotGeometry::default();
    for (name, _) in RUNS.into_iter().filter(|(name, _)| *name != WITHOUT_MOCAP) {
        let run = Recording::read(folder.join(name)).unwrap();
        let samples = SettleRule::default().samples(&run, &geometry).unwrap();
        println!("{name}: {} settled, {} not", samples.len(), samples.skipped);
        assert!(samples.len() > 9 * samples.skipped, "{name}");
        for platform in &samples.platform {
            let position = platform.translation.vector;
            assert!((0.10..0.16).contains(&position.z) && position.xy().norm() < 0.06);
        }
    }
}

#[test]
fn simulated_recordings_are_read_and_settle() {
    let Some(folder) = data("concealed") else {
        return;
    };
    let geometry = RobotGeometry::default();
    let mut recordings = 0;
    for case in ["a", "b", "c", "d", "e", "f"] {
        for entry in std::fs::read_dir(folder.join(format!("open_{case}"))).unwrap() {
            let path = entry.unwrap().path();
            let recording = Recording::read(&path).unwrap();
            let samples = SettleRule::default()
                .samples(&recording, &geometry)
                .unwrap();
            println!(
                "{case} {}: {} settled, {} not",
                recording.name,
                samples.len(),
                samples.skipped
            );
            assert!(samples.len() >= 20 && samples.skipped <= 1);
            recordings += 1;
        }
    }
    assert_eq!(recordings, 24);
}
