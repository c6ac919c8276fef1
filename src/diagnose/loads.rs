//! What motors report as their loads, held against the torques in the model that explains the poses.
//!
//! Loads come after poses and don't weigh against them: how a reading grows with the torque is known of no motor, so that they
//! tell little about rods, and friction in the gears is often as large as the torque.

use super::forward::torques;
use super::samples::Samples;
use super::search::Form;
use super::verdict::{Estimated, LoadScore, Loads, Named};
use super::{DiagnoseError, LEFT, ODDS, SOUND, unfit};
use crate::config::Source;
use crate::engine::scenario::{MotorLoads, Scenario};
use crate::identify::{Effect, Quantity};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Share of a load that no model is asked to explain, since meshes differ by as much.
const NUMERICS: f64 = 0.005;
/// Share of chi2 that an effect must explain to be named.
const GAIN: f64 = 0.25;
/// Most effects that are named.
const MOST: usize = 2;
/// Least reading for a torque of 1 N m.
const LEAST: f64 = 1e-6;
/// Steps of a fit; what is fitted is nearly linear.
const STEPS: usize = 6;
/// Step of a difference over the size of a number.
const STEP: f64 = 1e-4;

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
    train: Vec<Reported<'a>>,
    holdout: Vec<Reported<'a>>,
}

/// A recording with the torques of the model.
struct Reported<'a> {
    samples: &'a Samples,
    torques: Vec<[f64; 4]>,
}

/// A fit: forms, and values of the gain and of theirs.
#[derive(Clone)]
struct Fit {
    forms: Vec<usize>,
    at: Vec<f64>,
    chi2: f64,
    /// Covariance of the values for residuals of unit variance.
    covariance: DMatrix<f64>,
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
    let silent = |samples: &Samples| {
        let mut all = samples.list.iter().flat_map(|sample| &sample.motors);
        all.all(|motor| motor.load == 0.0)
    };
    if scenario.motor_loads.is_none() || train.iter().chain(holdout).any(silent) {
        return Ok(None);
    }
    let hearing = Hearing {
        source,
        forms,
        train: Reported::all(source, train)?,
        holdout: Reported::all(source, holdout)?,
    };
    hearing.heard(effects).map(Some)
}

impl Hearing<'_> {
    fn heard(&self, effects: &[Box<dyn Effect>]) -> Result<Heard, DiagnoseError> {
        let before = self.fit(vec![], vec![self.gain()]).map_err(unfit)?;
        let mut now = before.clone();
        let mut probabilities = Vec::new();
        while now.chi2 > SOUND * self.measured() && now.forms.len() < MOST {
            let Some((next, probability)) = self.grown(&now).map_err(unfit)? else {
                break;
            };
            now = next;
            probabilities.push(probability);
        }
        let share = 1.0
            - (now.chi2 - self.measured()).max(0.0) / (before.chi2 - self.measured()).max(1e-300);
        let named = self.named(&now, &probabilities, effects);
        let left = now.chi2 / self.measured();
        let loads = Loads {
            words: words(&named, share, left, before.at[0] > LEAST),
            gain: self.estimates(&now).remove(0),
            recordings: self.scores(&before, &now).map_err(unfit)?,
            reduced_chi2: [before.chi2 / self.measured(), left],
        };
        let scenario = self.scenario(&now.forms, &now.at).map_err(unfit)?;
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

    /// Reading for a torque of 1 N m, were there nothing else.
    fn gain(&self) -> f64 {
        let (mut product, mut square) = (0.0, 1e-300);
        for reported in &self.train {
            for (sample, torques) in reported.samples.list.iter().zip(&reported.torques) {
                for (motor, torque) in sample.motors.iter().zip(torques) {
                    product += motor.load * torque;
                    square += torque * torque;
                }
            }
        }
        (product / square).max(LEAST)
    }

    fn quantities(&self, forms: &[usize]) -> Vec<&Quantity> {
        let each = forms
            .iter()
            .map(|form| &self.forms[*form].variant.quantities);
        each.flatten().collect()
    }

    fn scenario(&self, forms: &[usize], at: &[f64]) -> Result<Source, String> {
        let gain = format!("motor_loads.gain={:?}", at[0]);
        let mut source = self.source.with(&[gain]).map_err(|e| e.to_string())?;
        let mut rest = &at[1..];
        for form in forms {
            let variant = &self.forms[*form].variant;
            let (values, others) = rest.split_at(variant.quantities.len());
            source = variant.apply(&source, values).map_err(|e| e.to_string())?;
            rest = others;
        }
        Ok(source)
    }

    /// Residuals of some recordings in standard deviations.
    fn residuals(
        &self,
        (forms, at): (&[usize], &[f64]),
        data: &[Reported<'_>],
    ) -> Result<DVector<f64>, String> {
        let motors = self.motors(forms, at)?;
        let all = data.iter().flat_map(|reported| reported.apart(&motors));
        Ok(DVector::from_iterator(
            data.iter().map(|r| 4 * r.torques.len()).sum(),
            all.map(|(apart, deviation)| apart / deviation),
        ))
    }

    fn motors(&self, forms: &[usize], at: &[f64]) -> Result<MotorLoads, String> {
        let source = self.scenario(forms, at)?;
        let scenario: Scenario<'_> = source.parse().map_err(|e| e.to_string())?;
        Ok(scenario.motor_loads.expect("it had some"))
    }

    /// Least squares from these values.
    fn fit(&self, forms: Vec<usize>, mut at: Vec<f64>) -> Result<Fit, String> {
        let ranges: Vec<(f64, f64)> = std::iter::once((LEAST, f64::MAX))
            .chain(self.quantities(&forms).into_iter().map(|q| q.range))
            .collect();
        let sizes: Vec<f64> = std::iter::once(at[0])
            .chain(
                self.quantities(&forms)
                    .into_iter()
                    .map(|q| (q.typical - q.null).abs()),
            )
            .collect();
        let mut residuals = self.residuals((&forms, &at), &self.train)?;
        let mut jacobian = DMatrix::zeros(residuals.len(), at.len());
        for _ in 0..STEPS {
            for j in 0..at.len() {
                let moved = |step: f64| {
                    let mut there = at.clone();
                    there[j] = (there[j] + step).clamp(ranges[j].0, ranges[j].1);
                    let found = self.residuals((&forms, &there), &self.train)?;
                    Ok::<_, String>((there[j], found))
                };
                let step = STEP * sizes[j];
                let ((to, up), (from, down)) = (moved(step)?, moved(-step)?);
                jacobian.set_column(j, &((up - down) / (to - from)));
            }
            let change = jacobian.clone().svd(true, true).solve(&residuals, 1e-12)?;
            let there = at.iter().zip(&change).zip(&ranges);
            let there: Vec<f64> = there.map(|((x, d), r)| (x - d).clamp(r.0, r.1)).collect();
            let next = self.residuals((&forms, &there), &self.train)?;
            if next.norm_squared() >= residuals.norm_squared() {
                break;
            }
            (at, residuals) = (there, next);
        }
        let normal = jacobian.tr_mul(&jacobian);
        let least = 1e-12 * normal.diagonal().amax();
        Ok(Fit {
            forms,
            at,
            chi2: residuals.norm_squared(),
            covariance: normal.pseudo_inverse(least)?,
        })
    }

    /// A fit with one more form, if one is worth it, and the probability of its effect among those that were tried.
    fn grown(&self, now: &Fit) -> Result<Option<(Fit, f64)>, String> {
        let used = |form: &usize| {
            let group = self.forms[*form].group;
            now.forms.iter().any(|f| self.forms[*f].group == group)
        };
        let open: Vec<usize> = (0..self.forms.len()).filter(|form| !used(form)).collect();
        let mut found = Vec::new();
        for form in open {
            let forms = [&now.forms[..], &[form]].concat();
            let typical = self.quantities(&[form]).into_iter().map(|q| q.typical);
            let start = now.at.iter().copied().chain(typical).collect();
            found.push(self.fit(forms, start)?);
        }
        let measured = self.measured();
        let least = found.iter().map(|fit| fit.chi2).fold(f64::MAX, f64::min);
        let scale = (least / measured).max(1.0);
        let cost = |fit: &Fit| fit.chi2 / scale + fit.at.len() as f64 * measured.ln();
        found.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some(best) = found.first() else {
            return Ok(None);
        };
        let out = |fit: &Fit| {
            Ok::<_, String>(
                self.residuals((&fit.forms, &fit.at), &self.holdout)?
                    .norm_squared(),
            )
        };
        if best.chi2 > (1.0 - GAIN) * now.chi2 || out(best)? > out(now)? {
            return Ok(None);
        }
        let group = |fit: &Fit| fit.forms.last().map(|form| self.forms[*form].group);
        let mut groups = Vec::new();
        let mut total = 0.0;
        for fit in &found {
            if !groups.contains(&group(fit)) {
                groups.push(group(fit));
                let more = cost(fit) - cost(best);
                total += if more < ODDS {
                    1.0
                } else {
                    (-more / 2.0).exp()
                };
            }
        }
        Ok(Some((best.clone(), 1.0 / total)))
    }

    /// The values of a fit with their intervals, the gain's first.
    fn estimates(&self, fit: &Fit) -> Vec<Estimated> {
        let scale = (fit.chi2 / self.measured()).max(1.0);
        let names = std::iter::once(("load gain".to_owned(), "1/(N m)", (0.0, f64::MAX)));
        let quantities = self.quantities(&fit.forms).into_iter();
        let names = names.chain(quantities.map(|q| (q.name.clone(), q.unit, q.range)));
        let estimate = |(j, (name, unit, range)): (usize, (String, &str, (f64, f64)))| {
            let (value, reach) = (fit.at[j], 1.96 * (fit.covariance[(j, j)] * scale).sqrt());
            Estimated {
                name,
                value,
                unit: unit.to_owned(),
                ci95: [(value - reach).max(range.0), (value + reach).min(range.1)],
            }
        };
        names.enumerate().map(estimate).collect()
    }

    fn named(&self, fit: &Fit, probabilities: &[f64], effects: &[Box<dyn Effect>]) -> Vec<Named> {
        let mut estimates = self.estimates(fit).into_iter().skip(1);
        let each = fit.forms.iter().zip(probabilities);
        let named = |(form, probability): (&usize, &f64)| {
            let Form {
                effect, variant, ..
            } = &self.forms[*form];
            let parameters = estimates.by_ref().take(variant.quantities.len());
            Named::new(
                &*effects[*effect],
                variant,
                parameters.collect(),
                (*probability, 0.0),
            )
        };
        each.map(named).collect()
    }

    fn scores(&self, before: &Fit, now: &Fit) -> Result<Vec<LoadScore>, String> {
        let [before, after] = [before, now].map(|fit| self.motors(&fit.forms, &fit.at));
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

/// What loads say, in a sentence.
fn words(named: &[Named], share: f64, left: f64, grows: bool) -> String {
    let all: Vec<&str> = named.iter().map(|n| n.words.as_str()).collect();
    let rest = match left {
        left if left > LEFT => format!(", and {left:.0} times what noise makes is left"),
        _ => String::new(),
    };
    match all[..] {
        [] if left > LEFT && !grows => {
            "What the motors report as their loads falls as the model's torques grow: is its sign reversed?".into()
        }
        [] if left > LEFT => format!(
            "What the motors report as their loads differs from the model's torques by {:.0} times what noise makes, and \
             nothing that is known explains it.",
            left
        ),
        [] => "The motors' loads are as the model's torques say.".into(),
        _ => format!(
            "The motors' loads show: {}. That explains {:.0} % of their mismatch{rest}.",
            all.join("; "),
            100.0 * share
        ),
    }
}
