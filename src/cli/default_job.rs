//! The main job on an embedded scenario: the recorded robot beside a real recording, or beside one made here.

use super::progress::Meter;
use super::{Failure, compare::show, print};
use crate::compare::{Mode, SampleKind, compare, make_recording};
use crate::config::Source;
use crate::reproduce::Data;
use std::path::{Path, PathBuf};

const SCENARIO: &str = include_str!("../../scenarios/hsa_robot_recorded.ron");
/// The elongation recording of the public data set.
const RECORDING: &str = "recordings/20221011_174514";
/// How the robot of the made recording differs from the scenario that it is compared with.
const OTHER_ROBOT: [&str; 4] = [
    "rods[0].elements=13",
    "rods[0].material.bending=0.0216",
    "rods[0].material.twist=0.0094",
    "forcing=[(apply: Gravity(g: (0, 0, 9.81)))]",
];

pub(super) fn run(quiet: bool) -> Result<(), Failure> {
    let source = Source::from_text("scenarios/hsa_robot_recorded.ron (embedded)", SCENARIO, &[])?;
    let data = Data::from_environment();
    let real = data.folder().join(RECORDING);
    let folder = if real.is_dir() {
        real.clone()
    } else {
        let made = made_folder(quiet, data.folder())?;
        let robot = Source::from_text(source.name(), SCENARIO, &OTHER_ROBOT.map(String::from))?;
        make_recording(&robot, &made)?;
        made
    };
    let mut meter = Meter::new("comparing", quiet);
    let comparison = compare(
        &source,
        &folder,
        Mode::Steady,
        SampleKind::Settled,
        None,
        &mut |done| meter.update(done),
    )?;
    drop(meter);
    print(&show(&comparison))?;
    if quiet {
        return Ok(());
    }
    print(&format!(
        "\nTry next:\n  auxetica compare scenarios/hsa_robot_recorded.ron --recording {} --set 'laws[*].apply.factor=0.011'\n  \
         auxetica run scenarios/hsa_robot.ron\n  auxetica plugins\n  auxetica --help",
        if folder == real {
            real.display().to_string()
        } else {
            "DIR".into()
        }
    ))
}

/// Where the recording is made, after telling that there is no real one.
fn made_folder(quiet: bool, data: &Path) -> Result<PathBuf, Failure> {
    if !quiet {
        eprintln!(
            "No real recording under {}/{RECORDING}: this compares with a recording that Auxetica makes itself, of a \
             robot that weighs something and is a little stiffer in bending. For the real one, download the data set \
             github.com/tud-cor-sr/hsa-kinematic-model and set AUXETICA_DATA to the folder that holds `recordings/`.",
            data.display()
        );
    }
    let parent = PathBuf::from("out");
    let made = parent.join("made_by_auxetica");
    let fresh = || {
        std::fs::create_dir_all(&parent)?;
        if made.is_dir() {
            std::fs::remove_dir_all(&made)?;
        }
        Ok(())
    };
    fresh().map_err(|source| Failure::Output {
        path: made.clone(),
        source,
    })?;
    Ok(made)
}
