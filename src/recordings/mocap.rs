//! Reads the motion-capture file: three rows a frame, one each for base, platform and ring.

use std::path::Path;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::files;
use crate::table::Table;
use crate::{Body, Error, Mocap, Pose, Track};

/// How far a quaternion's length may be from 1; smaller deviations are normalised away.
const UNIT_TOLERANCE: f64 = 1e-3;

/// Reads the file of a recording of `samples` rows.
pub(crate) fn read(folder: &Path, samples: usize) -> Result<Mocap, Error> {
    let table = Table::<9>::read(folder, &files::MOCAP)?;
    let mut poses = [const { Vec::new() }; 3];
    for frame in frames(&table.rows) {
        let mut found = [None; 3];
        for (row, &line) in table.rows[frame.clone()]
            .iter()
            .zip(&table.lines[frame.clone()])
        {
            let index = body_index(&table, row[1], line)?;
            if found[index].replace(pose(&table, row, line)?).is_some() {
                return Err(Error::RepeatedBody {
                    path: table.path,
                    line,
                    body: Body::ALL[index],
                    frame: row[0],
                });
            }
        }
        for (index, found) in found.into_iter().enumerate() {
            poses[index].push(found.ok_or_else(|| Error::MissingBody {
                path: table.path.clone(),
                line: table.lines[frame.end - 1],
                body: Body::ALL[index],
                frame: table.rows[frame.start][0],
            })?);
        }
    }
    let [base, platform, ring] = poses;
    if base.len() != samples {
        return Err(Error::RowCount {
            path: table.path,
            expected: samples,
            found: base.len(),
        });
    }
    Ok(Mocap {
        base: Track::new(base),
        platform: Track::new(platform),
        ring: Track::new(ring),
    })
}

/// Ranges of consecutive rows with the same frame number.
#[expect(clippy::float_cmp, reason = "frame numbers are copied, not computed")]
fn frames(rows: &[[f64; 9]]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let mut end = 0;
    rows.chunk_by(|a, b| a[0] == b[0]).map(move |frame| {
        let start = end;
        end += frame.len();
        start..end
    })
}

#[expect(clippy::float_cmp, reason = "body numbers are small integers, exact")]
fn body_index(table: &Table<9>, number: f64, line: u64) -> Result<usize, Error> {
    (Body::ALL.iter())
        .position(|body| f64::from(body.number()) == number)
        .ok_or_else(|| Error::UnknownBody {
            path: table.path.clone(),
            line,
            found: number,
        })
}

fn pose(table: &Table<9>, row: &[f64; 9], line: u64) -> Result<Pose, Error> {
    let [_, _, qx, qy, qz, qw, x, y, z] = *row;
    let quaternion = Quaternion::new(qw, qx, qy, qz);
    let norm = quaternion.norm();
    if (norm - 1.0).abs() > UNIT_TOLERANCE {
        return Err(Error::NotUnit {
            path: table.path.clone(),
            line,
            norm,
        });
    }
    let rotation = UnitQuaternion::new_normalize(quaternion);
    Ok(Pose::from_parts(Vector3::new(x, y, z).into(), rotation))
}
