//! Motion to rest while time stands still: dynamic relaxation by implicit steps, with kinetic damping.

use super::{ImplicitSolver, NoStep};
use crate::system::System;

/// The first step, as a share of the longest, and the factor by which steps grow.
const FIRST: f64 = 0.01;
const GROWTH: f64 = 1.5;
/// Largest motion of a step, in radians or lengths of the longest rod; beyond, it may pass by where it would come to rest.
const FAR: f64 = 0.2;
/// Motion of a longest step from rest below which the system stays.
const AT_REST: f64 = 1e-8;
/// Steps before giving up.
const STEPS: usize = 3000;

impl ImplicitSolver {
    /// Lets the system come to rest, with loads and boundary values of the present time: it falls from its present state and
    /// is stopped whenever its kinetic energy falls, until it stays where it is. That is a stable state, unless it stood
    /// where nothing drew it away. Steps take `longest` \[s\] at most, which should be short beside what grows, as a third of
    /// the inverse of a growth rate is; a spectral radius of 0 damps most.
    ///
    /// # Errors
    /// If it doesn't come to rest, as when nothing holds it. The system is left where the last step has brought it.
    pub fn settle(&mut self, system: &mut System, longest: f64) -> Result<(), NoStep> {
        let time = system.time;
        let fail = |step: f64, reason: &str| NoStep {
            time,
            step,
            reason: reason.to_owned(),
        };
        self.motion.stop(system);
        let (mut h, mut energy) = (FIRST * longest, 0.0);
        for _ in 0..STEPS {
            let outcome = self.step(system, time, h, &mut |solver, system, h| {
                if solver.motion.largest_rate(system) * h > FAR {
                    return Err("it moves too far".into());
                }
                Ok(())
            });
            if let Err(reason) = outcome {
                self.return_to(system, time);
                self.report.halved += 1;
                h /= 4.0;
                if h < self.options.smallest * longest {
                    return Err(fail(h, &reason));
                }
                continue;
            }
            if h >= longest && self.motion.largest_rate(system) * h < AT_REST {
                return Ok(());
            }
            let before = std::mem::replace(&mut energy, system.kinetic_energy());
            if energy < before {
                self.motion.stop(system);
                energy = 0.0;
            }
            h = (h * GROWTH).min(longest);
        }
        Err(fail(h, "it doesn't come to rest"))
    }
}
