//! A base that gives way.

use auxetica_engine::{End, LawView, Moment, Positive, ReadBody, RodLaw, register};
use nalgebra::{Matrix6, Vector3, Vector6};
use schemars::JsonSchema;
use serde::Deserialize;

/// Springs between the base and the far end of a rod's first rigid end, which is held: it tilts under the couple and moves
/// under the force there. Twist is left to `MotorCompliance`. The tilt is taken as small.
///
/// The springs are in series with the rod's first element and first cell, whose stress and couple they relieve, so that
/// what is held stays held.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BaseCompliance {
    /// Stiffness against tilt about `d1` and `d2` [N m/rad]; rigid if left out.
    #[serde(default)]
    rotational_stiffness: Option<Positive>,
    /// Stiffness against displacement along all directors [N/m]; rigid if left out.
    #[serde(default)]
    stiffness: Option<Positive>,
}

register!(
    dyn RodLaw: BaseCompliance,
    example = "BaseCompliance(rotational_stiffness: 5, stiffness: 1e4)",
    source = "springs in series",
);

impl RodLaw for BaseCompliance {
    fn rest(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    fn in_series(&self) -> bool {
        true
    }

    fn stress(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let Some(v) = rod.cells().next() else {
            return;
        };
        let compliance = |k: Option<Positive>| k.map_or(0.0, |k| 1.0 / *k);
        let shift = compliance(self.stiffness);
        let tilt = compliance(self.rotational_stiffness);
        let springs = Vector6::new(shift, shift, shift, tilt, tilt, 0.0);

        // what the rod passes on if the base is rigid, and how stiff it is: force, then couple
        let dilated = rod.voronoi_dilatation(v).powi(3);
        let wrench = both(rod.stress(0) / rod.dilatation(0), rod.couple(v) / dilated);
        let rod_stiffness = both(
            rod.shear_stretch(0) / rod.length(0),
            rod.bend_twist(v) / (rod.rest_voronoi(v) * dilated),
        );

        // the springs' compliance at the cell, which is a lever away; in the held frame
        let edge = rod.position(v) - rod.position(0);
        let lever = rod.director(0) * edge + Vector3::z() * rod.cap(End::Start).length;
        let mut to_base = Matrix6::identity();
        let couple_of_force = lever.cross_matrix();
        to_base
            .fixed_view_mut::<3, 3>(3, 0)
            .copy_from(&couple_of_force);
        let springs = to_base.tr_mul(&Matrix6::from_diagonal(&springs)) * to_base;

        // relief = springs (wrench - rod_stiffness relief)
        let series = Matrix6::identity() + springs * Matrix6::from_diagonal(&rod_stiffness);
        let relief = series.lu().solve(&(springs * wrench));
        let relief = relief.expect("compliances are not negative");
        let strain = relief.fixed_rows::<3>(0) / rod.rest_length(0);
        let curvature = relief.fixed_rows::<3>(3) / rod.rest_voronoi(v);
        rod.add_stress(0, -rod.shear_stretch(0).component_mul(&strain));
        rod.add_couple(v, -rod.bend_twist(v).component_mul(&curvature));
    }
}

/// Six components of two vectors.
fn both(first: Vector3<f64>, second: Vector3<f64>) -> Vector6<f64> {
    Vector6::from_iterator(first.iter().chain(&second).copied())
}
