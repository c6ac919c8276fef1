//! The discrete Cosserat equations on flat arrays (Gazzola et al. 2018, section 3), pass by pass.
//!
//! Strains, stresses and couples are material; forces on nodes are world, torques on elements material.
//!
//! Every pass goes over all stations of all bodies alike, a few at a time. Where a station has no element or no cell
//! the masks of [`Bodies`] leave zero strains, so that nothing comes from there. The passes use no fused
//! multiplication and no reordering, hence give the same bits whatever vectors the machine has.

use crate::bodies::Bodies;
use crate::columns::Extent;
use crate::number::Lanes;
use crate::rotation::{self, SMALL_HAVERSINE, SMALL_SQUARE};
use crate::triple::{Rows, Triple, triple};
use crate::wide::{OverLanes, dispatch};

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
    /// [`Pass::Strain`] and [`Pass::Loads`], for laws that add nothing to stresses and couples.
    StrainAndLoads,
    /// All from [`Pass::Measure`] on, for rods without laws or walls.
    Elastic,
    /// Velocities and angular velocities after a time \[s\] under the present loads (eq. 2.16, 2.17).
    Kick(f64),
}

struct Sweep<'a>(&'a mut Bodies, Pass);

impl OverLanes for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn over<L: Lanes>(self, token: L::Token) {
        let Self(bodies, pass) = self;
        let all = Extent::<L>::new(token, bodies.stations());
        match pass {
            Pass::Drift(dt) => bodies.drift::<L, 1>(all, dt),
            Pass::DriftTwice(dt) => bodies.drift::<L, 2>(all, dt),
            Pass::Measure => bodies.internal_loads::<L, true, false, false>(all),
            Pass::Strain => bodies.internal_loads::<L, false, true, false>(all),
            Pass::Loads => bodies.internal_loads::<L, false, false, true>(all),
            Pass::StrainAndLoads => bodies.internal_loads::<L, false, true, true>(all),
            Pass::Elastic => bodies.internal_loads::<L, true, true, true>(all),
            Pass::Kick(dt) => bodies.kick::<L>(all, dt),
        }
    }
}

impl Bodies {
    /// Makes a pass with the widest vectors that the machine has.
    pub(crate) fn sweep(&mut self, pass: Pass) {
        dispatch(self.arch, Sweep(self, pass));
        if matches!(pass, Pass::Measure) {
            self.measure_walls();
        }
    }

    #[inline(always)]
    fn drift<L: Lanes, const TIMES: usize>(&mut self, all: Extent<L>, dt: f64) {
        let state = &mut self.state;
        let (velocity, omega) = (state.velocity.blocks(all), state.omega.blocks(all));
        let mut positions = state.position.blocks_mut(all);
        let mut directors = state.director.blocks_mut(all);
        let mut far = false;
        for b in 0..all.count {
            let move_by = velocity.at(b).scaled(dt);
            let theta = omega.at(b).scaled(-dt);
            let squared = theta.squared();
            let turn = rotation::exp_small(theta, squared);
            let (mut position, mut director) = (positions.at(b), directors.at(b));
            for _ in 0..TIMES {
                position = position + move_by;
                director = turn.product(&director);
            }
            let near = squared.at_most(squared.constant(SMALL_SQUARE));
            if !squared.everywhere(near) {
                director = director.select(near, &directors.at(b));
                far = true;
            }
            positions.set(b, position);
            directors.set(b, &director);
        }
        if far {
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

    /// From poses to internal loads, or that part of the way: what isn't computed has been before.
    #[inline(always)]
    fn internal_loads<L: Lanes, const MEASURE: bool, const STRAIN: bool, const LOADS: bool>(
        &mut self,
        all: Extent<L>,
    ) {
        let (positions, directors) = (&self.state.position, &self.state.director);
        let (position, next) = (positions.blocks(all), positions.after(all));
        let (director, previous) = (directors.blocks(all), directors.before(all));
        let (element, element_before) = (self.element.blocks(all), self.element.before(all));
        let built = self.reference_length.blocks(all);
        let (rest, rest_before) = (self.rest_length.blocks(all), self.rest_length.before(all));
        let (cell, twist_length) = (self.cell.blocks(all), self.twist_length.blocks(all));
        let shear_stretch = self.shear_stretch.blocks(all);
        let rest_sigma = self.rest_sigma.blocks(all);
        let bend_twist = self.bend_twist.blocks(all);
        let rest_kappa = self.rest_kappa.blocks(all);

        let mut lengths = self.length.blocks_mut(all);
        let mut tangents = self.tangent.blocks_mut(all);
        let mut turns = self.rotation.blocks_mut(all);
        let mut dilatations = self.dilatation.blocks_mut(all);
        let mut sigmas = self.sigma.blocks_mut(all);
        let mut stresses = self.stress.blocks_mut(all);
        let mut rest_voronois = self.rest_voronoi.blocks_mut(all);
        let mut voronoi_dilatations = self.voronoi_dilatation.blocks_mut(all);
        let mut kappas = self.kappa.blocks_mut(all);
        let mut couples = self.couple.blocks_mut(all);
        let mut forces = self.force.blocks_mut(all);
        let mut torques = self.torque.before_mut(all);

        let zero = all.zero();
        let one = zero.constant(1.0);
        let nothing = triple(zero, zero, zero);
        // rotated ones of the block before, whose first is that of its last station
        let mut last_length = zero;
        let mut last = Contact {
            force: nothing,
            couple: nothing,
            transported: nothing,
            shear: nothing,
        };
        for b in 0..all.count {
            let director = director.at(b);
            let (element, element_before) = (element.at(b), element_before.at(b));
            let (length, per_length, tangent, turn);
            if MEASURE {
                let edge = next.at(b) - position.at(b);
                let missing = element.is_zero();
                length = built.at(b).select(missing, edge.squared().sqrt());
                per_length = one / length;
                tangent = (edge * per_length).zero_where(missing);

                let previous = previous.at(b);
                let (axis, haversine) = rotation::sines(&previous.product_transposed(&director));
                let inner = element * element_before;
                let near = haversine.at_most(haversine.constant(SMALL_HAVERSINE));
                let apart = inner.is_zero();
                let small = rotation::log_small(axis, haversine).zero_where(apart);
                turn = if inner.everywhere(inner.either(near, apart)) {
                    small
                } else {
                    measured_far(small, haversine, inner, [previous, director])
                };
                lengths.set(b, length);
                tangents.set(b, tangent);
                turns.set(b, turn);
            } else {
                (length, tangent, turn) = (lengths.at(b), tangents.at(b), turns.at(b));
                per_length = one / length;
            }

            let (rest, rest_before) = (rest.at(b), rest_before.at(b));
            let stretch = length / rest;
            let no_cell = cell.at(b).is_zero();
            let rotated_length = length.rotated();
            let length_before = rotated_length.with_first_of(last_length);
            last_length = rotated_length;
            // At a wall a cell has half of its only element.
            let at_rest = (element_before * rest_before + element * rest) * 0.5;
            let present = (element_before * length_before + element * length) * 0.5;
            let voronoi = Voronoi::new(
                one.select(no_cell, at_rest),
                one.select(no_cell, present),
                twist_length.at(b),
            );

            let (stress, kappa, couple);
            if STRAIN {
                let mut sigma = director.times(tangent) * stretch;
                sigma.z = sigma.z - one;
                stress = (sigma - rest_sigma.at(b)).times(shear_stretch.at(b));
                kappa = triple(
                    turn.x * voronoi.per_rest,
                    turn.y * voronoi.per_rest,
                    turn.z * voronoi.per_twist,
                );
                let elastic = (kappa - rest_kappa.at(b)).times(bend_twist.at(b));
                couple = elastic.zero_where(no_cell);
                dilatations.set(b, stretch);
                sigmas.set(b, sigma);
                stresses.set(b, stress);
                rest_voronois.set(b, voronoi.rest);
                voronoi_dilatations.set(b, voronoi.dilatation);
                kappas.set(b, kappa);
                couples.set(b, couple);
            } else {
                (stress, kappa, couple) = (stresses.at(b), kappas.at(b), couples.at(b));
            }

            if LOADS {
                let force = director.transposed_times(stress) * (rest * per_length);
                let shear = director.times(tangent).cross(stress) * rest;
                // couples over their dilatation cubed, and the halves of them that the cells' own rotations transport
                let squeeze = voronoi.per_dilatation;
                let couple = couple * (squeeze * squeeze * squeeze);
                let transported = kappa.cross(couple) * (voronoi.rest * 0.5);

                let rotated = Contact {
                    force: force.rotated(),
                    couple: couple.rotated(),
                    transported: transported.rotated(),
                    shear: shear.rotated(),
                };
                let before = rotated.with_first_of(&last);
                last = rotated;
                forces.set(b, force - before.force);
                let (bending, transport) =
                    (couple - before.couple, transported + before.transported);
                torques.set(b, bending + transport + before.shear);
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

    #[inline(always)]
    fn kick<L: Lanes>(&mut self, all: Extent<L>, dt: f64) {
        let inertia = self.inertia.blocks(all);
        let inverse_inertia = self.inverse_inertia.blocks(all);
        let (force, torque) = (self.force.blocks(all), self.torque.blocks(all));
        let inverse_mass = self.inverse_mass.blocks(all);
        let tangent = self.tangent.blocks(all);
        let (length, dilatation) = (self.length.blocks(all), self.dilatation.blocks(all));
        // with the block after the last, whose first station is read
        let mut velocities = self.state.velocity.blocks_mut(all.and_next());
        let mut omegas = self.state.omega.blocks_mut(all);
        for b in 0..all.count {
            let velocity = velocities.at(b);
            // before velocities change
            let spread = (velocities.after(b) - velocity).dot(tangent.at(b));
            velocities.set(b, velocity + force.at(b) * (inverse_mass.at(b) * dt));

            let element = Spinning {
                inertia: inertia.at(b),
                inverse_inertia: inverse_inertia.at(b),
                torque: torque.at(b) * dilatation.at(b),
                stretching: spread / length.at(b),
            };
            // These torques depend on the rate itself: taken at the middle of the step, or a tumbling body would
            // converge at first order only.
            let start = omegas.at(b);
            let middle = start + element.rate(start).scaled(dt / 2.0);
            omegas.set(b, start + element.rate(middle).scaled(dt));
        }
    }
}

/// Lengths of cells, and one over them.
struct Voronoi<L> {
    rest: L,
    per_rest: L,
    /// One over the length that twist is referred to: its own, so that a law that lengthens the rod need not dilute it.
    per_twist: L,
    dilatation: L,
    per_dilatation: L,
}

impl<L: Lanes> Voronoi<L> {
    #[inline(always)]
    fn new(rest: L, present: L, twist: L) -> Self {
        // one division for all
        let per_all = rest.constant(1.0) / (rest * present * twist);
        let per_rest = present * twist * per_all;
        Self {
            rest,
            per_rest,
            per_twist: rest * present * per_all,
            dilatation: present * per_rest,
            per_dilatation: rest * (rest * twist * per_all),
        }
    }
}

/// What elements and cells pass on to their neighbours.
struct Contact<L> {
    /// Forces of elements, world.
    force: Triple<L>,
    /// Couples of cells.
    couple: Triple<L>,
    /// Halves of what the couples are transported by.
    transported: Triple<L>,
    /// Torques of elements from shear.
    shear: Triple<L>,
}

impl<L: Lanes> Contact<L> {
    /// See [`Lanes::with_first_of`].
    #[inline(always)]
    fn with_first_of(&self, others: &Self) -> Self {
        Self {
            force: self.force.with_first_of(others.force),
            couple: self.couple.with_first_of(others.couple),
            transported: self.transported.with_first_of(others.transported),
            shear: self.shear.with_first_of(others.shear),
        }
    }
}

/// What changes angular velocities.
struct Spinning<L> {
    inertia: Triple<L>,
    inverse_inertia: Triple<L>,
    torque: Triple<L>,
    /// Growth rate of the dilatation over the dilatation.
    stretching: L,
}

impl<L: Lanes> Spinning<L> {
    /// The angular accelerations at these angular velocities.
    #[inline(always)]
    fn rate(&self, omega: Triple<L>) -> Triple<L> {
        let momentum = self.inertia.times(omega);
        let torque = self.torque + momentum.cross(omega) + momentum * self.stretching;
        torque.times(self.inverse_inertia)
    }
}

/// Rotation vectors between the frames of neighbouring elements, where the power series isn't for them.
#[cold]
#[inline(never)]
fn measured_far<L: Lanes>(
    near: Triple<L>,
    haversine: L,
    inner: L,
    [before, after]: [Rows<L>; 2],
) -> Triple<L> {
    (0..L::COUNT).fold(near, |turns, l| {
        if inner.lane(l) > 0.0 && is_beyond(haversine.lane(l), SMALL_HAVERSINE) {
            turns.with_lane(l, rotation::between(&before.lane(l), &after.lane(l)))
        } else {
            turns
        }
    })
}

/// Whether a number is beyond a bound, or none.
#[inline(always)]
fn is_beyond(x: f64, bound: f64) -> bool {
    x.is_nan() || x > bound
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
    fn parts_of_the_way_to_loads_change_no_bit() {
        let parts = [Pass::Measure, Pass::Strain, Pass::Loads];
        assert_same(&[Pass::Elastic], &parts);
        assert_same(&[Pass::Measure, Pass::StrainAndLoads], &parts);
    }

    #[test]
    fn vectors_change_no_bit() {
        let step = [Pass::Elastic, Pass::Kick(1e-5), Pass::Drift(1e-5)];
        let [plain, vectors] = [pulp::Arch::Scalar, pulp::Arch::new()].map(|arch| {
            let mut bodies = bodies(40);
            bodies.arch = arch;
            step.iter().for_each(|pass| bodies.sweep(*pass));
            (bodies.state, bodies.force, bodies.torque, bodies.couple)
        });
        assert_eq!(plain, vectors);
    }

    #[test]
    fn two_halves_of_steps_at_once_change_no_bit() {
        let dt = 1e-5;
        assert_same(&[Pass::DriftTwice(dt)], &[Pass::Drift(dt), Pass::Drift(dt)]);
    }
}
