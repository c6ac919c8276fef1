//! `auxetica diagnose --curves`

use super::{Options, numbers};
use crate::cli::progress::shared;
use crate::cli::table::table;
use crate::cli::{Failure, write_whole};
use crate::diagnose::curves::verdict::{
    CurvesDiagnosis, CurvesLocation, FittedRods, ScoredQuantity,
};
use crate::diagnose::curves::{CurvesRequest, diagnose_curves};
use crate::diagnose::verdict::Kind;
use std::path::{Path, PathBuf};

pub(super) fn run(options: &Options, file: &Path, quiet: bool) -> Result<(), Failure> {
    let scenarios = options.load()?;
    let request = CurvesRequest {
        scenarios: &scenarios,
        file,
        rows: &options.rows,
        effects: &options.effects,
    };
    let told = shared("diagnosing", quiet);
    let (diagnosis, augmented) = options.at_work(|| diagnose_curves(&request, &told))?;
    drop(told);
    options.tell(&diagnosis, show)?;
    if let Some(path) = &options.write_scenario {
        for (source, of) in augmented.iter().zip(&options.scenarios) {
            let to = match augmented.len() {
                1 => path.clone(),
                _ => beside(path, of),
            };
            write_whole(&to, source.text())?;
        }
    }
    Ok(())
}

/// `out/x.ron` for `rod_4.ron` is `out/x-rod_4.ron`.
fn beside(path: &Path, scenario: &Path) -> PathBuf {
    let stem = |path: &Path| path.file_stem().unwrap_or_default().display().to_string();
    path.with_file_name(format!("{}-{}.ron", stem(path), stem(scenario)))
}

/// The diagnosis for people.
fn show(d: &CurvesDiagnosis) -> String {
    let mut text = format!("{}\n", d.words);
    // within the error bars there is no where
    if d.verdict != Kind::None {
        text += &location(&d.location);
    }
    for effect in &d.effects {
        text += &format!(
            "\n{} ({}), probability {:.2}\n  {}\n",
            effect.id, effect.words, effect.probability, effect.equation
        );
        text += &numbers(&effect.parameters);
    }
    if let Some(e) = &d.experiment {
        text += &format!("{}\n", e.sentence());
    }
    for alarm in &d.alarms {
        text += &format!("note: {alarm}\n");
    }
    for line in &d.audit {
        text += &format!("{line}\n");
    }
    text += &format!("\n{}\n", results(&d.baseline, &d.augmented));
    text += &format!(
        "error bars at least {:.0} %; mean squared residual where it was left out {:.2} before, {:.2} after; {:.1} s",
        100.0 * d.floor,
        d.baseline.reduced_chi2,
        d.augmented.reduced_chi2,
        d.seconds
    );
    text
}

fn location(location: &CurvesLocation) -> String {
    let mut text = format!("\nwhere: {}\n", location.state);
    for q in &location.quantities {
        text += &format!(
            "  {}: {:.0} % ({:.0} % when calibrated by all)\n",
            q.quantity.replace('_', " "),
            100.0 * q.share,
            100.0 * q.calibrated
        );
    }
    text
}

fn results(before: &FittedRods, after: &FittedRods) -> String {
    let rows = after.figures.iter().map(|a| {
        let same =
            |b: &&ScoredQuantity| b.rod == a.rod && b.quantity == a.quantity && b.role == a.role;
        let b = before.figures.iter().find(same);
        vec![
            a.rod.clone(),
            format!("{} [{}]", a.quantity.replace('_', " "), a.unit),
            a.role.clone(),
            b.map_or("-".into(), |b| format!("{:.3}", b.rmse)),
            format!("{:.3}", a.rmse),
            b.map_or("-".into(), |b| format!("{:.2}", b.rms_in_bars)),
            format!("{:.2}", a.rms_in_bars),
        ]
    });
    let header = [
        "rod",
        "quantity",
        "role",
        "before",
        "after",
        "before [bars]",
        "after [bars]",
    ];
    table(&header, rows)
}
