//! What a diagnosis says. Its JSON keys are stable.

use crate::identify::{Effect, Hooked, Variant};
use serde::{Deserialize, Serialize};

/// The kinds of verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Nothing above the floor.
    None,
    /// A fault of the recording.
    Recording,
    /// One effect.
    Effect,
    /// One of several that these data can't tell apart.
    Class,
    /// Several effects.
    Several,
    /// None of the effects that are known.
    Unexplained,
    /// Nothing above the floor, in recordings in which most effects would not show.
    Insufficient,
}

impl Kind {
    /// Its name in JSON.
    #[must_use]
    pub fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

/// A diagnosis.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Diagnosis {
    /// The verdict.
    pub verdict: Kind,
    /// The verdict in words.
    pub words: String,
    /// Effects that are named, the strongest first.
    pub effects: Vec<Named>,
    /// Others that explain nearly as much.
    pub alternatives: Vec<Alternative>,
    /// What would tell them apart.
    pub experiment: Option<Experiment>,
    /// Where simulation and recordings differ.
    pub location: Location,
    /// What can't be told from noise.
    pub floor: Floor,
    /// The calibrated scenario without effects.
    pub baseline: Fitted,
    /// The scenario with the named effects.
    pub augmented: Fitted,
    /// Share of the mismatch, beyond noise, that the named effects explain.
    pub explained: f64,
    /// How much of the mismatch the calibration had hidden before the effects were named.
    pub hidden: Option<Hidden>,
    /// If nothing is found: from which value each effect would have been.
    pub noticeable: Vec<Noticeable>,
    /// Calibrated numbers that ended where they should not be.
    pub alarms: Vec<String>,
    /// What is odd about the recordings.
    pub audit: Vec<String>,
    /// What the motors' loads say, if they report any.
    pub loads: Option<Loads>,
    /// The platform's error over time, recording by recording.
    pub traces: Vec<Trace>,
    /// Time it took [s].
    pub seconds: f64,
}

/// An effect that is named.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Named {
    /// Its identifier.
    pub id: String,
    /// What it is.
    pub words: String,
    /// Its equation.
    pub equation: String,
    /// Which part of the model it belongs to.
    pub hook: Hooked,
    /// Its numbers.
    pub parameters: Vec<Estimated>,
    /// Probability among the effects that were tried.
    pub probability: f64,
    /// Root mean square that the platform's position error falls by when it is added, on the training data [mm].
    pub gain_mm: f64,
}

impl Named {
    /// An effect in one of its forms, with its numbers, its probability and its gain \[mm\].
    #[must_use]
    pub fn new(
        effect: &dyn Effect,
        variant: &Variant,
        parameters: Vec<Estimated>,
        (probability, gain_mm): (f64, f64),
    ) -> Self {
        Self {
            id: effect.id().to_owned(),
            words: match variant.name.as_str() {
                "" => effect.words().to_owned(),
                which => format!("{} ({which})", effect.words()),
            },
            equation: effect.equation().to_owned(),
            hook: effect.hook(),
            parameters,
            probability,
            gain_mm,
        }
    }
}

/// What the motors' loads say.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Loads {
    /// In words.
    pub words: String,
    /// Reading for a torque of 1 N m.
    pub gain: Estimated,
    /// How far predicted loads are from reported ones.
    pub recordings: Vec<LoadScore>,
    /// Sum of the squares of residuals in deviations over their number, on the training data, without and with the effects
    /// that loads name.
    pub reduced_chi2: [f64; 2],
}

/// How far the predicted loads of a recording are from the reported ones.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LoadScore {
    /// The recording.
    pub name: String,
    /// `train` or `holdout`.
    pub role: String,
    /// Root mean squares without and with the effects that loads name, in the motors' unit.
    pub rms: [f64; 2],
}

impl Diagnosis {
    /// The same with what the motors' loads say, and the effects that they name.
    pub(super) fn hearing(mut self, loads: Loads, named: Vec<Named>) -> Self {
        if !named.is_empty() {
            let poses = self.verdict;
            self.verdict = match (poses, &named[..]) {
                (Kind::None | Kind::Insufficient, [one]) => match one.hook {
                    Hooked::Recording => Kind::Recording,
                    _ => Kind::Effect,
                },
                (Kind::Unexplained, _) => Kind::Unexplained,
                _ => Kind::Several,
            };
            let of_poses = match poses {
                Kind::None => "Poses show nothing that is missing.",
                _ => &self.words,
            };
            self.words = format!("{of_poses} {}", loads.words);
        }
        self.effects.extend(named);
        self.loads = Some(loads);
        self
    }
}

/// What a calibration hides.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Hidden {
    /// Share of the named effects' mark that the scenario's own numbers took up.
    pub share: f64,
    /// The number that took most, over what was known of it.
    pub parameter: String,
    /// Its value without and with the effects.
    pub values: [f64; 2],
    /// Its unit.
    pub unit: String,
}

impl Hidden {
    /// In a sentence.
    #[must_use]
    pub fn words(&self) -> String {
        let [without, with] = self.values;
        format!(
            "The calibration had hidden {:.0} % of it, most in the {}: {without:.4} {unit} without, {with:.4} {unit} with what \
             was left out.",
            100.0 * self.share,
            self.parameter,
            unit = self.unit
        )
    }
}

/// From where on an effect would have been noticed.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Noticeable {
    /// Its identifier.
    pub id: String,
    /// Its form that shows first.
    pub form: String,
    /// A number of it.
    pub parameter: String,
    /// Value from which it is noticed, to first order; none if no value that is physical would be.
    pub value: Option<f64>,
    /// Unit.
    pub unit: String,
    /// What that is of the effect's typical strength, at most 1e6; beyond 1 the effect may be there and not show.
    pub share: f64,
}

impl Noticeable {
    /// In a few words.
    #[must_use]
    pub fn words(&self) -> String {
        let Some(value) = self.value else {
            return format!("{} never", self.id);
        };
        let unit = match self.unit.as_str() {
            "-" => String::new(),
            unit => format!(" {unit}"),
        };
        let beyond = if self.share > 1.0 {
            format!(", {:.1} times its typical strength", self.share)
        } else {
            String::new()
        };
        format!(
            "{} at {} = {value:.2e}{unit}{beyond}",
            self.id, self.parameter
        )
    }
}

/// A number and its interval.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Estimated {
    /// What it is.
    pub name: String,
    /// Value that fits best.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// Interval with 95 % confidence, given that the model is right.
    pub ci95: [f64; 2],
}

impl Estimated {
    /// Value and interval, however small they are.
    #[must_use]
    pub fn figures(&self) -> [String; 2] {
        let figure = |x: f64| match x.abs() {
            size if size > 0.0 && size < 0.01 => format!("{x:.3e}"),
            _ => format!("{x:.4}"),
        };
        let [low, high] = self.ci95.map(figure);
        [figure(self.value), format!("{low} .. {high}")]
    }
}

/// Another effect that explains nearly as much.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Alternative {
    /// Its identifier.
    pub id: String,
    /// Probability among the effects that were tried.
    pub probability: f64,
}

/// What to do next.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Experiment {
    /// What to do.
    pub words: String,
    /// The effects that it tells apart.
    pub discriminates: Vec<String>,
    /// What each of them predicts; none if no experiment was found that tells them apart.
    pub predictions: Vec<Prediction>,
    /// How many floors the two closest predictions are apart.
    pub apart_floors: Option<f64>,
}

/// How far the platform moves in an experiment, by a model; in the base frame.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Prediction {
    /// Identifier of the model's effect.
    pub id: String,
    /// How far its marker moves [mm].
    pub position_mm: [f64; 3],
    /// How far it turns, a rotation vector [mrad].
    pub rotation_mrad: [f64; 3],
}

impl Experiment {
    /// What to do, in a sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        format!(
            "To tell {} apart: {}.",
            self.discriminates.join(", "),
            self.words
        )
    }

    /// How far apart the predictions are, in a sentence.
    #[must_use]
    pub fn power(&self) -> Option<String> {
        let apart = self.apart_floors?;
        Some(format!(
            "The two closest predictions are {apart:.0} floors apart."
        ))
    }
}

impl Prediction {
    /// In a few words.
    #[must_use]
    pub fn words(&self) -> String {
        let [x, y, z] = self.position_mm;
        let [a, b, c] = self.rotation_mrad;
        format!(
            "with {} the platform moves by ({x:.2}, {y:.2}, {z:.2}) mm and turns by ({a:.1}, {b:.1}, {c:.1}) mrad",
            self.id
        )
    }
}

/// Where simulation and recordings differ.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Location {
    /// Shares of the calibrated baseline's mismatch.
    pub channels: Vec<ChannelShare>,
    /// Recording, and from and to which time [s] it differs most.
    pub time: Vec<Interval>,
    /// In which states of the robot, in words.
    pub state: String,
    /// Where along the robot: places of the recorded bodies over its length, with their shares.
    pub arclength: Vec<(f64, f64)>,
}

/// Share of a channel.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ChannelShare {
    /// `platform` or `ring`.
    pub body: String,
    /// `x`, `y`, `z`, `turn x`, ..
    pub channel: String,
    /// Share of the squared, whitened mismatch.
    pub share: f64,
}

/// A stretch of time.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Interval {
    /// The recording.
    pub recording: String,
    /// Begin and end [s].
    pub seconds: [f64; 2],
}

/// How far the simulated platform is from the recorded one, sample by sample.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Trace {
    /// The recording.
    pub recording: String,
    /// `train` or `holdout`.
    pub role: String,
    /// Times [s].
    pub time: Vec<f64>,
    /// How far the rods are wound by then, the mean of the four [degrees].
    pub winding_deg: Vec<f64>,
    /// Distance of the calibrated scenario's platform [mm].
    pub before_mm: Vec<f64>,
    /// Distance with the named effects [mm].
    pub after_mm: Vec<f64>,
}

/// What can't be told from noise.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Floor {
    /// Of a position [mm].
    pub position_mm: f64,
    /// Of a rotation [mrad].
    pub rotation_mrad: f64,
}

/// A fitted scenario.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Fitted {
    /// Its own numbers.
    pub parameters: Vec<Estimated>,
    /// How well it does.
    pub recordings: Vec<Scored>,
    /// Sum of the squares of whitened residuals over their number, on the training data.
    pub reduced_chi2: f64,
}

/// How well a scenario does on a recording.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Scored {
    /// The recording.
    pub name: String,
    /// `train` or `holdout`.
    pub role: String,
    /// Root mean square of the platform's distance where it rests [mm].
    pub position_rmse_mm: f64,
    /// Root mean square of the platform's rotation where it rests [mrad].
    pub rotation_rmse_mrad: f64,
}
