//! Why a steady state can't be found, in words.

use super::tangent::Tangent;
use super::unknowns::{Freedom, PER_STATION, Unknowns};
use crate::bodies::Layout;
use crate::system::System;
use crate::view::ReadBody;
use nalgebra::{Matrix6, SymmetricEigen, Vector3, Vector6};

/// Resistance to a rigid motion, as a share of the largest stiffness, that counts as none: above what differences
/// leave of zero, below what any sound support gives.
const NONE: f64 = 1e-5;

/// A body, or bodies that joints connect: their stations and names.
struct Set {
    stations: Vec<usize>,
    names: Vec<String>,
}

/// Which bodies nothing keeps from moving as if rigid, at the state that the tangent was filled at.
pub(super) fn unheld(
    system: &System,
    unknowns: &Unknowns,
    freedom: &Freedom,
    tangent: &Tangent,
) -> Option<String> {
    let found = sets(system, unknowns).into_iter().find_map(|set| {
        let motion = free_motion(system, unknowns, freedom, tangent, &set.stations)?;
        Some((set, motion))
    });
    let (set, motion) = found?;
    let names: Vec<String> = set.names.iter().map(|n| format!("`{n}`")).collect();
    let is = if names.len() == 1 { "is" } else { "are" };
    Some(format!(
        "{} {is} free to {motion}; hold it with a boundary condition or a joint",
        names.join(", ")
    ))
}

/// What is connected by joints first, then every single body of that.
fn sets(system: &System, unknowns: &Unknowns) -> Vec<Set> {
    let ids = system.ids();
    let mut label: Vec<usize> = (0..ids.len()).collect();
    for joint in &system.joints {
        let of = |side: usize| ids.iter().position(|id| *id == joint.sides[side].0);
        if let (Some(a), Some(b)) = (of(0), of(1)) {
            let (from, to) = (label[a], label[b]);
            label
                .iter_mut()
                .filter(|l| **l == from)
                .for_each(|l| *l = to);
        }
    }
    let set = |members: &[usize]| {
        let bodies = members.iter().map(|i| system.body(ids[*i]));
        Set {
            names: bodies.map(|b| b.name().to_owned()).collect(),
            stations: (members.iter())
                .flat_map(|i| {
                    let layout = layout(system, *i);
                    let first = unknowns.global(ids[*i].group, layout.first);
                    first..first + layout.nodes()
                })
                .collect(),
        }
    };
    let mut sets = Vec::new();
    for l in 0..ids.len() {
        let members: Vec<usize> = (0..ids.len()).filter(|i| label[*i] == l).collect();
        if members.len() > 1 {
            sets.push(set(&members));
        }
    }
    sets.extend((0..ids.len()).map(|i| set(&[i])));
    sets
}

fn layout(system: &System, body: usize) -> &Layout {
    let id = system.ids()[body];
    &system.groups[id.group].bodies.layouts()[id.index]
}

/// The rigid motion of these stations that meets least resistance, in words, if that is none.
fn free_motion(
    system: &System,
    unknowns: &Unknowns,
    freedom: &Freedom,
    tangent: &Tangent,
    stations: &[usize],
) -> Option<String> {
    let position = |station: usize| {
        let (group, k) = unknowns.locate(station);
        system.groups[group].bodies.state.position.get(k)
    };
    let count = stations.len() as f64;
    let centre = stations.iter().map(|s| position(*s)).sum::<Vector3<f64>>() / count;
    let mut motions = Vec::new();
    for j in 0..PER_STATION {
        let unit = Vector6::ith(j, 1.0);
        let (shift, turn): (Vector3<f64>, Vector3<f64>) = (
            unit.fixed_rows::<3>(0).into(),
            unit.fixed_rows::<3>(3).into(),
        );
        let mut motion = vec![0.0; unknowns.stations * PER_STATION];
        for &station in stations {
            let (group, k) = unknowns.locate(station);
            let bodies = &system.groups[group].bodies;
            let moved = shift + turn.cross(&(position(station) - centre)) / unknowns.scale;
            let at = station * PER_STATION;
            motion[at..at + 3].copy_from_slice(moved.as_slice());
            if unknowns.has_frame(station) {
                let turned = bodies.state.director.get(k) * turn;
                motion[at + 3..at + 6].copy_from_slice(turned.as_slice());
            }
        }
        let norm = motion.iter().map(|v| v * v).sum::<f64>().sqrt();
        motion.iter_mut().for_each(|v| *v /= norm);
        motions.push(motion);
    }
    let stiffness = tangent.largest(stations);
    let resisted: Vec<Vec<f64>> = (motions.iter())
        .map(|m| tangent.times(freedom, m, stiffness))
        .collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let gram = Matrix6::from_fn(|i, j| dot(&resisted[i], &resisted[j]));
    if !gram.iter().all(|v| v.is_finite()) {
        return None;
    }
    let modes = SymmetricEigen::new(gram);
    let least = modes.eigenvalues.imin();
    if modes.eigenvalues[least].max(0.0).sqrt() > NONE * stiffness {
        return None;
    }
    let mode = modes.eigenvectors.column(least);
    let (shift, turn): (Vector3<f64>, Vector3<f64>) = (
        mode.fixed_rows::<3>(0).into(),
        mode.fixed_rows::<3>(3).into(),
    );
    let (verb, axis) = if shift.norm() > turn.norm() {
        ("move along", shift.normalize())
    } else {
        ("turn about", turn.normalize())
    };
    Some(format!(
        "{verb} ({:.2}, {:.2}, {:.2})",
        axis.x, axis.y, axis.z
    ))
}

/// Where the loads near the present poses aren't finite numbers although those at them are.
pub(crate) fn no_derivative(system: &System, unknowns: &Unknowns, station: usize) -> String {
    let place = place(system, unknowns, station);
    format!("the loads on {place} have no finite derivative")
}

/// Body and node of a station, in words.
pub(crate) fn place(system: &System, unknowns: &Unknowns, station: usize) -> String {
    let (group, k) = unknowns.locate(station);
    let layouts = system.groups[group].bodies.layouts().iter();
    let layout = layouts.rev().find(|l| l.first <= k);
    let (name, first) = layout.map_or(("", k), |l| (&l.name, l.first));
    format!("`{name}` at node {}", k - first)
}

/// Whose loads aren't finite numbers at the present poses, which are.
pub(crate) fn not_finite(system: &mut System) -> String {
    system.evaluate();
    let bad = |body: &crate::view::Body<'_>| {
        let node = |i: &usize| {
            !body
                .force(*i)
                .iter()
                .chain(&body.torque(*i))
                .all(|v| v.is_finite())
        };
        (0..body.nodes()).find(node)
    };
    let place = system.ids().iter().find_map(|id| {
        let body = system.body(*id);
        bad(&body).map(|i| format!("the loads on `{}` at node {i}", body.name()))
    });
    let place = place.unwrap_or_else(|| "loads".into());
    let culprit = system.culprit(system.time);
    let culprit = culprit.map_or(String::new(), |c| format!(", they come from {c}"));
    format!("{place} are not finite numbers{culprit}")
}
