//! Solving a model from start to end, with its callbacks.

use crate::hooks::{CallbackError, Snapshot};
use crate::implicit::{ImplicitReport, ImplicitSolver, NoStep};
use crate::scenario::{LARGEST_SHARE, Model, Solver, StepSize, Watcher};
use crate::steady::{NotSteady, Stability, SteadyReport, SteadySolver};
use crate::step::BlowUp;
use crate::system::System;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Steps between reports of progress.
const STEPS_PER_REPORT: u64 = 256;

/// Why a run didn't reach its end. What was recorded until then is kept.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// Something became infinite or NaN.
    #[error(
        "{blow_up}; the largest stable time step at the start was {limit:.3e} s, this run took {dt:.3e} s"
    )]
    BlowUp {
        /// When, where and why.
        blow_up: Box<BlowUp>,
        /// Stability limit \[s\].
        limit: f64,
        /// Time step \[s\].
        dt: f64,
    },
    /// The time step is too long.
    #[error(
        "the time step of {dt:.3e} s is beyond the stability limit of {limit:.3e} s at the start; give `solver.dt` \
         {:.3e} or less or `Auto`, or set `solver.unstable: true` to go on all the same",
        limit * LARGEST_SHARE
    )]
    Unstable {
        /// Time step \[s\].
        dt: f64,
        /// Stability limit \[s\].
        limit: f64,
    },
    /// No implicit step was found.
    #[error(transparent)]
    NoStep(#[from] NoStep),
    /// No equilibrium was found.
    #[error(transparent)]
    NotSteady(#[from] NotSteady),
    /// Results could not be kept.
    #[error(transparent)]
    Callback(#[from] CallbackError),
    /// The user stopped the run.
    #[error("the run was stopped at t = {time:.6} s; what was recorded until then is kept")]
    Interrupted {
        /// Time \[s\].
        time: f64,
    },
}

/// What a run did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Time reached \[s\].
    pub time: f64,
    /// Steps of a dynamic run.
    pub steps: u64,
    /// Time step of a run through time, and stability limit of an explicit one.
    pub step: StepSize,
    /// What implicit steps have cost.
    pub implicit: Option<ImplicitReport>,
    /// Time \[s\], cost and stability of each steady state; no stability of a singular one.
    pub steady: Vec<(f64, SteadyReport, Option<Stability>)>,
    /// Files written by callbacks.
    pub files: Vec<PathBuf>,
}

/// Tells how much is done (0 to 1) and asks whether to go on.
pub type Progress<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

impl Model {
    /// Solves the model. Callbacks write to `out`; they are finished whatever happens. `reached` is told every steady
    /// state, or the last state of a dynamic run.
    pub fn run(
        &mut self,
        out: &Path,
        progress: &mut Progress<'_>,
        reached: &mut dyn FnMut(&Self),
    ) -> Result<Summary, RunError> {
        let mut summary = Summary::default();
        self.system.apply_boundaries();
        // Before any callback replaces results: what can't be run leaves them as they are.
        let step = match self.solver {
            Solver::Dynamic { .. } => self.time_step()?,
            Solver::Implicit { .. } | Solver::Steady { .. } => StepSize::default(),
        };
        let mut started = 0;
        let mut outcome = Ok(());
        for watcher in &mut self.watchers {
            let bodies: Vec<_> = watcher
                .bodies
                .iter()
                .map(|id| self.system.body(*id))
                .collect();
            if let Err(e) = watcher.callback.start(out, &bodies) {
                outcome = Err(e.into());
                break;
            }
            started += 1;
        }
        if outcome.is_ok() {
            outcome = match self.solver.clone() {
                Solver::Dynamic { duration, .. } => self
                    .run_dynamic(*duration, step, &mut summary, progress)
                    .inspect(|()| reached(self)),
                Solver::Implicit { duration, dt, .. } => self
                    .run_implicit(*duration, *dt, &mut summary, progress)
                    .inspect(|()| reached(self)),
                Solver::Steady { at, .. } => {
                    let at = at.iter().map(|t| **t).collect();
                    self.run_steady(at, &mut summary, progress, reached)
                }
            };
        }
        summary.time = self.system.time();
        for watcher in &mut self.watchers[..started] {
            match watcher.callback.finish() {
                Ok(files) => summary.files.extend(files),
                Err(e) if outcome.is_ok() => outcome = Err(e.into()),
                Err(_) => {} // the first failure is the one to tell
            }
        }
        outcome.map(|()| summary)
    }

    fn run_dynamic(
        &mut self,
        duration: f64,
        StepSize { dt: wanted, limit }: StepSize,
        summary: &mut Summary,
        progress: &mut Progress<'_>,
    ) -> Result<(), RunError> {
        let steps = (duration / wanted).ceil().max(1.0);
        let dt = duration / steps;
        summary.step = StepSize { dt, limit };
        let advance = &mut |system: &mut System, _, count| {
            system.advance(dt, count).map_err(|blow_up| {
                let blow_up = Box::new(blow_up);
                RunError::BlowUp { blow_up, limit, dt }
            })
        };
        self.run_through(dt, steps, STEPS_PER_REPORT, advance, summary, progress)
    }

    fn run_implicit(
        &mut self,
        duration: f64,
        wanted: f64,
        summary: &mut Summary,
        progress: &mut Progress<'_>,
    ) -> Result<(), RunError> {
        let mut solver = ImplicitSolver::new(&mut self.system, self.solver.implicit_options())?;
        let steps = (duration / wanted).ceil().max(1.0);
        let dt = duration / steps;
        summary.step.dt = dt;
        let start = self.system.time();
        let advance = &mut |system: &mut System, step, count| {
            let to = start + (step + count) as f64 * dt;
            Ok(solver.advance(system, to)?)
        };
        let outcome = self.run_through(dt, steps, 1, advance, summary, progress);
        summary.implicit = Some(solver.report());
        outcome
    }

    /// Steps of `dt` \[s\] by `advance`, which is told how many there were and how many to take now, with callbacks and
    /// reports of progress between them.
    fn run_through(
        &mut self,
        dt: f64,
        steps: f64,
        steps_per_report: u64,
        advance: &mut dyn FnMut(&mut System, u64, u64) -> Result<(), RunError>,
        summary: &mut Summary,
        progress: &mut Progress<'_>,
    ) -> Result<(), RunError> {
        let system = &mut self.system;
        let start = system.time();
        let mut next: Vec<f64> = vec![start; self.watchers.len()];
        let (mut step, last) = (0, steps as u64);
        loop {
            let due = |next: &f64, time: f64| time >= *next - dt / 2.0;
            if next.iter().any(|next| due(next, system.time())) {
                // strains and loads of the step are those of its middle; show those of now
                system.evaluate();
                for (watcher, next) in self.watchers.iter_mut().zip(&mut next) {
                    if due(next, system.time()) {
                        watcher.call(system)?;
                        *next += watcher.every;
                    }
                }
            }
            if step % steps_per_report == 0 && progress(step as f64 / steps).is_break() {
                let time = system.time();
                return Err(RunError::Interrupted { time });
            }
            if step == last {
                return Ok(());
            }
            // as far as there is nothing to record or report
            let (mut count, mut time) = (1, system.time() + dt);
            while step + count < last
                && (step + count) % steps_per_report != 0
                && !next.iter().any(|next| due(next, time))
            {
                count += 1;
                time += dt;
            }
            advance(system, step, count)?;
            step += count;
            summary.steps = step;
        }
    }

    fn run_steady(
        &mut self,
        mut at: Vec<f64>,
        summary: &mut Summary,
        progress: &mut Progress<'_>,
        reached: &mut dyn FnMut(&Self),
    ) -> Result<(), RunError> {
        if at.is_empty() {
            at = self.dwells.iter().map(|dwell| dwell.time).collect();
        }
        if at.is_empty() {
            at.push(0.0);
        }
        let mut solver = SteadySolver::new(&mut self.system, self.solver.steady_options())?;
        for (done, time) in at.iter().enumerate() {
            if progress(done as f64 / at.len() as f64).is_break() {
                let time = self.system.time();
                return Err(RunError::Interrupted { time });
            }
            let report = solver.advance(&mut self.system, *time)?;
            let stability = solver.stability(&mut self.system).ok();
            summary.steady.push((*time, report, stability));
            reached(self);
            for watcher in &mut self.watchers {
                watcher.call(&self.system)?;
            }
        }
        Ok(())
    }
}

impl Watcher {
    fn call(&mut self, system: &System) -> Result<(), CallbackError> {
        let snapshot = Snapshot {
            time: system.time(),
            bodies: self.bodies.iter().map(|id| system.body(*id)).collect(),
        };
        self.callback.record(&snapshot)
    }
}
