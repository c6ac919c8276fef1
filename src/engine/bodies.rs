//! Rods and rigid bodies stored together, one flat array a quantity.
//!
//! Every body owns a range of *stations*. Station `k` of a rod of `n` elements (there are `n + 1`) holds node `k`,
//! element `k` (between nodes `k` and `k + 1`; unused at the last station) and Voronoi cell `k` (between elements
//! `k - 1` and `k`; cells 0 and `n` exist only where a wall holds the end). A rigid body is one station without
//! elements: its node is the centre of mass.

use crate::cylinder::Cylinder;
use crate::rod::Rod;
use crate::vectors::{Matrices, Scalars, Vectors};
use nalgebra::{Matrix3, Vector3};

/// One end of a rod.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize, schemars::JsonSchema,
)]
pub enum End {
    /// At the first node.
    Start,
    /// At the last node.
    Tip,
}

/// How a boundary condition holds the frame of a rod's end.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    serde::Deserialize,
    serde::Serialize,
    schemars::JsonSchema,
)]
pub enum Cell {
    /// The end element is fixed, as in PyElastica; half of its length doesn't bend.
    #[default]
    Rigid,
    /// The end element turns against a wall over half of its length.
    Half,
}

/// A rigid end of a rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cap {
    /// Length \[m\].
    pub length: f64,
    /// Mass \[kg\].
    pub mass: f64,
}

/// Where a body lies in the arrays.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Unique name.
    pub name: String,
    /// First station.
    pub first: usize,
    /// Elements, 0 for a rigid body.
    pub elements: usize,
    /// Rigid ends.
    pub caps: [Cap; 2],
    /// Whether a wall holds the end through a half cell (see [`Bodies::walls`]).
    pub walled: [bool; 2],
}

impl Layout {
    /// Whether the body is a rod.
    #[inline]
    pub fn is_rod(&self) -> bool {
        self.elements > 0
    }

    /// Number of nodes (and of stations).
    #[inline]
    pub fn nodes(&self) -> usize {
        self.elements + 1
    }

    /// Number of frames: one an element, or the one of a rigid body.
    #[inline]
    pub fn directors(&self) -> usize {
        self.elements.max(1)
    }

    /// Stations whose Voronoi cell exists.
    #[inline]
    pub fn cells(&self) -> std::ops::Range<usize> {
        let first = if self.walled[0] { 0 } else { 1 };
        let past = self.elements + usize::from(self.walled[1]);
        self.first + first..(self.first + past).max(self.first + first)
    }

    /// Stations whose element exists.
    #[inline]
    pub fn element_stations(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.elements
    }
}

/// What a simulation is resumed from. All arrays have one entry a station.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Node positions and centres of mass, world frame \[m\].
    pub position: Vectors,
    /// Velocities, world frame \[m/s\].
    pub velocity: Vectors,
    /// Frames of elements and rigid bodies (rows are directors in the world frame).
    pub director: Matrices,
    /// Angular velocities, material frame \[rad/s\].
    pub omega: Vectors,
    /// What rod laws remember, each in a range of its own.
    pub memory: Vec<f64>,
}

impl State {
    /// Becomes the same as `other`, without allocating if it has its size.
    pub fn copy_from(&mut self, other: &Self) {
        self.pose_as(other);
        self.memory.clone_from(&other.memory);
    }

    /// Multiplies all rates.
    pub(crate) fn scale_rates(&mut self, by: f64) {
        self.velocity.scale(by);
        self.omega.scale(by);
    }

    /// Takes all rates away.
    pub(crate) fn stop(&mut self) {
        self.velocity.clear_to_zero();
        self.omega.clear_to_zero();
    }

    /// Takes positions, frames and rates of `other`, but not what its laws remember.
    pub(crate) fn pose_as(&mut self, other: &Self) {
        self.position.copy_from(&other.position);
        self.velocity.copy_from(&other.velocity);
        self.director.copy_from(&other.director);
        self.omega.copy_from(&other.omega);
    }
}

/// Bodies stored together: state, properties and workspace. All arrays have one entry a station.
#[derive(Clone, Debug, Default)]
pub struct Bodies {
    pub(crate) layouts: Vec<Layout>,
    pub(crate) state: State,
    /// Frames of the walls at start and tip of every body; read only where [`Layout::walled`] says so.
    pub(crate) walls: Vec<[Matrix3<f64>; 2]>,
    /// Whether laws have changed rigidities since they were as built.
    pub(crate) stiffened: bool,
    /// Whether laws have added to stresses or couples in the last evaluation.
    pub(crate) stressed: bool,
    /// The instructions that passes are compiled for.
    pub(crate) arch: pulp::Arch,
    /// 1 where the element exists, else 0.
    pub(crate) element: Scalars,
    /// 1 where the Voronoi cell exists, else 0.
    pub(crate) cell: Scalars,
    // as built
    pub(crate) mass: Scalars,
    pub(crate) inertia: Vectors,
    pub(crate) inverse_mass: Scalars,
    pub(crate) inverse_inertia: Vectors,
    pub(crate) reference_length: Scalars,
    pub(crate) built_shear_stretch: Vectors,
    pub(crate) built_bend_twist: Vectors,
    // what a rod law may change
    pub(crate) rest_length: Scalars,
    pub(crate) twist_length: Scalars,
    pub(crate) shear_stretch: Vectors,
    pub(crate) bend_twist: Vectors,
    pub(crate) rest_sigma: Vectors,
    pub(crate) rest_kappa: Vectors,
    // workspace of elements
    pub(crate) length: Scalars,
    pub(crate) tangent: Vectors,
    pub(crate) dilatation: Scalars,
    pub(crate) sigma: Vectors,
    pub(crate) stress: Vectors,
    // workspace of Voronoi cells
    pub(crate) rotation: Vectors,
    pub(crate) rest_voronoi: Scalars,
    pub(crate) voronoi_dilatation: Scalars,
    pub(crate) kappa: Vectors,
    pub(crate) couple: Vectors,
    // loads
    pub(crate) force: Vectors,
    pub(crate) torque: Vectors,
}

impl Bodies {
    /// Number of stations.
    #[inline]
    pub fn stations(&self) -> usize {
        self.mass.len()
    }

    /// Where the bodies lie.
    #[inline]
    pub fn layouts(&self) -> &[Layout] {
        &self.layouts
    }

    /// Positions, frames and rates.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Holds an end of body `b` by a wall.
    pub(crate) fn set_wall(&mut self, b: usize, end: End, director: Matrix3<f64>) {
        let layout = &mut self.layouts[b];
        layout.walled[end as usize] = true;
        self.walls[b][end as usize] = director;
        let cell = match end {
            End::Start => layout.first,
            End::Tip => layout.first + layout.elements,
        };
        self.cell[cell] = 1.0;
    }

    /// Adds a rod at rest and returns its index. The rod has passed [`Rod::check`].
    pub fn push_rod(&mut self, rod: &Rod) -> usize {
        let n = rod.elements();
        let element_length = rod.length / n as f64;
        let directors = Matrix3::from_rows(&[
            rod.normal.transpose(),
            rod.direction.cross(&rod.normal).transpose(),
            rod.direction.transpose(),
        ]);
        let caps = [0, n - 1].map(|e| rod.section(e));
        let caps = std::array::from_fn::<_, 2, _>(|end| Cap {
            length: rod.caps[end],
            mass: rod.density[if end == 0 { 0 } else { n - 1 }] * caps[end].area() * rod.caps[end],
        });
        let first = self.stations();
        for k in 0..=n {
            let (left, right) = (k.checked_sub(1), (k < n).then_some(k));
            let half_mass =
                |e: usize| rod.density[e] * rod.section(e).area() * element_length / 2.0;
            let mut mass: f64 = [left, right].into_iter().flatten().map(half_mass).sum();
            if k == 0 {
                mass += caps[0].mass;
            }
            if k == n {
                mass += caps[1].mass;
            }
            let inertia = right.map_or(Vector3::repeat(1.0), |e| {
                let per_length = rod.section(e).second_moment() * rod.density[e];
                let mut inertia = per_length * element_length;
                for (cap, at) in caps.iter().zip([0, n - 1]) {
                    if e == at {
                        let lever = cap.mass * cap.length.powi(2) / 3.0;
                        inertia += per_length * cap.length + Vector3::new(lever, lever, 0.0);
                    }
                }
                inertia
            });
            let bend_twist = match (left, right) {
                (Some(l), Some(r)) => (rod.bend_twist[l] + rod.bend_twist[r]) / 2.0,
                (l, r) => rod.bend_twist[l.or(r).unwrap_or(0)],
            };
            let whole_cell = left.is_some() && right.is_some();
            self.push_station(Station {
                position: rod.start + rod.direction * (element_length * k as f64),
                director: directors,
                element: right.is_some(),
                whole_cell,
                mass,
                inertia,
                length: element_length,
                cell: if whole_cell {
                    element_length
                } else {
                    element_length / 2.0
                },
                shear_stretch: right.map_or(Vector3::zeros(), |e| rod.shear_stretch[e]),
                bend_twist,
                rest_sigma: rod.rest_sigma,
                rest_kappa: rod.rest_kappa,
            });
        }
        self.push_layout(&rod.name, first, n, caps, directors)
    }

    /// Rest lengths and rigidities as built, for laws to start from.
    pub(crate) fn as_built(&mut self) {
        self.rest_length.copy_from(&self.reference_length);
        if std::mem::take(&mut self.stiffened) {
            self.shear_stretch.copy_from(&self.built_shear_stretch);
            self.bend_twist.copy_from(&self.built_bend_twist);
        }
    }

    /// Adds a rigid body at rest and returns its index.
    pub fn push_cylinder(&mut self, cylinder: &Cylinder) -> usize {
        let first = self.stations();
        self.push_station(Station {
            position: cylinder.centre,
            director: cylinder.director,
            element: false,
            whole_cell: false,
            mass: cylinder.mass,
            inertia: cylinder.inertia,
            length: 1.0,
            cell: 1.0,
            shear_stretch: Vector3::zeros(),
            bend_twist: Vector3::zeros(),
            rest_sigma: Vector3::zeros(),
            rest_kappa: Vector3::zeros(),
        });
        let caps = [Cap::default(); 2];
        self.push_layout(&cylinder.name, first, 0, caps, cylinder.director)
    }

    fn push_layout(
        &mut self,
        name: &str,
        first: usize,
        elements: usize,
        caps: [Cap; 2],
        rest: Matrix3<f64>,
    ) -> usize {
        self.layouts.push(Layout {
            name: name.into(),
            first,
            elements,
            caps,
            walled: [false; 2],
        });
        self.walls.push([rest; 2]);
        self.layouts.len() - 1
    }

    fn push_station(&mut self, s: Station) {
        let zero = Vector3::zeros();
        self.state.position.push(s.position);
        self.state.velocity.push(zero);
        self.state.director.push(s.director);
        self.state.omega.push(zero);
        self.element.push(f64::from(s.element));
        self.cell.push(f64::from(s.whole_cell));
        self.mass.push(s.mass);
        self.inertia.push(s.inertia);
        self.inverse_mass.push(1.0 / s.mass);
        self.inverse_inertia.push(s.inertia.map(|j| 1.0 / j));
        self.reference_length.push(s.length);
        self.rest_length.push(s.length);
        self.twist_length.push(s.cell);
        self.rest_voronoi.push(s.cell);
        self.built_shear_stretch.push(s.shear_stretch);
        self.shear_stretch.push(s.shear_stretch);
        self.built_bend_twist.push(s.bend_twist);
        self.bend_twist.push(s.bend_twist);
        self.rest_sigma.push(s.rest_sigma);
        self.rest_kappa.push(s.rest_kappa);
        self.length.push(s.length);
        self.dilatation.push(1.0);
        self.voronoi_dilatation.push(1.0);
        for zeroed in [
            &mut self.tangent,
            &mut self.sigma,
            &mut self.stress,
            &mut self.rotation,
            &mut self.kappa,
            &mut self.couple,
            &mut self.force,
            &mut self.torque,
        ] {
            zeroed.push(zero);
        }
    }
}

/// What one station is built from.
struct Station {
    position: Vector3<f64>,
    director: Matrix3<f64>,
    element: bool,
    whole_cell: bool,
    mass: f64,
    inertia: Vector3<f64>,
    length: f64,
    cell: f64,
    shear_stretch: Vector3<f64>,
    bend_twist: Vector3<f64>,
    rest_sigma: Vector3<f64>,
    rest_kappa: Vector3<f64>,
}
