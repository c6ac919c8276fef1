//! Internal loads of a free rod, however deformed, have no resultant: no force to rounding; no moment to rounding in
//! the plane, and in space one that vanishes at third order in the rotation between neighbours (Gazzola et al. 2018
//! average a couple over its two elements).

mod common;

use auxetica::engine::{BoundaryCondition, Moment, PoseView, RateView, ReadBody, rotation};
use common::{deform, model};
use nalgebra::{Matrix3, Vector3};

/// Puts the rod into a wavy pose: rotations of `size` [rad] between neighbours, about `d2` alone in the plane.
struct Deform {
    size: f64,
    plane: bool,
}

impl BoundaryCondition for Deform {
    fn rates(&self, _now: &Moment<'_>, _body: &mut RateView<'_>) {}

    fn values(&self, _now: &Moment<'_>, body: &mut PoseView<'_>) {
        let flat = if self.plane { 0.0 } else { 1.0 };
        let (mut frame, mut point) = (Matrix3::identity(), Vector3::zeros());
        body.set_position(0, point);
        for e in 0..body.elements() {
            let s = e as f64;
            let turn = Vector3::new(flat * (1.3 * s).sin(), (0.7 * s).cos(), flat * 0.8);
            frame = rotation::turned(&frame, &(turn * self.size));
            let shear = Vector3::new(0.05 * (2.1 * s).sin(), flat * 0.03, 1.0 + 0.1 * s.cos());
            point += frame.tr_mul(&(shear * self.size)) * body.reference_length(e)
                + frame.tr_mul(&Vector3::z()) * body.reference_length(e);
            body.set_director(e, frame);
            body.set_position(e + 1, point);
        }
    }
}

/// Resultant force and moment about the origin, over the sum of their parts' sizes.
fn resultants(size: f64, plane: bool) -> (f64, f64) {
    let mut model = model(
        r#"(
            title: "free rod",
            rods: [(
                name: "rod", length: 1, elements: 12, radius: 0.03, density: 1000,
                material: Rigidities(shear: 80, axial: 200, bending: 2, twist: 1.1),
            )],
            solver: Dynamic(duration: 1),
        )"#,
    );
    let id = deform(&mut model, Box::new(Deform { size, plane }));
    let body = model.system.body(id);
    let (mut force, mut moment, mut sizes) = (Vector3::zeros(), Vector3::zeros(), (0.0, 0.0));
    for i in 0..body.nodes() {
        let f = body.force(i);
        force += f;
        moment += body.position(i).cross(&f);
        sizes = (
            sizes.0 + f.norm(),
            sizes.1 + body.position(i).cross(&f).norm(),
        );
    }
    for e in 0..body.directors() {
        let torque = body.director(e).tr_mul(&body.torque(e));
        moment += torque;
        sizes.1 += torque.norm();
    }
    (force.norm() / sizes.0, moment.norm() / sizes.1)
}

#[test]
fn in_the_plane_nothing_is_left_but_rounding() {
    for size in [0.01, 0.1, 0.5] {
        let (force, moment) = resultants(size, true);
        println!("{size} rad: force {force:.1e}, moment {moment:.1e}");
        assert!(force < 1e-14 && moment < 1e-14, "{force:.1e} {moment:.1e}");
    }
}

#[test]
fn in_space_no_force_is_left_and_a_moment_of_higher_order() {
    let moments: Vec<f64> = [0.2, 0.1, 0.05, 0.025]
        .iter()
        .map(|size| {
            let (force, moment) = resultants(*size, false);
            assert!(force < 1e-14, "{force:.1e}");
            moment
        })
        .collect();
    for pair in moments.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        println!("relative moments {pair:?}: order {order:.2}");
        // relative to couples, which are of first order themselves; 3 as the rotations go to zero
        assert!((2.3..3.5).contains(&order), "order {order:.2}");
    }
}
