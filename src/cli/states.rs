//! The states that a run reaches, as a table for people.

use super::table::table;
use crate::engine::Model;
use crate::poses::{Rest, state_name};

/// Rows of the table.
pub(super) struct States {
    rest: Rest,
    rows: Vec<Vec<String>>,
}

impl States {
    /// No states yet; the model is at rest.
    pub(super) fn new(model: &Model) -> Self {
        Self {
            rest: Rest::of(model),
            rows: Vec::new(),
        }
    }

    /// Adds the model's present state.
    pub(super) fn push(&mut self, model: &Model) {
        for pose in self.rest.poses(model) {
            // adding zero drops the sign of what rounds to zero
            let rounded = |v: f64, to: f64| (v / to).round() * to + 0.0;
            let [x, y, z] = pose.position.map(|v| rounded(v * 1e3, 1e-3));
            let turn = pose.turn.map(|v| rounded(v.to_degrees(), 1e-2));
            self.rows.push(vec![
                pose.name,
                state_name(model).to_owned(),
                format!("{:.3}", model.system.time()),
                format!("{x:.3}"),
                format!("{y:.3}"),
                format!("{z:.3}"),
                format!("{:.2} {:.2} {:.2}", turn[0], turn[1], turn[2]),
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
