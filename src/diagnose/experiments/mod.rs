//! Which experiment would tell models apart that the recordings can't, and what each model predicts for it.
//!
//! Every model predicts how far the platform's pose moves in each experiment of a [`menu`]. The experiment is the better,
//! the further apart the two models are that are closest, in floors, beyond what the fit leaves open: differences d count as
//! d (1 + G C G')^-1 d', where C is the covariance of the first model's fitted numbers and G what its prediction changes by
//! with them.

mod menu;
mod predict;

use super::trial::Trial;
use super::verdict::{Floor, Prediction};
use crate::config::Source;
pub use menu::{Plan, Setup, menu};
use nalgebra::{DMatrix, Matrix6, Vector6};
pub use predict::{Shift, predict};
use rayon::prelude::*;

/// Floors apart from which models are told apart.
const TOLD: f64 = 3.0;
/// Error of the time at which a robot that moves is seen [s].
const CLOCK: f64 = 0.014;

/// A model among which an experiment decides.
pub struct Member<'a> {
    /// Identifier of its effect.
    pub id: &'a str,
    /// The fitted scenario.
    pub scenario: Source,
    /// The same with the fitted numbers a deviation away, in each direction in which they are independent of each other.
    around: Vec<Source>,
}

impl<'a> Member<'a> {
    /// A model at the values that fit best, with their covariance if that is to count.
    ///
    /// # Errors
    /// In words, if the scenario has no place for them.
    pub fn new(
        id: &'a str,
        trial: &Trial<'_>,
        at: &[f64],
        covariance: Option<&DMatrix<f64>>,
    ) -> Result<Self, String> {
        let mut around = Vec::new();
        if let Some(covariance) = covariance {
            let axes = covariance.clone().symmetric_eigen();
            for (axis, square) in axes.eigenvectors.column_iter().zip(&axes.eigenvalues) {
                let away = |(j, value): (usize, &f64)| {
                    let (least, most) = trial.range(j);
                    (value + axis[j] * square.max(0.0).sqrt()).clamp(least, most)
                };
                let there: Vec<f64> = at.iter().enumerate().map(away).collect();
                around.push(trial.scenario(&there)?);
            }
        }
        Ok(Self {
            id,
            scenario: trial.scenario(at)?,
            around,
        })
    }
}

/// The best experiment.
pub struct Chosen {
    /// What is done.
    pub plan: Plan,
    /// What each member predicts.
    pub predictions: Vec<Prediction>,
    /// How many floors the two closest predictions are apart.
    pub apart: f64,
}

impl Chosen {
    /// Whether all members are told apart.
    #[must_use]
    pub fn decides(&self) -> bool {
        self.apart >= TOLD
    }
}

/// The experiment whose closest predictions are furthest apart; none if there is none that all members can follow.
#[must_use]
pub fn choose(members: &[Member<'_>], plans: Vec<Plan>, floor: &Floor) -> Option<Chosen> {
    let foreseen = |plan: Plan| {
        let shifts = members.iter().map(|m| predict(&m.scenario, &plan));
        let shifts = shifts.collect::<Result<Vec<_>, _>>().ok()?;
        let apart = closest(&shifts, &Matrix6::identity(), floor)?;
        Some((apart, plan, shifts))
    };
    let foreseen: Vec<_> = plans.into_par_iter().map(foreseen).collect();
    let mut foreseen: Vec<_> = foreseen.into_iter().flatten().collect();
    foreseen.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut best: Option<Chosen> = None;
    for (most, plan, shifts) in foreseen {
        // doubt makes differences smaller only
        if best.as_ref().is_some_and(|best| best.apart >= most) {
            break;
        }
        let Some(doubt) = doubt(&members[0], &plan, &shifts[0], floor) else {
            continue;
        };
        let Some(apart) = closest(&shifts, &doubt, floor) else {
            continue;
        };
        if best.as_ref().is_none_or(|best| apart > best.apart) {
            let predictions = members.iter().zip(&shifts);
            best = Some(Chosen {
                plan,
                predictions: predictions.map(|(m, s)| prediction(m.id, s)).collect(),
                apart,
            });
        }
    }
    best
}

/// A shift over the floor.
fn white(shift: &Shift, floor: &Floor) -> Vector6<f64> {
    let position = 1e3 * shift.position / floor.position_mm;
    let rotation = 1e3 * shift.rotation / floor.rotation_mrad;
    Vector6::from_iterator(position.iter().chain(&rotation).copied())
}

/// Covariance of a member's prediction by what its fit leaves open and by clocks, beside a unit one; none if there is no
/// prediction around it.
fn doubt(member: &Member<'_>, plan: &Plan, shift: &Shift, floor: &Floor) -> Option<Matrix6<f64>> {
    let late = Plan {
        at: plan.at + CLOCK,
        ..plan.clone()
    };
    let around = member.around.iter().map(|source| (source, plan));
    let around: Vec<_> = around.chain([(&member.scenario, &late)]).collect();
    let around = around
        .par_iter()
        .map(|(source, plan)| predict(source, plan));
    let around = around.collect::<Result<Vec<_>, _>>().ok()?;
    let here = white(shift, floor);
    let change = around.iter().map(|moved| white(moved, floor) - here);
    let sum = change.map(|g| g * g.transpose());
    Some(sum.fold(Matrix6::identity(), |sum, each| sum + each))
}

/// Floors between the two shifts that are closest; none if there is one only.
fn closest(shifts: &[Shift], doubt: &Matrix6<f64>, floor: &Floor) -> Option<f64> {
    let factors = doubt.cholesky()?;
    let apart = |a: &Shift, b: &Shift| {
        let d = white(a, floor) - white(b, floor);
        d.dot(&factors.solve(&d)).sqrt()
    };
    let pairs = shifts.iter().enumerate();
    let pairs = pairs.flat_map(|(i, a)| shifts[..i].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| apart(a, b)).min_by(f64::total_cmp)
}

fn prediction(id: &str, shift: &Shift) -> Prediction {
    Prediction {
        id: id.to_owned(),
        position_mm: (1e3 * shift.position).into(),
        rotation_mrad: (1e3 * shift.rotation).into(),
    }
}
