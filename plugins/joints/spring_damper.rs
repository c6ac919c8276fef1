//! The spring-damper joint of Stölzle et al. 2023, eq. 6-7, which may have play.

use crate::clearance;
use auxetica_engine::{
    Inputs, Joint, JointLoad, Moment, NonNegative, Signal, Site, Wrench, register,
    rotation::{self, to_material, to_world},
};
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::Deserialize;

/// Holds two bodies together as they were at rest, by springs and dampers in translation and rotation, once their play is
/// used up. Without rotational stiffness it is a ball joint, with a `twist` a motor that stands on the second. The defaults
/// are those of the paper's robot (section II-E).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringDamper {
    /// Translational stiffness k_F [N/m].
    #[serde(default = "stiffness")]
    stiffness: NonNegative,
    /// Play in translation, to every side [m].
    #[serde(default)]
    clearance: NonNegative,
    /// Play in rotation, to every side [rad].
    #[serde(default)]
    rotational_clearance: NonNegative,
    /// Translational damping nu_F [N s/m].
    #[serde(default)]
    damping: NonNegative,
    /// Rotational stiffness k_tau [N m/rad].
    #[serde(default = "rotational_stiffness")]
    rotational_stiffness: NonNegative,
    /// Rotational damping nu_tau [N m s/rad].
    #[serde(default)]
    rotational_damping: NonNegative,
    /// Angle about `d3` of the first body that it is to have from its rest against the second [rad], over time; none if
    /// left out.
    #[serde(default)]
    twist: Option<Signal>,
    #[serde(skip)]
    rest: Rest,
}

fn stiffness() -> NonNegative {
    NonNegative::new(5e5).expect("the paper's stiffness is positive")
}

fn rotational_stiffness() -> NonNegative {
    NonNegative::new(20.0).expect("the paper's stiffness is positive")
}

/// Force [N] and torque [N m] at which 70 % of the play is crossed: small beside what rods pass on in motion, and not so small
/// that the joint has no stiffness to speak of before, which solvers don't like.
const SEATING: (f64, f64) = (0.5, 5e-3);

/// The first body's pose at rest, seen from the second.
#[derive(Clone, Debug, Default)]
struct Rest {
    lever: Vector3<f64>,
    turn: Matrix3<f64>,
}

register!(
    dyn Joint: SpringDamper,
    example = "SpringDamper(stiffness: 5e5, rotational_stiffness: 20)",
    source = "Stölzle et al. 2023, eq. 6-7",
);

impl Joint for SpringDamper {
    fn load(&self, now: &Moment<'_>, a: &Site, b: &Site) -> JointLoad {
        let attachment = b.position + to_world(&b.director, &self.rest.lever);
        let speed = b.velocity + to_world(&b.director, &b.omega.cross(&self.rest.lever));
        let apart = attachment - a.position;
        let force = clearance::load(apart, *self.stiffness, *self.clearance, SEATING.0)
            + (speed - a.velocity) * *self.damping;

        let mut wanted = self.rest.turn * b.director;
        if let Some(twist) = &self.twist {
            wanted = rotation::turned(&wanted, &(Vector3::z() * twist.at(now)));
        }
        let turn = rotation::between(&a.director, &wanted);
        let (stiffness, gap) = (*self.rotational_stiffness, *self.rotational_clearance);
        let torque = clearance::load(turn, stiffness, gap, SEATING.1)
            + (to_material(&a.director, &to_world(&b.director, &b.omega)) - a.omega)
                * *self.rotational_damping;
        JointLoad {
            on_a: Wrench { force, torque },
            on_b: Wrench {
                force: -force,
                torque: self.rest.lever.cross(&(b.director * -force))
                    - b.director * a.director.tr_mul(&torque),
            },
        }
    }

    fn attach(&mut self, a: &Site, b: &Site, inputs: &Inputs) -> Result<(), String> {
        self.rest = Rest {
            lever: b.director * (a.position - b.position),
            turn: a.director * b.director.transpose(),
        };
        self.twist
            .as_ref()
            .map_or(Ok(()), |twist| twist.check(inputs))
    }
}
