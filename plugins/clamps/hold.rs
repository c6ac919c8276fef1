//! Some directions held, others free.

use crate::clamp::at;
use auxetica_engine::{
    BoundaryCondition, End, Moment, PoseView, RateView, ReadBody, Setting, register,
};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Axis {
    /// First axis.
    X,
    /// Second axis.
    Y,
    /// Third axis.
    Z,
}

/// Holds chosen directions of one end of a rod, or of a rigid body: positions along the world's axes, rotations about
/// the end's own directors. What isn't named stays free.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hold {
    /// Which end.
    end: End,
    /// World axes along which the position is held.
    #[serde(default)]
    position: Vec<Axis>,
    /// Directors (X is `d1`) about which the end can't turn.
    #[serde(default)]
    rotation: Vec<Axis>,
    #[serde(skip)]
    rest: Vector3<f64>,
}

register!(
    dyn BoundaryCondition: Hold,
    example = "Hold(end: Tip, rotation: [X, Y, Z])",
    source = "PyElastica GeneralConstraint",
);

impl BoundaryCondition for Hold {
    fn rates(&self, _now: &Moment<'_>, body: &mut RateView<'_>) {
        let (node, element) = at(self.end, body);
        let (mut velocity, mut omega) = (body.velocity(node), body.omega(element));
        for axis in &self.position {
            velocity[*axis as usize] = 0.0;
        }
        for axis in &self.rotation {
            omega[*axis as usize] = 0.0;
        }
        body.set_velocity(node, velocity);
        body.set_omega(element, omega);
    }

    fn values(&self, _now: &Moment<'_>, body: &mut PoseView<'_>) {
        let (node, _) = at(self.end, body);
        let mut position = body.position(node);
        for axis in &self.position {
            position[*axis as usize] = self.rest[*axis as usize];
        }
        body.set_position(node, position);
    }

    fn attach(&mut self, setting: &Setting<'_>) -> Result<(), String> {
        if self.position.is_empty() && self.rotation.is_empty() {
            return Err("nothing is held; name axes under `position` or `rotation`".into());
        }
        let (node, _) = at(self.end, &setting.body);
        self.rest = setting.body.position(node);
        Ok(())
    }
}
