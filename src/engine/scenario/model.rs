//! A scenario ready to be solved.

use super::{Capture, Marker, MotorLoads, Solver};
use crate::group::BodyId;
use crate::hooks::{Callback, Dwell};
use crate::rotation;
use crate::system::System;
use crate::view::{Body, ReadBody};
use nalgebra::{Matrix3, Vector3};

/// A callback with its bodies and its clock.
pub struct Watcher {
    /// Name of the plugin and place in the scenario, for reports.
    pub name: String,
    /// Time between calls \[s\].
    pub every: f64,
    /// Bodies that it sees.
    pub bodies: Vec<BodyId>,
    /// The callback.
    pub callback: Box<dyn Callback>,
}

/// A scenario ready to be solved.
pub struct Model {
    /// What the scenario shows.
    pub title: String,
    /// Bodies and hooks.
    pub system: System,
    /// How to solve it.
    pub solver: Solver,
    /// When the inputs are at rest.
    pub dwells: Vec<Dwell>,
    /// Named points.
    pub markers: Vec<Marker>,
    /// How motion capture sees them.
    pub capture: Capture,
    /// What motors report as their loads.
    pub motor_loads: Option<MotorLoads>,
    /// Callbacks.
    pub watchers: Vec<Watcher>,
    /// Stability limit \[s\] at the start, once it has been asked for.
    pub(super) stability_limit: Option<f64>,
}

impl Model {
    /// Position in the world frame \[m\] and frame (rows are directors) of a marker.
    pub fn marker_pose(&self, marker: &Marker) -> Option<(Vector3<f64>, Matrix3<f64>)> {
        let body = self.system.body(self.system.find(&marker.on)?);
        let (point, frame) = pose_along(&body, *marker.along);
        Some((point + frame.tr_mul(&Vector3::from(*marker.offset)), frame))
    }

    /// Torques that turn the starts of the first four rods about their axes \[N m\]: what their first two elements pass on,
    /// before division by the dilatation. Zero for rods that aren't there or have one element.
    pub fn motor_torques(&self) -> [f64; 4] {
        let bodies = self.system.ids().iter().map(|id| self.system.body(*id));
        let mut rods = bodies.filter(|body| body.elements() > 0);
        let torque = |rod: Body<'_>| match rod.elements() {
            1 => 0.0,
            _ => -rod.couple(1).z,
        };
        std::array::from_fn(|_| rods.next().map_or(0.0, torque))
    }
}

/// Point and frame at a fraction of a rod's length, between the frames of the elements whose middles surround it.
fn pose_along(body: &Body<'_>, along: f64) -> (Vector3<f64>, Matrix3<f64>) {
    let n = body.elements();
    if n == 0 {
        return (body.position(0), body.director(0));
    }
    let nodes = along.min(1.0) * n as f64;
    let node = (nodes as usize).min(n - 1);
    let share = nodes - node as f64;
    let point = body.position(node) * (1.0 - share) + body.position(node + 1) * share;
    let middles = (nodes - 0.5).clamp(0.0, n as f64 - 1.0);
    let element = (middles as usize).min(n.saturating_sub(2));
    let frame = body.director(element);
    if n == 1 {
        return (point, frame);
    }
    let turn = rotation::between(&frame, &body.director(element + 1));
    (
        point,
        rotation::turned(&frame, &(turn * (middles - element as f64))),
    )
}
