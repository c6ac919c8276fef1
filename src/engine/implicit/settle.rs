//! Motion to rest while time stands still: dynamic relaxation by implicit steps.

use super::{ImplicitSolver, NoStep};
use crate::system::System;

/// The longest step and the first one, as shares of the time in which the system moves, and the factor by which steps grow.
const LONGEST: f64 = 0.3;
const FIRST: f64 = 0.003;
const GROWTH: f64 = 1.5;
/// Decay of all rates within that time: what swings once in it comes to rest fastest.
const DECAY: f64 = 2.0;
/// Largest motion of a step, in radians or lengths of the longest rod; beyond, it may pass by where it would come to rest.
const FAR: f64 = 0.2;
/// Motion of a longest step below which the system rests, over the error that steps may have.
const AT_REST: f64 = 10.0;
/// Steps before giving up.
const STEPS: usize = 3000;

impl ImplicitSolver {
    /// Lets the system come to rest from its present poses, with loads and boundary values of the present time. Where it rests
    /// is stable, unless nothing drew it away from where it stood. It moves within about `time` \[s\]: the inverse of what is
    /// unstable grows at, or of the slowest angular frequency; all rates decay within it, while damping, which may make it
    /// slower by far, is left out. A spectral radius of 0 damps vibrations most. Rest is known to ten times the tolerance.
    ///
    /// # Errors
    /// If it doesn't come to rest, as when nothing holds it. The system is left where the last step has brought it.
    pub fn settle(&mut self, system: &mut System, time: f64) -> Result<(), NoStep> {
        let dampers = system
            .groups
            .iter_mut()
            .map(|g| std::mem::take(&mut g.damping));
        let dampers: Vec<_> = dampers.collect();
        let outcome = self.settle_undamped(system, time);
        for (group, dampers) in system.groups.iter_mut().zip(dampers) {
            group.damping = dampers;
        }
        outcome
    }

    fn settle_undamped(&mut self, system: &mut System, time: f64) -> Result<(), NoStep> {
        let now = system.time;
        let fail = |step: f64, reason: &str| NoStep {
            time: now,
            step,
            reason: reason.to_owned(),
        };
        self.motion.stop(system);
        let longest = LONGEST * time;
        let mut h = FIRST * time;
        for _ in 0..STEPS {
            let outcome = self.step(system, now, h, &mut |solver, system, h| {
                if solver.motion.largest_rate(system) * h > FAR {
                    return Err("it moves too far".into());
                }
                Ok(())
            });
            if let Err(reason) = outcome {
                self.return_to(system, now);
                self.report.halved += 1;
                h /= 4.0;
                if h < self.options.smallest * longest {
                    return Err(fail(h, &reason));
                }
                continue;
            }
            let motion = self.motion.largest_rate(system) * h;
            if h >= longest && motion < AT_REST * self.options.tolerance {
                return Ok(());
            }
            let slower = (-DECAY * h / time).exp();
            for group in &mut system.groups {
                group.bodies.state.scale_rates(slower);
            }
            h = (h * GROWTH).min(longest);
        }
        Err(fail(h, "it doesn't come to rest"))
    }
}
