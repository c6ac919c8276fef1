//! A clamped end.

use auxetica_engine::{
    BoundaryCondition, Cell, End, Moment, PoseView, RateView, ReadBody, Setting, register,
};
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::Deserialize;

/// Holds position and frame of one end of a rod, or of a rigid body, as they are at rest.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clamp {
    /// Which end.
    #[serde(default = "start")]
    end: End,
    /// How the frame is held: `Rigid` fixes the end element, as PyElastica does; `Half` lets it turn against the wall
    /// over half an element's length, which is second order.
    #[serde(default)]
    cell: Cell,
    #[serde(skip)]
    rest: (Vector3<f64>, Matrix3<f64>),
}

fn start() -> End {
    End::Start
}

register!(
    dyn BoundaryCondition: Clamp,
    example = "Clamp(end: Start, cell: Half)",
    source = "PyElastica OneEndFixedBC; half cell: Auxetica",
);

/// Node and element at an end.
pub(crate) fn at(end: End, body: &impl ReadBody) -> (usize, usize) {
    match end {
        End::Start => (0, 0),
        End::Tip => (body.nodes() - 1, body.directors() - 1),
    }
}

impl BoundaryCondition for Clamp {
    fn rates(&self, _now: &Moment<'_>, body: &mut RateView<'_>) {
        let (node, element) = at(self.end, body);
        body.set_velocity(node, Vector3::zeros());
        if self.cell == Cell::Rigid {
            body.set_omega(element, Vector3::zeros());
        }
    }

    fn values(&self, _now: &Moment<'_>, body: &mut PoseView<'_>) {
        let (node, element) = at(self.end, body);
        let (position, director) = self.rest;
        body.set_position(node, position);
        match self.cell {
            Cell::Rigid => body.set_director(element, director),
            Cell::Half => body.set_wall(self.end, director),
        }
    }

    fn attach(&mut self, setting: &Setting<'_>) -> Result<(), String> {
        if self.cell == Cell::Half && !setting.body.is_rod() {
            return Err("a half cell needs a rod; use `cell: Rigid` for a rigid body".into());
        }
        let (node, element) = at(self.end, &setting.body);
        self.rest = (setting.body.position(node), setting.body.director(element));
        Ok(())
    }
}
