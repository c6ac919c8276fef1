//! The discrete Cosserat equations on flat arrays (Gazzola et al. 2018, section 3), pass by pass.
//!
//! Strains, stresses and couples are material; forces on nodes are world, torques on elements material.
//!
//! Every pass goes over all stations of all bodies alike, eight at a time. Where a station has no element or no cell
//! the masks of [`Bodies`] leave zero strains, so that nothing comes from there. The passes use no fused
//! multiplication and no reordering, hence give the same bits whatever vectors the machine has.

use crate::bodies::Bodies;
use crate::lanes::{LANES, Lanes, Matrix, Rows, Span, Triple, Vector, ZERO, triple};
use crate::rotation::{self, SMALL_HAVERSINE, SMALL_SQUARE};
use pulp::{Simd, WithSimd};

/// A pass over all stations.
#[derive(Clone, Copy)]
pub(crate) enum Pass {
    /// Moves every node and frame with its present rates for a time \[s\] (half a step of position Verlet).
    Drift(f64),
    /// The same twice, to the same bits: the end of a step and the beginning of the next.
    DriftTwice(f64),
    /// Element lengths and tangents, and the rotation vectors between neighbouring elements.
    Measure,
    /// Strains and linear elastic loads from the measures and from what the rod laws set (eq. 2.12, 2.13, 2.18).
    Strain,
    /// Internal forces on nodes \[N\] and torques on elements \[N m\] from stresses and couples; overwrites the loads
    /// (eq. 3.2, 3.3 without the inertial terms).
    Loads,
    /// All three, for rods without laws or walls.
    Elastic,
    /// Velocities and angular velocities after a time \[s\] under the present loads (eq. 2.16, 2.17).
    Kick(f64),
}

/// Blocks that go through several passes one after the other, in the cache.
const CHUNK: usize = 8;

struct Sweep<'a>(&'a mut Bodies, Pass);

impl WithSimd for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(bodies, pass) = self;
        match pass {
            Pass::Drift(dt) => bodies.drift::<1>(dt),
            Pass::DriftTwice(dt) => bodies.drift::<2>(dt),
            Pass::Measure => bodies.measure(bodies.blocks()),
            Pass::Strain => bodies.strain(bodies.blocks()),
            Pass::Loads => {
                bodies.contact_loads(bodies.blocks());
                bodies.balance(bodies.blocks());
            }
            Pass::Elastic => bodies.by_chunks(),
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

    /// All blocks.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> Span {
        Span {
            start: 0,
            count: self.stations().div_ceil(LANES),
        }
    }

    #[allow(clippy::needless_range_loop)] // a lane of every array alike
    #[inline(always)]
    fn drift<const TIMES: usize>(&mut self, dt: f64) {
        let all = self.blocks();
        let state = &mut self.state;
        let (velocity, omega) = (state.velocity.blocks(all), state.omega.blocks(all));
        let mut position = state.position.blocks_mut(all);
        let mut director = state.director.blocks_mut(all);
        let mut far = ZERO;
        for b in 0..all.count {
            let (velocity, omega) = (velocity.at(b), omega.at(b));
            let (at, frame) = (position.at(b), director.at(b));
            let (mut moved, mut turned) = (Vector::ZERO, Matrix::ZERO);
            for l in 0..LANES {
                let (mut at, kept) = (at.get(l), frame.get(l));
                let mut frame = kept;
                let move_by = velocity.get(l) * dt;
                let turn = omega.get(l) * -dt;
                let squared = turn.squared();
                let near = squared <= SMALL_SQUARE;
                far[l] = if near { far[l] } else { 1.0 };
                let turn = rotation::exp_small(turn, squared);
                for _ in 0..TIMES {
                    at = at + move_by;
                    frame = turn.product(&frame);
                }
                moved.set(l, at);
                turned.set(l, &if near { frame } else { kept });
            }
            position.set(b, &moved);
            director.set(b, &turned);
        }
        if any(&far) {
            (0..TIMES).for_each(|_| self.turn_far(dt));
        }
    }

    /// Turns the frames that turn by more than the power series is for, or by no number, which [`Bodies::drift`] leaves.
    #[cold]
    fn turn_far(&mut self, dt: f64) {
        for k in 0..self.stations() {
            let omega = self.state.omega.get(k);
            if is_beyond((Triple::from(&omega) * -dt).squared(), SMALL_SQUARE) {
                let turned = rotation::turned(&self.state.director.get(k), &(omega * dt));
                self.state.director.set(k, turned);
            }
        }
    }

    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    fn measure(&mut self, at: Span) {
        let state = &self.state;
        let (position, next) = (state.position.blocks(at), state.position.after(at));
        let (director, before) = (state.director.blocks(at), state.director.before(at));
        let (element, element_before) = (self.element.blocks(at), self.element.before(at));
        let built = self.reference_length.blocks(at);
        let lengths = self.length.blocks_mut(at);
        let mut tangents = self.tangent.blocks_mut(at);
        let mut turns = self.rotation.blocks_mut(at);
        let mut far = ZERO;
        for b in 0..at.count {
            let (position, next) = (position.at(b), next.at(b));
            let (director, before) = (director.at(b), before.at(b));
            let (element, element_before) = (&element[b], &element_before[b]);
            let built = &built[b];
            let mut length = ZERO;
            let (mut tangent, mut turn) = (Vector::ZERO, Vector::ZERO);
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
                let near = !exists | (u <= SMALL_HAVERSINE);
                far[l] = if near { far[l] } else { 1.0 };
                turn.set(l, rotation::log_small(axis, u).only_if(exists));
            }
            lengths[b] = length;
            tangents.set(b, &tangent);
            turns.set(b, &turn);
        }
        if any(&far) {
            self.measure_far(at);
        }
    }

    /// Rotation vectors where neighbours are turned by more than the power series is for.
    #[cold]
    fn measure_far(&mut self, at: Span) {
        let Self { layouts, state, .. } = self;
        let measured = at.start * LANES..(at.start + at.count) * LANES;
        for k in layouts
            .iter()
            .flat_map(|l| l.first + 1..l.first + l.elements)
        {
            let [before, after] = [k - 1, k].map(|k| state.director.get(k));
            let [a, b] = [&before, &after].map(Rows::from);
            let (_, haversine) = rotation::sines(&a.product_transposed(&b));
            if measured.contains(&k) && is_beyond(haversine, SMALL_HAVERSINE) {
                self.rotation.set(k, rotation::between(&before, &after));
            }
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

    /// From poses to internal loads.
    #[inline(always)]
    fn by_chunks(&mut self) {
        let Span { count, .. } = self.blocks();
        for start in (0..count).step_by(CHUNK) {
            let chunk = Span {
                start,
                count: CHUNK.min(count - start),
            };
            self.measure(chunk);
            self.strain(chunk);
            self.contact_loads(chunk);
            // a block behind: it needs the station after its last
            self.balance(Span {
                start: start.max(1) - 1,
                count: chunk.count - usize::from(start == 0),
            });
        }
        self.balance(Span {
            start: count.max(1) - 1,
            count: count.min(1),
        });
    }

    #[inline(always)]
    fn strain(&mut self, at: Span) {
        let director = self.state.director.blocks(at);
        let (length, length_before) = (self.length.blocks(at), self.length.before(at));
        let (rest, rest_before) = (self.rest_length.blocks(at), self.rest_length.before(at));
        let (element, element_before) = (self.element.blocks(at), self.element.before(at));
        let (tangent, turn) = (self.tangent.blocks(at), self.rotation.blocks(at));
        let (shear_stretch, rest_sigma) =
            (self.shear_stretch.blocks(at), self.rest_sigma.blocks(at));
        let (bend_twist, rest_kappa) = (self.bend_twist.blocks(at), self.rest_kappa.blocks(at));
        let (cell, twist_length) = (self.cell.blocks(at), self.twist_length.blocks(at));
        let dilatations = self.dilatation.blocks_mut(at);
        let (mut sigmas, mut stresses) = (self.sigma.blocks_mut(at), self.stress.blocks_mut(at));
        let rest_voronois = self.rest_voronoi.blocks_mut(at);
        let voronoi_dilatations = self.voronoi_dilatation.blocks_mut(at);
        let (mut kappas, mut couples) = (self.kappa.blocks_mut(at), self.couple.blocks_mut(at));
        for b in 0..at.count {
            let director = director.at(b);
            let (length, length_before) = (&length[b], &length_before[b]);
            let (rest, rest_before) = (&rest[b], &rest_before[b]);
            let (element, element_before) = (&element[b], &element_before[b]);
            let (tangent, turn) = (tangent.at(b), turn.at(b));
            let (shear_stretch, rest_sigma) = (shear_stretch.at(b), rest_sigma.at(b));
            let (bend_twist, rest_kappa) = (bend_twist.at(b), rest_kappa.at(b));
            let (cell, twist_length) = (&cell[b], &twist_length[b]);
            let (mut dilatation, mut rest_voronoi) = (ZERO, ZERO);
            let mut voronoi_dilatation = ZERO;
            let (mut sigma, mut stress) = (Vector::ZERO, Vector::ZERO);
            let (mut kappa, mut couple) = (Vector::ZERO, Vector::ZERO);
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
            dilatations[b] = dilatation;
            sigmas.set(b, &sigma);
            stresses.set(b, &stress);
            rest_voronois[b] = rest_voronoi;
            voronoi_dilatations[b] = voronoi_dilatation;
            kappas.set(b, &kappa);
            couples.set(b, &couple);
        }
    }

    /// Forces and couples that elements and cells pass on, and the torques that come from shear.
    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    fn contact_loads(&mut self, at: Span) {
        let (director, tangent) = (self.state.director.blocks(at), self.tangent.blocks(at));
        let (stress, dilatation) = (self.stress.blocks(at), self.dilatation.blocks(at));
        let (rest, rest_voronoi) = (self.rest_length.blocks(at), self.rest_voronoi.blocks(at));
        let (kappa, couple) = (self.kappa.blocks(at), self.couple.blocks(at));
        let voronoi_dilatation = self.voronoi_dilatation.blocks(at);
        let mut forces = self.contact_force.blocks_mut(at);
        let mut couples = self.contact_couple.blocks_mut(at);
        let mut transports = self.transported_couple.blocks_mut(at);
        let mut torques = self.torque.blocks_mut(at);
        for b in 0..at.count {
            let (director, tangent) = (director.at(b), tangent.at(b));
            let (stress, dilatation) = (stress.at(b), &dilatation[b]);
            let (rest, rest_voronoi) = (&rest[b], &rest_voronoi[b]);
            let (kappa, couple) = (kappa.at(b), couple.at(b));
            let voronoi_dilatation = &voronoi_dilatation[b];
            let (mut force, mut shear) = (Vector::ZERO, Vector::ZERO);
            let (mut passed, mut transported) = (Vector::ZERO, Vector::ZERO);
            for l in 0..LANES {
                let (q, n) = (director.get(l), stress.get(l));
                force.set(l, q.transposed_times(n) * (1.0 / dilatation[l]));
                shear.set(l, q.times(tangent.get(l)).cross(n) * rest[l]);

                let stretch = voronoi_dilatation[l];
                let m = couple.get(l) * (1.0 / (stretch * stretch * stretch));
                passed.set(l, m);
                transported.set(l, kappa.get(l).cross(m) * (rest_voronoi[l] / 2.0));
            }
            forces.set(b, &force);
            couples.set(b, &passed);
            transports.set(b, &transported);
            torques.set(b, &shear);
        }
    }

    /// Differences of what is passed on: couples over their dilatation cubed, the halves of the couples that the cells'
    /// own rotations transport.
    #[inline(always)]
    fn balance(&mut self, at: Span) {
        let (force, force_before) = (self.contact_force.blocks(at), self.contact_force.before(at));
        let (couple, couple_after) = (
            self.contact_couple.blocks(at),
            self.contact_couple.after(at),
        );
        let transported = self.transported_couple.blocks(at);
        let transported_after = self.transported_couple.after(at);
        let mut forces = self.force.blocks_mut(at);
        let mut torques = self.torque.blocks_mut(at);
        for b in 0..at.count {
            let (force, force_before) = (force.at(b), force_before.at(b));
            let (couple, couple_after) = (couple.at(b), couple_after.at(b));
            let (transported, transported_after) = (transported.at(b), transported_after.at(b));
            let shear = torques.at(b);
            let (mut difference, mut torque) = (Vector::ZERO, Vector::ZERO);
            for l in 0..LANES {
                difference.set(l, force.get(l) - force_before.get(l));
                let bending = couple_after.get(l) - couple.get(l);
                let transport = transported_after.get(l) + transported.get(l);
                torque.set(l, bending + transport + shear.get(l));
            }
            forces.set(b, &difference);
            torques.set(b, &torque);
        }
    }

    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    fn kick(&mut self, dt: f64) {
        let all = self.blocks();
        let (inertia, inverse) = (self.inertia.blocks(all), self.inverse_inertia.blocks(all));
        let (force, torque) = (self.force.blocks(all), self.torque.blocks(all));
        let (inverse_mass, tangent) = (self.inverse_mass.blocks(all), self.tangent.blocks(all));
        let (length, dilatation) = (self.length.blocks(all), self.dilatation.blocks(all));
        // with the block after the last, whose first station is read
        let mut velocities = self.state.velocity.blocks_mut(all.and_next());
        let mut omegas = self.state.omega.blocks_mut(all);
        for b in 0..all.count {
            let (velocity, next) = (velocities.at(b), velocities.after(b));
            let omega = omegas.at(b);
            let (inertia, inverse) = (inertia.at(b), inverse.at(b));
            let (force, torque) = (force.at(b), torque.at(b));
            let (inverse_mass, tangent) = (&inverse_mass[b], tangent.at(b));
            let (length, dilatation) = (&length[b], &dilatation[b]);
            let (mut linear, mut angular) = (Vector::ZERO, Vector::ZERO);
            for l in 0..LANES {
                linear.set(l, velocity.get(l) + force.get(l) * (dt * inverse_mass[l]));

                // before velocities change
                let spread = (next.get(l) - velocity.get(l)).dot(tangent.get(l));
                let stretching = spread / length[l];
                let (j, torque) = (inertia.get(l), torque.get(l) * dilatation[l]);
                let inverse = inverse.get(l);
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
            velocities.set(b, &linear);
            omegas.set(b, &angular);
        }
    }
}

/// Whether a number is beyond a bound, or none.
#[inline(always)]
fn is_beyond(x: f64, bound: f64) -> bool {
    x.is_nan() || x > bound
}

/// Whether a lane isn't zero.
#[inline(always)]
fn any(lanes: &Lanes) -> bool {
    lanes.iter().sum::<f64>() != 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::{Rod, Section};
    use nalgebra::Vector3;

    /// Two rods, bent, twisted and moving at random, one of them by turns that the power series isn't for.
    fn bodies(elements: usize) -> Bodies {
        let mut bodies = Bodies::default();
        let section = Section {
            outside: 0.01,
            inside: 0.0,
        };
        let moduli = section.rigidities(1e7, 4e6);
        for name in ["a", "b"] {
            let length = 0.01 * elements as f64;
            bodies.push_rod(&Rod::uniform(name, length, elements, section, 1e3, moduli));
        }
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24) - 0.5
        };
        for k in 0..bodies.stations() {
            let state = &mut bodies.state;
            let [shift, velocity, turn, omega] =
                [2e-3, 1.0, 0.1, 20.0].map(|size| Vector3::from_fn(|_, _| size * random()));
            state.position.add(k, shift);
            state.velocity.set(k, velocity);
            // zeros in every second frame, which have signs
            let turn = turn.component_mul(&Vector3::new(1.0, (k % 2) as f64, 0.0));
            let frame = rotation::turned(&state.director.get(k), &turn);
            let turn = if k == 3 { 9.0 } else { 1.0 };
            state
                .director
                .set(k, rotation::turned(&frame, &Vector3::new(turn, 0.0, 0.0)));
            state
                .omega
                .set(k, omega * if k % 5 == 1 { 1e4 } else { 1.0 });
        }
        bodies
    }

    /// Whether two ways to make passes leave the same bits, with vectors and without.
    fn assert_same(one: &[Pass], other: &[Pass]) {
        for elements in [1, 6, 7, 8, 40, 200] {
            for arch in [pulp::Arch::Scalar, pulp::Arch::new()] {
                let [a, b] = [one, other].map(|passes| {
                    let mut bodies = bodies(elements);
                    bodies.arch = arch;
                    passes.iter().for_each(|pass| bodies.sweep(*pass));
                    (bodies.state, bodies.force, bodies.torque, bodies.couple)
                });
                assert!(a.1.all_finite() && a.2.all_finite());
                assert_eq!(a, b, "{elements} elements");
            }
        }
    }

    #[test]
    fn chunks_change_no_bit() {
        assert_same(
            &[Pass::Elastic],
            &[Pass::Measure, Pass::Strain, Pass::Loads],
        );
    }

    #[test]
    fn two_halves_of_steps_at_once_change_no_bit() {
        let dt = 1e-5;
        assert_same(&[Pass::DriftTwice(dt)], &[Pass::Drift(dt), Pass::Drift(dt)]);
    }
}
