//! One job: a scenario with its numbers, solved by itself.

use super::Plan;
use crate::config::Problems;
use crate::engine::{Model, RunError, Summary};
use crate::poses::{Pose, Rest, state_name};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// What came of a job.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Outcome {
    /// Index in the list.
    pub job: usize,
    /// Hash of scenario and parameters.
    pub hash: String,
    /// Why it didn't reach its end, if it didn't.
    pub failure: Option<String>,
    /// Steps of a dynamic run.
    pub steps: Option<u64>,
    /// Every steady state, up to the one that failed, or the last state of a dynamic run.
    pub states: Vec<State>,
    /// Time it took \[s\].
    pub seconds: f64,
}

/// A state that a job has reached.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct State {
    /// Time \[s\].
    pub time: f64,
    /// Name of the dwell; empty if it has none.
    pub name: String,
    /// Newton iterations of a steady state; not known of a job that failed.
    pub iterations: Option<usize>,
    /// Poses of the markers, or of all tips.
    pub poses: Vec<Pose>,
}

impl Outcome {
    /// Does a job; nothing comes of one that `stop` stops. Callbacks of the scenario are not called.
    pub(super) fn of(plan: &Plan, job: usize, stop: &AtomicBool) -> Option<Self> {
        let start = Instant::now();
        let mut states = Vec::new();
        let solved = plan
            .source(job)
            .and_then(|source| Model::build(&source, None))
            .map_err(|problems| in_a_line(&problems))
            .map(|mut model| solve(&mut model, &mut states, stop));
        let (failure, steps) = match solved {
            Ok(Err(RunError::Interrupted { .. })) => return None,
            Ok(Err(failure)) => (Some(failure.to_string()), None),
            Err(problems) => (Some(problems), None),
            Ok(Ok(summary)) => {
                for (state, (_, report, _)) in states.iter_mut().zip(&summary.steady) {
                    state.iterations = Some(report.iterations);
                }
                (None, summary.steady.is_empty().then_some(summary.steps))
            }
        };
        Some(Self {
            job,
            hash: plan.hash(job),
            failure,
            steps,
            states,
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// Whether both are the same but for the time they took.
    pub(super) fn agrees(&self, other: &Self) -> bool {
        let seconds = self.seconds;
        let other = Self {
            seconds,
            ..other.clone()
        };
        *self == other
    }
}

fn solve(
    model: &mut Model,
    states: &mut Vec<State>,
    stop: &AtomicBool,
) -> Result<Summary, RunError> {
    model.watchers.clear();
    let rest = Rest::of(model);
    let go_on = &mut |_| match stop.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    model.run(Path::new(""), go_on, &mut |model| {
        states.push(State {
            time: model.system.time(),
            name: state_name(model).to_owned(),
            iterations: None,
            poses: rest.poses(model),
        });
    })
}

/// Problems as they fit in a table.
fn in_a_line(problems: &Problems) -> String {
    let words = |p: &crate::config::Problem| match &p.path {
        Some(path) => format!("{path}: {}", p.message),
        None => p.message.clone(),
    };
    problems.0.iter().map(words).collect::<Vec<_>>().join("; ")
}
