//! Derivatives of steady states with respect to numbers of their scenario, by implicit differentiation.
//!
//! At a steady state the loads `R(z, p) = 0` in the free displacements `z` for every value of a number `p`, so
//! `J dz/dp = -dR/dp` with the tangent matrix `J = dR/dz`. `dR/dp` is the central difference of two scenarios in which
//! the number is a little larger and a little smaller, at the same free displacements: whatever it changes (geometry as
//! built, what joints and clamps remember of it, boundary values, inputs) is in it. Outputs are differences of the same
//! two scenarios, a little forth and back along `dz/dp`.

use super::path::{Poses, hold};
use super::{NotSteady, SteadyReport, SteadySolver};
use crate::inputs::Inputs;
use crate::scenario::Model;
use crate::system::System;
use crate::varied::{self, Varied};
use auxetica_config::{Problems, Source};
use nalgebra::DMatrix;

/// Derivatives of a scenario's steady states with respect to some of its numbers.
pub struct Sensitivities {
    parameters: Vec<Varied>,
}

impl Sensitivities {
    /// Prepares derivatives with respect to the numbers at `paths`, which are those of `--set`; a path that means
    /// several places is one parameter, the value that all of them have. `inputs` are those that the scenario was
    /// built with.
    ///
    /// # Errors
    /// If a path means no number, or different ones, or one that can't be varied: a count, or a number at the end of
    /// what is allowed.
    pub fn new(source: &Source, inputs: Option<&Inputs>, paths: &[&str]) -> Result<Self, Problems> {
        let parameters = Varied::all(source, inputs, paths)?;
        Ok(Self { parameters })
    }

    /// Derivatives with respect to any change of a scenario: for each, a step and the models in which the number is
    /// larger and smaller by that step. All have the bodies of the model that is solved.
    pub fn between(pairs: Vec<(f64, [Model; 2])>) -> Self {
        let parameters = pairs.into_iter();
        let parameters = parameters.map(|(step, models)| Varied { step, models });
        Self {
            parameters: parameters.collect(),
        }
    }

    /// Derivatives of `outputs` (rows) with respect to the parameters (columns, in the order of the paths) at the
    /// steady state of `system` that `solver` has found. `outputs` reads what it likes of a model at a steady state:
    /// positions, frames, strains, forces and couples are those of an evaluation there.
    ///
    /// # Errors
    /// If the state is singular, as at a limit point.
    pub fn at(
        &mut self,
        solver: &mut SteadySolver,
        system: &mut System,
        outputs: &dyn Fn(&Model) -> Vec<f64>,
    ) -> Result<DMatrix<f64>, NotSteady> {
        let time = system.time;
        let fail = |reason| NotSteady { time, reason };
        let mut report = SteadyReport::default();
        // laws had not remembered the state yet when it was sought
        system.swap_memory(&mut solver.memory);
        let factorised = solver.factorise(system, &mut report);
        system.swap_memory(&mut solver.memory);
        factorised.map_err(fail)?;
        let here = Poses::of(system);
        let columns = self.parameters.iter_mut().map(|parameter| {
            let change = parameter.change(solver, &here, time).map_err(fail)?;
            Ok(parameter.outputs(solver, &here, &change, outputs))
        });
        let columns = columns.collect::<Result<Vec<Vec<f64>>, _>>()?;
        Ok(varied::matrix(&columns))
    }
}

impl Varied {
    /// Displacements of all stations for a unit of the parameter.
    fn change(
        &mut self,
        solver: &SteadySolver,
        here: &Poses,
        time: f64,
    ) -> Result<Vec<f64>, String> {
        let size = solver.loads.len();
        let (mut change, mut moves) = (vec![0.0; size], vec![0.0; size]);
        for (model, sign) in self.models.iter_mut().zip([1.0, -1.0]) {
            let system = &mut model.system;
            here.set(system);
            system.time = time;
            hold(system);
            let share = sign / (2.0 * self.step);
            let moved = here.moves(&Poses::of(system), solver.unknowns.scale);
            system.evaluate();
            let mut loads = vec![0.0; size];
            solver.unknowns.read_loads(&system.groups, &mut loads);
            for i in 0..size {
                moves[i] += moved[i] * share;
                change[i] -= loads[i] * share;
            }
        }
        solver.freedom.project(&mut change);
        if !solver.tangent.solve(&mut change) {
            return Err(
                "the tangent matrix is singular, so the state has no derivatives; go on a little"
                    .into(),
            );
        }
        change.iter_mut().zip(moves).for_each(|(c, m)| *c += m);
        Ok(change)
    }

    /// Derivatives of the outputs along `change`.
    fn outputs(
        &mut self,
        solver: &SteadySolver,
        here: &Poses,
        change: &[f64],
        outputs: &dyn Fn(&Model) -> Vec<f64>,
    ) -> Vec<f64> {
        let [more, less] = &mut self.models;
        let values = |model: &mut Model, step: f64| {
            let system = &mut model.system;
            here.set(system);
            let change: Vec<f64> = change.iter().map(|c| c * step).collect();
            solver.unknowns.displace_all(&mut system.groups, &change);
            hold(system);
            system.evaluate();
            // what laws remember depends on the number, too
            system.remember();
            outputs(model)
        };
        let (forth, back) = (values(more, self.step), values(less, -self.step));
        self.slopes(&forth, &back)
    }
}
