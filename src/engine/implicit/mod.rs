//! Time steps far beyond the explicit limit: the generalised-alpha method on the Lie group of poses, in the form of
//! Brüls and Cardona 2010 ([10.1115/1.4001370](https://doi.org/10.1115/1.4001370)).
//!
//! A step solves the equations of motion at its end by Newton's method, with the unknowns, tangent and factors of the
//! steady solver. It is of second order and stable for any length; vibrations much faster than it decay by the spectral
//! radius a step. Laws with a memory see the ends of steps only, so what they add is of first order.

mod loads;
mod motion;
mod scheme;
mod sensitivity;
mod settle;

use crate::group::Group;
use crate::steady::diagnosis;
use crate::steady::tangent::Tangent;
use crate::steady::unknowns::{Freedom, PER_STATION, Unknowns};
use crate::system::System;
use motion::Motion;
use scheme::Scheme;
pub use sensitivity::MotionSensitivities;

/// How implicit steps are taken.
#[derive(Clone, Debug, PartialEq)]
pub struct ImplicitOptions {
    /// Share that a step leaves of vibrations much faster than it: 1 keeps all energy, 0 drops them at once.
    pub spectral_radius: f64,
    /// Error of a step that Newton's method may leave: rotations \[rad\], and displacements in element lengths.
    pub tolerance: f64,
    /// Newton iterations a step may take before it is halved.
    pub iterations: usize,
    /// Smallest step before giving up, as a share of the one asked for.
    pub smallest: f64,
}

impl Default for ImplicitOptions {
    fn default() -> Self {
        Self {
            spectral_radius: 0.5,
            tolerance: 1e-7,
            iterations: 25,
            smallest: 1e-6,
        }
    }
}

/// What implicit steps have cost so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImplicitReport {
    /// Steps taken.
    pub steps: usize,
    /// Steps that didn't converge and were halved.
    pub halved: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Tangent matrices that were found and factorised; iterations and steps share them while they contract well.
    pub factorisations: usize,
}

/// No step was found, however short.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("no time step leads on from t = {time:.6} s: {reason}, down to steps of {step:.1e} s")]
pub struct NoStep {
    /// Time \[s\] that was reached.
    pub time: f64,
    /// The shortest step tried \[s\].
    pub step: f64,
    /// Where and why.
    pub reason: String,
}

/// Factor by which corrections must shrink for the tangent of an earlier state to be kept.
const REUSE: f64 = 0.5;
/// How much smaller than accepted the first correction of a step must be, since how fast they shrink isn't known yet.
const UNTRIED: f64 = 20.0;
/// Corrections below this may grow once: a law's kink may cost that.
const HARMLESS: f64 = 0.02;
/// Relative change of the step for which factors are kept.
const SAME_STEP: f64 = 0.2;

/// What is done at the end of a step of a length \[s\].
type Ended<'a> = dyn FnMut(&mut ImplicitSolver, &mut System, f64) -> Result<(), String> + 'a;

/// Steps one system through time.
pub struct ImplicitSolver {
    options: ImplicitOptions,
    motion: Motion,
    tangent: Tangent,
    /// The step that the factors are for, if there are any.
    factors: Option<f64>,
    report: ImplicitReport,
}

impl ImplicitSolver {
    /// Prepares to step a system on from its present state and rates.
    ///
    /// # Errors
    /// If its boundary conditions aren't projections of the rates.
    pub fn new(system: &mut System, options: ImplicitOptions) -> Result<Self, NoStep> {
        let time = system.time;
        let fail = |reason| NoStep {
            time,
            step: 0.0,
            reason,
        };
        system.apply_boundaries();
        let unknowns = Unknowns::of(system);
        let present = system.save();
        let freedom = Freedom::of(system, &unknowns).map_err(fail)?;
        system.restore(&present);
        let reach = unknowns.reach(system);
        let tangent = Tangent::new(system, &unknowns, reach);
        let scheme = Scheme::new(options.spectral_radius);
        Ok(Self {
            motion: Motion::new(system, scheme, unknowns, freedom),
            options,
            tangent,
            factors: None,
            report: ImplicitReport::default(),
        })
    }

    /// What steps have cost so far.
    pub fn report(&self) -> ImplicitReport {
        self.report
    }

    /// Moves the system to `time` \[s\], in one step or, where Newton's method doesn't converge, in as few as it does
    /// for. On failure the system is left where the last step has brought it.
    pub fn advance(&mut self, system: &mut System, time: f64) -> Result<(), NoStep> {
        self.advance_with(system, time, &mut |_, _, _| Ok(()))
    }

    /// The same, with something to do at the end of each step before it becomes the past.
    fn advance_with(
        &mut self,
        system: &mut System,
        time: f64,
        ended: &mut Ended<'_>,
    ) -> Result<(), NoStep> {
        let whole = time - system.time;
        let mut step = whole;
        while system.time < time {
            let from = system.time;
            // no crumb is left for a last step
            let to = if step > 0.999 * (time - from) {
                time
            } else {
                from + step
            };
            match self.step(system, to, to - from, ended) {
                Ok(()) => step = 2.0 * (to - from),
                Err(reason) => {
                    self.return_to(system, from);
                    self.report.halved += 1;
                    step = (to - from) / 2.0;
                    if step < self.options.smallest * whole {
                        return Err(NoStep {
                            time: from,
                            step: to - from,
                            reason,
                        });
                    }
                }
            }
        }
        Ok(())
    }

    /// One step of `h` to `time` \[s\].
    fn step(
        &mut self,
        system: &mut System,
        time: f64,
        h: f64,
        ended: &mut Ended<'_>,
    ) -> Result<(), String> {
        self.motion.begin(system);
        self.motion.predict(system, h);
        system.time = time;
        system.set_values();
        self.newton(system, h)?;
        self.motion.follow(system, h);
        self.check(system)?;
        ended(self, system, h)?;
        if system.remembers() {
            system.evaluate();
            system.remember();
        }
        self.motion.end();
        system.steps += 1;
        self.report.steps += 1;
        Ok(())
    }

    /// Whether what was found still resembles rods.
    fn check(&self, system: &System) -> Result<(), String> {
        let sound = system.groups.iter().all(|g| g.bodies.is_sound());
        sound.then_some(()).ok_or_else(|| {
            let fault = system.first_fault();
            let (body, node, what) = fault.unwrap_or_default();
            format!("body `{body}`, node {node}: {what}")
        })
    }

    /// Poses that are in equilibrium with inertia at the end of a step of `h`.
    fn newton(&mut self, system: &mut System, h: f64) -> Result<(), String> {
        let usable = |made_for: f64| (h / made_for - 1.0).abs() < SAME_STEP;
        self.factors = self.factors.filter(|made_for| usable(*made_for));
        let mut last = f64::INFINITY;
        let mut worst = 0;
        for iteration in 1..=self.options.iterations {
            self.report.iterations += 1;
            self.motion.follow(system, h);
            self.motion.find_residual(system);
            if !self.motion.residual.iter().all(|v| v.is_finite()) {
                return Err(diagnosis::not_finite(system));
            }
            let mut fresh = self.factors.is_none();
            if fresh {
                self.factorise(system, h)?;
            }
            let mut size = self.correction(&mut worst)?;
            if !fresh && size > REUSE * last {
                self.factorise(system, h)?;
                size = self.correction(&mut worst)?;
                fresh = true;
            }
            if fresh && size > last && size > HARMLESS {
                break;
            }
            self.motion
                .unknowns
                .displace_all(&mut system.groups, &self.motion.change);
            // what is left after it, if the next ones shrink as this one has
            let ratio = if iteration == 1 { UNTRIED } else { size / last };
            if size * ratio < self.options.tolerance {
                return Ok(());
            }
            last = size;
        }
        Err(format!(
            "Newton's method doesn't converge, least at {}",
            diagnosis::place(system, &self.motion.unknowns, worst)
        ))
    }

    /// Solves for the motion of all stations towards equilibrium. Returns its largest rotation \[rad\] or displacement in
    /// element lengths, and where that is.
    fn correction(&mut self, worst: &mut usize) -> Result<f64, String> {
        for (change, load) in self.motion.change.iter_mut().zip(&self.motion.residual) {
            *change = -load;
        }
        if !self.tangent.solve(&mut self.motion.change) {
            return Err("the tangent matrix is singular".into());
        }
        let sizes = self.motion.change.iter().enumerate();
        let largest = sizes.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let (at, size) = largest.map_or((0, 0.0), |(i, v)| (i, v.abs()));
        *worst = at / PER_STATION;
        Ok(size)
    }

    /// The tangent matrix of the present state and its factors, for a step of `h`.
    fn factorise(&mut self, system: &mut System, h: f64) -> Result<(), String> {
        self.factors = None;
        let (rate, acceleration) = self.motion.scheme.slopes(h);
        self.tangent
            .fill(system, &self.motion.unknowns, Group::loads_in_motion, rate);
        if let Some(station) = self.tangent.not_finite() {
            return Err(diagnosis::no_derivative(
                system,
                &self.motion.unknowns,
                station,
            ));
        }
        self.tangent
            .subtract_inertia(&self.motion.inertia, acceleration);
        self.tangent.factorise(&self.motion.freedom);
        self.report.factorisations += 1;
        self.factors = Some(h);
        Ok(())
    }

    /// Back to the start of a step that failed.
    fn return_to(&mut self, system: &mut System, time: f64) {
        for (start, group) in self.motion.start.iter().zip(&mut system.groups) {
            group.bodies.state.copy_from(start);
        }
        system.time = time;
        system.apply_boundaries();
        self.factors = None;
    }
}
