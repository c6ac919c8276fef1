//! The one view that plugins have of a body, whatever the storage.
//!
//! [`Body`] reads. [`LawView`], [`LoadView`], [`PoseView`] and [`RateView`] read as well, and write what their hook is
//! for. Indices count from the body's own first node, element or cell. A rigid body has one node (its centre of mass)
//! and one frame, so that a loop over nodes or frames serves rods and rigid bodies alike.

use crate::bodies::{Bodies, Cap, End, Layout};
use crate::site::{Place, Wrench};
use nalgebra::{Matrix3, Vector3};

/// Read access to a body's arrays.
pub trait ReadBody {
    /// The arrays that the body lies in.
    #[doc(hidden)]
    fn bodies(&self) -> &Bodies;
    /// Index of the body in the arrays.
    #[doc(hidden)]
    fn index(&self) -> usize;

    #[doc(hidden)]
    #[inline]
    fn layout(&self) -> &Layout {
        &self.bodies().layouts[self.index()]
    }
    #[doc(hidden)]
    #[inline]
    fn at(&self, i: usize) -> usize {
        self.layout().first + i
    }

    /// Name in the scenario.
    #[inline]
    fn name(&self) -> &str {
        &self.layout().name
    }
    /// Whether the body is a rod (else it is rigid).
    #[inline]
    fn is_rod(&self) -> bool {
        self.layout().is_rod()
    }
    /// Number of elements, 0 for a rigid body.
    #[inline]
    fn elements(&self) -> usize {
        self.layout().elements
    }
    /// Number of nodes: elements + 1.
    #[inline]
    fn nodes(&self) -> usize {
        self.layout().nodes()
    }
    /// Number of frames: one an element, or the one of a rigid body.
    #[inline]
    fn directors(&self) -> usize {
        self.layout().directors()
    }
    /// Indices of the Voronoi cells that exist: `1..elements`, and 0 or `elements` where a wall holds the end.
    /// Cell `v` lies between elements `v - 1` and `v`.
    #[inline]
    fn cells(&self) -> std::ops::Range<usize> {
        let (cells, first) = (self.layout().cells(), self.layout().first);
        cells.start - first..cells.end - first
    }
    /// The rigid end at `end`.
    #[inline]
    fn cap(&self, end: End) -> Cap {
        self.layout().caps[end as usize]
    }

    /// Position of node `i`, world frame \[m\].
    #[inline]
    fn position(&self, i: usize) -> Vector3<f64> {
        self.bodies().state.position.get(self.at(i))
    }
    /// Velocity of node `i`, world frame \[m/s\].
    #[inline]
    fn velocity(&self, i: usize) -> Vector3<f64> {
        self.bodies().state.velocity.get(self.at(i))
    }
    /// Frame of element `e`: rows are `d1, d2, d3` in the world frame.
    #[inline]
    fn director(&self, e: usize) -> Matrix3<f64> {
        self.bodies().state.director.get(self.at(e))
    }
    /// Angular velocity of element `e`, material frame \[rad/s\].
    #[inline]
    fn omega(&self, e: usize) -> Vector3<f64> {
        self.bodies().state.omega.get(self.at(e))
    }
    /// Mass of node `i`, rigid ends included \[kg\].
    #[inline]
    fn mass(&self, i: usize) -> f64 {
        self.bodies().mass[self.at(i)]
    }
    /// Moments of inertia of element `e` about its directors, rigid ends included \[kg m2\].
    #[inline]
    fn inertia(&self, e: usize) -> Vector3<f64> {
        self.bodies().inertia.get(self.at(e))
    }
    /// Present length of element `e` \[m\].
    #[inline]
    fn length(&self, e: usize) -> f64 {
        self.bodies().length[self.at(e)]
    }
    /// Length of element `e` as built \[m\].
    #[inline]
    fn reference_length(&self, e: usize) -> f64 {
        self.bodies().reference_length[self.at(e)]
    }
    /// Rest length of element `e`: as built unless a rod law sets it \[m\].
    #[inline]
    fn rest_length(&self, e: usize) -> f64 {
        self.bodies().rest_length[self.at(e)]
    }
    /// Dilatation of element `e`: present over rest length \[-\].
    #[inline]
    fn dilatation(&self, e: usize) -> f64 {
        self.bodies().dilatation[self.at(e)]
    }
    /// Unit tangent of element `e`, world frame.
    #[inline]
    fn tangent(&self, e: usize) -> Vector3<f64> {
        self.bodies().tangent.get(self.at(e))
    }
    /// Shear and stretch strains of element `e`, material frame \[-\].
    #[inline]
    fn sigma(&self, e: usize) -> Vector3<f64> {
        self.bodies().sigma.get(self.at(e))
    }
    /// Internal force of element `e` (before division by the dilatation), material frame \[N\].
    #[inline]
    fn stress(&self, e: usize) -> Vector3<f64> {
        self.bodies().stress.get(self.at(e))
    }
    /// Curvatures and twist of cell `v`, material frame \[rad/m\].
    #[inline]
    fn kappa(&self, v: usize) -> Vector3<f64> {
        self.bodies().kappa.get(self.at(v))
    }
    /// Rotation vector across cell `v`, material frame \[rad\].
    #[inline]
    fn rotation(&self, v: usize) -> Vector3<f64> {
        self.bodies().rotation.get(self.at(v))
    }
    /// Internal couple of cell `v`, material frame \[N m\].
    #[inline]
    fn couple(&self, v: usize) -> Vector3<f64> {
        self.bodies().couple.get(self.at(v))
    }
    /// Rest length of cell `v` \[m\].
    #[inline]
    fn rest_voronoi(&self, v: usize) -> f64 {
        self.bodies().rest_voronoi[self.at(v)]
    }
    /// Dilatation of cell `v`: present over rest length \[-\].
    #[inline]
    fn voronoi_dilatation(&self, v: usize) -> f64 {
        self.bodies().voronoi_dilatation[self.at(v)]
    }
    /// Length that the twist of cell `v` is referred to \[m\]: as built unless a rod law sets it.
    #[inline]
    fn twist_length(&self, v: usize) -> f64 {
        self.bodies().twist_length[self.at(v)]
    }
    /// Twist of cell `v` \[rad/m\], from the present frames; right also inside [`RodLaw::rest`](crate::RodLaw::rest).
    #[inline]
    fn twist(&self, v: usize) -> f64 {
        self.rotation(v).z / self.twist_length(v)
    }
    /// Rigidities of element `e` as built: shear, shear, axial \[N\].
    #[inline]
    fn built_shear_stretch(&self, e: usize) -> Vector3<f64> {
        self.bodies().built_shear_stretch.get(self.at(e))
    }
    /// Rigidities of cell `v` as built: bending, bending, twist \[N m2\].
    #[inline]
    fn built_bend_twist(&self, v: usize) -> Vector3<f64> {
        self.bodies().built_bend_twist.get(self.at(v))
    }
    /// Total force on node `i` in the last evaluation, world frame \[N\].
    #[inline]
    fn force(&self, i: usize) -> Vector3<f64> {
        self.bodies().force.get(self.at(i))
    }
    /// Total torque on element `e` in the last evaluation, material frame \[N m\].
    #[inline]
    fn torque(&self, e: usize) -> Vector3<f64> {
        self.bodies().torque.get(self.at(e))
    }
}

/// Read-only view of a body.
#[derive(Clone, Copy)]
pub struct Body<'a> {
    bodies: &'a Bodies,
    index: usize,
}

impl<'a> Body<'a> {
    /// View of body `index` of `bodies`.
    #[inline]
    pub fn new(bodies: &'a Bodies, index: usize) -> Self {
        Self { bodies, index }
    }
}

impl ReadBody for Body<'_> {
    #[inline]
    fn bodies(&self) -> &Bodies {
        self.bodies
    }
    #[inline]
    fn index(&self) -> usize {
        self.index
    }
}

macro_rules! writing_view {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        pub struct $name<'a> {
            bodies: &'a mut Bodies,
            index: usize,
        }

        impl<'a> $name<'a> {
            #[inline]
            pub(crate) fn new(bodies: &'a mut Bodies, index: usize) -> Self {
                Self { bodies, index }
            }
        }

        impl ReadBody for $name<'_> {
            #[inline]
            fn bodies(&self) -> &Bodies {
                self.bodies
            }
            #[inline]
            fn index(&self) -> usize {
                self.index
            }
        }
    };
}

/// What a rod law sees and sets.
pub struct LawView<'a> {
    bodies: &'a mut Bodies,
    index: usize,
    /// First number and count of what the law remembers.
    memory: (usize, usize),
}

impl<'a> LawView<'a> {
    #[inline]
    pub(crate) fn new(bodies: &'a mut Bodies, index: usize, memory: (usize, usize)) -> Self {
        Self {
            bodies,
            index,
            memory,
        }
    }

    /// What the law remembers of this rod.
    #[inline]
    pub fn memory(&self) -> &[f64] {
        let (first, count) = self.memory;
        &self.bodies.state.memory[first..first + count]
    }

    /// What the law remembers, to be changed in [`RodLaw::remember`](crate::RodLaw::remember) only.
    #[inline]
    pub fn memory_mut(&mut self) -> &mut [f64] {
        let (first, count) = self.memory;
        &mut self.bodies.state.memory[first..first + count]
    }
}

impl ReadBody for LawView<'_> {
    #[inline]
    fn bodies(&self) -> &Bodies {
        self.bodies
    }
    #[inline]
    fn index(&self) -> usize {
        self.index
    }
}

writing_view! {
    /// What a forcing sees and adds to.
    LoadView
}
writing_view! {
    /// What a boundary condition sees and sets of positions and frames.
    PoseView
}
writing_view! {
    /// What a boundary condition or damping sees and sets of velocities.
    RateView
}

/// Lengths and twists of a rod as slices, for loops that must be fast.
pub struct LengthSlices<'a> {
    /// Rest lengths of elements \[m\].
    pub rest_length: &'a mut [f64],
    /// Lengths of elements as built \[m\].
    pub reference_length: &'a [f64],
    /// Rotations about d3 across cells, one a node; 0 where there is no cell \[rad\].
    pub turn: &'a [f64],
    /// Lengths that the twists of cells are referred to, one a node \[m\].
    pub twist_length: &'a [f64],
}

impl LawView<'_> {
    /// Lengths and twists at once, for loops over the whole rod.
    #[inline]
    pub fn length_slices(&mut self) -> LengthSlices<'_> {
        let layout = &self.bodies.layouts[self.index];
        let (elements, nodes) = (
            layout.element_stations(),
            layout.first..layout.first + layout.nodes(),
        );
        LengthSlices {
            rest_length: &mut self.bodies.rest_length.as_mut_slice()[elements.clone()],
            reference_length: &self.bodies.reference_length.as_slice()[elements],
            turn: self.bodies.rotation.slices(nodes.clone())[2],
            twist_length: &self.bodies.twist_length.as_slice()[nodes],
        }
    }
    /// Present rigidities of element `e`, as the laws before have left them: shear, shear, axial \[N\].
    #[inline]
    pub fn shear_stretch(&self, e: usize) -> Vector3<f64> {
        self.bodies.shear_stretch.get(self.at(e))
    }
    /// Present rigidities of cell `v`, as the laws before have left them: bending, bending, twist \[N m2\].
    #[inline]
    pub fn bend_twist(&self, v: usize) -> Vector3<f64> {
        self.bodies.bend_twist.get(self.at(v))
    }
    /// Sets the rest length of element `e` \[m\].
    #[inline]
    pub fn set_rest_length(&mut self, e: usize, length: f64) {
        let k = self.at(e);
        self.bodies.rest_length[k] = length;
    }
    /// Sets the length that the twist of cell `v` is referred to \[m\].
    #[inline]
    pub fn set_twist_length(&mut self, v: usize, length: f64) {
        let k = self.at(v);
        self.bodies.twist_length[k] = length;
    }
    /// Sets the rigidities of element `e`: shear, shear, axial \[N\].
    #[inline]
    pub fn set_shear_stretch(&mut self, e: usize, rigidity: Vector3<f64>) {
        let k = self.at(e);
        self.bodies.stiffened = true;
        self.bodies.shear_stretch.set(k, rigidity);
    }
    /// Sets the rigidities of cell `v`: bending, bending, twist \[N m2\].
    #[inline]
    pub fn set_bend_twist(&mut self, v: usize, rigidity: Vector3<f64>) {
        let k = self.at(v);
        self.bodies.stiffened = true;
        self.bodies.bend_twist.set(k, rigidity);
    }
    /// Sets the intrinsic shear and stretch strains of element `e` \[-\].
    #[inline]
    pub fn set_rest_sigma(&mut self, e: usize, sigma: Vector3<f64>) {
        let k = self.at(e);
        self.bodies.rest_sigma.set(k, sigma);
    }
    /// Sets the intrinsic curvatures and twist of cell `v` \[rad/m\].
    #[inline]
    pub fn set_rest_kappa(&mut self, v: usize, kappa: Vector3<f64>) {
        let k = self.at(v);
        self.bodies.rest_kappa.set(k, kappa);
    }
    /// Adds to the internal force of element `e`, material frame \[N\].
    #[inline]
    pub fn add_stress(&mut self, e: usize, stress: Vector3<f64>) {
        let k = self.at(e);
        self.bodies.stressed = true;
        self.bodies.stress.add(k, stress);
    }
    /// Adds to the internal couple of cell `v`, material frame \[N m\].
    #[inline]
    pub fn add_couple(&mut self, v: usize, couple: Vector3<f64>) {
        let k = self.at(v);
        self.bodies.stressed = true;
        self.bodies.couple.add(k, couple);
    }
}

impl LoadView<'_> {
    /// The body, for what only reads.
    #[inline]
    pub fn read(&self) -> Body<'_> {
        Body::new(self.bodies, self.index)
    }
    /// Adds a force and a torque at a place of the body.
    #[inline]
    pub fn add_wrench(&mut self, place: Place, wrench: &Wrench) {
        let (node, element, torque) = wrench.at_station(&self.read(), place);
        self.add_force(node, wrench.force);
        self.add_torque(element, torque);
    }
    /// Adds a force on node `i`, world frame \[N\].
    #[inline]
    pub fn add_force(&mut self, i: usize, force: Vector3<f64>) {
        let k = self.at(i);
        self.bodies.force.add(k, force);
    }
    /// Adds a torque on element `e`, material frame \[N m\].
    #[inline]
    pub fn add_torque(&mut self, e: usize, torque: Vector3<f64>) {
        let k = self.at(e);
        self.bodies.torque.add(k, torque);
    }
}

impl PoseView<'_> {
    /// Sets the position of node `i`, world frame \[m\].
    #[inline]
    pub fn set_position(&mut self, i: usize, position: Vector3<f64>) {
        let k = self.at(i);
        self.bodies.state.position.set(k, position);
    }
    /// Sets the frame of element `e` (rows are directors in the world frame).
    #[inline]
    pub fn set_director(&mut self, e: usize, director: Matrix3<f64>) {
        let k = self.at(e);
        self.bodies.state.director.set(k, director);
    }
    /// Holds `end` of a rod by a wall of frame `director`: the end element turns against it over half an element's
    /// length, which makes a clamp second order. Once set, the wall stays.
    #[inline]
    pub fn set_wall(&mut self, end: End, director: Matrix3<f64>) {
        self.bodies.set_wall(self.index, end, director);
    }
}

/// Rates of a body, and what they decay by, as slices for loops that must be fast: one an axis or director, as long as
/// there are nodes (velocities, masses) or frames (all else).
pub struct RateSlices<'a> {
    /// Velocities, world frame \[m/s\].
    pub velocity: [&'a mut [f64]; 3],
    /// Angular velocities, material frame \[rad/s\].
    pub omega: [&'a mut [f64]; 3],
    /// Masses of nodes, rigid ends included \[kg\].
    pub mass: &'a [f64],
    /// Moments of inertia about the directors, rigid ends included \[kg m2\].
    pub inertia: [&'a [f64]; 3],
    /// One over them \[1/(kg m2)\].
    pub inverse_inertia: [&'a [f64]; 3],
    /// Dilatations \[-\], 1 for a rigid body.
    pub dilatation: &'a [f64],
    /// What dispatches a loop over these to its version for the machine's vector instructions.
    pub arch: pulp::Arch,
}

impl RateView<'_> {
    /// Everything at once, for loops over whole bodies.
    #[inline]
    pub fn slices(&mut self) -> RateSlices<'_> {
        let layout = &self.bodies.layouts[self.index];
        let nodes = layout.first..layout.first + layout.nodes();
        let frames = layout.first..layout.first + layout.directors();
        RateSlices {
            velocity: self.bodies.state.velocity.slices_mut(nodes.clone()),
            omega: self.bodies.state.omega.slices_mut(frames.clone()),
            mass: &self.bodies.mass.as_slice()[nodes],
            inertia: self.bodies.inertia.slices(frames.clone()),
            inverse_inertia: self.bodies.inverse_inertia.slices(frames.clone()),
            dilatation: &self.bodies.dilatation.as_slice()[frames],
            arch: self.bodies.arch,
        }
    }

    /// Sets the velocity of node `i`, world frame \[m/s\].
    #[inline]
    pub fn set_velocity(&mut self, i: usize, velocity: Vector3<f64>) {
        let k = self.at(i);
        self.bodies.state.velocity.set(k, velocity);
    }
    /// Sets the angular velocity of element `e`, material frame \[rad/s\].
    #[inline]
    pub fn set_omega(&mut self, e: usize, omega: Vector3<f64>) {
        let k = self.at(e);
        self.bodies.state.omega.set(k, omega);
    }
}
