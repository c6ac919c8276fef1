//! What motors report as their loads, held against the torques in the model that explains the poses.
//!
//! Loads come after poses and don't weigh against them: how a reading grows with the torque is known of no motor, so that they
//! tell little about rods, and friction in the gears is often as large as the torque.

use super::forward::torques;
use super::samples::Samples;
use super::search::Form;
use super::standing::GAIN;
use super::trial::version;
use super::verdict::{Estimated, LoadScore, Loads, Named};
use super::{DiagnoseError, LEFT, ODDS, SOUND_AS_MEASURED, unfit};
use crate::config::Source;
use crate::engine::scenario::{MotorLoads, Scenario};
use crate::identify::{Effect, Estimate, Fit, Options, Parameter, Variant, fit};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// Share of a load that no model is asked to explain, since meshes differ by as much.
const NUMERICS: f64 = 0.005;
/// Most effects that are named.
const MOST: usize = 2;
/// Least reading for a torque of 1 N m.
const LEAST: f64 = 1e-6;
/// Factor that the gain stays within of what it were if there were nothing else.
const GAIN_WITHIN: f64 = 10.0;

/// What loads say, beside the effects that they name and the scenario with those.
pub(super) struct Heard {
    pub(super) loads: Loads,
    pub(super) named: Vec<Named>,
    pub(super) scenario: Source,
}

/// What is fitted to loads.
struct Hearing<'a> {
    source: &'a Source,
    forms: &'a [Form],
    /// Reading for a torque of 1 N m.
    gain: Parameter,
    train: Vec<Reported<'a>>,
    holdout: Vec<Reported<'a>>,
}

/// A recording with the torques of the model.
struct Reported<'a> {
    samples: &'a Samples,
    torques: Vec<[f64; 4]>,
}

/// Forms, and the gain and their numbers, fitted.
#[derive(Clone)]
struct Fitted {
    forms: Vec<usize>,
    fit: Fit,
}

/// What the loads say that the motors of these recordings report; nothing if the scenario doesn't say that they do, or a
/// recording has none.
///
/// # Errors
/// If the scenario has no steady state at a sample.
pub(super) fn heard(
    source: &Source,
    [train, holdout]: [&[Samples]; 2],
    forms: &[Form],
    effects: &[Box<dyn Effect>],
) -> Result<Option<Heard>, DiagnoseError> {
    let scenario: Scenario<'_> = source.parse()?;
    if scenario.motor_loads.is_none() || train.iter().chain(holdout).any(Samples::is_silent) {
        return Ok(None);
    }
    let train = Reported::all(source, train)?;
    let hearing = Hearing {
        source,
        forms,
        gain: gain(&train),
        train,
        holdout: Reported::all(source, holdout)?,
    };
    hearing.heard(effects).map(Some)
}

impl Hearing<'_> {
    fn heard(&self, effects: &[Box<dyn Effect>]) -> Result<Heard, DiagnoseError> {
        let before = self.fitted(vec![]).map_err(unfit)?;
        let mut now = before.clone();
        let mut probabilities = Vec::new();
        while now.fit.chi2 > SOUND_AS_MEASURED * self.measured() && now.forms.len() < MOST {
            let Some((next, probability)) = self.grown(&now).map_err(unfit)? else {
                break;
            };
            now = next;
            probabilities.push(probability);
        }
        let [mismatch, left] = [&before, &now].map(|f| f.fit.chi2 / self.measured());
        let share = 1.0 - (left - 1.0).max(0.0) / (mismatch - 1.0).max(1e-300);
        let named = self.named(&now, &probabilities, effects);
        let loads = Loads {
            words: words(&named, share, left, self.gain.nominal > LEAST),
            gain: estimated(&now.fit.estimates[0]),
            recordings: self.scores(&before, &now).map_err(unfit)?,
            reduced_chi2: [mismatch, left],
        };
        let scenario = self.scenario(&now.forms, &now.fit.values());
        let scenario = scenario.map_err(unfit)?;
        Ok(Heard {
            loads,
            named,
            scenario,
        })
    }

    fn measured(&self) -> f64 {
        let samples = self.train.iter().map(|r| r.torques.len());
        4.0 * samples.sum::<usize>() as f64
    }

    fn variants(&self, forms: &[usize]) -> Vec<&Variant> {
        forms
            .iter()
            .map(|form| &self.forms[*form].variant)
            .collect()
    }

    fn scenario(&self, forms: &[usize], at: &[f64]) -> Result<Source, String> {
        let gain = std::slice::from_ref(&self.gain);
        version(self.source, gain, &self.variants(forms), at)
    }

    /// Residuals of some recordings in standard deviations.
    fn residuals(
        &self,
        (forms, at): (&[usize], &[f64]),
        data: &[Reported<'_>],
    ) -> Result<Vec<f64>, String> {
        let motors = self.motors(forms, at)?;
        let all = data.iter().flat_map(|reported| reported.apart(&motors));
        Ok(all.map(|(apart, deviation)| apart / deviation).collect())
    }

    fn motors(&self, forms: &[usize], at: &[f64]) -> Result<MotorLoads, String> {
        let source = self.scenario(forms, at)?;
        let scenario: Scenario<'_> = source.parse().map_err(|e| e.to_string())?;
        Ok(scenario.motor_loads.expect("it had some"))
    }

    /// The gain and the numbers of some forms, fitted to all training recordings.
    fn fitted(&self, forms: Vec<usize>) -> Result<Fitted, String> {
        let variants = self.variants(&forms);
        let quantities = variants.iter().flat_map(|variant| &variant.quantities);
        let parameters: Vec<_> = std::iter::once(self.gain.clone())
            .chain(quantities.map(|q| Parameter::new(&q.name, q.unit, q.typical, q.range)))
            .collect();
        let options = Options {
            starts: 1,
            ..Options::default()
        };
        let residuals = |at: &[f64]| self.residuals((&forms, at), &self.train);
        let go_on = |_| ControlFlow::Continue(());
        let fit = fit(&parameters, &residuals, &options, &go_on).map_err(|e| e.to_string())?;
        Ok(Fitted { forms, fit })
    }

    /// A fit with one more form, if one is worth it, and the probability of its effect among those that were tried.
    fn grown(&self, now: &Fitted) -> Result<Option<(Fitted, f64)>, String> {
        let used = |form: &usize| {
            let group = self.forms[*form].group;
            now.forms.iter().any(|f| self.forms[*f].group == group)
        };
        let open = (0..self.forms.len()).filter(|form| !used(form));
        let with = |form: usize| self.fitted([&now.forms[..], &[form]].concat());
        let mut found = open.map(with).collect::<Result<Vec<_>, String>>()?;
        let measured = self.measured();
        let least = found.iter().map(|f| f.fit.chi2).fold(f64::MAX, f64::min);
        let scale = (least / measured).max(1.0);
        let cost = |f: &Fitted| f.fit.chi2 / scale + f.fit.estimates.len() as f64 * measured.ln();
        found.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some(best) = found.first() else {
            return Ok(None);
        };
        let out = |f: &Fitted| -> Result<f64, String> {
            let residuals = self.residuals((&f.forms, &f.fit.values()), &self.holdout)?;
            Ok(residuals.iter().map(|r| r * r).sum())
        };
        if best.fit.chi2 > (1.0 - GAIN[0]) * now.fit.chi2 || out(best)? > out(now)? {
            return Ok(None);
        }
        let group = |f: &Fitted| f.forms.last().map(|form| self.forms[*form].group);
        let mut groups = Vec::new();
        let mut total = 0.0;
        for f in &found {
            if !groups.contains(&group(f)) {
                groups.push(group(f));
                let more = cost(f) - cost(best);
                total += if more < ODDS {
                    1.0
                } else {
                    (-more / 2.0).exp()
                };
            }
        }
        Ok(Some((best.clone(), 1.0 / total)))
    }

    fn named(
        &self,
        now: &Fitted,
        probabilities: &[f64],
        effects: &[Box<dyn Effect>],
    ) -> Vec<Named> {
        let mut estimates = now.fit.estimates.iter().skip(1).map(estimated);
        let each = now.forms.iter().zip(probabilities);
        let named = |(form, probability): (&usize, &f64)| {
            let Form {
                effect, variant, ..
            } = &self.forms[*form];
            let parameters = estimates.by_ref().take(variant.quantities.len()).collect();
            Named::new(&*effects[*effect], variant, parameters, (*probability, 0.0))
        };
        each.map(named).collect()
    }

    fn scores(&self, before: &Fitted, now: &Fitted) -> Result<Vec<LoadScore>, String> {
        let [before, after] = [before, now].map(|f| self.motors(&f.forms, &f.fit.values()));
        let (before, after) = (before?, after?);
        let score = |(reported, role): (&Reported<'_>, &str)| {
            let rms = |motors: &MotorLoads| {
                let squares: f64 = reported.apart(motors).map(|(apart, _)| apart * apart).sum();
                (squares / (4 * reported.torques.len()) as f64).sqrt()
            };
            LoadScore {
                name: reported.samples.name.clone(),
                role: role.to_owned(),
                rms: [rms(&before), rms(&after)],
            }
        };
        let train = self.train.iter().map(|r| (r, "train"));
        let all = train.chain(self.holdout.iter().map(|r| (r, "holdout")));
        Ok(all.map(score).collect())
    }
}

impl<'a> Reported<'a> {
    fn all(source: &Source, data: &'a [Samples]) -> Result<Vec<Self>, DiagnoseError> {
        let each = data.par_iter().map(|samples| {
            let torques = torques(source, samples)?;
            Ok(Self { samples, torques })
        });
        each.collect()
    }

    /// Predicted less reported loads, and their standard deviations.
    fn apart(&self, motors: &MotorLoads) -> impl Iterator<Item = (f64, f64)> {
        let samples = self.samples.list.iter().zip(&self.torques);
        samples.flat_map(move |(sample, torques)| {
            std::array::from_fn::<_, 4, _>(|i| {
                let motor = &sample.motors[i];
                let apart = motors.reading(i, torques[i], motor.turn) - motor.load;
                (apart, motor.deviation.hypot(NUMERICS * motor.load))
            })
        })
    }
}

/// The gain as it were if there were nothing else, to begin with.
fn gain(train: &[Reported<'_>]) -> Parameter {
    let (mut product, mut square) = (0.0, 1e-300);
    for reported in train {
        for (sample, torques) in reported.samples.list.iter().zip(&reported.torques) {
            for (motor, torque) in sample.motors.iter().zip(torques) {
                product += motor.load * torque;
                square += torque * torque;
            }
        }
    }
    let nominal = f64::max(product / square, LEAST);
    let range = (nominal / GAIN_WITHIN, nominal * GAIN_WITHIN);
    Parameter {
        path: "motor_loads.gain".into(),
        ..Parameter::new("load gain", "1/(N m)", nominal, range)
    }
}

fn estimated(estimate: &Estimate) -> Estimated {
    Estimated {
        name: estimate.parameter.name.clone(),
        value: estimate.value,
        unit: estimate.parameter.unit.clone(),
        ci95: estimate.interval.into(),
    }
}

/// What loads say, in a sentence.
fn words(named: &[Named], share: f64, left: f64, grows: bool) -> String {
    let all: Vec<&str> = named.iter().map(|n| n.words.as_str()).collect();
    let rest = if left > LEFT {
        format!(", and {left:.0} times what noise makes is left")
    } else {
        String::new()
    };
    match all[..] {
        [] if left > LEFT && !grows => {
            "What the motors report as their loads falls as the model's torques grow: is its sign reversed?".into()
        }
        [] if left > LEFT => format!(
            "What the motors report as their loads differs from the model's torques by {left:.0} times what noise makes, and \
             nothing that is known explains it."
        ),
        [] => "The motors' loads are as the model's torques say.".into(),
        _ => format!(
            "The motors' loads show: {}. That explains {:.0} % of their mismatch{rest}.",
            all.join("; "),
            100.0 * share
        ),
    }
}
