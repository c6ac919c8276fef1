//! A motor whose torque is given (Stölzle et al. 2023, section II-D, option b).

use auxetica_engine::{
    BoundaryCondition, LoadView, Moment, PoseView, RateView, ReadBody, Setting, Signal, register,
};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Holds the start of a rod in place, lets it turn about its own axis only, and drives it with a given torque.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotorTorque {
    /// Torque about `d3` [N m], over time.
    torque: Signal,
    #[serde(skip)]
    position: Vector3<f64>,
}

register!(
    dyn BoundaryCondition: MotorTorque,
    example = "MotorTorque(torque: Ramp(to: 0.1, over: 1))",
    source = "Stölzle et al. 2023, section II-D (b)",
);

impl BoundaryCondition for MotorTorque {
    fn rates(&self, _now: &Moment<'_>, body: &mut RateView<'_>) {
        body.set_velocity(0, Vector3::zeros());
        body.set_omega(0, Vector3::z() * body.omega(0).z);
    }

    fn values(&self, _now: &Moment<'_>, body: &mut PoseView<'_>) {
        body.set_position(0, self.position);
    }

    fn loads(&self, now: &Moment<'_>, body: &mut LoadView<'_>) {
        body.add_torque(0, Vector3::z() * self.torque.at(now));
    }

    fn attach(&mut self, setting: &Setting<'_>) -> Result<(), String> {
        self.position = setting.body.position(0);
        self.torque.check(setting.inputs)
    }
}
