//! What a scenario shows under recorded motor angles.

use super::{CompareError, Observed};
use crate::config::{Source, Vec3};
use crate::engine::run::Progress;
use crate::engine::scenario::{Capture, Marker, Solver, StepSize};
use crate::engine::steady::NotSteady;
use crate::engine::{ImplicitSolver, Model, RunError, SteadySolver, System};
use crate::recordings::{MarkerFrame, OffsetZ, Pose};
use nalgebra::{Rotation3, UnitQuaternion, Vector3};

/// How the scenario is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// A steady state at each settled sample.
    Steady,
    /// A steady state at every row, as if the robot moved infinitely slowly.
    Quasistatic,
    /// Through time, by explicit steps if the scenario's solver is `Dynamic`, else by implicit ones.
    Dynamic,
}

/// Names of the markers that recordings know.
pub const BODIES: [&str; 2] = ["platform", "ring"];
/// Implicit step \[s\] of scenarios that give none.
const STEP: f64 = 0.02;
/// Progress is told this many times at most.
const REPORTS: usize = 200;

/// Poses of the scenario's markers, as motion capture would show them; nothing where no state was found.
pub struct Simulated {
    /// Poses of `platform` and of `ring`, one entry a sample.
    pub poses: [Vec<Option<Pose>>; 2],
    /// Samples without a steady state, and why.
    pub unsolved: Vec<(usize, String)>,
}

impl Simulated {
    /// Runs the scenario under the recorded angles.
    pub fn run(
        source: &Source,
        observed: &Observed,
        mode: Mode,
        progress: &mut Progress<'_>,
    ) -> Result<Self, CompareError> {
        let mut model = Model::build(source, Some(observed.inputs()?))?;
        if observed.time.is_empty() {
            return Err(CompareError::Unfit(format!(
                "recording `{}` has no sample to compare",
                observed.name
            )));
        }
        let markers = markers(&model)?;
        model.system.set_time(observed.rest);
        let options = model.solver.steady_options();
        let mut solver = SteadySolver::new(&mut model.system, options).map_err(RunError::from)?;
        // Both sides are referred to rest.
        solver
            .advance(&mut model.system, observed.rest)
            .map_err(RunError::from)?;
        let rest = [0, 1].map(|b| pose(&model, &markers[b], None));
        let recorded = [&observed.reference.platform, &observed.reference.ring];
        let frames = [0, 1].map(|b| {
            MarkerFrame::new(recorded[b], &rest[b].translation.vector, OffsetZ::Reference)
        });
        let mut simulated = Self {
            poses: [Vec::new(), Vec::new()],
            unsolved: Vec::new(),
        };
        let mut driver = match mode {
            Mode::Steady | Mode::Quasistatic => Driver::Steady(solver),
            Mode::Dynamic => Driver::through_time(&mut model)?,
        };
        for (i, time) in observed.time.iter().enumerate() {
            if i % observed.time.len().div_ceil(REPORTS) == 0
                && progress(i as f64 / observed.time.len() as f64).is_break()
            {
                let time = model.system.time();
                return Err(RunError::Interrupted { time }.into());
            }
            let solved = driver.advance(&mut model.system, *time)?;
            if let Err(e) = &solved {
                simulated.unsolved.push((i, e.to_string()));
            }
            for b in [0, 1] {
                let shown = solved
                    .is_ok()
                    .then(|| frames[b].marker_pose(&pose(&model, &markers[b], Some(&rest[b]))));
                simulated.poses[b].push(shown);
            }
        }
        match simulated.unsolved.first() {
            Some((_, reason)) if simulated.unsolved.len() == observed.time.len() => Err(
                CompareError::Unfit(format!("no sample was solved: {reason}")),
            ),
            _ => Ok(simulated),
        }
    }
}

pub(crate) fn markers(model: &Model) -> Result<[Marker; 2], CompareError> {
    let find = |name: &str| {
        let marker = model.markers.iter().find(|m| m.name == name).cloned();
        marker.ok_or_else(|| {
            CompareError::Unfit(format!(
                "the scenario has no marker `{name}`; add one under `markers`, such as \
                 (name: \"{name}\", on: \"a body\")"
            ))
        })
    };
    Ok([find(BODIES[0])?, find(BODIES[1])?])
}

/// A marker's pose as motion capture sees it; its rotation is from `rest` if given, else from the world's axes.
pub(crate) fn pose(model: &Model, marker: &Marker, rest: Option<&Pose>) -> Pose {
    let (point, frame) = model
        .marker_pose(marker)
        .expect("the model was built with the marker's body");
    // rows of a frame are directors, so its transpose rotates the world's axes onto them
    let rotation = Rotation3::from_matrix_unchecked(frame.transpose());
    let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
    let from = rest.map_or(UnitQuaternion::identity(), |rest| rest.rotation);
    seen(&model.capture) * Pose::from_parts(point.into(), rotation * from.inverse())
}

/// How what is seen lies against what is there.
pub(crate) fn seen(Capture { turn, shift }: &Capture) -> Pose {
    let vector = |v: &Option<Vec3>| v.map_or(Vector3::zeros(), |v| Vector3::from(*v));
    Pose::new(vector(shift), vector(turn))
}

/// What moves the scenario from sample to sample.
enum Driver {
    Steady(SteadySolver),
    Explicit(StepSize),
    Implicit { solver: ImplicitSolver, dt: f64 },
}

impl Driver {
    fn through_time(model: &mut Model) -> Result<Self, RunError> {
        let dt = match model.solver {
            Solver::Dynamic { .. } => return Ok(Self::Explicit(model.time_step()?)),
            Solver::Implicit { dt, .. } => *dt,
            Solver::Steady { .. } => STEP,
        };
        let options = model.solver.implicit_options();
        let solver = ImplicitSolver::new(&mut model.system, options)?;
        Ok(Self::Implicit { solver, dt })
    }

    /// Moves the system to `time` \[s\]. That there is no steady state is no reason to end.
    fn advance(
        &mut self,
        system: &mut System,
        time: f64,
    ) -> Result<Result<(), NotSteady>, RunError> {
        let start = system.time();
        let steps = |dt: f64| ((time - start) / dt).ceil().max(0.0) as u64;
        match self {
            Self::Steady(solver) => return Ok(solver.advance(system, time).map(drop)),
            Self::Explicit(StepSize { dt, limit }) => {
                let steps = steps(*dt);
                let (limit, dt) = (*limit, (time - start) / steps as f64);
                system.advance(dt, steps).map_err(|blow_up| {
                    let blow_up = Box::new(blow_up);
                    RunError::BlowUp { blow_up, limit, dt }
                })?;
            }
            Self::Implicit { solver, dt } => {
                let steps = steps(*dt);
                for step in 1..=steps {
                    let share = step as f64 / steps as f64;
                    solver.advance(system, start + (time - start) * share)?;
                }
            }
        }
        Ok(Ok(()))
    }
}
