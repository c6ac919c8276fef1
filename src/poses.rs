//! Where the markers of a model are, or without any the tips of all bodies, and how they have turned since rest.

use crate::engine::{End, Model, Place, ReadBody, rotation};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The place of a marker or tip, and its rotation from rest.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Pose {
    /// Name of the marker, or of the body.
    #[serde(rename = "where")]
    pub name: String,
    /// Position, world frame \[m\].
    pub position: [f64; 3],
    /// Rotation vector from rest, world frame \[rad\].
    pub turn: [f64; 3],
}

/// The frames at rest that rotations count from.
pub struct Rest(Vec<Matrix3<f64>>);

impl Rest {
    /// Takes the model's present state for rest.
    pub fn of(model: &Model) -> Self {
        let frames = places(model).into_iter().map(|(_, _, frame)| frame);
        Self(frames.collect())
    }

    /// The model's present poses.
    pub fn poses(&self, model: &Model) -> Vec<Pose> {
        let places = places(model).into_iter().zip(&self.0);
        let pose = |((name, position, frame), rest): ((_, Vector3<f64>, _), &Matrix3<f64>)| Pose {
            name,
            position: position.into(),
            // material components are the same in both frames; the rest frame takes them to the world
            turn: rest.tr_mul(&rotation::between(rest, &frame)).into(),
        };
        places.map(pose).collect()
    }
}

/// The name of the model's present time, if its inputs dwell there; empty otherwise.
pub fn state_name(model: &Model) -> &str {
    let time = model.system.time();
    #[expect(clippy::float_cmp, reason = "times are copied, not computed")]
    let dwell = model.dwells.iter().find(|dwell| dwell.time == time);
    dwell.map_or("", |dwell| &dwell.name)
}

/// Name, position and frame of every marker, or of every body's tip.
fn places(model: &Model) -> Vec<(String, Vector3<f64>, Matrix3<f64>)> {
    let marked = model.markers.iter().filter_map(|marker| {
        let (position, frame) = model.marker_pose(marker)?;
        Some((marker.name.clone(), position, frame))
    });
    let tips = model.system.ids().iter().map(|id| {
        let site = model.system.site(*id, Place::End(End::Tip));
        let name = model.system.body(*id).name().to_owned();
        (name, site.position, site.director)
    });
    if model.markers.is_empty() {
        tips.collect()
    } else {
        marked.collect()
    }
}
