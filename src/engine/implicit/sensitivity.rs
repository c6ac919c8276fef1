//! Derivatives of a motion with respect to numbers of its scenario, forward in time.
//!
//! For each number two neighbours move beside the system, in whose scenarios it is a little larger and smaller. At the end
//! of a step they take its poses, what is held where they hold it, and their residuals `R` there differ by what the number
//! does to loads and by what it has done so far to rates, accelerations and memory. Poses move apart, as far to one side as
//! to the other, until residuals no longer differ; corrections are those of the system's own tangent matrix. So a step costs
//! a factorisation beside its own, and some evaluations a number. Damping is known by a difference of rates that nearly
//! cancel, so derivatives by its own numbers may be off by some 1e-3 where they are small.

use super::motion::Motion;
use super::{ImplicitSolver, NoStep};
use crate::inputs::Inputs;
use crate::scenario::Model;
use crate::system::System;
use crate::varied::{self, Varied};
use auxetica_config::{Problems, Source};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Share of the first correction below which another adds nothing, and how many may follow it.
const SMALL: f64 = 1e-7;
const CORRECTIONS: usize = 20;
/// Corrections that rounding may make: rotations \[rad\], and displacements in element lengths.
const ROUNDING: f64 = 1e-10;
const ASTRAY: &str = "corrections of its derivatives don't shrink";

/// Derivatives of a scenario's motion with respect to some of its numbers.
pub struct MotionSensitivities {
    parameters: Vec<Parameter>,
}

/// A number, and the motions of the scenarios in which it is larger and smaller.
struct Parameter {
    number: Varied,
    motions: [Motion; 2],
}

impl MotionSensitivities {
    /// Prepares derivatives with respect to the numbers at `paths`, which are those of `--set`; a path that means
    /// several places is one parameter, the value that all of them have. `inputs` are those that the scenario was
    /// built with. Neighbours begin as the scenario does, so `solver` has made no step yet.
    ///
    /// # Errors
    /// If a path means no number, or different ones, or one that can't be varied: a count, or a number at the end of
    /// what is allowed.
    pub fn new(
        solver: &ImplicitSolver,
        source: &Source,
        inputs: Option<&Inputs>,
        paths: &[&str],
    ) -> Result<Self, Problems> {
        let parameter = |mut number: Varied| {
            let motions = number.models.each_mut().map(|model| {
                model.system.apply_boundaries();
                let mut motion = solver.motion.of(&mut model.system);
                motion.begin(&model.system);
                motion
            });
            Parameter { number, motions }
        };
        let numbers = Varied::all(source, inputs, paths)?;
        let parameters = numbers.into_iter().map(parameter).collect();
        Ok(Self { parameters })
    }

    /// Moves the system to `time` \[s\] as [`ImplicitSolver::advance`] does, and the derivatives with it.
    ///
    /// # Errors
    /// If the system can't be moved, or a state on the way is singular. The system is left where the last step has
    /// brought it.
    pub fn advance(
        &mut self,
        solver: &mut ImplicitSolver,
        system: &mut System,
        time: f64,
    ) -> Result<(), NoStep> {
        solver.advance_with(system, time, &mut |solver, system, h| {
            solver.motion.find_residual(system);
            solver.factorise(system, h)?;
            // only when all have been found does the past change: a step that fails is tried again from there
            let parameters = &mut self.parameters;
            (parameters.par_iter_mut()).try_for_each(|p| p.follow(solver, system, h))?;
            parameters.iter_mut().for_each(|p| p.end(h));
            Ok(())
        })
    }

    /// Derivatives of `outputs` (rows) with respect to the parameters (columns, in the order of the paths) at the present
    /// time. `outputs` reads what it likes of a model in motion: poses, rates, strains, forces and couples.
    pub fn of(&mut self, outputs: &dyn Fn(&Model) -> Vec<f64>) -> DMatrix<f64> {
        let columns = self.parameters.iter_mut().map(|Parameter { number, .. }| {
            let [more, less] = number.models.each_mut().map(|model| {
                model.system.evaluate();
                outputs(model)
            });
            number.slopes(&more, &less)
        });
        varied::matrix(&columns.collect::<Vec<_>>())
    }
}

impl Parameter {
    /// Neighbours at the end of a step of `h` that has led the system to its present poses.
    fn follow(&mut self, solver: &ImplicitSolver, system: &System, h: f64) -> Result<(), String> {
        for model in &mut self.number.models {
            let neighbour = &mut model.system;
            for (group, to) in neighbour.groups.iter_mut().zip(&system.groups) {
                group.bodies.state.pose_as(&to.bodies.state);
            }
            neighbour.time = system.time;
            neighbour.set_values();
        }
        let first = self.correct(solver, h)?;
        let mut last = first;
        for _ in 0..CORRECTIONS {
            let size = self.correct(solver, h)?;
            if size <= SMALL * first {
                return Ok(());
            }
            if size > 0.5 * last {
                // as small as rounding lets it be, or no use
                return (size <= ROUNDING).then_some(()).ok_or(ASTRAY.into());
            }
            last = size;
        }
        Err(ASTRAY.into())
    }

    /// Moves poses apart so that residuals differ less. Returns the largest move.
    fn correct(&mut self, solver: &ImplicitSolver, h: f64) -> Result<f64, String> {
        for (model, motion) in self.number.models.iter_mut().zip(&mut self.motions) {
            motion.follow(&mut model.system, h);
            motion.find_residual(&mut model.system);
        }
        let [more, less] = &mut self.motions;
        let residuals = more.residual.iter().zip(&less.residual);
        for (change, (m, l)) in more.change.iter_mut().zip(residuals) {
            *change = (l - m) / 2.0;
        }
        solver.motion.freedom.project(&mut more.change);
        if !solver.tangent.solve(&mut more.change) {
            return Err("the tangent matrix is singular, so the motion has no derivatives".into());
        }
        for (back, forth) in less.change.iter_mut().zip(&more.change) {
            *back = -forth;
        }
        for (model, motion) in self.number.models.iter_mut().zip(&mut self.motions) {
            let groups = &mut model.system.groups;
            motion.unknowns.displace_all(groups, &motion.change);
        }
        let [more, _] = &self.motions;
        Ok(more.change.iter().fold(0.0, |size, c| c.abs().max(size)))
    }

    /// What was found becomes the past.
    fn end(&mut self, h: f64) {
        for (model, motion) in self.number.models.iter_mut().zip(&mut self.motions) {
            motion.follow(&mut model.system, h);
            if model.system.remembers() {
                model.system.evaluate();
                model.system.remember();
            }
            motion.end();
            motion.begin(&model.system);
        }
    }
}
