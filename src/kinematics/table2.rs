//! Table II of the paper, repeated: five runs of the robot, three choices of strains.
//!
//! A sample has three poses: the rod's base, constructed from the motor's angle, the ring and the
//! tip, both measured. The rod has two equal segments that end at the tip.

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::{Descent, LeastSquares, Metrics, Observed, Pose, Spcs, StrainSelector};

/// One run of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// The trajectory's name in the table.
    pub name: &'static str,
    /// Folder of the recording in the data set.
    pub recording: &'static str,
    /// The errors as printed, for the three choices of strains in [`SELECTORS`].
    pub printed: [Metrics; 3],
}

/// The table's three choices of strains: 7, 11 and 13 degrees of freedom.
pub const SELECTORS: [StrainSelector; 3] = [
    StrainSelector::UNSHEARED,
    StrainSelector::SHEARED,
    StrainSelector::PIECEWISE,
];

/// The table as printed, its [`MISPRINTS`] included.
pub const RUNS: [Run; 5] = [
    Run {
        name: "Elongation",
        recording: "20221011_174514",
        printed: [
            printed(1.010, 0.0092, [0.0029, 0.0079, 0.0166]),
            printed(0.126, 0.0082, [0.0020, 0.0031, 0.0166]),
            printed(0.009, 0.0042, [0.0020, 0.0031, 0.0070]),
        ],
    },
    Run {
        name: "Circles",
        recording: "20221011_184131",
        printed: [
            printed(1.744, 0.0136, [0.0108, 0.0123, 0.0228]),
            printed(0.227, 0.0082, [0.0110, 0.0122, 0.0227]),
            printed(0.092, 0.0093, [0.0116, 0.0125, 0.0075]),
        ],
    },
    Run {
        name: "Lemniscate",
        recording: "20221012_153814",
        printed: [
            printed(1.227, 0.0098, [0.0042, 0.0051, 0.0195]),
            printed(0.215, 0.0082, [0.0045, 0.0053, 0.0195]),
            printed(0.023, 0.0052, [0.0043, 0.0054, 0.0076]),
        ],
    },
    Run {
        name: "Twisting",
        recording: "20221012_103309",
        printed: [
            printed(2.931, 0.0136, [0.0121, 0.0186, 0.0195]),
            printed(0.263, 0.0141, [0.0130, 0.0196, 0.0194]),
            printed(0.030, 0.0127, [0.0131, 0.0217, 0.0017]),
        ],
    },
    Run {
        name: "Random actuation",
        recording: "20221012_140717",
        printed: [
            printed(4.345, 0.0381, [0.0678, 0.0544, 0.0195]),
            printed(0.365, 0.0383, [0.0681, 0.0544, 0.0193]),
            printed(0.255, 0.0380, [0.0700, 0.0527, 0.0200]),
        ],
    },
];

/// Where the table misprints `e_quat`: trajectory, degrees of freedom, and what the data give. Both
/// times it prints the 0.0082 of the elongation instead.
pub const MISPRINTS: [(&str, usize, f64); 2] =
    [("Circles", 11, 0.0136), ("Lemniscate", 11, 0.0098)];

/// A row of the table, repeated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Degrees of freedom, `phi0` included.
    pub dof: usize,
    /// Errors of the paper's descent, counted as the paper counts them.
    pub descent: Metrics,
    /// Errors at the optimum of the same cost, counted so.
    pub optimum: Metrics,
    /// Errors at the optimum over the two measured points alone.
    pub optimum_measured: Metrics,
}

/// Repeats the three rows of a run, in the order of [`SELECTORS`], in a few seconds.
///
/// Given are for each sample the base's angle (rad) and the three poses, and their arc lengths
/// (m). The paper's samples and poses are those of the published tables.
///
/// # Panics
/// When there are not as many angles as samples.
#[must_use]
pub fn reproduce(base_angles: &[f64], poses: &[[Pose; 3]], arc_lengths: &[f64; 3]) -> Vec<Row> {
    SELECTORS
        .into_par_iter()
        .map(|selector| reproduce_row(selector, base_angles, poses, arc_lengths))
        .collect()
}

/// Repeats the row of a run for one choice of strains; see [`reproduce`].
///
/// # Panics
/// When there are not as many angles as samples.
#[must_use]
pub fn reproduce_row(
    selector: StrainSelector,
    base_angles: &[f64],
    poses: &[[Pose; 3]],
    arc_lengths: &[f64; 3],
) -> Row {
    assert_eq!(base_angles.len(), poses.len(), "number of samples");
    let samples: Vec<Observed<'_>> = (base_angles.iter().zip(poses))
        .map(|(&angle, poses)| Observed {
            arc_lengths,
            poses,
            base_angle: Some(angle),
        })
        .collect();
    let rod = Spcs::uniform(selector, arc_lengths[2], 2);
    let descent = Descent::new(&rod).fit_sequence(&samples);
    let descent = rod.poses(&descent, arc_lengths);
    let optimum: Vec<Vec<f64>> = (LeastSquares::new(rod.clone())
        .fit_each(&samples)
        .into_iter())
    .map(|fit| fit.configuration)
    .collect();
    let optimum = rod.poses(&optimum, arc_lengths);
    Row {
        dof: rod.dof(),
        descent: Metrics::as_printed(pairs(&samples, &descent, 0)),
        optimum: Metrics::new(pairs(&samples, &optimum, 0)),
        optimum_measured: Metrics::new(pairs(&samples, &optimum, 1)),
    }
}

/// Measured and fitted poses of all samples, from point `first` on.
fn pairs<'a>(
    samples: &'a [Observed<'_>],
    fitted: &'a [Vec<Pose>],
    first: usize,
) -> impl Iterator<Item = (&'a Pose, &'a Pose)> {
    (samples.iter().zip(fitted))
        .flat_map(move |(sample, fitted)| sample.poses[first..].iter().zip(&fitted[first..]))
}

const fn printed(position_mm: f64, quaternion: f64, euler: [f64; 3]) -> Metrics {
    Metrics {
        position: position_mm * 1e-3,
        quaternion,
        euler: Vector3::new(euler[0], euler[1], euler[2]),
    }
}
