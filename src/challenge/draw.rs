//! Draws what a case conceals.

use super::ChallengeError;
use super::spec::{Recorded, Spec};
use super::spiked::Background;
use super::toured::normal;
use super::truth::{Concealed, Truth};
use crate::compare::CompareError;
use crate::config::{Problem, Problems, Source};
use crate::identify::{Effect, Parameter, Robot, Variant};
use crate::recordings::Recording;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::path::Path;

/// Drawn values of uncertain numbers are at most so many deviations from their mean.
const FARTHEST: f64 = 1.5;
/// Draws of a case before giving up: a strong effect may leave the robot without a steady state.
const DRAWS: u64 = 20;

/// How much a case conceals.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Control,
    Single,
    Double,
    Foreign,
}

/// What cases are drawn from.
pub(super) struct Draw<'a> {
    pub(super) spec: &'a Spec,
    pub(super) nominal: &'a Source,
    pub(super) own: &'a [Parameter],
    pub(super) robot: &'a Robot,
    /// Real recordings that effects are concealed in, if they are.
    pub(super) real: &'a [Background],
}

impl Draw<'_> {
    /// Makes a case in a new folder.
    ///
    /// # Errors
    /// If the folder can't be made, or the case has no steady state however it is drawn.
    pub(super) fn case(
        &self,
        name: &str,
        index: u64,
        kind: Kind,
        folder: &Path,
    ) -> Result<Truth, ChallengeError> {
        let mut last = String::new();
        for draw in 0..DRAWS {
            let seed = self.spec.seed ^ (index + 1) << 32 ^ draw << 16;
            let mut random = Pcg64Mcg::seed_from_u64(seed);
            let (mut truth, plain) = self.robot(name, &mut random)?;
            let source = self.conceal((index, kind), &plain, &mut truth, &mut random)?;
            match self.recordings([&plain, &source], &mut random) {
                Ok(recordings) => {
                    std::fs::create_dir(folder).map_err(|e| ChallengeError::file(folder, e))?;
                    for recording in recordings {
                        recording.write(folder.join(&recording.name))?;
                    }
                    return Ok(truth);
                }
                Err(e) => last = format!("{:?}: {e}", truth.effects),
            }
        }
        Err(ChallengeError::Unfit(format!(
            "`{name}` has no steady states in {DRAWS} draws; the last: {last}"
        )))
    }

    /// The robot of a case, and what is true of it.
    fn robot(&self, case: &str, random: &mut Pcg64Mcg) -> Result<(Truth, Source), Problems> {
        let (path, least, most) = &self.spec.mesh;
        let elements = random.random_range(*least..=*most);
        let mut sets = vec![format!("{path}={elements}")];
        let mut parameters = Vec::new();
        for p in self.own {
            let mut value = p.nominal;
            if let Recorded::Simulated(_) = self.spec.recordings {
                let (mean, deviation) = p.prior.unwrap_or((p.nominal, 0.1 * p.width()));
                let away = normal(random).clamp(-FARTHEST, FARTHEST) * deviation;
                value = (mean + away).clamp(p.range.0, p.range.1);
            }
            sets.push(p.set(value));
            parameters.push((p.name.clone(), value));
        }
        let truth = Truth {
            case: case.to_owned(),
            effects: Vec::new(),
            parameters,
            elements,
            real: matches!(self.spec.recordings, Recorded::Real(_)),
        };
        Ok((truth, self.nominal.with(&sets)?))
    }

    /// The scenario with what a case conceals, which is put down.
    fn conceal(
        &self,
        (index, kind): (u64, Kind),
        plain: &Source,
        truth: &mut Truth,
        random: &mut Pcg64Mcg,
    ) -> Result<Source, Problems> {
        let mut source = plain.with(&[])?;
        let effects = &mut truth.effects;
        if kind == Kind::Foreign {
            let foreign = &self.spec.foreign;
            if foreign.is_empty() {
                return Err(
                    Problem::new("`foreigners` are asked for, but `foreign` lists none").into(),
                );
            }
            let which = &foreign[random.random_range(0..foreign.len())];
            let value = random.random_range(which.range.0..=which.range.1);
            let entry = which.entry.replace("{0}", &format!("{value:?}"));
            let set = match source.values(&which.list) {
                Ok(_) => format!("{}[+]={entry}", which.list),
                Err(_) => format!("{}=[{entry}]", which.list),
            };
            source = source.with(&[set])?;
            effects.push(Concealed {
                id: Concealed::FOREIGN.to_owned(),
                form: which.words.clone(),
                hook: String::new(),
                values: vec![(String::new(), value)],
            });
        }
        let known = self.known()?;
        let count = match kind {
            Kind::Control => 0,
            Kind::Single | Kind::Foreign => 1,
            Kind::Double => 2,
        };
        while effects.len() < count {
            // of effects that are listed, each has its turn
            let which = match (&self.spec.effects[..], effects.is_empty()) {
                ([], _) | (_, false) => random.random_range(0..known.len()),
                (listed, true) => index as usize % listed.len(),
            };
            let effect = &known[which];
            let variants = effect.variants(self.robot);
            if variants.is_empty() || effects.iter().any(|e| e.id == effect.id()) {
                continue;
            }
            let variant = &variants[random.random_range(0..variants.len())];
            let values = self.strength(variant, random);
            source = variant.apply(&source, &values)?;
            let names = variant.quantities.iter().map(|q| q.name.clone());
            effects.push(Concealed {
                id: effect.id().to_owned(),
                form: variant.name.clone(),
                hook: effect.hook().name(),
                values: names.zip(values).collect(),
            });
        }
        Ok(source)
    }

    /// Effects that may be concealed.
    fn known(&self) -> Result<Vec<Box<dyn Effect>>, Problem> {
        let listed = self.spec.effects.iter();
        let chosen = listed.map(|id| {
            let mut all = <dyn Effect>::all();
            let known: Vec<&str> = all.iter().map(|e| e.id()).collect();
            let Some(place) = known.iter().position(|k| k == id) else {
                let remedy = crate::config::remedy(id, &known, "effects");
                return Err(Problem::new(format!("there is no effect `{id}`; {remedy}")));
            };
            let effect = all.swap_remove(place);
            if effect.variants(self.robot).is_empty() {
                return Err(Problem::new(format!("`{id}` can't act on this robot")));
            }
            Ok(effect)
        });
        let chosen: Vec<_> = chosen.collect::<Result<_, _>>()?;
        if chosen.is_empty() {
            let mut all = <dyn Effect>::all();
            // how strong an effect is drawn goes by poses
            all.retain(|effect| effect.is_cause() && !effect.in_loads());
            return Ok(all);
        }
        Ok(chosen)
    }

    /// Recordings of the robot as it is and with what is concealed.
    fn recordings(
        &self,
        [plain, source]: [&Source; 2],
        random: &mut Pcg64Mcg,
    ) -> Result<Vec<Recording>, ChallengeError> {
        match &self.spec.recordings {
            Recorded::Simulated(tours) => tours.recordings(source, &self.robot.handed, random),
            Recorded::Real(_) => {
                let moved = |real: &Background| {
                    let films = [plain, source].map(|source| real.film(source));
                    let [plain, changed] = films;
                    let unfit = |e: CompareError| ChallengeError::Unfit(e.to_string());
                    Ok(real.moved(&plain.map_err(unfit)?, &changed.map_err(unfit)?))
                };
                self.real.iter().map(moved).collect()
            }
        }
    }

    /// Values of an effect: one strength for all numbers that make it, others within a factor of two.
    fn strength(&self, variant: &Variant, random: &mut Pcg64Mcg) -> Vec<f64> {
        let (least, most) = &self.spec.strength;
        let strength = random.random_range(least.ln()..=most.ln()).exp();
        let value = |q: &crate::identify::Quantity, random: &mut Pcg64Mcg| {
            let vary = random.random_range(-0.7_f64..0.7).exp();
            let value = if (q.typical - q.null).abs() < 1e-12 {
                q.typical * vary
            } else if q.absent_where_large() {
                q.typical / strength
            } else {
                q.null + strength * (q.typical - q.null)
            };
            value.clamp(q.range.0, q.range.1)
        };
        variant
            .quantities
            .iter()
            .map(|q| value(q, random))
            .collect()
    }
}
