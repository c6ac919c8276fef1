//! Bodies and hooks put together: what a solver works on.

use crate::bodies::{Bodies, State};
use crate::cylinder::Cylinder;
use crate::hooks::{BoundaryCondition, Damping, Forcing, Joint, RodLaw, Setting};
use crate::inputs::{Inputs, Moment};
use crate::rod::Rod;
use crate::site::{Place, Site};
use crate::vectors::Vectors;
use crate::view::{Body, LawView, LoadView, PoseView, RateView, ReadBody};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Stations that a group is filled to: large enough to be worth a thread, small enough for its cache. Fixed, so that
/// results don't depend on the number of threads.
const GROUP_STATIONS: usize = 512;

/// A body of a [`System`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BodyId {
    pub(crate) group: usize,
    pub(crate) index: usize,
}

/// A hook, the body of its group that it acts on, and what reports call it.
pub(crate) struct Hooked<T: ?Sized> {
    pub(crate) name: String,
    pub(crate) body: usize,
    pub(crate) hook: Box<T>,
}

/// Bodies that are computed together, with the hooks that act on one body alone.
#[derive(Default)]
pub(crate) struct Group {
    pub(crate) bodies: Bodies,
    pub(crate) laws: Vec<Hooked<dyn RodLaw>>,
    pub(crate) forcing: Vec<Hooked<dyn Forcing>>,
    pub(crate) boundary: Vec<Hooked<dyn BoundaryCondition>>,
    pub(crate) damping: Vec<Hooked<dyn Damping>>,
}

impl Group {
    /// Boundary values of positions and frames.
    pub(crate) fn set_values(&mut self, now: &Moment<'_>) {
        for b in &self.boundary {
            b.hook
                .values(now, &mut PoseView::new(&mut self.bodies, b.body));
        }
    }

    /// Boundary values of rates.
    pub(crate) fn set_rates(&mut self, now: &Moment<'_>) {
        for b in &self.boundary {
            b.hook
                .rates(now, &mut RateView::new(&mut self.bodies, b.body));
        }
    }

    /// All loads but those of joints.
    pub(crate) fn loads(&mut self, now: &Moment<'_>) {
        self.internal_loads(now);
        for f in &self.forcing {
            f.hook
                .apply(now, &mut LoadView::new(&mut self.bodies, f.body));
        }
        for b in &self.boundary {
            b.hook
                .loads(now, &mut LoadView::new(&mut self.bodies, b.body));
        }
    }

    fn internal_loads(&mut self, now: &Moment<'_>) {
        self.bodies.measure();
        for l in &self.laws {
            l.hook
                .rest(now, &mut LawView::new(&mut self.bodies, l.body));
        }
        self.bodies.strain();
        for l in &self.laws {
            l.hook
                .stress(now, &mut LawView::new(&mut self.bodies, l.body));
        }
        self.bodies.internal_loads();
    }

    /// Rates after a step under the present loads, damped and held.
    fn kick(&mut self, now: &Moment<'_>, dt: f64) {
        self.bodies.measure_rates();
        self.bodies.kick(dt);
        for d in &self.damping {
            d.hook
                .damp(dt, &mut RateView::new(&mut self.bodies, d.body));
        }
        self.set_rates(now);
    }

    /// The name of the hook whose loads are the first that aren't finite, if one is to blame.
    pub(crate) fn culprit(&mut self, now: &Moment<'_>) -> Option<String> {
        self.internal_loads(now);
        let finite = |b: &Bodies| b.force.all_finite() && b.torque.all_finite();
        if !finite(&self.bodies) {
            let bodies = &self.bodies;
            let spoiled = |l: &&Hooked<dyn RodLaw>| {
                let layout = &bodies.layouts()[l.body];
                let element = |k: usize| {
                    !bodies.rest_length[k].is_finite()
                        || !finite_at(&bodies.shear_stretch, k)
                        || (finite_at(&bodies.sigma, k) && !finite_at(&bodies.stress, k))
                };
                let cell = |k: usize| {
                    !finite_at(&bodies.bend_twist, k)
                        || (finite_at(&bodies.kappa, k) && !finite_at(&bodies.couple, k))
                };
                layout.element_stations().any(element) || layout.cells().any(cell)
            };
            return self.laws.iter().find(spoiled).map(|l| l.name.clone());
        }
        for f in &self.forcing {
            f.hook
                .apply(now, &mut LoadView::new(&mut self.bodies, f.body));
            if !finite(&self.bodies) {
                return Some(f.name.clone());
            }
        }
        for b in &self.boundary {
            b.hook
                .loads(now, &mut LoadView::new(&mut self.bodies, b.body));
            if !finite(&self.bodies) {
                return Some(b.name.clone());
            }
        }
        None
    }
}

/// A joint and what it connects.
pub(crate) struct Connection {
    pub(crate) name: String,
    pub(crate) joint: Box<dyn Joint>,
    pub(crate) sides: [(BodyId, Place); 2],
}

/// What one side of a joint adds to the loads: a force on a node and a torque on an element, both stations of a group.
pub(crate) struct Applied {
    pub(crate) group: usize,
    pub(crate) node: usize,
    pub(crate) element: usize,
    pub(crate) force: Vector3<f64>,
    pub(crate) torque: Vector3<f64>,
}

impl Connection {
    /// The joint's loads at the present poses.
    pub(crate) fn applied(&self, groups: &[Group], now: &Moment<'_>) -> [Applied; 2] {
        let bodies = self
            .sides
            .map(|(id, _)| Body::new(&groups[id.group].bodies, id.index));
        let [a, b] = [0, 1].map(|side| Site::of(&bodies[side], self.sides[side].1));
        let load = self.joint.load(now, &a, &b);
        let wrenches = [load.on_a, load.on_b];
        [0, 1].map(|side| {
            let (id, place) = self.sides[side];
            let (node, element, torque) = wrenches[side].at_station(&bodies[side], place);
            let first = groups[id.group].bodies.layouts[id.index].first;
            Applied {
                group: id.group,
                node: first + node,
                element: first + element,
                force: wrenches[side].force,
                torque,
            }
        })
    }

    /// Adds the joint's loads to both bodies.
    pub(crate) fn apply(&self, groups: &mut [Group], now: &Moment<'_>) {
        for load in self.applied(groups, now) {
            let bodies = &mut groups[load.group].bodies;
            bodies.force.add(load.node, load.force);
            bodies.torque.add(load.element, load.torque);
        }
    }
}

/// A simulation ran into something that isn't a number.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the simulation blew up at t = {time:.6} s, step {step}: {what} of body `{body}`, node {node}, is not finite{}",
    culprit.as_ref().map_or(String::new(), |c| format!("; the first loads that weren't came from {c}"))
)]
pub struct BlowUp {
    /// Time \[s\].
    pub time: f64,
    /// Steps taken.
    pub step: u64,
    /// Name of the body.
    pub body: String,
    /// Node or element, counted from the body's first.
    pub node: usize,
    /// Which quantity.
    pub what: &'static str,
    /// Hook to blame, if one is.
    pub culprit: Option<String>,
}

/// Bodies, hooks and inputs at a time: everything that a solver needs.
#[derive(Default)]
pub struct System {
    pub(crate) groups: Vec<Group>,
    pub(crate) joints: Vec<Connection>,
    pub(crate) inputs: Inputs,
    pub(crate) time: f64,
    steps: u64,
    ids: Vec<BodyId>,
}

impl System {
    /// An empty system whose hooks may read `inputs`.
    pub fn new(inputs: Inputs) -> Self {
        Self {
            inputs,
            ..Self::default()
        }
    }

    fn room(&mut self, stations: usize) -> usize {
        let full = self.groups.last().is_none_or(|g| {
            g.bodies.stations() > 0 && g.bodies.stations() + stations > GROUP_STATIONS
        });
        if full {
            self.groups.push(Group::default());
        }
        self.groups.len() - 1
    }

    /// Adds a rod at rest.
    pub fn add_rod(&mut self, rod: &Rod) -> Result<BodyId, String> {
        rod.check()?;
        let group = self.room(rod.elements() + 1);
        let index = self.groups[group].bodies.push_rod(rod);
        Ok(self.register(BodyId { group, index }))
    }

    /// Adds a rigid body at rest.
    pub fn add_cylinder(&mut self, cylinder: &Cylinder) -> Result<BodyId, String> {
        let sound = |v: f64| v > 0.0 && v.is_finite();
        if !sound(cylinder.mass) || !cylinder.inertia.iter().all(|i| sound(*i)) {
            return Err(format!(
                "a rigid body needs positive, finite mass and inertia, it has {} kg and {:?} kg m2",
                cylinder.mass,
                cylinder.inertia.as_slice()
            ));
        }
        let group = self.room(1);
        let index = self.groups[group].bodies.push_cylinder(cylinder);
        Ok(self.register(BodyId { group, index }))
    }

    fn register(&mut self, id: BodyId) -> BodyId {
        self.ids.push(id);
        id
    }

    /// Adds a rod law. The error says in words why it can't act on this body.
    pub fn add_law(&mut self, id: BodyId, name: &str, hook: Box<dyn RodLaw>) -> Result<(), String> {
        let body = self.body(id);
        if !body.is_rod() {
            return Err(format!("`{}` is rigid, a rod law needs a rod", body.name()));
        }
        hook.check(&self.setting(id))?;
        self.groups[id.group].laws.push(hooked(name, id, hook));
        Ok(())
    }

    /// Adds a forcing.
    pub fn add_forcing(
        &mut self,
        id: BodyId,
        name: &str,
        hook: Box<dyn Forcing>,
    ) -> Result<(), String> {
        hook.check(&self.setting(id))?;
        self.groups[id.group].forcing.push(hooked(name, id, hook));
        Ok(())
    }

    /// Adds a boundary condition, which remembers the present pose, and sets its values at the present time.
    pub fn add_boundary(
        &mut self,
        id: BodyId,
        name: &str,
        mut hook: Box<dyn BoundaryCondition>,
    ) -> Result<(), String> {
        hook.attach(&self.setting(id))?;
        self.groups[id.group].boundary.push(hooked(name, id, hook));
        Ok(())
    }

    /// Adds a damping.
    pub fn add_damping(
        &mut self,
        id: BodyId,
        name: &str,
        hook: Box<dyn Damping>,
    ) -> Result<(), String> {
        hook.check(&self.setting(id))?;
        self.groups[id.group].damping.push(hooked(name, id, hook));
        Ok(())
    }

    /// Adds a joint between two places, which remembers their present poses.
    pub fn add_joint(
        &mut self,
        name: &str,
        sides: [(BodyId, Place); 2],
        mut joint: Box<dyn Joint>,
    ) -> Result<(), String> {
        if sides[0].0 == sides[1].0 {
            return Err("a joint connects two different bodies".into());
        }
        let [a, b] = sides.map(|(id, place)| self.site(id, place));
        joint.attach(&a, &b)?;
        self.joints.push(Connection {
            name: name.into(),
            joint,
            sides,
        });
        Ok(())
    }

    fn setting(&self, id: BodyId) -> Setting<'_> {
        Setting {
            body: self.body(id),
            inputs: &self.inputs,
        }
    }

    /// The bodies in the order in which they were added.
    pub fn ids(&self) -> &[BodyId] {
        &self.ids
    }

    /// View of a body.
    pub fn body(&self, id: BodyId) -> Body<'_> {
        Body::new(&self.groups[id.group].bodies, id.index)
    }

    /// The body of this name.
    pub fn find(&self, name: &str) -> Option<BodyId> {
        self.ids
            .iter()
            .copied()
            .find(|id| self.body(*id).name() == name)
    }

    /// Pose and rates of a place.
    pub fn site(&self, id: BodyId, place: Place) -> Site {
        Site::of(&self.body(id), place)
    }

    /// Time \[s\].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Steps taken so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Stations of all bodies.
    pub fn stations(&self) -> usize {
        self.groups.iter().map(|g| g.bodies.stations()).sum()
    }

    /// Elements of all rods.
    pub fn elements(&self) -> usize {
        self.ids.iter().map(|id| self.body(*id).elements()).sum()
    }

    /// The inputs.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// A copy of the state, to return to with [`System::restore`].
    pub fn save(&self) -> Saved {
        Saved {
            time: self.time,
            steps: self.steps,
            states: self.groups.iter().map(|g| g.bodies.state.clone()).collect(),
        }
    }

    /// Returns to a state that this system has saved.
    pub fn restore(&mut self, saved: &Saved) {
        self.time = saved.time;
        self.steps = saved.steps;
        for (group, state) in self.groups.iter_mut().zip(&saved.states) {
            group.bodies.state.clone_from(state);
        }
    }

    /// Starts the clock at `time` \[s\] without moving anything.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
    }

    /// One step of position Verlet (Gazzola et al. 2018, section 3.2):
    /// 1. half a step of positions and frames, boundary values at the middle;
    /// 2. strains, rod laws, internal loads, forcing;
    /// 3. joints;
    /// 4. rates, damping, boundary rates;
    /// 5. half a step of positions and frames, boundary values at the end.
    pub fn step(&mut self, dt: f64) -> Result<(), BlowUp> {
        let Self {
            groups,
            joints,
            inputs,
            ..
        } = self;
        let middle = Moment {
            time: self.time + dt / 2.0,
            inputs,
        };
        let end = Moment {
            time: self.time + dt,
            inputs,
        };
        each(groups, |group| {
            group.bodies.drift(dt / 2.0);
            group.set_values(&middle);
            group.loads(&middle);
        });
        for joint in joints.iter() {
            joint.apply(groups, &middle);
        }
        each(groups, |group| {
            group.kick(&middle, dt);
            // Poses stay sound where rates aren't, so that the cause can be looked for.
            if group.bodies.rates_finite() {
                group.bodies.drift(dt / 2.0);
                group.set_values(&end);
            }
        });
        self.time += dt;
        self.steps += 1;
        if self.groups.iter().all(|g| g.bodies.rates_finite()) {
            Ok(())
        } else {
            Err(self.blow_up(dt))
        }
    }

    /// Forces and torques of the present state at the present time, joints included.
    pub fn evaluate(&mut self) {
        let now = Moment {
            time: self.time,
            inputs: &self.inputs,
        };
        each(&mut self.groups, |group| group.loads(&now));
        for joint in &self.joints {
            joint.apply(&mut self.groups, &now);
        }
    }

    /// Sets boundary values and rates of the present time.
    pub fn apply_boundaries(&mut self) {
        let now = Moment {
            time: self.time,
            inputs: &self.inputs,
        };
        for group in &mut self.groups {
            group.set_values(&now);
            group.set_rates(&now);
        }
    }

    #[cold]
    fn blow_up(&mut self, dt: f64) -> BlowUp {
        let (mut body, mut node, mut what) = (String::new(), 0, "velocity");
        'search: for id in &self.ids {
            let view = self.body(*id);
            for i in 0..view.nodes() {
                let omega_bad = i < view.directors() && !finite(view.omega(i));
                if !finite(view.velocity(i)) || omega_bad {
                    (body, node) = (view.name().to_owned(), i);
                    what = if omega_bad { "angular velocity" } else { what };
                    break 'search;
                }
            }
        }
        let middle = Moment {
            time: self.time - dt / 2.0,
            inputs: &self.inputs,
        };
        let culprit = self.groups.iter_mut().find_map(|g| g.culprit(&middle));
        let culprit = culprit.or_else(|| {
            let spoils = |joint: &&Connection| {
                let loads = joint.applied(&self.groups, &middle);
                !loads.iter().all(|l| finite(l.force) && finite(l.torque))
            };
            self.joints.iter().find(spoils).map(|j| j.name.clone())
        });
        BlowUp {
            time: self.time,
            step: self.steps,
            body,
            node,
            what,
            culprit,
        }
    }

    /// Kinetic energy \[J\] of all bodies.
    pub fn kinetic_energy(&self) -> f64 {
        self.ids
            .iter()
            .map(|id| {
                let body = self.body(*id);
                let moving: f64 = (0..body.nodes())
                    .map(|i| body.mass(i) * body.velocity(i).norm_squared())
                    .sum();
                let turning: f64 = (0..body.directors())
                    .map(|e| {
                        let omega = body.omega(e);
                        omega.component_mul(&body.inertia(e)).dot(&omega) / body.dilatation(e)
                    })
                    .sum();
                (moving + turning) / 2.0
            })
            .sum()
    }

    /// Elastic energy \[J\] of all linear elastic rods, at the last evaluation.
    pub fn elastic_energy(&self) -> f64 {
        self.groups
            .iter()
            .map(|group| {
                let b = &group.bodies;
                let mut energy = 0.0;
                for layout in b.layouts() {
                    for k in layout.element_stations() {
                        let strain = b.sigma.get(k) - b.rest_sigma.get(k);
                        energy += b.stress.get(k).dot(&strain) * b.rest_length[k] / 2.0;
                    }
                    for k in layout.cells() {
                        let strain = b.kappa.get(k) - b.rest_kappa.get(k);
                        energy += b.couple.get(k).dot(&strain) * b.rest_voronoi[k] / 2.0;
                    }
                }
                energy
            })
            .sum()
    }
}

/// Positions, frames, rates and time of a [`System`].
#[derive(Clone, Debug, PartialEq)]
pub struct Saved {
    time: f64,
    steps: u64,
    states: Vec<State>,
}

impl Saved {
    pub(crate) fn states(&self) -> &[State] {
        &self.states
    }
}

fn hooked<T: ?Sized>(name: &str, id: BodyId, hook: Box<T>) -> Hooked<T> {
    Hooked {
        name: name.into(),
        body: id.index,
        hook,
    }
}

fn finite(v: Vector3<f64>) -> bool {
    v.iter().all(|x| x.is_finite())
}

fn finite_at(vectors: &Vectors, k: usize) -> bool {
    finite(vectors.get(k))
}

/// Groups in parallel when there are several.
fn each(groups: &mut [Group], work: impl Fn(&mut Group) + Sync + Send) {
    match groups {
        [only] => work(only),
        many => many.par_iter_mut().for_each(work),
    }
}
