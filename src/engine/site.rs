//! Places where bodies are joined or observed.

use crate::bodies::End;
use crate::rotation::{to_material, to_world};
use crate::view::{Body, ReadBody};
use nalgebra::{Matrix3, Vector3};

/// Where on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// End of a rod, at the far end of its rigid cap. On a rigid body: its centre of mass.
    End(End),
    /// Node of a rod, with the frame of the element after it (before it at the last).
    Node(usize),
}

/// Pose and rates of a place on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Position, world frame \[m\].
    pub position: Vector3<f64>,
    /// Velocity, world frame \[m/s\].
    pub velocity: Vector3<f64>,
    /// Frame: rows are directors in the world frame.
    pub director: Matrix3<f64>,
    /// Angular velocity, material frame \[rad/s\].
    pub omega: Vector3<f64>,
}

/// Force and torque on one body at a site.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force at the site, world frame \[N\].
    pub force: Vector3<f64>,
    /// Torque about the site, material frame \[N m\].
    pub torque: Vector3<f64>,
}

/// What a joint does to its two sides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointLoad {
    /// On the first side.
    pub on_a: Wrench,
    /// On the second side.
    pub on_b: Wrench,
}

/// Node and element of `place` (relative to the body), and the vector from node to site in material components.
#[inline(always)]
fn resolve(body: &Body<'_>, place: Place) -> (usize, usize, Vector3<f64>) {
    let last = body.elements();
    match place {
        Place::End(_) if last == 0 => (0, 0, Vector3::zeros()),
        Place::End(End::Start) => (0, 0, -Vector3::z() * body.cap(End::Start).length),
        Place::End(End::Tip) => (last, last - 1, Vector3::z() * body.cap(End::Tip).length),
        Place::Node(i) => (i, i.min(last.saturating_sub(1)), Vector3::zeros()),
    }
}

impl Site {
    /// The site at `place` on `body`.
    #[inline]
    pub fn of(body: &Body<'_>, place: Place) -> Self {
        let (node, element, lever) = resolve(body, place);
        let director = body.director(element);
        let omega = body.omega(element);
        Self {
            position: body.position(node) + to_world(&director, &lever),
            velocity: body.velocity(node) + to_world(&director, &omega.cross(&lever)),
            director,
            omega,
        }
    }
}

impl Wrench {
    /// The node and the element (relative to the body) that the wrench at `place` acts on, and its torque about that
    /// node, material frame \[N m\].
    #[inline]
    pub(crate) fn at_station(&self, body: &Body<'_>, place: Place) -> (usize, usize, Vector3<f64>) {
        let (node, element, lever) = resolve(body, place);
        let torque = self.torque + lever.cross(&to_material(&body.director(element), &self.force));
        (node, element, torque)
    }
}
