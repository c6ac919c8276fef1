//! Bodies and hooks put together: what a solver works on.

use crate::bodies::State;
use crate::connection::Connection;
use crate::cylinder::Cylinder;
use crate::group::{BodyId, Group, Hooked, HookedLaw, each};
use crate::hooks::{BoundaryCondition, Damping, Forcing, Joint, RodLaw, Setting};
use crate::inputs::{Inputs, Moment};
use crate::rod::Rod;
use crate::site::{Place, Site};
use crate::view::{Body, ReadBody};

/// Stations that a group is filled to: large enough to be worth a thread, small enough for its cache. Fixed, so that
/// results don't depend on the number of threads.
const GROUP_STATIONS: usize = 512;

/// Bodies, hooks and inputs at a time: everything that a solver needs.
#[derive(Default)]
pub struct System {
    pub(crate) groups: Vec<Group>,
    pub(crate) joints: Vec<Connection>,
    pub(crate) inputs: Inputs,
    pub(crate) time: f64,
    pub(crate) steps: u64,
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
        let bodies = &mut self.groups[group].bodies;
        let index = bodies.push_rod(rod);
        // A copy of grown arrays has no room to spare, so that they lie one after the other.
        *bodies = bodies.clone();
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
        let count = hook.memory(&self.body(id));
        let group = &mut self.groups[id.group];
        let memory = &mut group.bodies.state.memory;
        let first = memory.len();
        memory.resize(first + count, 0.0);
        let place = if hook.in_series() {
            group.laws.len()
        } else {
            group.laws.partition_point(|l| !l.hook.in_series())
        };
        let hooked = HookedLaw {
            name: name.into(),
            body: id.index,
            hook,
            memory: (first, count),
        };
        group.laws.insert(place, hooked);
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
        joint.attach(&a, &b, &self.inputs)?;
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
            group.bodies.state.copy_from(state);
        }
    }

    /// Takes the poses, rates and time of a state that a system of the same bodies has saved, with what is held at its own
    /// boundary values of that time; what rod laws remember stays.
    pub(crate) fn pose_as(&mut self, saved: &Saved) {
        self.time = saved.time;
        for (group, state) in self.groups.iter_mut().zip(&saved.states) {
            group.bodies.state.pose_as(state);
        }
        self.apply_boundaries();
    }

    /// Starts the clock at `time` \[s\] without moving anything.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
    }

    /// Does without vector instructions that not every machine of this architecture has, as on a machine without them:
    /// slower, and to the same bits.
    pub fn use_baseline(&mut self) {
        for group in &mut self.groups {
            group.bodies.arch = pulp::Arch::Scalar;
        }
    }

    /// Forces and torques of the present state at the present time, joints included.
    pub fn evaluate(&mut self) {
        self.evaluate_by(Group::loads);
    }

    /// The same with other loads of bodies.
    pub(crate) fn evaluate_by(&mut self, loads: impl Fn(&mut Group, &Moment<'_>) + Send + Sync) {
        let now = Moment {
            time: self.time,
            inputs: &self.inputs,
        };
        each(&mut self.groups, |group| loads(group, &now));
        for joint in &self.joints {
            joint.apply(&mut self.groups, &now);
        }
    }

    /// Whether a rod law remembers states, so that it matters which are passed.
    #[must_use]
    pub fn remembers(&self) -> bool {
        self.groups
            .iter()
            .any(|g| !g.bodies.state.memory.is_empty())
    }

    /// What rod laws remember, a list for each group.
    pub(crate) fn memory(&self) -> Vec<Vec<f64>> {
        let memory = self.groups.iter().map(|g| g.bodies.state.memory.clone());
        memory.collect()
    }

    /// Exchanges what rod laws remember.
    pub(crate) fn swap_memory(&mut self, memory: &mut [Vec<f64>]) {
        for (group, memory) in self.groups.iter_mut().zip(memory) {
            std::mem::swap(&mut group.bodies.state.memory, memory);
        }
    }

    /// Lets rod laws remember the present state. Solvers do it for every state that they accept.
    pub(crate) fn remember(&mut self) {
        let now = Moment {
            time: self.time,
            inputs: &self.inputs,
        };
        for group in &mut self.groups {
            group.remember(&now);
        }
    }

    /// Sets boundary values and rates of the present time.
    pub fn apply_boundaries(&mut self) {
        self.set_values();
        self.set_rates();
    }

    /// Sets boundary values of the present time.
    pub(crate) fn set_values(&mut self) {
        let now = Moment {
            time: self.time,
            inputs: &self.inputs,
        };
        for group in &mut self.groups {
            group.set_values(&now);
        }
    }

    /// Sets boundary rates of the present time.
    pub(crate) fn set_rates(&mut self) {
        let now = Moment {
            time: self.time,
            inputs: &self.inputs,
        };
        for group in &mut self.groups {
            group.set_rates(&now);
        }
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
