//! Draws cases and simulates their recordings.

use super::spec::{Foreign, Spec};
use super::truth::{Concealed, Truth};
use super::{ChallengeError, NOMINAL, RECORDINGS, SEAL, TRUTH, hash, tours};
use crate::compare::film;
use crate::config::{Problem, Problems, Source};
use crate::identify::{Effect, Parameter, Robot, Variant};
use crate::recordings::{Pose, RADIANS_PER_TICK, Recording, RobotGeometry};
use nalgebra::{UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal};
use std::path::Path;

/// Drawn values of uncertain numbers are at most so many deviations from their mean.
const FARTHEST: f64 = 1.5;
/// Draws of a case before giving up: a strong effect may leave the robot without a steady state.
const DRAWS: u64 = 20;

impl Spec {
    /// Reads a specification; returns its scenario, too.
    ///
    /// # Errors
    /// If it can't be read, or its scenario can't.
    pub fn load(file: &Path) -> Result<(Self, Source), ChallengeError> {
        let text = std::fs::read_to_string(file).map_err(|e| ChallengeError::file(file, e))?;
        let spec: Self = crate::config::options().from_str(&text).map_err(|e| {
            ChallengeError::Unfit(format!("{}:{}: {}", file.display(), e.span, e.code))
        })?;
        if let Some(e) = spec.wrong() {
            let file = file.display();
            return Err(ChallengeError::Unfit(format!("{file}: {e}")));
        }
        let folder = file.parent().unwrap_or(Path::new("."));
        let source = Source::load(&folder.join(&spec.scenario), &[])?;
        Ok((spec, source))
    }

    /// What makes no sense, in words.
    fn wrong(&self) -> Option<String> {
        let (mesh, strength) = (&self.mesh, (*self.strength.0, *self.strength.1));
        let reversed = |field: &str, least: f64, most: f64| {
            let wrong = least > most || !least.is_finite() || !most.is_finite();
            wrong.then(|| format!("`{field}` goes from {least} to {most}; give the least first"))
        };
        let foreign =
            |f: &Foreign| reversed(&format!("range of `{}`", f.words), f.range.0, f.range.1);
        reversed("mesh", mesh.1 as f64, mesh.2 as f64)
            .or_else(|| reversed("strength", strength.0, strength.1))
            .or_else(|| self.foreign.iter().find_map(foreign))
            .or_else(|| {
                (self.set_points < 3).then(|| {
                    "`set_points` is less than 3, which no diagnosis takes; give more".into()
                })
            })
    }
}

/// Makes all cases in the new folder `out`.
///
/// # Errors
/// If the folder exists, can't be written, or a case has no steady state however it is drawn.
pub fn conceal(
    spec: &Spec,
    nominal: &Source,
    out: &Path,
    told: &(dyn Fn(f64) + Sync),
) -> Result<Vec<Truth>, ChallengeError> {
    let own = Parameter::declared(nominal)?;
    let robot = Robot::of(nominal)?;
    let (rods, recorded) = (robot.rods.len(), RobotGeometry::default().rods.len());
    if rods != recorded {
        return Err(ChallengeError::Unfit(format!(
            "the scenario has {rods} rods, but recordings are of a robot with {recorded}; give a scenario of that robot"
        )));
    }
    let above = out.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(above).map_err(|e| ChallengeError::file(above, e))?;
    // what is there already is kept
    std::fs::create_dir(out).map_err(|e| ChallengeError::file(out, e))?;
    let count = spec.controls + spec.singles + spec.doubles + spec.foreigners;
    // the order of kinds tells nothing
    let mut kinds: Vec<Kind> = [
        (Kind::Control, spec.controls),
        (Kind::Single, spec.singles),
        (Kind::Double, spec.doubles),
        (Kind::Foreign, spec.foreigners),
    ]
    .into_iter()
    .flat_map(|(kind, n)| std::iter::repeat_n(kind, n))
    .collect();
    rand::seq::SliceRandom::shuffle(&mut kinds[..], &mut Pcg64Mcg::seed_from_u64(spec.seed));
    let done = std::sync::atomic::AtomicUsize::new(0);
    let cases: Result<Vec<Truth>, ChallengeError> = kinds
        .par_iter()
        .enumerate()
        .map(|(i, kind)| {
            let name = format!("case_{i:03}");
            let draw = Draw {
                spec,
                nominal,
                own: &own,
                robot: &robot,
            };
            let truth = draw.case(&name, i as u64, *kind, &out.join(&name))?;
            let done = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
            told(done as f64 / count as f64);
            Ok(truth)
        })
        .collect();
    let cases = cases?;
    let sealed = serde_json::to_string_pretty(&cases).expect("truths are plain data");
    let write = |name: &str, text: &str| {
        let file = out.join(name);
        std::fs::write(&file, text).map_err(|e| ChallengeError::file(&file, e))
    };
    write(NOMINAL, nominal.text())?;
    write(SEAL, &hash(&sealed))?;
    write(TRUTH, &sealed)?;
    Ok(cases)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Control,
    Single,
    Double,
    Foreign,
}

struct Draw<'a> {
    spec: &'a Spec,
    nominal: &'a Source,
    own: &'a [Parameter],
    robot: &'a Robot,
}

/// Standard normal draws.
fn normal(random: &mut Pcg64Mcg) -> f64 {
    Normal::standard().inverse_cdf(random.random_range(1e-12..1.0 - 1e-12))
}

impl Draw<'_> {
    fn case(
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
            let (truth, source) = self.model(name, kind, &mut random)?;
            match self.recordings(&source, &mut random) {
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

    /// What is concealed, and the scenario that has it.
    fn model(
        &self,
        case: &str,
        kind: Kind,
        random: &mut Pcg64Mcg,
    ) -> Result<(Truth, Source), Problems> {
        let (path, least, most) = &self.spec.mesh;
        let elements = random.random_range(*least..=*most);
        let mut sets = vec![format!("{path}={elements}")];
        let mut parameters = Vec::new();
        for p in self.own {
            let (mean, deviation) = p.prior.unwrap_or((p.nominal, 0.1 * p.width()));
            let away = normal(random).clamp(-FARTHEST, FARTHEST) * deviation;
            let value = (mean + away).clamp(p.range.0, p.range.1);
            sets.push(p.set(value));
            parameters.push((p.name.clone(), value));
        }
        let mut source = self.nominal.with(&sets)?;
        let mut effects: Vec<Concealed> = Vec::new();
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
        let mut known = <dyn Effect>::all();
        known.retain(|effect| effect.is_cause());
        let count = match kind {
            Kind::Control => 0,
            Kind::Single | Kind::Foreign => 1,
            Kind::Double => 2,
        };
        while effects.len() < count {
            let effect = &known[random.random_range(0..known.len())];
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
        let truth = Truth {
            case: case.to_owned(),
            effects,
            parameters,
            elements,
        };
        Ok((truth, source))
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

    fn recordings(
        &self,
        source: &Source,
        random: &mut Pcg64Mcg,
    ) -> Result<Vec<Recording>, ChallengeError> {
        let one = |name: &&str| self.recording(name, source, random);
        RECORDINGS.iter().map(one).collect()
    }

    fn recording(
        &self,
        name: &str,
        source: &Source,
        random: &mut Pcg64Mcg,
    ) -> Result<Recording, ChallengeError> {
        let spec = self.spec;
        let geometry = RobotGeometry::default();
        let azimuths = geometry.rods.map(|[x, y]| f64::atan2(y, x));
        let kind = name.rsplit('_').next().unwrap_or_default();
        let points = tours::set_points(kind, spec, &azimuths, random);
        let (times, wound, goals) = tours::rows(&points, spec);
        let ticks = |wound: &[f64]| -> [f64; 4] {
            std::array::from_fn(|i| (self.robot.handed[i] * wound[i] / RADIANS_PER_TICK).round())
        };
        let present: Vec<[f64; 4]> = wound.iter().map(|w| ticks(w)).collect();
        let goal: Vec<[f64; 4]> = goals.iter().map(|k| ticks(&points[*k])).collect();
        let angles: Vec<[f64; 4]> =
            (present.iter().map(|row| row.map(|t| t * RADIANS_PER_TICK))).collect();
        let inputs =
            crate::compare::motor_inputs(&times, &angles).map_err(ChallengeError::Unfit)?;
        let poses =
            film(source, inputs, &times).map_err(|e| ChallengeError::Unfit(e.to_string()))?;

        let vector =
            |size: f64, random: &mut Pcg64Mcg| Vector3::from_fn(|_, _| size * normal(random));
        let bias = [0, 1].map(|_| (vector(*spec.bias.0, random), vector(*spec.bias.1, random)));
        let mut seen = |b: usize, pose: &Pose| {
            let shift = bias[b].0 + vector(*spec.noise.0, random);
            let turn = UnitQuaternion::from_scaled_axis(bias[b].1 + vector(*spec.noise.1, random));
            let moved = pose.translation.vector + shift;
            Pose::from_parts(moved.into(), turn * pose.rotation)
        };
        let poses: Vec<[Pose; 2]> = (poses.iter())
            .map(|[platform, ring]| [seen(0, platform), seen(1, ring)])
            .collect();
        let late = *spec.jitter / 2.0_f64.sqrt();
        let most = 0.4 / *spec.rate;
        let time = (times.iter())
            .map(|t| 1.0 + t + (late * normal(random)).clamp(-most, most))
            .collect();
        Ok(Recording::simulated(name, time, goal, present, &poses))
    }
}
