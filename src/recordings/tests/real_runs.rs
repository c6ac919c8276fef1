//! The five real runs: read, audited, brought into the base frame.

mod common;

use auxetica_recordings::{
    Audit, BasePoses, Body, MotorAngles, Recording, Reference, RobotGeometry,
};
use common::{RUNS, WITHOUT_MOCAP, data};

#[test]
fn every_run_is_read_in_full() {
    let Some(folder) = data("recordings") else {
        return;
    };
    for (name, rows) in RUNS {
        let run = Recording::read(folder.join(name)).unwrap();
        assert_eq!((run.name.as_str(), run.len()), (name, rows));
        assert_eq!(run.first_row(), 1, "row 0 of the motors is a place-holder");
        assert_eq!(run.mocap.is_none(), name == WITHOUT_MOCAP);
    }
}

#[test]
fn audits_find_what_is_known_of_the_runs() {
    let Some(folder) = data("recordings") else {
        return;
    };
    for (name, _) in RUNS {
        let audit = Audit::new(&Recording::read(folder.join(name)).unwrap()).unwrap();
        println!("{audit}");
        assert!((audit.median_step - 0.108).abs() < 5e-4);
        let gaps: Vec<usize> = audit.gaps.iter().map(|gap| gap.row).collect();
        assert_eq!(
            gaps,
            if name == WITHOUT_MOCAP {
                vec![15816]
            } else {
                vec![]
            }
        );
        for body in &audit.bodies {
            let twisting_ring = name == "20221012_103309" && body.body == Body::Ring;
            assert_eq!(
                body.flips.len(),
                if twisting_ring { 9 } else { 0 },
                "{name} {body:?}"
            );
            assert_eq!(body.sign_flips, 0);
            assert!((3..20).contains(&body.stale.len()));
            assert!(body.jumps.len() < 150, "most steps at rest are noise");
        }
        assert!(
            audit
                .base_rotation
                .is_none_or(|rotation| rotation.angle() < 2e-3)
        );
    }
}

#[test]
fn base_frame_has_the_robot_along_z() {
    let Some(folder) = data("recordings") else {
        return;
    };
    let geometry = RobotGeometry::default();
    for (name, _) in RUNS.into_iter().filter(|(name, _)| *name != WITHOUT_MOCAP) {
        let run = Recording::read(folder.join(name)).unwrap();
        let poses = BasePoses::new(&run, &geometry).unwrap();
        let rest = Reference::new(&run, &poses).unwrap();
        let platform = rest.platform.translation.vector;
        assert!(platform.xy().norm() < 6e-3, "{name}: {platform}");
        assert!((0.117..0.125).contains(&platform.z), "{name}: {platform}");
        let ring = rest.ring.translation.vector - geometry.ring_rod_base();
        assert!(ring.xy().norm() < 4e-3, "{name}: {ring}");
        assert!((0.029..0.034).contains(&ring.z), "{name}: {ring}");

        let moved = poses.from_rest(&rest);
        assert!(moved.platform[rest.rows.start].rotation.angle() < 1e-3);
        assert_eq!(moved.platform[7].translation, poses.platform[7].translation);
    }
}

#[test]
fn angles_stay_within_what_the_runs_command() {
    let Some(folder) = data("recordings") else {
        return;
    };
    let run = Recording::read(folder.join("20221011_174514")).unwrap();
    let angles = MotorAngles::new(&run);
    assert_eq!((angles.first_row, angles.time.len()), (1, run.len() - 1));
    assert!(angles.present[0].iter().all(|angle| angle.abs() < 1e-12));
    // Elongation to 180 degrees: right-handed rods wind with a growing, the others with a
    // falling angle.
    for motor in 0..4 {
        let extreme = angles
            .goal
            .iter()
            .map(|a| a[motor].abs())
            .fold(0.0, f64::max);
        assert!((extreme - std::f64::consts::PI).abs() < 0.05, "{extreme}");
        let sum: f64 = angles.present.iter().map(|a| a[motor]).sum();
        assert_eq!(sum > 0.0, motor % 2 == 0);
    }
}
