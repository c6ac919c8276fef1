//! `auxetica characterise`

mod angles;
mod json;
mod show;

use super::progress::Meter;
use super::{Failure, ScenarioArgs, print, write_whole};
use crate::characterise::{Bench, Characteristics, Comparison, Curves, Quantity, identify};
use crate::config::{Positive, Source};
use crate::identify::{Fit, Options as FitOptions, Parameter};
use angles::Angles;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

#[derive(clap::Args)]
pub(super) struct Options {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Which rod, if there are several.
    #[arg(long, value_name = "NAME")]
    rod: Option<String>,
    /// Twist angles [degrees], positive the way that winds the rod: a list `0,30,60`, or `0..180:7` for 7 of them.
    /// By default those of the measured curves, or else 0..180:7.
    #[arg(long, value_name = "ANGLES", value_parser = Angles::parse, allow_hyphen_values = true)]
    angles: Option<Angles>,
    /// Force that spring constants are measured with [N].
    #[arg(long, value_name = "NEWTONS", default_value = "1", value_parser = positive)]
    pull: f64,
    /// Measured curves to put beside: a CSV file with the columns quantity, unit, twist_angle_deg, value, error_minus,
    /// error_plus and, for several rods, rows.
    #[arg(long, value_name = "FILE")]
    curves: Option<PathBuf>,
    /// Put the measurements of Good et al. 2022 beside, of their rod of so many rows: 4, 6, 8, 10 or 12.
    #[arg(long, value_name = "ROWS", conflicts_with = "curves")]
    good2022: Option<u32>,
    /// Which rod of the measured curves, by its number of rows.
    #[arg(long, value_name = "ROWS", requires = "curves")]
    rows: Option<u32>,
    /// Write the result as JSON, to a file or to stdout if `-`.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Fit the rod to the measured curves: PATH=a..b is a number of the scenario and its range, and may be given several
    /// times; without one, all that the scenario declares under `uncertain`.
    #[arg(long, value_name = "PATH=a..b", num_args = 0..=1, default_missing_value = "")]
    fit: Vec<String>,
    /// Which measured quantities the fit uses; by default all.
    #[arg(
        long,
        value_name = "QUANTITIES",
        value_delimiter = ',',
        requires = "fit"
    )]
    fit_to: Vec<Quantity>,
    /// Descents of the fit: one from the scenario's values, the others from elsewhere in the ranges.
    #[arg(long, value_name = "COUNT", default_value = "5", requires = "fit",
          value_parser = clap::value_parser!(u16).range(1..))]
    starts: u16,
    /// Seed of those other places.
    #[arg(long, default_value = "1", requires = "fit")]
    seed: u64,
    /// Write the scenario with the fitted values: it stands alone and runs anywhere.
    #[arg(long, value_name = "FILE", requires = "fit")]
    write_scenario: Option<PathBuf>,
}

fn positive(text: &str) -> Result<f64, String> {
    let number: f64 = text
        .parse()
        .map_err(|_| "give a number above 0".to_owned())?;
    Positive::new(number).map(f64::from)
}

pub(super) fn run(options: &Options, quiet: bool) -> Result<(), Failure> {
    let curves = options.curves()?;
    let mut source = options.scenario.load()?;
    let mut bench = Bench::new(&source, options.rod.as_deref(), options.pull)?;
    let angles = options.angles(curves.as_ref());
    let characterise = |bench: &Bench| {
        let mut meter = Meter::new("characterising", quiet);
        bench.characterise(&angles, &mut |done| meter.update(done))
    };
    let mut found = characterise(&bench)?;
    let mut beside = curves
        .as_ref()
        .map(|curves| Comparison::new(curves, &found));
    let mut fitted = None;
    if !options.fit.is_empty() {
        let Some(curves) = &curves else {
            let what = "--fit needs measured curves; give --curves FILE or --good2022 ROWS";
            return Err(Failure::Unknown(what.into()));
        };
        let fit = options.fit(&source, &bench, curves, quiet)?;
        source = source.with(&fit.sets())?;
        bench = bench.with(&source)?;
        found = characterise(&bench)?;
        let before = beside.replace(Comparison::new(curves, &found));
        fitted = Some((fit, before.expect("curves are there")));
    }
    options.tell(&source, &bench, &found, beside.as_ref(), fitted.as_ref())
}

impl Options {
    /// Shows and writes what was found.
    fn tell(
        &self,
        source: &Source,
        bench: &Bench,
        found: &[Characteristics],
        beside: Option<&Comparison>,
        fitted: Option<&(Fit, Comparison)>,
    ) -> Result<(), Failure> {
        let to_stdout = self.json.as_deref() == Some(Path::new("-"));
        if !to_stdout {
            print(&show::states(source.name(), bench, found))?;
            if let Some(beside) = beside {
                print(&show::beside(beside))?;
                if let Some((fit, before)) = fitted {
                    print(&show::fit(fit, before, beside, &self.fit_to()))?;
                }
            }
        }
        if let Some(path) = &self.json {
            let mut result = json::states(source.name(), bench, found);
            result["measured"] = beside.map(json::beside).into();
            result["fit"] = fitted
                .map(|(fit, before)| json::fit(fit, before, &self.fit_to()))
                .into();
            let text = serde_json::to_string_pretty(&result).expect("plain data");
            if to_stdout {
                print(&text)?;
            } else {
                write_whole(path, &(text + "\n"))?;
            }
        }
        if let Some(path) = &self.write_scenario {
            write_whole(path, source.text())?;
        }
        Ok(())
    }

    /// The quantities that a fit uses.
    fn fit_to(&self) -> Vec<Quantity> {
        match self.fit_to.as_slice() {
            [] => Quantity::ALL.to_vec(),
            some => some.to_vec(),
        }
    }

    fn fit(
        &self,
        source: &Source,
        bench: &Bench,
        curves: &Curves,
        quiet: bool,
    ) -> Result<Fit, Failure> {
        let mut parameters: Vec<Parameter> = Vec::new();
        for text in &self.fit {
            let more = match text.as_str() {
                "" => Parameter::declared(source)?,
                text => vec![Parameter::given(source, text)?],
            };
            parameters.retain(|known| more.iter().all(|new| new.path != known.path));
            parameters.extend(more);
        }
        let used = Curves {
            points: curves
                .points
                .iter()
                .filter(|p| self.fit_to().contains(&p.quantity))
                .copied()
                .collect(),
            ..curves.clone()
        };
        if used.points.is_empty() {
            let what =
                "nothing that --fit-to names was measured; name quantities that the curves hold";
            return Err(Failure::Unknown(what.into()));
        }
        let options = FitOptions {
            starts: self.starts.into(),
            seed: self.seed,
            ..FitOptions::default()
        };
        let meter = Mutex::new(Meter::new("fitting", quiet));
        let watch = |done| {
            meter
                .lock()
                .expect("no panic while it is held")
                .update(done)
        };
        Ok(identify(
            source,
            bench,
            &used,
            &parameters,
            &options,
            &watch,
        )?)
    }
    fn curves(&self) -> Result<Option<Curves>, Failure> {
        let curves = match (&self.curves, self.good2022) {
            (Some(file), _) => Curves::read(file, self.rows).map(Some),
            (None, Some(rows)) => Curves::good2022(rows).map(Some),
            (None, None) => Ok(None),
        };
        curves.map_err(Failure::Curves)
    }

    /// The angles asked for and those of the curves [rad], ascending, each once.
    fn angles(&self, curves: Option<&Curves>) -> Vec<f64> {
        let points = curves.map_or(&[][..], |curves| &curves.points);
        let mut angles: Vec<f64> = points.iter().map(|point| point.angle).collect();
        let default = || Angles::parse(angles::DEFAULT).expect("the default is well formed");
        let asked = self
            .angles
            .clone()
            .or_else(|| points.is_empty().then(default));
        angles.extend(
            asked
                .iter()
                .flat_map(|asked| &asked.0)
                .map(|angle| angle.to_radians()),
        );
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        angles
    }
}
