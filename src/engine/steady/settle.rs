//! From a branch of equilibria that ends, or that isn't stable, to a stable one: the system is let go and comes to rest.

use super::path::Path;
use super::{SteadyReport, SteadySolver, Trial};
use crate::implicit::{ImplicitOptions, ImplicitSolver};
use crate::stability::seed;
use crate::system::System;

/// Motion of the push away from an unstable equilibrium.
const PUSH: f64 = 0.01;
/// Pushes before giving up.
const PUSHES: usize = 4;
/// Error of a step of the motion to rest.
const FINE: f64 = 1e-9;
/// Time in which the system moves where that isn't known \[s\].
const UNKNOWN: f64 = 0.1;

impl SteadySolver {
    /// From the equilibrium at a share of the path, beyond which there is none nearby, to rest at its end.
    pub(super) fn fall(
        &mut self,
        system: &mut System,
        path: &Path,
        from: f64,
        report: &mut SteadyReport,
    ) -> Result<(), String> {
        let time = self.stability_of(system).map_or(UNKNOWN, |s| s.time());
        // what is held goes to the end at once
        path.turn_walls(system, 1.0);
        let rest = path.moves.iter().map(|m| m * (1.0 - from));
        self.unknowns
            .displace_all(&mut system.groups, &rest.collect::<Vec<_>>());
        self.settle(system, path, time, report)
    }

    /// From an equilibrium at the end of the path, if it is unstable, to a stable one.
    pub(super) fn stabilise(
        &mut self,
        system: &mut System,
        path: &Path,
        report: &mut SteadyReport,
    ) -> Result<(), String> {
        for _ in 0..PUSHES {
            let stability = self.stability_of(system)?;
            if stability.is_stable() {
                return Ok(());
            }
            let mut push = seed(self.loads.len());
            self.freedom.project(&mut push);
            // what is soft gives way most
            if !self.tangent.solve(&mut push) {
                return Err(
                    "the state is unstable and its tangent matrix singular; go on a little".into(),
                );
            }
            let size = PUSH / self.size(&push).motion;
            push.iter_mut().for_each(|p| *p *= size);
            self.unknowns.displace_all(&mut system.groups, &push);
            self.settle(system, path, stability.time(), report)?;
        }
        Err(format!(
            "the state is unstable, and so were the {PUSHES} that the system came to when it was let go; follow its branch \
             instead, or let it settle with the dynamic solver"
        ))
    }

    /// Lets the system come to rest at the end of the path, where it moves within such a time \[s\].
    fn settle(
        &mut self,
        system: &mut System,
        path: &Path,
        time: f64,
        report: &mut SteadyReport,
    ) -> Result<(), String> {
        let options = ImplicitOptions {
            spectral_radius: 0.0,
            tolerance: FINE,
            ..ImplicitOptions::default()
        };
        let mut solver = ImplicitSolver::new(system, options).map_err(|e| e.reason)?;
        let settled = solver.settle(system, time);
        settled.map_err(|e| format!("let go, it doesn't come to rest: {}", e.reason))?;
        super::path::hold(system);
        report.settled += 1;
        self.moved = None;
        self.newton(system, path, (1.0, 1.0), &mut Trial::default(), report)
    }
}
