//! From a scenario to the residuals of recordings.

use super::samples::{Phase, Samples};
use crate::compare::{CompareError, markers, pose};
use crate::config::Source;
use crate::engine::scenario::{Datum, Marker};
use crate::engine::system::{Saved, System};
use crate::engine::{Model, RunError, Sensitivities, SteadySolver};
use crate::recordings::Pose;
use nalgebra::DMatrix;

/// Components of a sample: position and rotation of platform and ring.
pub const CHANNELS: usize = 12;
/// What no model is asked to explain, since meshes differ by as much: position [m], rotation [rad].
pub const NUMERICS: (f64, f64) = (3e-5, 3e-4);
/// Evaluations a sample may take on average; a model that takes more is no candidate, since its search never ends.
const EVALUATIONS: usize = 500;
/// Evaluations that a failure is taken for.
const FAILURE: usize = 1500;
/// Smallest share of the way from one sample to the next that is solved at once, for the same reason.
const SMALLEST: f64 = 1.0 / 8.0;

/// A scenario's model under the motor angles of a recording, and its markers.
pub struct Shown {
    model: Model,
    points: Points,
}

/// The markers, and their poses at rest, where they count from there.
#[derive(Clone)]
struct Points {
    markers: [Marker; 2],
    rest: [Pose; 2],
}

impl Shown {
    /// Builds the scenario.
    ///
    /// # Errors
    /// If it can't be built, or has no rest where markers count from rest.
    pub fn new(source: &Source, samples: &Samples) -> Result<Self, CompareError> {
        let mut model = Model::build(source, Some(samples.inputs.clone()))?;
        let markers = markers(&model)?;
        model.system.set_time(samples.rest);
        if markers.iter().any(|marker| marker.datum == Datum::Rest) {
            let options = model.solver.steady_options();
            let mut solver =
                SteadySolver::new(&mut model.system, options).map_err(RunError::from)?;
            solver
                .advance(&mut model.system, samples.rest)
                .map_err(RunError::from)?;
        }
        let rest = [0, 1].map(|b| pose(&model, &markers[b], None));
        Ok(Self {
            model,
            points: Points { markers, rest },
        })
    }

    /// Whether it depends on what was passed on the way.
    #[must_use]
    pub fn remembers(&self) -> bool {
        self.model.system.remembers()
    }
}

/// A scenario that is solved under the motor angles of a recording.
pub struct Run<'a> {
    guide: Option<&'a Guide>,
    shown: Shown,
    solver: SteadySolver,
    /// The state at rest.
    rest: Saved,
    /// Evaluations that are left.
    left: usize,
    /// Whether rows between samples must be passed, since a law remembers them.
    remembers: bool,
}

/// States of all samples, from which others are found faster.
pub type Guide = Vec<Saved>;

impl<'a> Run<'a> {
    /// Builds the scenario and finds its rest. With a guide, states that are hard to find are given up early; without, it
    /// takes as long as it takes.
    ///
    /// # Errors
    /// If the scenario can't be built or has no rest.
    pub fn new(
        source: &Source,
        samples: &Samples,
        guide: Option<&'a Guide>,
    ) -> Result<Self, CompareError> {
        let (left, smallest) = match guide {
            Some(_) => (EVALUATIONS * samples.list.len(), SMALLEST),
            None => (usize::MAX / 2, 0.0),
        };
        let mut shown = Shown::new(source, samples)?;
        let system = &mut shown.model.system;
        let mut options = shown.model.solver.steady_options();
        options.smallest_increment = options.smallest_increment.max(smallest);
        let mut solver = SteadySolver::new(system, options).map_err(RunError::from)?;
        solver
            .advance(system, samples.rest)
            .map_err(RunError::from)?;
        let rest = system.save();
        let remembers = system.remembers();
        let mut run = Self {
            guide,
            shown,
            solver,
            rest,
            left,
            remembers: false,
        };
        run.remember(remembers, samples);
        Ok(run)
    }

    fn remember(&mut self, remembers: bool, samples: &Samples) {
        if remembers && !self.remembers {
            self.remembers = true;
            self.left += EVALUATIONS * samples.passed.len();
        }
    }

    /// Goes to sample `i`, past all that must be passed on the way there, at each of which `passed` is called.
    fn go(
        &mut self,
        samples: &Samples,
        i: usize,
        mut passed: impl FnMut(&mut SteadySolver, &mut System) -> Result<(), RunError>,
    ) -> Result<(), CompareError> {
        if self.remembers {
            for time in samples.on_the_way(i) {
                let system = &mut self.shown.model.system;
                let report = self.solver.advance(system, *time).map_err(RunError::from)?;
                self.spend(report.evaluations, *time)?;
                passed(&mut self.solver, &mut self.shown.model.system)?;
            }
        }
        self.arrive(samples, i)
    }

    /// Goes to sample `i` at once, by way of the guide's state if there is one.
    fn arrive(&mut self, samples: &Samples, i: usize) -> Result<(), CompareError> {
        let time = samples.list[i].time;
        let before = self.shown.model.system.save();
        // from the guide's state, or from the sample before, or from rest
        let starts = match self.guide {
            Some(guide) => [guide[i].clone(), before.clone()],
            None => [before.clone(), self.rest.clone()],
        };
        let mut last = None;
        for start in starts {
            let system = &mut self.shown.model.system;
            self.solver.pose_as(system, &start);
            match self.solver.advance(system, time) {
                Ok(report) => return self.spend(report.evaluations, time),
                Err(e) => last = Some(e),
            }
            system.restore(&before);
            self.spend(FAILURE, time)?;
        }
        Err(RunError::from(last.expect("there is a start")).into())
    }

    fn spend(&mut self, evaluations: usize, time: f64) -> Result<(), CompareError> {
        self.left = self.left.checked_sub(evaluations).ok_or_else(|| {
            CompareError::Unfit(format!(
                "up to t = {time:.2} s its steady states took more than {EVALUATIONS} evaluations each"
            ))
        })?;
        Ok(())
    }

    /// What `read` finds at every sample.
    ///
    /// # Errors
    /// If a sample has no steady state.
    fn all<T>(
        &mut self,
        samples: &Samples,
        read: impl Fn(&Shown, usize) -> T,
    ) -> Result<Vec<T>, CompareError> {
        let each = (0..samples.list.len()).map(|i| {
            self.go(samples, i, |_, _| Ok(()))?;
            Ok(read(&self.shown, i))
        });
        each.collect()
    }

    /// Whitened residuals, derivatives by numbers of which `pairs` has the steps and the models with larger and smaller
    /// ones, and the states.
    ///
    /// # Errors
    /// If a sample has no steady state, or a singular one, or once the residuals' squares are more than `most`.
    pub fn derivatives(
        &mut self,
        samples: &Samples,
        pairs: Vec<(f64, [Shown; 2])>,
        most: f64,
    ) -> Result<(Vec<f64>, DMatrix<f64>, Guide), CompareError> {
        let runs = || pairs.iter().flat_map(|(_, runs)| runs);
        self.remember(runs().any(Shown::remembers), samples);
        let points: Vec<_> = runs().map(|run| run.points.clone()).collect();
        let columns = pairs.len();
        let models = pairs
            .into_iter()
            .map(|(step, [a, b])| (step, [a.model, b.model]));
        let mut sensitivities = Sensitivities::between(models.collect());
        let (mut residuals, mut states) = (Vec::new(), Vec::new());
        let mut rows: Vec<f64> = Vec::new();
        let mut left = most;
        for (i, sample) in samples.list.iter().enumerate() {
            // the models with larger and smaller numbers remember, too
            self.go(samples, i, |solver, system| {
                sensitivities.at(solver, system, &|_| vec![])?;
                Ok(())
            })?;
            let shown = &self.shown;
            let white = samples.whiten(i, difference(&shown.model, &shown.points, samples, i));
            left -= white.iter().map(|r| r * r).sum::<f64>();
            if left < 0.0 {
                return Err(CompareError::Unfit(format!(
                    "up to t = {:.2} s it is worse than what was there before",
                    sample.time
                )));
            }
            residuals.extend(white);
            let call = std::cell::Cell::new(0);
            let outputs = |model: &Model| {
                let points = &points[call.replace(call.get() + 1)];
                samples
                    .whiten(i, difference(model, points, samples, i))
                    .to_vec()
            };
            let slopes = sensitivities
                .at(&mut self.solver, &mut self.shown.model.system, &outputs)
                .map_err(RunError::from)?;
            rows.extend(slopes.transpose().iter());
            states.push(self.shown.model.system.save());
        }
        let rows = DMatrix::from_row_slice(residuals.len(), columns, &rows);
        Ok((residuals, rows, states))
    }
}

/// Times \[s\] of set-points at which a scenario isn't stable, and how many set-points there are.
///
/// # Errors
/// If the scenario can't be built, or a sample has no steady state.
pub fn unstable(source: &Source, samples: &Samples) -> Result<(Vec<f64>, usize), CompareError> {
    let mut run = Run::new(source, samples, None)?;
    let (mut times, mut all) = (Vec::new(), 0);
    for (i, sample) in samples.list.iter().enumerate() {
        run.go(samples, i, |_, _| Ok(()))?;
        if sample.phase == Phase::Settled {
            all += 1;
            let stability = run.solver.stability(&mut run.shown.model.system);
            if !stability.is_ok_and(|s| s.is_stable()) {
                times.push(sample.time);
            }
        }
    }
    Ok((times, all))
}

/// Simulated less recorded at one sample: positions \[m\], rotation vectors \[rad\], in the base frame.
fn difference(model: &Model, points: &Points, samples: &Samples, i: usize) -> [f64; CHANNELS] {
    let Points { markers, rest } = points;
    let recorded = [&samples.reference.platform, &samples.reference.ring];
    let sample = &samples.list[i];
    let mut all = [0.0; CHANNELS];
    for b in [0, 1] {
        let now = pose(model, &markers[b], None);
        let shown = match markers[b].datum {
            Datum::Body => now,
            Datum::Rest => {
                let turn = now.rotation * rest[b].rotation.inverse();
                let lever = recorded[b].translation.vector - rest[b].translation.vector;
                let point = now.translation.vector + turn * lever;
                Pose::from_parts(point.into(), turn * recorded[b].rotation)
            }
        };
        let apart = shown.translation.vector - sample.poses[b].translation.vector;
        let turn = (shown.rotation * sample.poses[b].rotation.inverse()).scaled_axis();
        all[6 * b..6 * b + 3].copy_from_slice(apart.as_slice());
        all[6 * b + 3..6 * b + 6].copy_from_slice(turn.as_slice());
    }
    all
}

/// Simulated less recorded at every sample, `CHANNELS` numbers each, however long it takes.
///
/// # Errors
/// If the scenario can't be built, or a sample has no steady state.
pub fn differences(source: &Source, samples: &Samples) -> Result<Vec<f64>, CompareError> {
    let apart = |shown: &Shown, i| difference(&shown.model, &shown.points, samples, i);
    let each = Run::new(source, samples, None)?.all(samples, apart)?;
    Ok(each.into_iter().flatten().collect())
}

/// Torques with which the motors turn the rods \[N m\] at every sample, however long it takes.
///
/// # Errors
/// If the scenario can't be built, or a sample has no steady state.
pub fn torques(source: &Source, samples: &Samples) -> Result<Vec<[f64; 4]>, CompareError> {
    Run::new(source, samples, None)?.all(samples, |shown, _| shown.model.motor_torques())
}

/// Residuals of a recording in standard deviations.
pub fn whitened(differences: &[f64], samples: &Samples) -> Vec<f64> {
    let each = differences.as_chunks().0.iter().enumerate();
    each.flat_map(|(i, values)| samples.whiten(i, *values))
        .collect()
}

impl Samples {
    /// Residuals of sample `i` in standard deviations.
    fn whiten(&self, i: usize, mut values: [f64; CHANNELS]) -> [f64; CHANNELS] {
        let sample = &self.list[i];
        for (c, value) in values.iter_mut().enumerate() {
            let (body, kind) = (c / 6, c / 3);
            let deviation = if kind % 2 == 0 {
                sample.position_deviation[body].hypot(NUMERICS.0)
            } else {
                sample.rotation_deviation[body].hypot(NUMERICS.1)
            };
            *value /= self.wider[kind] * deviation;
        }
        values
    }
}

/// Root mean squares over settled samples of the platform's distance \[mm\] and rotation \[mrad\].
pub fn platform_rms(differences: &[f64], samples: &Samples) -> (f64, f64) {
    let settled = samples.list.iter().zip(differences.chunks_exact(CHANNELS));
    let settled: Vec<_> = settled.filter(|(s, _)| s.phase != Phase::Moving).collect();
    let rms = |from: usize| {
        let squares = settled
            .iter()
            .map(|(_, d)| d[from..from + 3].iter().map(|x| x * x).sum::<f64>());
        1e3 * (squares.sum::<f64>() / settled.len() as f64).sqrt()
    };
    (rms(0), rms(3))
}
