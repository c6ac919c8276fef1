//! Steady states by Newton's method on all bodies at once, followed through time.
//!
//! A steady state at a time is an equilibrium under that time's loads and boundary values. It is reached from the
//! present one by continuation: boundary values move, and what was out of balance fades, in as few increments as
//! Newton's method converges for. Equilibria needn't be unique; this follows the branch that it stands on, if asked to past
//! limit points, too (`arc`), or leaves it for a stable one (`settle`).

mod arc;
mod block_lu;
pub(crate) mod diagnosis;
mod path;
mod sensitivity;
mod settle;
mod stability;
pub(crate) mod tangent;
pub(crate) mod unknowns;

use crate::group::Group;
use crate::system::{Saved, System};
use path::{Path, Poses};
pub use sensitivity::Sensitivities;
pub use stability::Stability;
use tangent::Tangent;
use unknowns::{Freedom, PER_STATION, Unknowns};

/// How steady states are sought.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyOptions {
    /// Last Newton correction that is accepted: rotations \[rad\], and displacements in element lengths.
    pub tolerance: f64,
    /// Newton iterations an increment may take.
    pub iterations: usize,
    /// Smallest increment before giving up, as a fraction of the way.
    pub smallest_increment: f64,
    /// Which of several equilibria is sought.
    pub branch: Branch,
}

/// Which of several equilibria is sought. Serialised by its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
pub enum Branch {
    /// The one that leads on from the present state, stable or not, up to where there is none nearby (a limit point).
    #[default]
    Followed,
    /// The same, past limit points along the path of equilibria, back and on again (arc length).
    PastLimits,
    /// A stable one: where the branch ends or isn't stable, the system is let go and comes to rest on another.
    Stable,
}

impl Default for SteadyOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            iterations: 25,
            smallest_increment: 1e-4,
            branch: Branch::Followed,
        }
    }
}

/// What it took to find a steady state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteadyReport {
    /// Newton iterations.
    pub iterations: usize,
    /// Increments of the continuation.
    pub increments: usize,
    /// Tangent matrices that were found and factorised; iterations share them while they contract well.
    pub factorisations: usize,
    /// Evaluations of all loads, those of the tangent matrices included and those of motions to rest left out.
    pub evaluations: usize,
    /// Times that the system was let go and came to rest on another branch.
    pub settled: usize,
    /// Largest force \[N\] left out of balance (torques are divided by the mean element length).
    pub residual: f64,
}

/// No steady state was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("no steady state was found at t = {time} s: {reason}")]
pub struct NotSteady {
    /// Time \[s\].
    pub time: f64,
    /// Why, and what to try.
    pub reason: String,
}

/// Largest rotation \[rad\] of boundary values in one increment of time.
const LARGEST_TURN: f64 = 1.0;
/// Factor by which each correction must at least shrink.
const CONTRACTION: f64 = 0.5;
/// Corrections below this stay on the branch, whatever their ratio: a law's kink may cost one that doesn't shrink.
const HARMLESS: f64 = 0.02;
/// Iterations that take as long as finding a tangent: one of an earlier state is kept if it promises to end in as many.
const WORTH: usize = 18;
/// Share of the tolerance that the last correction must stay below if it is that of an earlier state's tangent.
const REMAINDER: f64 = 0.01;
/// How far stations may move for a tangent to be kept.
const NEAR: f64 = 0.1;

/// Motion that shows whether the tangent is that of the path beyond: so small that only a kink leaves much to correct.
const GLIMPSE: f64 = 1e-5;
/// Correction that is left after it, as a share of it, at a kink.
const ASTRAY: f64 = 0.04;
/// Second correction, as a share of the first, that increments are made for: it grows with the increment.
const GOOD: f64 = 0.2;
/// Factor by which increments may grow at once.
const FASTEST: f64 = 64.0;
/// Increment below which the path is taken to turn back, if it may.
const TURNING: f64 = 0.02;
/// Share of an increment by which the path's tangent is found.
const DIFFERENCE: f64 = 1e-4;

/// How large a correction is.
#[derive(Default)]
struct Size {
    /// Largest rotation \[rad\], or displacement in element lengths.
    largest: f64,
    /// Largest rotation \[rad\], or displacement in lengths of the longest rod, so that it doesn't depend on how finely
    /// rods are cut.
    motion: f64,
}

/// What an increment of the path has shown.
#[derive(Default)]
struct Trial {
    /// Motion of the first correction, which follows the path's tangent.
    first: f64,
    /// Motion of the second correction as a share of it.
    ratio: f64,
    /// Whether stations have moved.
    begun: bool,
}

/// Finds and follows steady states of one system.
pub struct SteadySolver {
    options: SteadyOptions,
    unknowns: Unknowns,
    freedom: Freedom,
    tangent: Tangent,
    /// How far stations have moved since the factors were found, if there are any.
    moved: Option<f64>,
    /// What laws remembered when the present state was sought.
    memory: Vec<Vec<f64>>,
    loads: Vec<f64>,
    change: Vec<f64>,
}

impl SteadySolver {
    /// Prepares for a system; its rates are set to zero.
    pub fn new(system: &mut System, options: SteadyOptions) -> Result<Self, NotSteady> {
        let time = system.time;
        let fail = |reason| NotSteady { time, reason };
        let unknowns = Unknowns::of(system);
        let freedom = Freedom::of(system, &unknowns).map_err(fail)?;
        let reach = unknowns.reach(system);
        let size = unknowns.stations * PER_STATION;
        Ok(Self {
            options,
            tangent: Tangent::new(system, &unknowns, reach),
            unknowns,
            freedom,
            moved: None,
            memory: system.memory(),
            loads: vec![0.0; size],
            change: vec![0.0; size],
        })
    }

    /// Poses the system as a state that another of the same bodies has saved, with what is held at its own boundary values
    /// of that time; what rod laws remember stays. [`Self::advance`] then has a good guess.
    pub fn pose_as(&mut self, system: &mut System, saved: &Saved) {
        system.pose_as(saved);
        self.moved = None;
    }

    /// Moves the system to its steady state at `time` \[s\], from its present state. On failure the system is left
    /// where it was.
    pub fn advance(&mut self, system: &mut System, time: f64) -> Result<SteadyReport, NotSteady> {
        let mut report = SteadyReport::default();
        let start = Poses::of(system);
        let start_time = system.time;
        loop {
            let from = system.time;
            let mut to = time;
            let mut whole = true;
            while path::largest_turn(system, to, &self.unknowns) > LARGEST_TURN
                && (to - from).abs() > 1e-6 * (time - start_time).abs()
            {
                to = from + (to - from) / 2.0;
                whole = false;
            }
            if let Err(reason) = self.increments(system, to, &mut report) {
                start.set(system);
                self.moved = None;
                system.time = start_time;
                return Err(NotSteady { time: to, reason });
            }
            self.memory = system.memory();
            system.remember();
            if whole {
                return Ok(report);
            }
        }
    }

    /// From the present state to `time` by growing or shrinking increments of boundary values and imbalance.
    fn increments(
        &mut self,
        system: &mut System,
        time: f64,
        report: &mut SteadyReport,
    ) -> Result<(), String> {
        let target = path::held_at(system, time);
        system.time = time;
        self.find_imbalance(system, report);
        let path = Path::new(system, target, self.loads.clone(), &self.unknowns);
        let smallest = self.options.smallest_increment;
        let (mut done, mut increment, mut limit) = (0.0, 1.0_f64, 1.0_f64);
        // whether the last increment has shown a kink where it begins
        let mut kink = false;
        while done < 1.0 {
            let good = Poses::of(system);
            increment = increment.min(limit).min(1.0 - done);
            let to = if increment < 1.0 - done {
                done + increment
            } else {
                1.0
            };
            let mut trial = Trial::default();
            match self.newton(system, &path, (done, to), &mut trial, report) {
                Ok(()) => {
                    report.increments += 1;
                    done = to;
                    limit = limit.max(2.0 * increment);
                    // never less than what is given up at, or the end is never reached
                    let factor = if std::mem::take(&mut kink) {
                        // neither the tangent there nor how well it did tells anything of the path beyond
                        self.moved = None;
                        FASTEST
                    } else {
                        (GOOD / trial.ratio).clamp(0.5, FASTEST)
                    };
                    increment = (increment * factor).max(smallest);
                }
                Err(reason) => {
                    good.set(system);
                    kink = !trial.begun;
                    if trial.begun {
                        self.moved = None;
                    }
                    // as small as is harmless, since it may stand at a law's kink; it grows fast
                    let harmless = HARMLESS / 2.0 / trial.first;
                    limit = increment / 2.0;
                    match self.options.branch {
                        Branch::PastLimits if limit < TURNING => {
                            self.follow(system, &path, done, report)?;
                            break;
                        }
                        Branch::Stable if limit < TURNING => {
                            self.fall(system, &path, done, report)?;
                            break;
                        }
                        _ if limit < smallest => {
                            return Err(self.unheld(system).unwrap_or(reason));
                        }
                        _ => {}
                    }
                    increment = (increment * harmless.min(0.5)).max(smallest);
                }
            }
        }
        if self.options.branch == Branch::Stable {
            self.stabilise(system, &path, report)?;
        }
        self.find_imbalance(system, report);
        let largest = self.loads.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        report.residual = largest / self.unknowns.scale;
        Ok(())
    }

    /// Newton's method from the equilibrium at the first share of the path to the one at the second.
    fn newton(
        &mut self,
        system: &mut System,
        path: &Path,
        (from, to): (f64, f64),
        trial: &mut Trial,
        report: &mut SteadyReport,
    ) -> Result<(), String> {
        let mut last = f64::INFINITY;
        for iteration in 1..=self.options.iterations {
            report.iterations += 1;
            // The first step follows the tangent of the path; it takes held stations and walls there.
            let ahead = if iteration == 1 { to - from } else { 0.0 };
            self.find_imbalance(system, report);
            if !self.loads.iter().all(|v| v.is_finite()) {
                return Err(diagnosis::not_finite(system));
            }
            if ahead > 0.0 {
                let turning = self.turning_walls(system, path, (from, ahead), report);
                self.loads
                    .iter_mut()
                    .zip(turning)
                    .for_each(|(l, t)| *l += t);
            }
            if self.moved.is_none_or(|moved| moved > NEAR) {
                self.factorise(system, report)?;
            }
            let mut size = self.correction(path, ahead, to)?;
            let outworn = if iteration == 1 {
                size.motion > HARMLESS && self.strays(system, path, (from, to), &size, report)?
            } else {
                // whether what shrinks like this is still too large when a new tangent would have brought it to an end
                let left = WORTH.min(self.options.iterations - iteration);
                let shrunk = (size.motion / last).powi(left as i32);
                shrunk * size.motion > self.options.tolerance * REMAINDER
            };
            if outworn && self.moved > Some(0.0) {
                self.factorise(system, report)?;
                size = self.correction(path, ahead, to)?;
            } else if outworn && iteration == 1 {
                trial.first = size.motion;
                break;
            }
            if iteration == 1 {
                path.turn_walls(system, to);
            }
            match iteration {
                1 => trial.first = size.motion,
                2 => trial.ratio = size.motion / trial.first,
                _ => {}
            }
            // Corrections that don't shrink fast may end on another branch than the one that is followed.
            if size.motion > CONTRACTION * last && size.motion > HARMLESS {
                break;
            }
            last = size.motion;
            let accepted = match self.moved > Some(0.0) {
                true => self.options.tolerance * REMAINDER,
                false => self.options.tolerance,
            };
            self.unknowns.displace_all(&mut system.groups, &self.change);
            trial.begun = true;
            self.moved = self.moved.map(|moved| moved + size.motion);
            if size.largest < accepted {
                return Ok(());
            }
        }
        Err("Newton's method didn't converge, however small the increment; follow the load from a smaller one \
             (ramps, closer times), or set `solver.branch` to `PastLimits` or `Stable` to go on past a limit point"
            .into())
    }

    /// How the loads change, to first order, as walls turn by a share of the path from one share of it on. Walls and loads
    /// stay.
    fn turning_walls(
        &mut self,
        system: &mut System,
        path: &Path,
        (from, ahead): (f64, f64),
        report: &mut SteadyReport,
    ) -> Vec<f64> {
        let still = self.loads.clone();
        path.turn_walls(system, from + DIFFERENCE * ahead);
        self.find_imbalance(system, report);
        path.turn_walls(system, from);
        let turned = std::mem::replace(&mut self.loads, still);
        let changes = turned.iter().zip(&self.loads);
        changes.map(|(t, s)| (t - s) / DIFFERENCE).collect()
    }

    /// Whether already a glimpse of the first correction leaves much to correct. Poses, loads and the correction stay.
    fn strays(
        &mut self,
        system: &mut System,
        path: &Path,
        (from, to): (f64, f64),
        first: &Size,
        report: &mut SteadyReport,
    ) -> Result<bool, String> {
        let share = GLIMPSE / first.motion;
        let there = from + share * (to - from);
        let here = Poses::of(system);
        let kept = (self.change.clone(), self.loads.clone());
        self.change.iter_mut().for_each(|change| *change *= share);
        self.unknowns.displace_all(&mut system.groups, &self.change);
        path.turn_walls(system, there);
        self.find_imbalance(system, report);
        let second = self.correction(path, 0.0, there);
        here.set(system);
        (self.change, self.loads) = kept;
        Ok(second?.motion > ASTRAY * GLIMPSE)
    }

    /// Solves for the displacements of all stations towards equilibrium at the share `to` of the path, of which held
    /// stations go the share `ahead`.
    fn correction(&mut self, path: &Path, ahead: f64, to: f64) -> Result<Size, String> {
        for (i, change) in self.change.iter_mut().enumerate() {
            *change = ahead * path.moves[i] + (1.0 - to) * path.imbalance[i] - self.loads[i];
        }
        if !self.tangent.solve(&mut self.change) {
            return Err("the tangent matrix is singular: something can move without resistance; hold it with a \
                        boundary condition or a joint"
                .into());
        }
        Ok(self.size(&self.change))
    }

    fn size(&self, change: &[f64]) -> Size {
        let mut size = Size::default();
        for station in change.chunks_exact(PER_STATION) {
            let [shift, turn] = [&station[..3], &station[3..]]
                .map(|part| part.iter().fold(0.0_f64, |m, v| m.max(v.abs())));
            size.largest = size.largest.max(shift).max(turn);
            size.motion = size.motion.max(shift / self.unknowns.longest).max(turn);
        }
        size
    }

    /// The tangent matrix of the present state and its factors.
    fn factorise(&mut self, system: &mut System, report: &mut SteadyReport) -> Result<(), String> {
        self.tangent.fill(system, &self.unknowns, Group::loads, 0.0);
        report.evaluations += self.tangent.evaluations();
        if let Some(station) = self.tangent.not_finite() {
            self.moved = None;
            return Err(diagnosis::no_derivative(system, &self.unknowns, station));
        }
        self.tangent.factorise(&self.freedom);
        report.factorisations += 1;
        self.moved = Some(0.0);
        Ok(())
    }

    /// Bodies that nothing holds, in words.
    fn unheld(&mut self, system: &mut System) -> Option<String> {
        self.tangent.fill(system, &self.unknowns, Group::loads, 0.0);
        diagnosis::unheld(system, &self.unknowns, &self.freedom, &self.tangent)
    }

    /// Loads in free directions, as the right-hand side takes them.
    fn find_imbalance(&mut self, system: &mut System, report: &mut SteadyReport) {
        system.evaluate();
        report.evaluations += 1;
        self.unknowns.read_loads(&system.groups, &mut self.loads);
        self.freedom.project(&mut self.loads);
    }
}
