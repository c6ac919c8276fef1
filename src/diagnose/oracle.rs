//! What a diagnosis that knows the truth would reach.

use super::scores::Scores;
use super::trial::Trial;
use super::{DiagnoseError, Request, read, search};
use crate::identify::{Effect, Parameter, Robot};

/// Held-out position error \[mm\] of the scenario with given effects (identifier, form, values to begin with), fitted to
/// the training recordings: what a diagnosis that knows the truth would reach.
///
/// # Errors
/// As [`diagnose`], or if there is no such effect.
pub fn oracle(
    request: &Request<'_>,
    known: &[(String, String, Vec<f64>)],
) -> Result<f64, DiagnoseError> {
    let own = Parameter::declared(request.source)?;
    let (train, holdout) = read(request)?;
    let robot = Robot::of(request.source)?;
    let effects = <dyn Effect>::all();
    let forms = search::forms(&effects, &robot);
    let mut start: Vec<f64> = own.iter().map(|p| p.nominal).collect();
    let mut trial = Trial::new(request.source, &own, &train);
    for (id, name, values) in known {
        let same = |f: &&search::Form| effects[f.effect].id() == id && f.variant.name == *name;
        let form = forms.iter().find(same).ok_or_else(|| {
            DiagnoseError::Unfit(format!("there is no effect `{id}` of the form `{name}`"))
        })?;
        trial.forms.push(&form.variant);
        start.extend(values);
    }
    let start = trial.start(&start, None).map_err(DiagnoseError::Unfit)?;
    let all = 0..start.at.len();
    let fit = trial.fit(start, all, 12);
    let scenario = trial.scenario(&fit.at).map_err(DiagnoseError::Unfit)?;
    let scores = Scores::of(&scenario, &train, &holdout)?;
    Ok(scores.held_out_mm())
}
