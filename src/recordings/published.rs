//! Steady poses from the published tables of inverse kinematics results.

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::{Path, PathBuf};

use nalgebra::{Matrix4, Rotation3, UnitQuaternion, Vector3};
use npyz::npz::NpzArchive;

use crate::frames::shifted;
use crate::motors::angles_from;
use crate::{Error, Pose, Recording, Reference, RobotGeometry, SteadySamples};

/// How far a motor angle may be from the one a table was made with (rad).
const ANGLE_TOLERANCE: f64 = 1e-3;
/// Longest table that is read.
const MAX_SAMPLES: u64 = 1_000_000;

/// Measured poses along the ring's rod, as published: `sample_idx_ss`, `T_ss` and `s_ss` of a
/// table of inverse kinematics results.
#[derive(Debug, Clone, PartialEq)]
pub struct PublishedTable {
    /// Row of the recording that each sample's motor readings belong to: `sample_idx_ss` + 1,
    /// as the authors dropped the first row.
    pub row: Vec<usize>,
    /// Homogeneous matrices of the rod's base, the ring and the rod's tip, as stored in single
    /// precision: rotations are so only to about 3e-7. [`SteadySamples::rod_poses`] has the like.
    pub transforms: Vec<[Matrix4<f64>; 3]>,
    /// Arc lengths of the three points (m).
    pub arc_lengths: [f64; 3],
}

impl PublishedTable {
    /// Reads a table from an `.npz` archive.
    ///
    /// # Errors
    /// When the file is missing or damaged, or its arrays are not those of such a table.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let file = File::open(path).map_err(|source| match source.kind() {
            std::io::ErrorKind::NotFound => Error::MissingFile { path: path.into() },
            _ => Error::Unreadable {
                path: path.into(),
                source,
            },
        })?;
        let archive = NpzArchive::new(BufReader::new(file)).map_err(|source| {
            let path = path.into();
            Error::Unreadable { path, source }
        })?;
        let mut arrays = Arrays {
            path: path.into(),
            archive,
        };
        let index: Vec<i32> = arrays.array("sample_idx_ss", &[])?;
        let entries: Vec<f32> = arrays.array("T_ss", &[4, 4, 3])?;
        let lengths: Vec<f32> = arrays.array("s_ss", &[3])?;
        if entries.len() != 48 * index.len() || lengths.len() != 3 * index.len() {
            return Err(arrays.fault("T_ss", "is not as long as sample_idx_ss"));
        }
        let row = index
            .iter()
            .map(|&index| usize::try_from(index).map(|index| index + 1))
            .collect::<Result<_, _>>()
            .map_err(|_| arrays.fault("sample_idx_ss", "holds a negative index"))?;
        let Some(arc_lengths) = lengths.first_chunk().map(|s| s.map(f64::from)) else {
            return Err(arrays.fault("s_ss", "is empty"));
        };
        if !entries
            .iter()
            .chain(&lengths)
            .all(|value| value.is_finite())
        {
            return Err(arrays.fault("T_ss", "holds values that are not finite"));
        }
        let transforms = (entries.chunks_exact(48))
            .map(|sample| std::array::from_fn(|point| matrix(sample, point)))
            .collect();
        Ok(Self {
            row,
            transforms,
            arc_lengths,
        })
    }

    /// The table's poses as steady samples of the platform and the ring, with the motor angles
    /// of the recording it was made from.
    ///
    /// The table has its points on the rod's axis already, so the marker points come out on the
    /// axes of platform and rod. It does not tell the platform's orientation at rest: identity is
    /// taken for it, and for its height the one that follows from the arc lengths.
    ///
    /// # Errors
    /// When the table was not made from this recording.
    pub fn samples(
        &self,
        recording: &Recording,
        geometry: &RobotGeometry,
    ) -> Result<SteadySamples, Error> {
        let angles = self.angles(recording, geometry)?;
        let rod = geometry.ring_rod_base();
        let to_platform = geometry.tip_to_markers();
        let at_rest = |height: f64, offset: Vector3<f64>| {
            let point = rod + Vector3::z() * height + offset;
            Pose::from_parts(point.into(), UnitQuaternion::identity())
        };
        let [_, ring_height, tip_height] = self.arc_lengths;
        Ok(SteadySamples {
            time: (self.row.iter()).map(|&row| recording.time[row]).collect(),
            row: self.row.clone(),
            angles,
            platform: (self.transforms.iter())
                .map(|[_, _, tip]| pose(tip))
                .map(|tip| shifted(&tip, rod + tip.rotation * to_platform))
                .collect(),
            ring: (self.transforms.iter())
                .map(|[_, ring, _]| shifted(&pose(ring), rod))
                .collect(),
            reference: Reference {
                platform: at_rest(tip_height, to_platform),
                ring: at_rest(ring_height, Vector3::zeros()),
                rows: 1..2,
            },
            skipped: 0,
        })
    }

    /// Motor angles at the table's rows, checked against the rotation of the rod's base in it.
    fn angles(
        &self,
        recording: &Recording,
        geometry: &RobotGeometry,
    ) -> Result<Vec<[f64; 4]>, Error> {
        let mismatch = |sample: usize, reason: String| Error::TableMismatch {
            recording: recording.name.clone(),
            sample,
            reason,
        };
        let samples = self.row.iter().zip(&self.transforms).enumerate();
        samples
            .map(|(sample, (&row, [base, ..]))| {
                let (Some(zero), Some(ticks)) =
                    (recording.present.get(1), recording.present.get(row))
                else {
                    return Err(mismatch(sample, format!("there is no row {row}")));
                };
                let angles = angles_from(ticks, zero);
                let turned =
                    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angles[geometry.ring_rod]);
                let error = turned.angle_to(&pose(base).rotation);
                if error > ANGLE_TOLERANCE {
                    let reason = format!("the motor's angle differs by {error:.4} rad");
                    return Err(mismatch(sample, reason));
                }
                Ok(angles)
            })
            .collect()
    }
}

/// The matrix of a point, from a row-major (4, 4, points) array.
fn matrix(sample: &[f32], point: usize) -> Matrix4<f64> {
    Matrix4::from_fn(|i, j| f64::from(sample[(4 * i + j) * 3 + point]))
}

fn pose(transform: &Matrix4<f64>) -> Pose {
    let turn = Rotation3::from_matrix_unchecked(transform.fixed_view::<3, 3>(0, 0).into_owned());
    let point: Vector3<f64> = transform.fixed_view::<3, 1>(0, 3).into_owned();
    Pose::from_parts(point.into(), UnitQuaternion::from_rotation_matrix(&turn))
}

/// An open archive of arrays.
struct Arrays<R: Read + Seek> {
    path: PathBuf,
    archive: NpzArchive<R>,
}

impl<R: Read + Seek> Arrays<R> {
    /// Reads an array in row-major order whose shape is (samples, ...`inner`).
    fn array<T: npyz::Deserialize>(
        &mut self,
        name: &'static str,
        inner: &[u64],
    ) -> Result<Vec<T>, Error> {
        let Self { path, archive } = self;
        let fault = |reason: String| Error::Table {
            path: path.clone(),
            array: name,
            reason,
        };
        let array = (archive.by_name(name))
            .map_err(|error| fault(error.to_string()))?
            .ok_or_else(|| fault("is missing".into()))?;
        let (shape, order) = (array.shape(), array.order());
        // The length is checked before anything is read, as a damaged header may claim any.
        match shape {
            [samples, rest @ ..]
                if *samples <= MAX_SAMPLES && rest == inner && order == npyz::Order::C => {}
            _ => return Err(fault(format!("has shape {shape:?} in {order:?} order"))),
        }
        array.into_vec().map_err(|error| fault(error.to_string()))
    }

    fn fault(&self, array: &'static str, reason: &str) -> Error {
        Error::Table {
            path: self.path.clone(),
            array,
            reason: reason.into(),
        }
    }
}
