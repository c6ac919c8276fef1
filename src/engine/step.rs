//! The step of position Verlet, and what is told when it fails.

use crate::bodies::STRETCH;
use crate::connection::Connection;
use crate::group::each;
use crate::inputs::Moment;
use crate::system::System;
use crate::view::ReadBody;
use nalgebra::Vector3;

/// A simulation ran into something that is no number, or nothing like a rod.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the simulation blew up at t = {time:.6} s, step {step}: body `{body}`, node {node}: {what}{}",
    culprit.as_ref().map_or(String::new(), |c| format!("; the loads that are no finite numbers come from {c}"))
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
    /// What is wrong there.
    pub what: &'static str,
    /// Hook to blame, if one is.
    pub culprit: Option<String>,
}

impl System {
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
            if group.bodies.is_sound() {
                group.bodies.drift(dt / 2.0);
                group.set_values(&end);
            }
        });
        self.time += dt;
        self.steps += 1;
        if self.groups.iter().all(|g| g.bodies.is_sound()) {
            Ok(())
        } else {
            Err(self.blow_up(dt))
        }
    }

    #[cold]
    fn blow_up(&mut self, dt: f64) -> BlowUp {
        let (body, node, what) = self.first_fault().unwrap_or_default();
        let culprit = self.culprit(self.time - dt / 2.0);
        BlowUp {
            time: self.time,
            step: self.steps,
            body,
            node,
            what,
            culprit,
        }
    }

    /// The first hook whose loads at `time` \[s\] and the present poses aren't finite numbers, if one is to blame.
    pub(crate) fn culprit(&mut self, time: f64) -> Option<String> {
        let Self {
            groups,
            joints,
            inputs,
            ..
        } = self;
        let now = Moment { time, inputs };
        let of_groups = groups.iter_mut().find_map(|g| g.culprit(&now));
        of_groups.or_else(|| {
            let spoils = |joint: &&Connection| {
                let loads = joint.applied(groups, &now);
                !loads.iter().all(|l| finite(l.force) && finite(l.torque))
            };
            joints.iter().find(spoils).map(|j| j.name.clone())
        })
    }

    /// Body, node or element, and fault of the first that isn't sound.
    fn first_fault(&self) -> Option<(String, usize, &'static str)> {
        self.ids().iter().find_map(|id| {
            let body = self.body(*id);
            let fault = |i: usize| {
                if !finite(body.velocity(i)) {
                    Some("its velocity is not finite")
                } else if i < body.directors() && !finite(body.omega(i)) {
                    Some("its angular velocity is not finite")
                } else if i < body.elements() && !STRETCH.contains(&body.dilatation(i)) {
                    Some("its element is stretched or squeezed a thousandfold")
                } else if i == 0 && body.bodies().is_tangled(body.layout()) {
                    Some("its elements are turned against each other at random from here on")
                } else {
                    None
                }
            };
            (0..body.nodes()).find_map(|i| fault(i).map(|what| (body.name().to_owned(), i, what)))
        })
    }
}

fn finite(v: Vector3<f64>) -> bool {
    v.iter().all(|x| x.is_finite())
}
