//! Forces and torques at the ends of rods, or on rigid bodies.

use auxetica_engine::{
    End, Finite, Forcing, LoadView, Moment, Place, Setting, Signal, Site, Vec3, Wrench, register,
};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The frame that a load's components are given in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Frame {
    /// Fixed in space.
    #[default]
    World,
    /// Turning with the end (a follower load).
    Material,
}

fn tip() -> End {
    End::Tip
}

fn always() -> Signal {
    Signal::Constant(Finite::new(1.0).expect("one is finite"))
}

/// A force at the end of a rod (the far end of its rigid cap), or at the centre of a rigid body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EndForce {
    /// Force [N].
    force: Vec3,
    /// Which end.
    #[serde(default = "tip")]
    end: End,
    /// Frame of the components.
    #[serde(default)]
    frame: Frame,
    /// Factor over time [-], for instance `Ramp(to: 1, over: 0.5)`.
    #[serde(default = "always")]
    scale: Signal,
}

register!(
    dyn Forcing: EndForce,
    example = "EndForce(force: (0, 0, 1), scale: Ramp(to: 1, over: 0.5))",
    source = "PyElastica EndpointForces",
);

/// A torque at the end of a rod, or on a rigid body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EndTorque {
    /// Torque [N m].
    torque: Vec3,
    /// Which end.
    #[serde(default = "tip")]
    end: End,
    /// Frame of the components.
    #[serde(default)]
    frame: Frame,
    /// Factor over time [-], for instance `Ramp(to: 1, over: 0.5)`.
    #[serde(default = "always")]
    scale: Signal,
}

register!(
    dyn Forcing: EndTorque,
    example = "EndTorque(torque: (0, 0, 0.1), frame: Material)",
    source = "PyElastica EndpointTorque",
);

impl Forcing for EndForce {
    fn apply(&self, now: &Moment<'_>, body: &mut LoadView<'_>) {
        let place = Place::End(self.end);
        let given = Vector3::from(*self.force) * self.scale.at(now);
        let force = match self.frame {
            Frame::World => given,
            Frame::Material => Site::of(&body.read(), place).director.tr_mul(&given),
        };
        let torque = Vector3::zeros();
        body.add_wrench(place, &Wrench { force, torque });
    }

    fn check(&self, setting: &Setting<'_>) -> Result<(), String> {
        self.scale.check(setting.inputs)
    }
}

impl Forcing for EndTorque {
    fn apply(&self, now: &Moment<'_>, body: &mut LoadView<'_>) {
        let place = Place::End(self.end);
        let given = Vector3::from(*self.torque) * self.scale.at(now);
        let torque = match self.frame {
            Frame::World => Site::of(&body.read(), place).director * given,
            Frame::Material => given,
        };
        let force = Vector3::zeros();
        body.add_wrench(place, &Wrench { force, torque });
    }

    fn check(&self, setting: &Setting<'_>) -> Result<(), String> {
        self.scale.check(setting.inputs)
    }
}
