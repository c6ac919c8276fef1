//! The states that a run reaches, as a table: where markers are, or without any the tips of all bodies.

use super::table::table;
use crate::engine::{End, Model, Place, ReadBody, rotation};
use nalgebra::{Matrix3, Vector3};

/// Rows of the table, and the frames at rest that rotations count from.
pub(super) struct States {
    rest: Vec<Matrix3<f64>>,
    rows: Vec<Vec<String>>,
}

impl States {
    /// No states yet; the model is at rest.
    pub(super) fn new(model: &Model) -> Self {
        Self {
            rest: places(model)
                .into_iter()
                .map(|(_, _, frame)| frame)
                .collect(),
            rows: Vec::new(),
        }
    }

    /// Adds the model's present state.
    pub(super) fn push(&mut self, model: &Model) {
        let time = model.system.time();
        #[expect(clippy::float_cmp, reason = "times are copied, not computed")]
        let dwell = model.dwells.iter().find(|dwell| dwell.time == time);
        let state = dwell.map_or("", |dwell| &dwell.name);
        for ((name, position, frame), rest) in places(model).into_iter().zip(&self.rest) {
            let mm = position * 1e3;
            // material components are the same in both frames; the rest frame takes them to the world
            let turn = rest
                .tr_mul(&rotation::between(rest, &frame))
                .map(f64::to_degrees);
            // adding zero drops the sign of what rounds to zero
            let rounded = |v: Vector3<f64>, to: f64| v.map(|c| (c / to).round() * to + 0.0);
            let (mm, turn) = (rounded(mm, 1e-3), rounded(turn, 1e-2));
            self.rows.push(vec![
                name,
                state.to_owned(),
                format!("{time:.3}"),
                format!("{:.3}", mm.x),
                format!("{:.3}", mm.y),
                format!("{:.3}", mm.z),
                format!("{:.2} {:.2} {:.2}", turn.x, turn.y, turn.z),
            ]);
        }
    }

    /// The table.
    pub(super) fn table(self) -> String {
        let header = [
            "where",
            "state",
            "t [s]",
            "x [mm]",
            "y [mm]",
            "z [mm]",
            "turned by [deg]",
        ];
        table(&header, self.rows)
    }
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
