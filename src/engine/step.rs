//! The step of position Verlet, and what is told when it fails.

use crate::connection::Connection;
use crate::group::{Group, each};
use crate::inputs::{Inputs, Moment};
use crate::kernel::Pass;
use crate::soundness::STRETCH;
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

impl Group {
    /// The first part of a step: half a step of positions and frames, boundary values at the middle, loads but those of
    /// joints. After a step that wasn't ended its second half of a step of positions and frames comes first.
    fn before_joints(&mut self, inputs: &Inputs, time: f64, dt: f64) {
        let middle = Moment {
            time: time + dt / 2.0,
            inputs,
        };
        // What is held is set anew, hence needn't be at the end of the step before.
        let drift = if std::mem::take(&mut self.midway) {
            Pass::DriftTwice(dt / 2.0)
        } else {
            Pass::Drift(dt / 2.0)
        };
        self.bodies.sweep(drift);
        self.set_values(&middle);
        self.loads(&middle);
    }

    /// Rates, damping and boundary rates.
    fn after_joints(&mut self, inputs: &Inputs, time: f64, dt: f64) {
        let middle = Moment {
            time: time + dt / 2.0,
            inputs,
        };
        self.remember(&middle);
        self.kick(&middle, dt);
        self.sound = self.bodies.is_sound();
        // Poses stay sound where rates aren't, so that the cause can be looked for.
        self.midway = self.sound;
    }

    /// The rest of a step: half a step of positions and frames again, and boundary values at the end.
    fn end_step(&mut self, inputs: &Inputs, time: f64, dt: f64) {
        if std::mem::take(&mut self.midway) {
            self.bodies.sweep(Pass::Drift(dt / 2.0));
            self.set_values(&Moment { time, inputs });
        }
    }
}

impl System {
    /// One step of position Verlet (Gazzola et al. 2018, section 3.2):
    /// 1. half a step of positions and frames, boundary values at the middle;
    /// 2. strains, rod laws, internal loads, forcing;
    /// 3. joints;
    /// 4. rates, damping, boundary rates;
    /// 5. half a step of positions and frames, boundary values at the end.
    pub fn step(&mut self, dt: f64) -> Result<(), BlowUp> {
        self.advance(dt, 1)
    }

    /// Steps of which the last isn't ended.
    fn step_midway(&mut self, dt: f64, count: u64) -> Result<(), BlowUp> {
        for _ in 0..count {
            let Self {
                groups,
                joints,
                inputs,
                time,
                ..
            } = self;
            each(groups, |group| group.before_joints(inputs, *time, dt));
            let middle = Moment {
                time: *time + dt / 2.0,
                inputs,
            };
            for joint in joints.iter() {
                joint.apply(groups, &middle);
            }
            each(groups, |group| group.after_joints(inputs, *time, dt));
            self.time += dt;
            self.steps += 1;
            if !self.groups.iter().all(|g| g.sound) {
                return Err(self.blow_up(dt));
            }
        }
        Ok(())
    }

    /// `count` steps together.
    fn steps_of_all(&mut self, dt: f64, count: u64) -> Result<(), BlowUp> {
        let stepped = self.step_midway(dt, count);
        let Self {
            groups,
            inputs,
            time,
            ..
        } = self;
        each(groups, |group| group.end_step(inputs, *time, dt));
        stepped
    }

    /// `count` steps of `dt` \[s\], to the same bits as by [`System::step`]. Groups that no joint connects take all of
    /// them one after the other, in parallel and each in its core's cache.
    pub fn advance(&mut self, dt: f64, count: u64) -> Result<(), BlowUp> {
        if count == 1 || self.groups.len() == 1 || !self.joints.is_empty() {
            return self.steps_of_all(dt, count);
        }
        let Self { inputs, time, .. } = self;
        let end = |start| (0..count).fold(start, |time: f64, _| time + dt);
        each(&mut self.groups, |group| {
            group.start.copy_from(&group.bodies.state);
            let mut time = *time;
            for _ in 0..count {
                group.before_joints(inputs, time, dt);
                group.after_joints(inputs, time, dt);
                if !group.sound {
                    return;
                }
                time += dt;
            }
            group.end_step(inputs, time, dt);
        });
        if self.groups.iter().all(|g| g.sound) {
            self.time = end(self.time);
            self.steps += count;
            return Ok(());
        }
        // Again in step, so that all is told and left as it is when the first of them fails.
        for group in &mut self.groups {
            group.bodies.state.copy_from(&group.start);
        }
        self.steps_of_all(dt, count)
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
    pub(crate) fn first_fault(&self) -> Option<(String, usize, &'static str)> {
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
