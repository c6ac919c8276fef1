//! Which experiment would tell models apart that the recordings can't, and what each model predicts for it.
//!
//! Every model predicts how far the platform's pose moves in each experiment of a [`menu`]. The experiment is the better,
//! the further apart the two models are that are closest, in floors, beyond what the scenario's own numbers could make up
//! for: differences d count as d (1 + G G')^-1 d', where G is what the prediction of the first model changes by if those
//! numbers do by a deviation of what is known of them.

mod menu;
mod predict;

use super::trial::Trial;
use super::verdict::{Floor, Prediction};
use crate::config::Source;
pub use menu::{Plan, Setup, menu};
use nalgebra::{Matrix6, Vector6};
pub use predict::{Shift, predict};
use rayon::prelude::*;

/// Floors apart from which models are told apart.
const TOLD: f64 = 3.0;

/// A model among which an experiment decides.
pub struct Member<'a> {
    /// Identifier of its effect.
    pub id: &'a str,
    /// The fitted scenario.
    pub scenario: Source,
    /// The same with each of the scenario's own numbers a deviation larger.
    moved: Vec<Source>,
}

impl<'a> Member<'a> {
    /// A model at the values that fit best.
    ///
    /// # Errors
    /// In words, if the scenario has no place for them.
    pub fn new(id: &'a str, trial: &Trial<'_>, at: &[f64]) -> Result<Self, String> {
        let moved = trial.own.iter().enumerate().map(|(j, own)| {
            let mut there = at.to_vec();
            there[j] += own.deviation();
            trial.scenario(&there)
        });
        Ok(Self {
            id,
            scenario: trial.scenario(at)?,
            moved: moved.collect::<Result<_, _>>()?,
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
        // own numbers make differences smaller only
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

/// Covariance of a member's prediction by what is known of its scenario's own numbers, beside a unit one; none if it has no
/// prediction with one of them.
fn doubt(member: &Member<'_>, plan: &Plan, shift: &Shift, floor: &Floor) -> Option<Matrix6<f64>> {
    let moved = member.moved.par_iter().map(|moved| predict(moved, plan));
    let moved = moved.collect::<Result<Vec<_>, _>>().ok()?;
    let here = white(shift, floor);
    let change = |moved: &Shift| white(moved, floor) - here;
    let sum = moved.iter().map(change).map(|g| g * g.transpose());
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
