//! `auxetica diagnose`

mod curves;

use super::progress::shared;
use super::table::table;
use super::{Failure, print, write_whole};
use crate::config::Source;
use crate::diagnose::verdict::{Diagnosis, Estimated, Fitted, LoadScore, Loads, Noticeable};
use crate::diagnose::{DiagnoseError, Request, diagnose};
use serde::Serialize;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(super) struct Options {
    /// Scenario file; by measured curves, one for each rod.
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// Replace a value, as in `rods[0].length=0.12` or `laws[*].apply.factor=0.009`; may be given several times.
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Recordings to train on, two at least.
    #[arg(long, value_name = "DIR", num_args = 1.., required_unless_present = "curves")]
    train: Vec<PathBuf>,
    /// Recordings that nothing is fitted to, to judge by.
    #[arg(long, value_name = "DIR", num_args = 1..)]
    holdout: Vec<PathBuf>,
    /// Diagnose rods by their measured curves instead: a CSV file with the columns quantity, unit, twist_angle_deg, value,
    /// error_minus, error_plus and, for several rods, rows.
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["train", "holdout", "report"])]
    curves: Option<PathBuf>,
    /// The scenarios' rods in that file, by their numbers of rows; by default those that are as long.
    #[arg(long, value_name = "LIST", value_delimiter = ',', requires = "curves")]
    rows: Vec<u32>,
    /// Effects to try, separated by commas; all if left out (`auxetica plugins` lists them).
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    effects: Vec<String>,
    /// Write the diagnosis as JSON, to a file or to stdout if `-`.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write a page for the browser.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Write the scenario with the named effects; of several, each with its own name behind a dash.
    #[arg(long, value_name = "FILE.ron")]
    write_scenario: Option<PathBuf>,
    /// Seed of the calibration's second start.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads; all cores if left out.
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

pub(super) fn run(options: &Options, quiet: bool) -> Result<(), Failure> {
    options.check_outputs()?;
    match &options.curves {
        Some(file) => curves::run(options, file, quiet),
        None => by_recordings(options, quiet),
    }
}

fn by_recordings(options: &Options, quiet: bool) -> Result<(), Failure> {
    let [source] = &options.load()?[..] else {
        let what = "recordings are of one robot, and several scenarios are given; give one";
        return Err(Failure::Unknown(what.into()));
    };
    let request = Request {
        source,
        train: &options.train,
        holdout: &options.holdout,
        effects: &options.effects,
        seed: options.seed,
    };
    let told = shared("diagnosing", quiet);
    let (diagnosis, augmented) = options.at_work(|| diagnose(&request, &told))?;
    drop(told);
    options.tell(&diagnosis, show)?;
    if let Some(path) = &options.write_scenario {
        write_whole(path, augmented.text())?;
    }
    if let Some(path) = &options.report {
        let page = crate::diagnose::page::page(&diagnosis, source.name(), &options.commands());
        write_whole(path, &page)?;
    }
    Ok(())
}

impl Options {
    /// Refuses files that can't be written before anything is computed.
    fn check_outputs(&self) -> Result<(), Failure> {
        let outputs = [&self.json, &self.report, &self.write_scenario];
        for path in outputs.into_iter().flatten() {
            let folder = path.parent().filter(|folder| *folder != Path::new(""));
            if folder.is_some_and(|folder| !folder.is_dir()) || path.is_dir() {
                return Err(Failure::Unknown(format!(
                    "{path:?} can't be written: its folder does not exist, or it is a folder; make the folder, or name \
                     another file"
                )));
            }
        }
        Ok(())
    }

    /// The command that was given, and one that uses the scenario that it wrote.
    fn commands(&self) -> Vec<String> {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+".contains(c);
        let quoted = |word: String| match word.chars().all(plain) {
            true => word,
            false => format!("'{}'", word.replace('\'', r"'\''")),
        };
        let given = std::env::args_os().skip(1);
        let given = given.map(|word| quoted(word.to_string_lossy().into_owned()));
        let given = format!("auxetica {}", given.collect::<Vec<_>>().join(" "));
        let (scenario, recording) = (self.write_scenario.as_ref(), self.holdout.first());
        let using = scenario.zip(recording).map(|(scenario, recording)| {
            let [scenario, recording] =
                [scenario, recording].map(|path| quoted(path.display().to_string()));
            format!("auxetica compare {scenario} --recording {recording}")
        });
        std::iter::once(given).chain(using).collect()
    }

    fn load(&self) -> Result<Vec<Source>, Failure> {
        let load = |file: &PathBuf| Ok(Source::load(file, &self.set)?);
        self.scenarios.iter().map(load).collect()
    }

    /// Does the work with as many threads as are asked for.
    fn at_work<T: Send>(
        &self,
        work: impl FnOnce() -> Result<T, DiagnoseError> + Send,
    ) -> Result<T, Failure> {
        let Some(jobs) = self.jobs else {
            return Ok(work()?);
        };
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(jobs.max(1))
            .build();
        let pool =
            pool.map_err(|e| Failure::Unknown(format!("no {jobs} threads could be started: {e}")))?;
        Ok(pool.install(work)?)
    }

    /// Shows a diagnosis, and writes it as JSON.
    fn tell<T: Serialize>(&self, diagnosis: &T, show: fn(&T) -> String) -> Result<(), Failure> {
        let to_stdout = self.json.as_deref() == Some(Path::new("-"));
        if !to_stdout {
            print(&show(diagnosis))?;
        }
        let Some(path) = &self.json else {
            return Ok(());
        };
        let text = serde_json::to_string_pretty(diagnosis).expect("a diagnosis is plain data");
        if to_stdout {
            print(&text)
        } else {
            write_whole(path, &(text + "\n"))
        }
    }
}

/// The diagnosis for people.
fn show(d: &Diagnosis) -> String {
    let mut text = format!("{}\n\n", d.words);
    for effect in &d.effects {
        text += &format!(
            "{} ({}), probability {:.2}\n  {}\n",
            effect.id, effect.words, effect.probability, effect.equation
        );
        text += &numbers(&effect.parameters);
    }
    if let Some(h) = &d.hidden {
        text += &h.words();
        text += "\n";
    }
    if !d.noticeable.is_empty() {
        let all = d.noticeable.iter().map(Noticeable::words);
        let all = all.collect::<Vec<_>>().join("\n  ");
        text +=
            &format!("from where on effects would have been noticed, to first order:\n  {all}\n");
    }
    if let Some(e) = &d.experiment {
        text += &format!("{}\n", e.sentence());
        for prediction in &e.predictions {
            text += &format!("  {}\n", prediction.words());
        }
        text += &e
            .power()
            .map_or_else(String::new, |power| format!("  {power}\n"));
    }
    text += &format!("\nwhere: {}\n", d.location.state);
    for c in d.location.channels.iter().take(3) {
        text += &format!("  {} {}: {:.0} %\n", c.body, c.channel, 100.0 * c.share);
    }
    for alarm in &d.alarms {
        text += &format!("note: {alarm}\n");
    }
    text += &d.loads.as_ref().map_or_else(String::new, loads);
    text += &format!("\n{}\n", results(&d.baseline, &d.augmented));
    text += &format!(
        "floor {:.3} mm, {:.2} mrad; mean squared residual {:.2} before, {:.2} after; {:.1} s",
        d.floor.position_mm,
        d.floor.rotation_mrad,
        d.baseline.reduced_chi2,
        d.augmented.reduced_chi2,
        d.seconds
    );
    text
}

fn loads(loads: &Loads) -> String {
    let heads = ["recording", "role", "loads before", "after"];
    let row = |r: &LoadScore| {
        let [before, after] = r.rms.map(|rms| format!("{rms:.2}"));
        vec![r.name.clone(), r.role.clone(), before, after]
    };
    let rows = table(&heads, loads.recordings.iter().map(row));
    format!("\n{}\n{rows}\n", loads.words)
}

fn numbers(parameters: &[Estimated]) -> String {
    let line = |p: &Estimated| {
        let [value, interval] = p.figures();
        format!("  {} = {value} ({interval}) {}\n", p.name, p.unit)
    };
    parameters.iter().map(line).collect()
}

fn results(before: &Fitted, after: &Fitted) -> String {
    let rows = before
        .recordings
        .iter()
        .zip(&after.recordings)
        .map(|(b, a)| {
            vec![
                b.name.clone(),
                b.role.to_owned(),
                format!("{:.3}", b.position_rmse_mm),
                format!("{:.3}", a.position_rmse_mm),
                format!("{:.2}", b.rotation_rmse_mrad),
                format!("{:.2}", a.rotation_rmse_mrad),
            ]
        });
    table(
        &[
            "recording",
            "role",
            "before [mm]",
            "after [mm]",
            "before [mrad]",
            "after [mrad]",
        ],
        rows,
    )
}
