//! `auxetica conceal` and `auxetica score`

use super::progress::shared;
use super::table::table;
use super::{Failure, print};
use crate::challenge::{self, CaseResult, Spec, Tally};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct ConcealOptions {
    /// What the challenge is made of, a RON file.
    spec: PathBuf,
    /// Folder for the cases, which must not exist.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Seed in place of the file's.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
}

#[derive(clap::Args)]
pub(super) struct ScoreOptions {
    /// Folder of the challenge.
    challenge: PathBuf,
    /// Seed of the diagnoses.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// End with an error if more than this share of controls is given an effect.
    #[arg(long, value_name = "SHARE")]
    at_most_false: Option<f64>,
    /// End with an error if less than this share of visible single effects is named rightly.
    #[arg(long, value_name = "SHARE")]
    at_least_right: Option<f64>,
    /// Diagnose each case once more without the effects that it conceals.
    #[arg(long)]
    hide: bool,
}

pub(super) fn conceal(options: &ConcealOptions, quiet: bool) -> Result<(), Failure> {
    let (mut spec, nominal) = Spec::load(&options.spec)?;
    spec.seed = options.seed.unwrap_or(spec.seed);
    let told = shared("concealing", quiet);
    let cases = challenge::conceal(&spec, &nominal, &options.out, &told)?;
    drop(told);
    print(&format!(
        "{} cases in `{}`; what they conceal is in its `{}`",
        cases.len(),
        options.out.display(),
        challenge::TRUTH
    ))
}

pub(super) fn score(options: &ScoreOptions, quiet: bool) -> Result<(), Failure> {
    let told = shared("diagnosing", quiet);
    let (results, tally) = challenge::score(&options.challenge, options.seed, options.hide, &told)?;
    drop(told);
    print(&format!("{}\n{}", cases(&results), summary(&tally)))?;
    let share = |(all, some): (usize, usize)| some as f64 / (all.max(1)) as f64;
    let missed = |what: &str| Err(challenge::ChallengeError::Unfit(what.to_owned()).into());
    if options
        .at_most_false
        .is_some_and(|most| share(tally.controls) > most)
    {
        return missed("too many controls were given an effect");
    }
    if options
        .at_least_right
        .is_some_and(|least| share(tally.singles) < least)
    {
        return missed("too few visible effects were named rightly");
    }
    Ok(())
}

fn cases(results: &[CaseResult]) -> String {
    let rows = results.iter().map(|r| {
        let concealed = r
            .truth
            .effects
            .iter()
            .map(|e| format!("{} {}", e.id, e.form));
        let concealed = concealed.collect::<Vec<_>>().join(" + ");
        vec![
            r.truth.case.clone(),
            if concealed.is_empty() {
                "nothing".into()
            } else {
                concealed
            },
            format!("{:.1}", r.visible),
            r.verdict.name(),
            r.said.join(", "),
            (if r.right { "yes" } else { "no" }).into(),
            r.hidden
                .map_or(String::new(), |(verdict, _)| verdict.name()),
            r.over_oracle.map_or(String::new(), |x| format!("{x:.2}")),
            format!("{:.0}", r.seconds),
        ]
    });
    table(
        &[
            "case",
            "concealed",
            "floors",
            "verdict",
            "said",
            "right",
            "hidden",
            "/oracle",
            "s",
        ],
        rows,
    )
}

fn summary(t: &Tally) -> String {
    let of = |(all, some): (usize, usize)| format!("{some} of {all}");
    let rows = [
        ("controls that were given an effect", of(t.controls)),
        (
            "visible single effects named, alone or in a class",
            of(t.singles),
        ),
        ("  named first", of((t.singles.0, t.first))),
        ("  among the first three", of((t.singles.0, t.third))),
        ("  with the right hook", of((t.singles.0, t.hooks))),
        ("visible doubles of which both are named", of(t.doubles)),
        (
            "visible effects of no library, given to another",
            of(t.foreigners),
        ),
        (
            "visible effects hidden from the library, given to another",
            of(t.hidden),
        ),
        (
            "median error of values",
            format!("{:.1} %", 100.0 * t.value_error),
        ),
        (
            "intervals of 95 % that hold the truth",
            format!("{:.0} %", 100.0 * t.coverage),
        ),
        (
            "median held-out error over the oracle's",
            format!("{:.2}", t.over_oracle),
        ),
    ];
    let rows = rows.map(|(what, figure)| vec![what.to_owned(), figure]);
    table(&["over all cases", ""], rows)
}
