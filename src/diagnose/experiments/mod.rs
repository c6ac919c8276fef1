//! Which experiment would tell models apart that the recordings can't, and what each model predicts for it.
//!
//! Every model predicts how far the platform's pose moves in each experiment of a [`menu`]. The experiment is the better,
//! the further apart the two models are that are closest. Only movements count, so that it matters little how well the
//! models' poses agree before.

mod menu;
mod predict;

use super::verdict::{Floor, Prediction};
use crate::config::Source;
pub use menu::{Plan, Setup, menu};
use nalgebra::Vector3;
pub use predict::{Shift, predict};
use rayon::prelude::*;

/// Floors apart from which models are told apart.
const TOLD: f64 = 3.0;

/// A model among which an experiment decides.
pub struct Member<'a> {
    /// Identifier of its effect.
    pub id: &'a str,
    /// The fitted scenario.
    pub scenario: &'a Source,
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
    let judged = |plan: Plan| {
        let shifts = members.iter().map(|m| predict(m.scenario, &plan));
        let shifts = shifts.collect::<Result<Vec<_>, _>>().ok()?;
        let apart = closest(&shifts, floor)?;
        let predictions = (members.iter().zip(&shifts))
            .map(|(member, shift)| Prediction {
                id: member.id.to_owned(),
                position_mm: (1e3 * shift.position).into(),
                rotation_mrad: (1e3 * shift.rotation).into(),
            })
            .collect();
        Some(Chosen {
            plan,
            predictions,
            apart,
        })
    };
    let judged: Vec<Option<Chosen>> = plans.into_par_iter().map(judged).collect();
    // the first of equals, which are the simpler
    let judged = judged.into_iter().flatten();
    judged.reduce(|best, next| if next.apart > best.apart { next } else { best })
}

/// Floors between the two shifts that are closest; none if there is one only.
fn closest(shifts: &[Shift], floor: &Floor) -> Option<f64> {
    let size = |v: Vector3<f64>, floor: f64| 1e3 * v.norm() / floor;
    let apart = |a: &Shift, b: &Shift| {
        let position = size(a.position - b.position, floor.position_mm);
        position.max(size(a.rotation - b.rotation, floor.rotation_mrad))
    };
    let pairs = shifts.iter().enumerate();
    let pairs = pairs.flat_map(|(i, a)| shifts[..i].iter().map(move |b| apart(a, b)));
    pairs.min_by(f64::total_cmp)
}
