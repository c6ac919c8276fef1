//! Makes the cases of a challenge and seals what they conceal.

use super::draw::{Draw, Kind};
use super::spec::{Recorded, Spec};
use super::spiked::Background;
use super::truth::Truth;
use super::{ChallengeError, NOMINAL, SEAL, TRUTH, hash};
use crate::config::Source;
use crate::identify::{Parameter, Robot};
use crate::recordings::RobotGeometry;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use std::path::Path;

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
    let real = match &spec.recordings {
        Recorded::Simulated(_) => Vec::new(),
        Recorded::Real(onto) => Background::read(onto)?,
    };
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
                real: &real,
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
