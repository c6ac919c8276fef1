//! A motor whose angle is given (Stölzle et al. 2023, section II-D, option a).

use auxetica_engine::{
    BoundaryCondition, Cell, End, Moment, PoseView, RateView, ReadBody, Setting, Signal, register,
    rotation,
};
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::Deserialize;

/// Holds the start of a rod in place and turns it about its own axis by a given angle.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotorAngle {
    /// Angle about `d3` from the rod's pose at rest [rad], over time.
    angle: Signal,
    /// How the motor holds the rod.
    #[serde(default)]
    cell: Cell,
    #[serde(skip)]
    rest: Rest,
}

#[derive(Clone, Debug, Default)]
struct Rest {
    position: Vector3<f64>,
    director: Matrix3<f64>,
}

register!(
    dyn BoundaryCondition: MotorAngle,
    example = "MotorAngle(angle: Ramp(to: 3.14, over: 5))",
    source = "Stölzle et al. 2023, section II-D (a)",
);

impl BoundaryCondition for MotorAngle {
    fn rates(&self, _now: &Moment<'_>, body: &mut RateView<'_>) {
        body.set_velocity(0, Vector3::zeros());
        if self.cell == Cell::Rigid {
            body.set_omega(0, Vector3::zeros());
        }
    }

    fn values(&self, now: &Moment<'_>, body: &mut PoseView<'_>) {
        body.set_position(0, self.rest.position);
        let turn = Vector3::z() * self.angle.at(now);
        let frame = rotation::turned(&self.rest.director, &turn);
        match self.cell {
            Cell::Rigid => body.set_director(0, frame),
            Cell::Half => body.set_wall(End::Start, frame),
        }
    }

    fn attach(&mut self, setting: &Setting<'_>) -> Result<(), String> {
        self.rest = Rest {
            position: setting.body.position(0),
            director: setting.body.director(0),
        };
        self.angle.check(setting.inputs)
    }
}
