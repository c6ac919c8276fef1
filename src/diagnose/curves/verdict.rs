//! What a diagnosis of measured curves says. Its JSON keys are stable, and those that a diagnosis of recordings has too
//! mean the same.

use crate::diagnose::verdict::{Alternative, Estimated, Experiment, Kind};
use crate::identify::Hooked;
use serde::Serialize;

/// A diagnosis of measured curves.
#[derive(Clone, Debug, Serialize)]
pub struct CurvesDiagnosis {
    /// The verdict.
    pub verdict: Kind,
    /// The verdict in words.
    pub words: String,
    /// The effect that is named, if any.
    pub effects: Vec<NamedOfRods>,
    /// Others that predict about as well.
    pub alternatives: Vec<Alternative>,
    /// What would tell them apart.
    pub experiment: Option<Experiment>,
    /// Where the calibrated scenarios contradict the figures.
    pub location: CurvesLocation,
    /// Least error bar of a figure, as a share of the largest value of its quantity (of lengths, of the extension).
    pub floor: f64,
    /// The calibrated scenarios without effects.
    pub baseline: FittedRods,
    /// The scenarios with the named effect.
    pub augmented: FittedRods,
    /// Share of the mismatch beyond the error bars that the named effect explains.
    pub explained: f64,
    /// Calibrated numbers that ended where they should not be, or that the rest of the figures contradicts.
    pub alarms: Vec<String>,
    /// What was measured, and which of it was left out in turn.
    pub audit: Vec<String>,
    /// Time it took \[s\].
    pub seconds: f64,
}

/// An effect that is named.
#[derive(Clone, Debug, Serialize)]
pub struct NamedOfRods {
    /// Its identifier.
    pub id: String,
    /// What it is.
    pub words: String,
    /// Its equation.
    pub equation: String,
    /// Which part of the model it belongs to.
    pub hook: Hooked,
    /// Its numbers, the same for all rods.
    pub parameters: Vec<Estimated>,
    /// Probability among the effects that were tried.
    pub probability: f64,
}

/// Numbers of a rod.
#[derive(Clone, Debug, Serialize)]
pub struct OfRod {
    /// The rod.
    pub rod: String,
    /// The numbers.
    pub numbers: Vec<Estimated>,
}

/// Where scenarios differ from the figures.
#[derive(Clone, Debug, Serialize)]
pub struct CurvesLocation {
    /// The quantities, the one that differs most first.
    pub quantities: Vec<QuantityShare>,
    /// Twist angles \[degrees\] between which the mismatch of that quantity lies for the most part.
    pub twist_angles_deg: [f64; 2],
    /// In words.
    pub state: String,
}

/// How much of the mismatch lies in a quantity.
#[derive(Clone, Debug, Serialize)]
pub struct QuantityShare {
    /// The quantity.
    pub quantity: String,
    /// Share of the squared mismatch, in units of the error bars, with the values that the scenarios state.
    pub share: f64,
    /// The same once they are calibrated by all quantities, which spreads the mismatch.
    pub calibrated: f64,
}

/// Fitted scenarios of rods.
#[derive(Clone, Debug, Serialize)]
pub struct FittedRods {
    /// Their own numbers, by all quantities but the one that differs most.
    pub parameters: Vec<OfRod>,
    /// How well they do.
    pub figures: Vec<ScoredQuantity>,
    /// Mean of the squared residuals of the quantity that differs most, at figures held out, in units of the error bars.
    pub reduced_chi2: f64,
}

/// How well a scenario does on a quantity.
#[derive(Clone, Debug, Serialize)]
pub struct ScoredQuantity {
    /// The rod, or `all`.
    pub rod: String,
    /// The quantity.
    pub quantity: String,
    /// `train`, or `holdout`: these figures were not used.
    pub role: String,
    /// Root mean square of the differences, in `unit`.
    pub rmse: f64,
    /// Unit.
    pub unit: String,
    /// The same in units of the error bars.
    pub rms_in_bars: f64,
}
