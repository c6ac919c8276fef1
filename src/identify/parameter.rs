//! Numbers to be identified.

use auxetica_config::{Finite, Problem, Problems, Source};
use auxetica_engine::scenario::{Scenario, Uncertain};

/// A number that measurements are to tell.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// What reports call it.
    pub name: String,
    /// Where it stands in the scenario; one path may mean several places.
    pub path: String,
    /// Its unit.
    pub unit: String,
    /// Value before the fit, inside the range.
    pub nominal: f64,
    /// Least and largest value. The width of the range is the parameter's scale.
    pub range: (f64, f64),
    /// Mean and standard deviation of what is known beforehand (a Gaussian prior).
    pub prior: Option<(f64, f64)>,
}

impl Parameter {
    /// A parameter that stands in no scenario.
    pub fn new(name: &str, unit: &str, nominal: f64, range: (f64, f64)) -> Self {
        Self {
            name: name.to_owned(),
            path: name.to_owned(),
            unit: unit.to_owned(),
            nominal,
            range,
            prior: None,
        }
    }

    /// What a scenario declares under `uncertain`.
    ///
    /// # Errors
    /// If there is nothing, or it is wrong: a path that leads to no number, a reversed range.
    pub fn declared(source: &Source) -> Result<Vec<Self>, Problems> {
        let scenario: Scenario<'_> = source.parse()?;
        if scenario.uncertain.is_empty() {
            return Err(Problem::new(format!(
                "`{}` declares nothing under `uncertain`",
                source.name()
            ))
            .with_hint("declare its uncertain numbers there, or give each as PATH=a..b")
            .into());
        }
        let mut problems = Problems::default();
        let mut parameters = Vec::new();
        for (i, number) in scenario.uncertain.iter().enumerate() {
            match number.nominal(source) {
                Ok(nominal) => parameters.push(Self::of(number, nominal)),
                Err((field, e)) => {
                    let path = format!("uncertain[{i}].{field}");
                    problems
                        .0
                        .push(with_remedy(&e, |text| source.problem(&path, text)));
                }
            }
        }
        problems.into_result()?;
        Ok(parameters)
    }

    /// What `PATH=a..b` means in a scenario, such as `laws[*].apply.factor=0.002..0.005`.
    ///
    /// # Errors
    /// If it isn't written like that, the path leads to no number, or the number is outside the range.
    pub fn given(source: &Source, text: &str) -> Result<Self, Problems> {
        let told = |e: &str| with_remedy(&format!("`{text}`: {e}"), |text| Problem::new(text));
        let read = |end: &str| end.trim().parse().ok().and_then(|v| Finite::new(v).ok());
        let parts = text.split_once('=').and_then(|(path, range)| {
            let (least, most) = range.split_once("..")?;
            Some((path.trim(), (read(least)?, read(most)?)))
        });
        let (path, range) = parts.ok_or_else(|| {
            told("this is not understood; write PATH=a..b, such as rods[0].material.twist=0.001..0.005")
        })?;
        let number = Uncertain {
            name: path.to_owned(),
            path: path.to_owned(),
            unit: String::new(),
            range,
            prior: None,
        };
        let nominal = number.nominal(source).map_err(|(_, e)| told(&e))?;
        Ok(Self::of(&number, nominal))
    }

    fn of(number: &Uncertain, nominal: f64) -> Self {
        Self {
            name: number.name.clone(),
            path: number.path.clone(),
            unit: number.unit.clone(),
            nominal,
            range: (*number.range.0, *number.range.1),
            prior: number.prior.map(|(mean, deviation)| (*mean, *deviation)),
        }
    }

    /// The change of the scenario that gives the parameter a value, as `--set` takes it.
    pub fn set(&self, value: f64) -> String {
        format!("{}={value:e}", self.path)
    }

    /// Width of the range.
    pub fn width(&self) -> f64 {
        self.range.1 - self.range.0
    }

    /// How well it is known beforehand: the prior's standard deviation, or a tenth of the range's width.
    pub fn deviation(&self) -> f64 {
        let known = self.prior.map(|(_, deviation)| deviation);
        known.unwrap_or(0.1 * self.width())
    }
}

/// Messages say what is wrong and, after a semicolon, what to do.
fn with_remedy(message: &str, problem: impl Fn(&str) -> Problem) -> Problem {
    match message.split_once("; ") {
        Some((what, remedy)) => problem(what).with_hint(remedy),
        None => problem(message),
    }
}
