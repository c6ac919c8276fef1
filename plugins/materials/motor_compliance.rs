//! A drive that gives way.

use auxetica_engine::{LawView, Moment, Positive, ReadBody, RodLaw, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// A torsional spring between motor and rod (shaft, horn, glue), in series with the rod's first twisting cell. The rod
/// keeps what is left of the motor's angle.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotorCompliance {
    /// Stiffness [N m/rad].
    stiffness: Positive,
}

register!(
    dyn RodLaw: MotorCompliance,
    example = "MotorCompliance(stiffness: 1.0)",
    source = "springs in series",
);

impl RodLaw for MotorCompliance {
    fn in_series(&self) -> bool {
        true
    }

    fn rest(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        // turn = k_z (cell + B_z / stiffness): the same couple twists the cell and turns the spring
        if let Some(v) = rod.cells().next() {
            let cell = if v == 0 {
                rod.reference_length(0) / 2.0
            } else {
                rod.reference_length(v)
            };
            rod.set_twist_length(v, cell + rod.bend_twist(v).z / *self.stiffness);
        }
    }
}
