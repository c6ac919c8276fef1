//! Whether scenario and recordings are of the same robot, in the same units.

use super::DiagnoseError;
use super::forward::{CHANNELS, differences, platform_rms};
use super::samples::{Phase, Samples};
use super::scores::Scores;
use crate::compare::motor_inputs;
use crate::config::Source;
use nalgebra::Vector3;
use std::path::PathBuf;

/// Root mean square of the platform's error after calibration beyond which a recording is of another robot [mm].
const OTHER_ROBOT: f64 = 40.0;
/// Times as far as the scenario's platform that the recorded one may move, and as far that it may be from the base.
const SIZE: f64 = 3.0;
/// Movement of the platform that says nothing of units [m].
const LITTLE: f64 = 2e-3;
/// Times as good as the order of the motors that another must be.
const BETTER: f64 = 3.0;
/// Units of length that are taken for metres, and how many there are to a metre.
const UNITS: [(&str, f64); 4] = [
    ("mm", 1e3),
    ("cm", 100.0),
    ("inches", 39.37),
    ("feet", 3.281),
];

/// Refuses a recording that is given twice, since a model must be judged by others than those it is fitted to.
pub(super) fn given_once(folders: &[PathBuf]) -> Result<(), DiagnoseError> {
    let real = |folder: &PathBuf| folder.canonicalize().unwrap_or_else(|_| folder.clone());
    let mut seen = Vec::new();
    for folder in folders {
        if seen.contains(&real(folder)) {
            return Err(DiagnoseError::Unfit(format!(
                "recording {folder:?} is given twice; each recording is either trained on (--train) or held out \
                 (--holdout), once"
            )));
        }
        seen.push(real(folder));
    }
    Ok(())
}

/// Refuses a recording whose platform is elsewhere or moves otherwise by far than the scenario's before anything is
/// calibrated; `apart` is simulated less recorded.
pub(super) fn before_calibration(
    source: &Source,
    apart: &[f64],
    samples: &Samples,
) -> Result<(), DiagnoseError> {
    let recorded: Vec<Vector3<f64>> = (samples.list.iter())
        .map(|sample| sample.poses[0].translation.vector)
        .collect();
    let simulated: Vec<Vector3<f64>> = (recorded.iter().zip(apart.chunks_exact(CHANNELS)))
        .map(|(recorded, apart)| recorded + Vector3::from_column_slice(apart))
        .collect();
    let (height, wanted) = (mean(&recorded), mean(&simulated));
    if (height - wanted).norm() > wanted.norm() * (1.0 - 1.0 / SIZE) {
        let [x, y, z]: [f64; 3] = height.into();
        let [a, b, c]: [f64; 3] = wanted.into();
        let times = height.norm() / wanted.norm();
        let unit = UNITS
            .iter()
            .find(|(_, per)| (times / per - 1.0).abs() < 0.2);
        let remedy = match unit {
            Some((unit, _)) => format!("its positions seem to be in {unit} and not in m; convert them"),
            None => "positions are in m, and bodies are numbered 2 (base), 3 (platform) and 4 (ring); mend the file, or \
                     give the scenario of the robot that was recorded"
                .into(),
        };
        return Err(DiagnoseError::Unfit(format!(
            "recording `{}`, mocap_frame_data_history.csv: on average its platform is at ({x:.3}, {y:.3}, {z:.3}) m from \
             the base, and the scenario's at ({a:.3}, {b:.3}, {c:.3}) m: {remedy}",
            samples.name
        )));
    }
    let (moved, expected) = (spread(&recorded, &height), spread(&simulated, &wanted));
    if moved > (SIZE * expected).max(LITTLE) || expected > (SIZE * moved).max(LITTLE) {
        motor_order(source, samples)?;
        return Err(DiagnoseError::Unfit(format!(
            "recording `{}`: its platform moves by {:.1} mm (root mean square), and the scenario's by {:.1} mm under the \
             same motor positions: they are in ticks, of which 4096 are a turn; convert them, or give the scenario of the \
             robot that was recorded",
            samples.name,
            1e3 * moved,
            1e3 * expected
        )));
    }
    Ok(())
}

fn mean(positions: &[Vector3<f64>]) -> Vector3<f64> {
    positions.iter().sum::<Vector3<f64>>() / positions.len() as f64
}

fn spread(positions: &[Vector3<f64>], mean: &Vector3<f64>) -> f64 {
    let squares = positions.iter().map(|p| (p - mean).norm_squared());
    (squares.sum::<f64>() / positions.len() as f64).sqrt()
}

/// Refuses a calibrated scenario that is far off on a recording.
pub(super) fn after_calibration(scores: &Scores) -> Result<(), DiagnoseError> {
    let (name, worst) = scores.worst();
    if worst <= OTHER_ROBOT {
        return Ok(());
    }
    Err(DiagnoseError::Unfit(format!(
        "the calibrated scenario is {worst:.0} mm off on recording `{name}`: it is of another robot, or its motors are in \
         another order; give the scenario of the robot that was recorded"
    )))
}

/// Refuses a recording whose motors, in another order or turning the other way, fit the scenario far better.
pub(super) fn motor_order(source: &Source, samples: &Samples) -> Result<(), DiagnoseError> {
    let mut found: Vec<(f64, [usize; 4], f64)> = Vec::new();
    for order in orders() {
        for sign in [1.0, -1.0] {
            let with = permuted(samples, order, sign).map_err(DiagnoseError::Unfit)?;
            let rms = differences(source, &with).map(|apart| platform_rms(&apart, &with).0);
            found.extend(rms.ok().map(|rms| (rms, order, sign)));
        }
    }
    let as_given = found
        .iter()
        .find(|(_, order, sign)| *order == [0, 1, 2, 3] && *sign > 0.0);
    let best = found.iter().min_by(|a, b| a.0.total_cmp(&b.0));
    match (as_given, best) {
        (Some((given, ..)), Some((rms, order, sign))) if *given > BETTER * rms => {
            let columns = order.map(|i| (i + 1).to_string()).join(", ");
            let turn = if *sign > 0.0 {
                ""
            } else {
                " and the opposite sign"
            };
            Err(DiagnoseError::Unfit(format!(
                "recording `{}`, present_positions_history.csv: its motors seem to be in another order: with columns \
                 {columns}{turn} the scenario is {rms:.2} mm off before anything is calibrated, as they are {given:.2} mm; \
                 put the columns in the order of the scenario's motor_1 to motor_4",
                samples.name
            )))
        }
        _ => Ok(()),
    }
}

/// All orders of four motors.
fn orders() -> Vec<[usize; 4]> {
    let all = (0..256).map(|k| [k / 64, k / 16 % 4, k / 4 % 4, k % 4]);
    all.filter(|order| (0..4).all(|i| order.contains(&i)))
        .collect()
}

/// The settled samples, with motor `i` where motor `order[i]` is recorded.
fn permuted(samples: &Samples, order: [usize; 4], sign: f64) -> Result<Samples, String> {
    let mut with = samples.clone();
    with.list.retain(|sample| sample.phase == Phase::Settled);
    for sample in &mut with.list {
        sample.angles = order.map(|i| sign * sample.angles[i]);
    }
    let rest = std::iter::once((with.rest, [0.0; 4]));
    let later = with.list.iter().filter(|sample| sample.time > with.rest);
    let way = rest.chain(later.map(|sample| (sample.time, sample.angles)));
    let (times, angles): (Vec<f64>, Vec<[f64; 4]>) = way.unzip();
    with.inputs = motor_inputs(&times, &angles)?;
    Ok(with)
}
