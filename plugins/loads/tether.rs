//! A cable that pulls.

use auxetica_engine::{
    End, Forcing, LoadView, Moment, NonNegative, Place, Site, Vec3, Wrench, register,
};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// A spring from a fixed point to the tip of a rod or the centre of a rigid body, which pulls when it is longer than
/// when slack.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tether {
    /// The fixed point, world frame [m].
    anchor: Vec3,
    /// Stiffness [N/m].
    stiffness: NonNegative,
    /// Length up to which it is slack [m].
    slack: NonNegative,
}

register!(
    dyn Forcing: Tether,
    example = "Tether(anchor: (0.15, 0, 0.06), stiffness: 40, slack: 0.12)",
    source = "unilateral linear spring",
);

impl Forcing for Tether {
    fn apply(&self, _now: &Moment<'_>, body: &mut LoadView<'_>) {
        let place = Place::End(End::Tip);
        let apart = Vector3::from(*self.anchor) - Site::of(&body.read(), place).position;
        let length = apart.norm();
        let tension = *self.stiffness * (length - *self.slack).max(0.0);
        let wrench = Wrench {
            force: apart * (tension / length.max(1e-9)),
            torque: Vector3::zeros(),
        };
        body.add_wrench(place, &wrench);
    }
}
