//! Past limit points: where the path of equilibria turns back, it is followed by its own length.
//!
//! Poses and the share of the way are then sought together: corrections are normal to the step (Riks), and each step goes
//! on as the last one went, whichever way its share changes.

use super::path::{Path, Poses};
use super::unknowns::PER_STATION;
use super::{CONTRACTION, HARMLESS, SteadyReport, SteadySolver, Trial};
use crate::system::System;

/// Motion of the longest step.
const LONGEST: f64 = 0.2;
/// Motion of a step before giving up.
const SHORTEST: f64 = 1e-6;
/// Steps before giving up.
const STEPS: usize = 1000;
/// Corrections that a step may take.
const CORRECTIONS: usize = 8;

impl SteadySolver {
    /// From the equilibrium at a share of the path along it to where the share is first 1.
    pub(super) fn follow(
        &mut self,
        system: &mut System,
        path: &Path,
        mut share: f64,
        report: &mut SteadyReport,
    ) -> Result<(), String> {
        let mut length = HARMLESS;
        let mut last: Option<Vec<f64>> = None;
        for _ in 0..STEPS {
            let good = Poses::of(system);
            let tangent = self.tangent_of(system, path, share, report)?;
            let onwards = last.as_ref().map_or(1.0, |last| self.dot(last, &tangent));
            let step = (length / self.size(&tangent).motion).copysign(onwards);
            let end = share + step >= 1.0;
            let reached = if end {
                let to_end = (share, 1.0);
                self.newton(system, path, to_end, &mut Trial::default(), report)
            } else {
                self.step(system, path, (&tangent, step), &mut share, report)
                    .map(|moved| last = Some(moved))
            };
            match reached {
                Ok(()) => {
                    report.increments += 1;
                    length = (1.5 * length).min(LONGEST);
                    if end {
                        return Ok(());
                    }
                }
                Err(reason) => {
                    good.set(system);
                    self.moved = None;
                    length /= 4.0;
                    if length < SHORTEST {
                        return Err(reason);
                    }
                }
            }
        }
        Err(format!(
            "the path of equilibria past the limit point was followed for {STEPS} steps and didn't come to its end"
        ))
    }

    /// A step along the tangent, and back to the path normal to it. Returns the displacements.
    fn step(
        &mut self,
        system: &mut System,
        path: &Path,
        (tangent, step): (&[f64], f64),
        share: &mut f64,
        report: &mut SteadyReport,
    ) -> Result<Vec<f64>, String> {
        let mut to = *share + step;
        let mut change: Vec<f64> = tangent.iter().map(|t| t * step).collect();
        let mut moved = change.clone();
        let mut last = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            self.unknowns.displace_all(&mut system.groups, &change);
            path.turn_walls(system, to);
            report.iterations += 1;
            let along = self.tangent_of(system, path, to, report)?;
            self.correction(path, 0.0, to)?;
            let share_change = -self.dot(tangent, &self.change) / self.dot(tangent, &along);
            let parts = self.change.iter().zip(&along);
            change = parts.map(|(c, a)| c + share_change * a).collect();
            to += share_change;
            moved.iter_mut().zip(&change).for_each(|(m, c)| *m += c);
            let size = self.size(&change);
            if size.motion > CONTRACTION * last && size.motion > HARMLESS {
                break;
            }
            last = size.motion;
            if size.largest < self.options.tolerance && to < 1.0 {
                self.unknowns.displace_all(&mut system.groups, &change);
                path.turn_walls(system, to);
                *share = to;
                return Ok(moved);
            }
        }
        Err("steps along the path of equilibria don't converge past the limit point".into())
    }

    /// Displacements for a unit of the share at the present state, whose tangent matrix and loads are found.
    fn tangent_of(
        &mut self,
        system: &mut System,
        path: &Path,
        share: f64,
        report: &mut SteadyReport,
    ) -> Result<Vec<f64>, String> {
        self.factorise(system, report)?;
        self.find_imbalance(system, report);
        let turning = self.turning_walls(system, path, (share, 1.0), report);
        let mut tangent = path.moves.clone();
        for (i, t) in tangent.iter_mut().enumerate() {
            *t -= path.imbalance[i] + turning[i];
        }
        self.tangent
            .solve(&mut tangent)
            .then_some(tangent)
            .ok_or_else(|| "the tangent matrix is singular".into())
    }

    /// Product of displacements, those of positions in lengths of the longest rod.
    fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        let weight = |i: usize| match i % PER_STATION {
            0..3 => self.unknowns.longest.powi(-2),
            _ => 1.0,
        };
        let products = a.iter().zip(b).enumerate();
        products.map(|(i, (a, b))| a * b * weight(i)).sum()
    }
}
