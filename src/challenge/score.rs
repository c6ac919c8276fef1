//! Diagnoses every case, then opens the truth and counts.

use super::truth::{Concealed, Truth};
use super::{ChallengeError, NOMINAL, SEAL, TRUTH, hash};
use crate::config::Source;
use crate::diagnose::verdict::{Diagnosis, Kind};
use crate::diagnose::{Request, diagnose, oracle};
use crate::identify::Effect;
use rayon::prelude::*;
use statrs::statistics::{Data, Median};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// File of a case's diagnosis, kept so that an interrupted score goes on.
const DIAGNOSIS: &str = "diagnosis.json";
/// The same of its diagnosis without the concealed effects.
const HIDDEN: &str = "hidden.json";
/// Share of the floor above which a mismatch is visible.
pub const VISIBLE: f64 = 0.7;

/// What was said of a case, beside what it concealed.
pub struct Result {
    /// The truth.
    pub truth: Truth,
    /// The verdict.
    pub verdict: Kind,
    /// Effects that were named, then alternatives.
    pub said: Vec<String>,
    /// Mismatch of the calibrated baseline in floors: the root of its mean squared residual less one.
    pub visible: f64,
    /// Whether the verdict is right; a class is right if it contains the effect.
    pub right: bool,
    /// Whether the first effect acts where the true one does.
    pub right_hook: bool,
    /// Errors of the true effect's values over their sizes, and whether each interval holds the truth.
    pub values: Vec<(f64, bool)>,
    /// Held-out position error of the improved model over that of the true effect's model.
    pub over_oracle: Option<f64>,
    /// The verdict without the true effects in the library, and whether they are given to another then, if that was asked
    /// for.
    pub hidden: Option<(Kind, bool)>,
    /// Time it took \[s\].
    pub seconds: f64,
}

/// Counts over a challenge.
#[derive(Default)]
pub struct Tally {
    /// Controls, and those in which something was named.
    pub controls: (usize, usize),
    /// Single effects that are visible; of these those named rightly, alone or in a class.
    pub singles: (usize, usize),
    /// Of these, those that were named first.
    pub first: usize,
    /// Of these, those among the first three.
    pub third: usize,
    /// Of these, those with the right hook.
    pub hooks: usize,
    /// Visible doubles, and those of which both effects were named.
    pub doubles: (usize, usize),
    /// Visible effects that are in no library, and those that were given to another without a warning.
    pub foreigners: (usize, usize),
    /// Visible single effects that were hidden from the library, and those that were given to another then without a
    /// warning.
    pub hidden: (usize, usize),
    /// Median error of values, over their sizes.
    pub value_error: f64,
    /// Share of intervals that hold the truth.
    pub coverage: f64,
    /// Median of held-out errors over the oracle's.
    pub over_oracle: f64,
}

/// Diagnoses the cases in `folder` that have no diagnosis yet, without the truth; then opens it. To `hide` is to diagnose
/// each case once more then, without the effects that it conceals.
///
/// # Errors
/// If a case can't be diagnosed, or the truth isn't the one that was sealed.
pub fn score(
    folder: &Path,
    seed: u64,
    hide: bool,
    told: &(dyn Fn(f64) + Sync),
) -> std::result::Result<(Vec<Result>, Tally), ChallengeError> {
    let nominal = Source::load(&folder.join(NOMINAL), &[])?;
    let mut cases = folders(folder)?;
    cases.retain(|case| recordings(case).is_ok_and(|[train, _]| !train.is_empty()));
    cases.sort();
    let done = AtomicUsize::new(0);
    cases.par_iter().try_for_each(|case| {
        keep_diagnosis(case, DIAGNOSIS, &nominal, (&[], seed))?;
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        told(done as f64 / cases.len() as f64);
        Ok::<_, ChallengeError>(())
    })?;
    // all is said; now the truth
    let sealed = read(&folder.join(TRUTH))?;
    if hash(&sealed) != read(&folder.join(SEAL))?.trim() {
        return Err(ChallengeError::Unfit(format!(
            "`{TRUTH}` is not the truth that was sealed in `{SEAL}`; make the challenge anew"
        )));
    }
    let truths: Vec<Truth> = parsed(&folder.join(TRUTH), &sealed)?;
    let judged = truths.into_par_iter().map(|truth| {
        let case = folder.join(&truth.case);
        let said = keep_diagnosis(&case, DIAGNOSIS, &nominal, (&[], seed))?;
        let known: Vec<(String, String, Vec<f64>)> = (truth.effects.iter())
            .filter(|e| e.id != Concealed::FOREIGN)
            .map(|e| {
                let values = e.values.iter().map(|(_, v)| *v).collect();
                (e.id.clone(), e.form.clone(), values)
            })
            .collect();
        let (mut best, mut hidden) = (None, None);
        if !known.is_empty() {
            let [train, holdout] = recordings(&case)?;
            best = oracle(&request(&nominal, &train, &holdout, (&[], seed)), &known).ok();
            if hide {
                let concealed = |e: &dyn Effect| known.iter().any(|(id, ..)| id == e.id());
                let others = <dyn Effect>::all().into_iter();
                let others = others
                    .filter(|e| !concealed(&**e))
                    .map(|e| e.id().to_owned());
                let others: Vec<String> = others.collect();
                hidden = Some(keep_diagnosis(&case, HIDDEN, &nominal, (&others, seed))?);
            }
        }
        Ok(judge(truth, &said, best, hidden.as_ref()))
    });
    let mut results = judged.collect::<std::result::Result<Vec<_>, ChallengeError>>()?;
    without_what_was_there(&mut results);
    let tally = Tally::of(&results);
    told(1.0);
    Ok((results, tally))
}

/// Whether nothing but a law that describes was named, which gives the mismatch to no cause.
fn describes(said: &[String]) -> bool {
    let effects = <dyn Effect>::all();
    let is_cause = |id: &String| effects.iter().any(|e| e.id() == id && e.is_cause());
    !said.is_empty() && !said.iter().any(is_cause)
}

/// Whether a mismatch is given to causes, without a warning.
fn given(verdict: Kind, said: &[String]) -> bool {
    !matches!(verdict, Kind::Unexplained | Kind::None | Kind::Insufficient) && !describes(said)
}

/// Effects that a diagnosis names, then alternatives.
fn named(said: &Diagnosis) -> Vec<String> {
    let effects = said.effects.iter().map(|e| &e.id);
    let all = effects.chain(said.alternatives.iter().map(|a| &a.id));
    all.cloned().collect()
}

/// Folders of a case's recordings: to train on, and to judge by.
fn recordings(case: &Path) -> std::result::Result<[Vec<PathBuf>; 2], ChallengeError> {
    let mut folders = folders(case)?;
    folders.sort();
    Ok(["train_", "holdout_"].map(|role| {
        let name = |f: &&PathBuf| {
            let name = f.file_name().and_then(|name| name.to_str());
            name.is_some_and(|name| name.starts_with(role))
        };
        folders.iter().filter(name).cloned().collect()
    }))
}

fn folders(of: &Path) -> std::result::Result<Vec<PathBuf>, ChallengeError> {
    let entries = std::fs::read_dir(of).map_err(|e| ChallengeError::file(of, e))?;
    let paths = entries.filter_map(|e| e.ok().map(|e| e.path()));
    Ok(paths.filter(|path| path.is_dir()).collect())
}

fn request<'a>(
    source: &'a Source,
    train: &'a [PathBuf],
    holdout: &'a [PathBuf],
    (effects, seed): (&'a [String], u64),
) -> Request<'a> {
    Request {
        source,
        train,
        holdout,
        effects,
        seed,
    }
}

/// The diagnosis of a case by some effects, kept in `file`, from which it is read if it is there.
fn keep_diagnosis(
    case: &Path,
    file: &str,
    nominal: &Source,
    by: (&[String], u64),
) -> std::result::Result<Diagnosis, ChallengeError> {
    let file = case.join(file);
    if file.exists() {
        return parsed(&file, &read(&file)?);
    }
    let [train, holdout] = recordings(case)?;
    let diagnosis = diagnose(&request(nominal, &train, &holdout, by), &|_| ());
    let (diagnosis, _) = diagnosis.map_err(|source| ChallengeError::Diagnosis {
        case: case.display().to_string(),
        source,
    })?;
    let text = serde_json::to_string_pretty(&diagnosis).expect("a diagnosis is plain data");
    let part = file.with_extension("part");
    std::fs::write(&part, text)
        .and_then(|()| std::fs::rename(&part, &file))
        .map_err(|e| ChallengeError::file(&file, e))?;
    Ok(diagnosis)
}

fn read(file: &Path) -> std::result::Result<String, ChallengeError> {
    std::fs::read_to_string(file).map_err(|e| ChallengeError::file(file, e))
}

fn parsed<T: serde::de::DeserializeOwned>(
    file: &Path,
    text: &str,
) -> std::result::Result<T, ChallengeError> {
    serde_json::from_str(text)
        .map_err(|e| ChallengeError::Unfit(format!("`{}`: {e}", file.display())))
}

/// Gives no credit for what is named in the same real recordings when nothing is concealed in them.
fn without_what_was_there(results: &mut [Result]) {
    let controls = |r: &&Result| r.truth.real && r.truth.effects.is_empty();
    let there: Vec<String> = (results.iter().filter(controls))
        .flat_map(|r| r.said.clone())
        .collect();
    for r in results {
        if r.truth.effects.iter().any(|e| there.contains(&e.id)) {
            r.right = false;
        }
    }
}

fn judge(
    truth: Truth,
    said: &Diagnosis,
    oracle: Option<f64>,
    hidden: Option<&Diagnosis>,
) -> Result {
    let ids = named(said);
    // what is said beside "unexplained" isn't claimed, but of real recordings there is always something unexplained
    let claimed = truth.real || said.verdict != Kind::Unexplained;
    let right = match truth.effects.len() {
        0 => said.verdict == Kind::None,
        1 if truth.effects[0].id == Concealed::FOREIGN => !claimed || describes(&ids),
        _ => claimed && truth.effects.iter().all(|e| ids.contains(&e.id)),
    };
    let first = said.effects.first().filter(|_| claimed);
    let hook = |e: &Concealed| first.is_some_and(|f| f.hook.name() == e.hook);
    let mut values = Vec::new();
    for e in &truth.effects {
        let named = said.effects.iter().find(|n| n.id == e.id);
        for (name, value) in &e.values {
            let same = named.and_then(|n| n.parameters.iter().find(|p| p.name == *name));
            if let Some(p) = same {
                let holds = p.ci95[0] <= *value && *value <= p.ci95[1];
                values.push(((p.value - value).abs() / value.abs().max(1e-9), holds));
            }
        }
    }
    let held: Vec<f64> = (said.augmented.recordings.iter())
        .filter(|r| r.role == "holdout")
        .map(|r| r.position_rmse_mm)
        .collect();
    let held = (held.iter().map(|x| x * x).sum::<f64>() / held.len().max(1) as f64).sqrt();
    Result {
        right_hook: truth.effects.first().is_some_and(hook),
        verdict: said.verdict,
        visible: (said.baseline.reduced_chi2 - 1.0).max(0.0).sqrt(),
        over_oracle: oracle.map(|o| held / o.max(said.floor.position_mm)),
        seconds: said.seconds,
        said: ids,
        right,
        values,
        hidden: hidden.map(|h| (h.verdict, given(h.verdict, &named(h)))),
        truth,
    }
}

impl Tally {
    fn of(results: &[Result]) -> Self {
        let mut tally = Self::default();
        let (mut errors, mut ratios) = (Vec::new(), Vec::new());
        for r in results {
            let foreign = r.truth.effects.iter().any(|e| e.id == Concealed::FOREIGN);
            let visible = r.visible > VISIBLE;
            match r.truth.effects.len() {
                // nobody knows what real recordings conceal
                0 if r.truth.real => {}
                0 => {
                    tally.controls.0 += 1;
                    tally.controls.1 += usize::from(!r.right);
                }
                1 if foreign && visible => {
                    tally.foreigners.0 += 1;
                    tally.foreigners.1 += usize::from(given(r.verdict, &r.said));
                }
                1 if visible && !foreign => {
                    let id = &r.truth.effects[0].id;
                    tally.singles.0 += 1;
                    tally.singles.1 += usize::from(r.right);
                    tally.first += usize::from(r.right && r.said.first() == Some(id));
                    let third = r.said.iter().take(3).any(|s| s == id);
                    tally.third += usize::from(r.right && third);
                    tally.hooks += usize::from(r.right_hook);
                    if let Some((_, given)) = r.hidden {
                        tally.hidden.0 += 1;
                        tally.hidden.1 += usize::from(given);
                    }
                }
                2 if visible => {
                    tally.doubles.0 += 1;
                    tally.doubles.1 += usize::from(r.right);
                }
                _ => {}
            }
            if visible && !foreign {
                errors.extend(r.values.iter().copied());
                ratios.extend(r.over_oracle);
            }
        }
        let inside = errors.iter().filter(|(_, holds)| *holds).count();
        tally.coverage = inside as f64 / errors.len() as f64;
        let errors = errors.iter().map(|(error, _)| *error).collect::<Vec<_>>();
        tally.value_error = Data::new(errors).median();
        tally.over_oracle = Data::new(ratios).median();
        tally
    }
}
