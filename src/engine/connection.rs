//! Joints between bodies.

use crate::group::{BodyId, Group};
use crate::hooks::Joint;
use crate::inputs::Moment;
use crate::site::{Place, Site, Wrench};
use crate::view::{Body, ReadBody};
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

#[inline(always)]
fn applied(group: usize, body: &Body<'_>, place: Place, wrench: &Wrench) -> Applied {
    let (node, element, torque) = wrench.at_station(body, place);
    Applied {
        group,
        node: body.at(node),
        element: body.at(element),
        force: wrench.force,
        torque,
    }
}

impl Connection {
    /// The joint's loads at the present poses.
    pub(crate) fn applied(&self, groups: &[Group], now: &Moment<'_>) -> [Applied; 2] {
        let body = |id: BodyId| Body::new(&groups[id.group].bodies, id.index);
        let [(a, place_a), (b, place_b)] = self.sides;
        let (body_a, body_b) = (body(a), body(b));
        let (site_a, site_b) = (Site::of(&body_a, place_a), Site::of(&body_b, place_b));
        let load = self.joint.load(now, &site_a, &site_b);
        [
            applied(a.group, &body_a, place_a, &load.on_a),
            applied(b.group, &body_b, place_b, &load.on_b),
        ]
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
