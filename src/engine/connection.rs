//! Joints between bodies.

use crate::group::{BodyId, Group};
use crate::hooks::Joint;
use crate::inputs::Moment;
use crate::site::{Place, Site};
use crate::view::Body;
use nalgebra::Vector3;

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
