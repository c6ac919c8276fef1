//! What sets the stability limit: the part of the model that is strained most in the mode that grows first.

use crate::inputs::Moment;
use crate::rotation;
use crate::stability::{displace, follow, mean_element_length};
use crate::system::{Saved, System};
use crate::view::{Body, ReadBody};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Time steps \[of the limit\] at which the mode is looked for: far enough beyond it for the mode to stand out.
const BEYOND: f64 = 1.05;

/// The part of a model whose stiffness bounds the time step.
#[derive(Clone, Debug, PartialEq)]
pub struct Critical {
    /// `stretch`, `shear`, `bending` or `twist` of rods, or the name of a joint.
    pub what: String,
    /// The body that has most of it.
    pub body: String,
    /// Its share of the elastic work in the critical mode, over all bodies.
    pub share: f64,
}

/// What sets the stability limit of `limit` \[s\] about the present state, if that stands out; the system is left as
/// it was. The mode is that of the power iteration on the step; each part's share is its elastic work in it, the
/// change in its load times the change in its strain.
pub fn critical(system: &mut System, limit: f64) -> Option<Critical> {
    let dt = BEYOND * limit;
    let (_, mut mode) = follow(system, dt)?;
    // rates would add the work of dampers
    for station in mode.chunks_exact_mut(12) {
        station[3..6].fill(0.0);
        station[9..12].fill(0.0);
    }
    let start = system.save();
    let scale = mean_element_length(system);
    let before = parts(system, &start);
    displace(system, &mode, scale, dt);
    let after = parts(system, &start);
    system.restore(&start);
    let mut works: BTreeMap<&str, BTreeMap<&str, f64>> = BTreeMap::new();
    for (a, b) in before.iter().zip(&after) {
        let bodies = works.entry(&a.what).or_default();
        *bodies.entry(&a.body).or_default() += (b.load - a.load).dot(&(b.strain - a.strain));
    }
    let sum = |bodies: &BTreeMap<&str, f64>| bodies.values().sum::<f64>();
    let total: f64 = works.values().map(sum).sum();
    let (what, bodies) = works.iter().max_by(|a, b| sum(a.1).total_cmp(&sum(b.1)))?;
    let (body, _) = bodies.iter().max_by(|a, b| a.1.total_cmp(b.1))?;
    let share = sum(bodies) / total;
    share.is_finite().then(|| Critical {
        what: (*what).to_owned(),
        body: (*body).to_owned(),
        share,
    })
}

/// A load, and the strain or displacement that it does elastic work on.
struct Part {
    what: String,
    body: String,
    load: Vector3<f64>,
    strain: Vector3<f64>,
}

/// Every elastic load of the present poses, always in the same order; rotations count from `start`.
fn parts(system: &mut System, start: &Saved) -> Vec<Part> {
    system.evaluate();
    let bodies = system.ids().iter().map(|id| system.body(*id));
    let mut parts: Vec<Part> = bodies.flat_map(|body| of_rod(&body)).collect();
    let now = Moment {
        time: system.time,
        inputs: &system.inputs,
    };
    for joint in &system.joints {
        let body = system.body(joint.sides[0].0);
        for side in joint.applied(&system.groups, &now) {
            let state = &system.groups[side.group].bodies.state;
            let from = start.states()[side.group].director.get(side.element);
            let turn = rotation::between(&from, &state.director.get(side.element));
            // what is stored in a joint is what it doesn't do on the bodies
            let part = |load: Vector3<f64>, strain| Part {
                what: joint.name.clone(),
                body: body.name().to_owned(),
                load: -load,
                strain,
            };
            parts.push(part(side.force, state.position.get(side.node)));
            parts.push(part(side.torque, turn));
        }
    }
    parts
}

fn of_rod(body: &Body<'_>) -> Vec<Part> {
    let part = |what: &str, load: Vector3<f64>, strain: Vector3<f64>| Part {
        what: what.to_owned(),
        body: body.name().to_owned(),
        load,
        strain,
    };
    let across = |v: Vector3<f64>| Vector3::new(v.x, v.y, 0.0);
    let along = |v: Vector3<f64>| Vector3::new(0.0, 0.0, v.z);
    let mut parts = Vec::new();
    for e in 0..body.elements() {
        let (load, strain) = (body.stress(e) * body.rest_length(e), body.sigma(e));
        parts.push(part("shear", across(load), across(strain)));
        parts.push(part("stretch", along(load), along(strain)));
    }
    for v in body.cells() {
        let (load, strain) = (body.couple(v) * body.rest_voronoi(v), body.kappa(v));
        parts.push(part("bending", across(load), across(strain)));
        parts.push(part("twist", along(load), along(strain)));
    }
    parts
}
