//! `auxetica compare`

use super::progress::Meter;
use super::table::table;
use super::{Failure, ScenarioArgs, print, write_whole};
use crate::compare::{Comparison, Mode, SampleKind, compare};
use crate::config::Source;
use crate::engine::scenario::{Scenario, Solver};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(super) struct Options {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Folder of the recording, in the layout of the public data set.
    #[arg(long, value_name = "DIR")]
    recording: PathBuf,
    /// Write the result as JSON, to a file or to stdout if `-`.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// How to drive the scenario; by default as its solver says.
    #[arg(long)]
    mode: Option<Mode>,
    /// Which steady samples to take.
    #[arg(long, value_enum, default_value_t)]
    samples: SampleKind,
    /// End here [s].
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
}

pub(super) fn run(options: &Options, quiet: bool) -> Result<(), Failure> {
    let source = options.scenario.load()?;
    let mode = match options.mode {
        Some(mode) => mode,
        None => mode_of(&source)?,
    };
    let mut meter = Meter::new("comparing", quiet);
    let comparison = compare(
        &source,
        &options.recording,
        mode,
        options.samples,
        options.until,
        &mut |done| meter.update(done),
    )?;
    drop(meter);
    if !quiet {
        eprintln!("{}\n", comparison.audit.join("\n"));
    }
    let to_stdout = options.json.as_deref() == Some(Path::new("-"));
    if !to_stdout {
        print(&show(&comparison))?;
    }
    if let Some(path) = &options.json {
        let text = serde_json::to_string_pretty(&comparison).expect("a comparison is plain data");
        if to_stdout {
            print(&text)?;
        } else {
            write_whole(path, &(text + "\n"))?;
        }
    }
    Ok(())
}

fn mode_of(source: &Source) -> Result<Mode, Failure> {
    let scenario: Scenario<'_> = source.parse()?;
    Ok(match scenario.solver {
        Solver::Steady { .. } => Mode::Steady,
        Solver::Dynamic { .. } | Solver::Implicit { .. } => Mode::Dynamic,
    })
}

/// The comparison for people.
pub(super) fn show(c: &Comparison) -> String {
    let all = c.bodies.iter().map(|b| (b, b.name.to_owned()));
    let settled = (c.settled.iter()).map(|b| (b, format!("{}, settled", b.name)));
    let rows = all.chain(settled).map(|(b, name)| {
        let [x, y, z] = b.position_bias_mm;
        vec![
            name,
            format!("{:.3}", b.position_rmse_mm),
            format!("{:.2}", b.rotation_rmse_mrad),
            format!("{x:+.2} {y:+.2} {z:+.2}"),
            format!("{:.2}", b.worst.position_mm),
            format!("{} at {:.1} s", b.worst.sample, b.worst.time_s),
        ]
    });
    let rows = table(
        &[
            "body",
            "position RMSE [mm]",
            "rotation RMSE [mrad]",
            "bias x y z [mm]",
            "worst [mm]",
            "at sample",
        ],
        rows,
    );
    let what = match c.mode {
        Mode::Steady => "steady samples",
        Mode::Quasistatic => "rows, a steady state each",
        Mode::Dynamic => "rows through time",
    };
    let mut parts = String::new();
    if c.settled_samples > 0 {
        parts += &format!(", {} of them settled", c.settled_samples);
    }
    if c.skipped > 0 {
        parts += &format!(", {} dwells never settled", c.skipped);
    }
    if c.unsolved > 0 {
        parts += &format!(", {} samples without a steady state", c.unsolved);
    }
    format!(
        "{} against recording {} ({}): {} {what}{parts}, simulated in {:.2} s\n{rows}",
        c.scenario, c.recording, c.origin, c.samples, c.seconds
    )
}
