//! The discrete Cosserat equations on flat arrays (Gazzola et al. 2018, section 3), pass by pass.
//!
//! Strains, stresses and couples are material; forces on nodes are world, torques on elements material.
//!
//! Every pass goes over all stations of all bodies alike, eight at a time. Where a station has no element or no cell
//! the masks of [`Bodies`] leave zero strains, so that nothing comes from there. The passes use no fused
//! multiplication and no reordering, hence give the same bits whatever vectors the machine has.

use crate::bodies::Bodies;
use crate::lanes::{LANES, Lanes, MatrixLanes, Rows, Triple, VectorLanes, ZERO, triple};
use crate::rotation::{self, SMALL_HAVERSINE, SMALL_SQUARE};
use nalgebra::{Matrix3, Vector3};
use pulp::{Simd, WithSimd};

/// A pass over all stations.
#[derive(Clone, Copy)]
pub(crate) enum Pass {
    /// Moves every node and frame with its present rates for a time \[s\] (half a step of position Verlet).
    Drift(f64),
    /// Element lengths and tangents, and the rotation vectors between neighbouring elements.
    Measure,
    /// Strains and linear elastic loads from the measures and from what the rod laws set (eq. 2.12, 2.13, 2.18).
    Strain,
    /// Internal forces on nodes \[N\] and torques on elements \[N m\] from stresses and couples; overwrites the loads
    /// (eq. 3.2, 3.3 without the inertial terms).
    Loads,
    /// Velocities and angular velocities after a time \[s\] under the present loads (eq. 2.16, 2.17).
    Kick(f64),
}

struct Sweep<'a>(&'a mut Bodies, Pass);

impl WithSimd for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(bodies, pass) = self;
        match pass {
            Pass::Drift(dt) => bodies.drift(dt),
            Pass::Measure => bodies.measure(),
            Pass::Strain => bodies.strain(),
            Pass::Loads => {
                bodies.contact_loads();
                bodies.balance();
            }
            Pass::Kick(dt) => bodies.kick(dt),
        }
    }
}

impl Bodies {
    /// Makes a pass with the widest vectors that the machine has.
    pub(crate) fn sweep(&mut self, pass: Pass) {
        self.arch.dispatch(Sweep(self, pass));
        if matches!(pass, Pass::Measure) {
            self.measure_walls();
        }
    }

    /// First stations of the blocks.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.stations()).step_by(LANES)
    }

    #[allow(clippy::needless_range_loop)] // a lane of every array alike
    #[inline(always)]
    fn drift(&mut self, dt: f64) {
        for k in self.blocks() {
            let state = &mut self.state;
            let (velocity, omega) = (state.velocity.lanes(k), state.omega.lanes(k));
            let (position, director) = (state.position.lanes(k), state.director.lanes(k));
            let mut moved = VectorLanes::ZERO;
            let mut turned = MatrixLanes::ZERO;
            let mut squared = ZERO;
            for l in 0..LANES {
                moved.set(l, position.get(l) + velocity.get(l) * dt);
                let turn = omega.get(l) * -dt;
                squared[l] = turn.squared();
                let turn = rotation::exp_small(turn, squared[l]);
                turned.set(l, &turn.product(&director.get(l)));
            }
            if any_beyond(&squared, SMALL_SQUARE) {
                turned_far(&mut turned, &director, &omega, dt);
            }
            state.position.set_lanes(k, &moved);
            state.director.set_lanes(k, &turned);
        }
    }

    #[inline(always)]
    fn measure(&mut self) {
        for k in self.blocks() {
            let state = &self.state;
            let (position, next) = (state.position.lanes(k), state.position.after(k));
            let (director, before) = (state.director.lanes(k), state.director.before(k));
            let (element, element_before) = (self.element.lanes(k), self.element.before(k));
            let built = self.reference_length.lanes(k);
            let mut length = ZERO;
            let mut tangent = VectorLanes::ZERO;
            let mut turn = VectorLanes::ZERO;
            let mut haversine = ZERO;
            for l in 0..LANES {
                let edge = next.get(l) - position.get(l);
                let norm = edge.squared().sqrt();
                let exists = element[l] != 0.0;
                length[l] = if exists { norm } else { built[l] };
                let along = edge * (1.0 / length[l]);
                tangent.set(l, along.only_if(exists));

                let (axis, u) =
                    rotation::sines(&before.get(l).product_transposed(&director.get(l)));
                let exists = element[l] * element_before[l] != 0.0;
                haversine[l] = if exists { u } else { 0.0 };
                turn.set(l, rotation::log_small(axis, u).only_if(exists));
            }
            if any_beyond(&haversine, SMALL_HAVERSINE) {
                turns_far(&mut turn, &before, &director, &haversine);
            }
            self.length.set_lanes(k, &length);
            self.tangent.set_lanes(k, &tangent);
            self.rotation.set_lanes(k, &turn);
        }
    }

    /// Rotation vectors between end elements and the walls that hold them.
    fn measure_walls(&mut self) {
        for (layout, [start, tip]) in self.layouts.iter().zip(&self.walls) {
            let director = &self.state.director;
            let (first, last) = (layout.first, layout.first + layout.elements);
            if layout.walled[0] {
                let turn = rotation::between(start, &director.get(first));
                self.rotation.set(first, turn);
            }
            if layout.walled[1] {
                let turn = rotation::between(&director.get(last - 1), tip);
                self.rotation.set(last, turn);
            }
        }
    }

    #[inline(always)]
    fn strain(&mut self) {
        for k in self.blocks() {
            let director = self.state.director.lanes(k);
            let (length, length_before) = (self.length.lanes(k), self.length.before(k));
            let (rest, rest_before) = (self.rest_length.lanes(k), self.rest_length.before(k));
            let (element, element_before) = (self.element.lanes(k), self.element.before(k));
            let (tangent, turn) = (self.tangent.lanes(k), self.rotation.lanes(k));
            let (shear_stretch, rest_sigma) =
                (self.shear_stretch.lanes(k), self.rest_sigma.lanes(k));
            let (bend_twist, rest_kappa) = (self.bend_twist.lanes(k), self.rest_kappa.lanes(k));
            let (cell, twist_length) = (self.cell.lanes(k), self.twist_length.lanes(k));
            let (mut dilatation, mut rest_voronoi) = (ZERO, ZERO);
            let mut voronoi_dilatation = ZERO;
            let (mut sigma, mut stress) = (VectorLanes::ZERO, VectorLanes::ZERO);
            let (mut kappa, mut couple) = (VectorLanes::ZERO, VectorLanes::ZERO);
            for l in 0..LANES {
                let stretch = length[l] / rest[l];
                dilatation[l] = stretch;
                let mut strain = director.get(l).times(tangent.get(l)) * stretch;
                strain.z -= 1.0;
                sigma.set(l, strain);
                let elastic = strain - rest_sigma.get(l);
                stress.set(l, elastic.times(shear_stretch.get(l)));

                // At a wall a cell has half of its only element.
                let exists = cell[l] != 0.0;
                let mean = |before: f64, after: f64| {
                    (element_before[l] * before + element[l] * after) / 2.0
                };
                let (before, after) = (
                    mean(rest_before[l], rest[l]),
                    mean(length_before[l], length[l]),
                );
                let (before, after) = if exists { (before, after) } else { (1.0, 1.0) };
                rest_voronoi[l] = before;
                voronoi_dilatation[l] = after / before;
                // Twist is referred to its own length, so that a law that lengthens the rod need not dilute it.
                let (theta, per_length) = (turn.get(l), 1.0 / before);
                let curvature = triple(
                    theta.x * per_length,
                    theta.y * per_length,
                    theta.z / twist_length[l],
                );
                kappa.set(l, curvature);
                let elastic = (curvature - rest_kappa.get(l)).times(bend_twist.get(l));
                couple.set(l, elastic.only_if(exists));
            }
            self.dilatation.set_lanes(k, &dilatation);
            self.sigma.set_lanes(k, &sigma);
            self.stress.set_lanes(k, &stress);
            self.rest_voronoi.set_lanes(k, &rest_voronoi);
            self.voronoi_dilatation.set_lanes(k, &voronoi_dilatation);
            self.kappa.set_lanes(k, &kappa);
            self.couple.set_lanes(k, &couple);
        }
    }

    /// Forces and couples that elements and cells pass on, and the torques that come from shear.
    #[inline(always)]
    fn contact_loads(&mut self) {
        for k in self.blocks() {
            let (director, tangent) = (self.state.director.lanes(k), self.tangent.lanes(k));
            let (stress, dilatation) = (self.stress.lanes(k), self.dilatation.lanes(k));
            let (rest, rest_voronoi) = (self.rest_length.lanes(k), self.rest_voronoi.lanes(k));
            let (kappa, couple) = (self.kappa.lanes(k), self.couple.lanes(k));
            let voronoi_dilatation = self.voronoi_dilatation.lanes(k);
            let (mut force, mut shear) = (VectorLanes::ZERO, VectorLanes::ZERO);
            let (mut passed, mut transported) = (VectorLanes::ZERO, VectorLanes::ZERO);
            for l in 0..LANES {
                let (q, n) = (director.get(l), stress.get(l));
                force.set(l, q.transposed_times(n) * (1.0 / dilatation[l]));
                shear.set(l, q.times(tangent.get(l)).cross(n) * rest[l]);

                let stretch = voronoi_dilatation[l];
                let m = couple.get(l) * (1.0 / (stretch * stretch * stretch));
                passed.set(l, m);
                transported.set(l, kappa.get(l).cross(m) * (rest_voronoi[l] / 2.0));
            }
            self.contact_force.set_lanes(k, &force);
            self.contact_couple.set_lanes(k, &passed);
            self.transported_couple.set_lanes(k, &transported);
            self.torque.set_lanes(k, &shear);
        }
    }

    /// Differences of what is passed on: couples over their dilatation cubed, the halves of the couples that the cells'
    /// own rotations transport.
    #[inline(always)]
    fn balance(&mut self) {
        for k in self.blocks() {
            let (force, force_before) = (self.contact_force.lanes(k), self.contact_force.before(k));
            let (couple, couple_after) =
                (self.contact_couple.lanes(k), self.contact_couple.after(k));
            let transported = self.transported_couple.lanes(k);
            let transported_after = self.transported_couple.after(k);
            let shear = self.torque.lanes(k);
            let (mut forces, mut torques) = (VectorLanes::ZERO, VectorLanes::ZERO);
            for l in 0..LANES {
                forces.set(l, force.get(l) - force_before.get(l));
                let bending = couple_after.get(l) - couple.get(l);
                let transport = transported_after.get(l) + transported.get(l);
                torques.set(l, bending + transport + shear.get(l));
            }
            self.force.set_lanes(k, &forces);
            self.torque.set_lanes(k, &torques);
        }
    }

    #[inline(always)]
    fn kick(&mut self, dt: f64) {
        for k in self.blocks() {
            let state = &mut self.state;
            let (velocity, next) = (state.velocity.lanes(k), state.velocity.after(k));
            let (omega, inertia) = (state.omega.lanes(k), self.inertia.lanes(k));
            let (force, torque) = (self.force.lanes(k), self.torque.lanes(k));
            let (mass, tangent) = (self.mass.lanes(k), self.tangent.lanes(k));
            let (rest, dilatation) = (self.rest_length.lanes(k), self.dilatation.lanes(k));
            let (mut linear, mut angular) = (VectorLanes::ZERO, VectorLanes::ZERO);
            for l in 0..LANES {
                linear.set(l, velocity.get(l) + force.get(l) * (dt / mass[l]));

                // before velocities change
                let spread = (next.get(l) - velocity.get(l)).dot(tangent.get(l));
                let stretching = spread / (rest[l] * dilatation[l]);
                let (j, torque) = (inertia.get(l), torque.get(l) * dilatation[l]);
                let inverse = triple(1.0 / j.x, 1.0 / j.y, 1.0 / j.z);
                let rate = |omega: Triple| {
                    let momentum = j.times(omega);
                    (torque + momentum.cross(omega) + momentum * stretching).times(inverse)
                };
                // These torques depend on the rate itself: taken at the middle of the step, or a tumbling body would
                // converge at first order only.
                let start = omega.get(l);
                let middle = start + rate(start) * (dt / 2.0);
                angular.set(l, start + rate(middle) * dt);
            }
            state.velocity.set_lanes(k, &linear);
            state.omega.set_lanes(k, &angular);
        }
    }
}

/// Whether a number is beyond a bound, or none.
#[inline(always)]
fn is_beyond(x: f64, bound: f64) -> bool {
    x.is_nan() || x > bound
}

/// Whether a lane is beyond a bound, or no number.
#[inline(always)]
fn any_beyond(lanes: &Lanes, bound: f64) -> bool {
    let mut beyond = 0_u64;
    for x in lanes {
        beyond += u64::from(is_beyond(*x, bound));
    }
    beyond > 0
}

/// Frames turned by any angles.
#[cold]
fn turned_far(turned: &mut MatrixLanes, director: &MatrixLanes, omega: &VectorLanes, dt: f64) {
    for l in 0..LANES {
        let turn = Vector3::from(omega.get(l)) * dt;
        let frame = rotation::turned(&Matrix3::from(director.get(l)), &turn);
        turned.set(l, &Rows::from(&frame));
    }
}

/// Rotation vectors of any angles, where the last argument is beyond its bound.
#[cold]
fn turns_far(
    turns: &mut VectorLanes,
    before: &MatrixLanes,
    director: &MatrixLanes,
    haversine: &Lanes,
) {
    for (l, haversine) in haversine.iter().enumerate() {
        if is_beyond(*haversine, SMALL_HAVERSINE) {
            let [before, after] = [before, director].map(|m| Matrix3::from(m.get(l)));
            turns.set(l, Triple::from(&rotation::between(&before, &after)));
        }
    }
}
