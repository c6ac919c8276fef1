//! A test bench for single rods: what holds, turns, pulls and blocks them, as scenarios.

use super::CharacteriseError;
use crate::config::{Problem, Problems, Source, remedy};
use crate::engine::scenario::{Applied, Scenario, Targets};
use crate::engine::{Model, ReadBody, SteadySolver};

/// A rod of a scenario, taken from it with its laws and put upright on a bench (Stölzle et al. 2023, section II-C): its
/// start is turned about the rod, its tip can't twist and is free otherwise.
#[derive(Debug)]
pub struct Bench {
    rod: String,
    /// The sense in which a motor winds the rod: +1 or -1.
    sense: f64,
    pull: f64,
    /// The rod alone, its tip free.
    free: Source,
}

/// What is done to the tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Experiment {
    /// Nothing.
    Free,
    /// It is pulled along the rod.
    Pulled,
    /// It is kept from moving along the rod.
    Blocked,
}

/// Winding \[rad\] by which the sense is found.
const TRIAL: f64 = 0.1;
/// Winding angles \[rad\] are given as times, which ends here.
const MOST: f64 = 1e4;

impl Bench {
    /// Takes `rod`, or the only one there is, from a scenario. `pull` \[N\] is the small force that spring constants are
    /// measured with. Twist angles count in the sense that lengthens the rod, whatever its handedness; a rod that
    /// lengthens in neither sense is turned about its own axis in the positive one.
    ///
    /// # Errors
    /// If the scenario is wrong, or has no such rod, or several and none is named.
    pub fn new(source: &Source, rod: Option<&str>, pull: f64) -> Result<Self, CharacteriseError> {
        // What is wrong with the scenario is told at its place, before it is taken apart.
        Model::build(source, None)?;
        let rod = chosen(source, rod)?;
        let mut bench = Self {
            free: alone(source, &rod)?,
            rod,
            sense: 1.0,
            pull,
        };
        let mut model = bench.model(Experiment::Free)?;
        let lengths = [TRIAL, -TRIAL].map(|angle| {
            let options = model.solver.steady_options();
            let mut solver = SteadySolver::new(&mut model.system, options).ok()?;
            solver.advance(&mut model.system, angle).ok()?;
            Some(Measured::of(&model).length)
        });
        if let [Some(there), Some(back)] = lengths
            && back > there * (1.0 + 1e-9)
        {
            bench.sense = -1.0;
        }
        Ok(bench)
    }

    /// The same bench for another version of the scenario.
    ///
    /// # Errors
    /// If that version is wrong, or lacks the rod.
    pub fn with(&self, source: &Source) -> Result<Self, Problems> {
        Ok(Self {
            free: alone(source, &self.rod)?,
            rod: self.rod.clone(),
            ..*self
        })
    }

    /// Name of the rod.
    pub fn rod(&self) -> &str {
        &self.rod
    }

    /// Force \[N\] that spring constants are measured with.
    pub fn pull(&self) -> f64 {
        self.pull
    }

    /// The sense in which a motor winds the rod: +1, or -1 for a left-handed one.
    pub fn sense(&self) -> f64 {
        self.sense
    }

    /// The scenario of an experiment. Its time is the twist angle: `t` seconds are `t` radians.
    ///
    /// # Errors
    /// If the rod's law or material can't be built alone.
    pub fn scenario(&self, experiment: Experiment) -> Result<Source, Problems> {
        let most = MOST * self.sense;
        let mut sets = vec![format!(
            "boundary[0].apply.angle=Table([({}, {}), ({MOST}, {most})])",
            -MOST, -most
        )];
        match experiment {
            Experiment::Free => {}
            Experiment::Pulled => sets.push(format!(
                "forcing=[(apply: EndForce(force: (0, 0, {:e})))]",
                self.pull
            )),
            Experiment::Blocked => sets.push("boundary[1].apply.position=[Z]".into()),
        }
        self.free.with(&sets)
    }

    /// The model of an experiment, at rest.
    pub(super) fn model(&self, experiment: Experiment) -> Result<Model, Problems> {
        Model::build(&self.scenario(experiment)?, None)
    }
}

/// The name of the rod that is meant.
fn chosen(source: &Source, wanted: Option<&str>) -> Result<String, Problems> {
    let scenario: Scenario<'_> = source.parse()?;
    let names: Vec<_> = scenario
        .rods
        .iter()
        .flat_map(|group| group.names())
        .collect();
    match (wanted, names.as_slice()) {
        (None, [only]) => Ok((*only).to_owned()),
        (None, []) => Err(source
            .problem("cylinders", "there is no rod to characterise")
            .with_hint("give one under `rods`")
            .into()),
        (None, _) => Err(Problem::new("the scenario has several rods")
            .with_hint(format!("choose one with --rod: {}", names.join(", ")))
            .into()),
        (Some(wanted), names) if names.contains(&wanted) => Ok(wanted.to_owned()),
        (Some(wanted), names) => Err(Problem::new(format!("there is no rod named `{wanted}`"))
            .with_hint(remedy(wanted, names, "rods"))
            .into()),
    }
}

/// The scenario of a rod with its laws and nothing else, upright, its start held as the scenario holds it.
fn alone(source: &Source, rod: &str) -> Result<Source, Problems> {
    let scenario: Scenario<'_> = source.parse()?;
    let of_rod = |group: &&crate::engine::scenario::RodGroup| group.names().contains(&rod);
    let group = scenario.rods.iter().position(|group| of_rod(&group));
    let group = group.ok_or_else(|| Problem::new(format!("there is no rod named `{rod}`")))?;
    let acts = |applied: &Applied<'_>| match &applied.on {
        Targets::All => true,
        Targets::Named(names) => names
            .iter()
            .any(|name| name == rod || *name == scenario.rods[group].name),
    };
    let text = |path: &str| source.values(path).ok().map(|found| found[0].to_owned());
    let laws = scenario.laws.iter().filter(|law| acts(law));
    // The line end closes a comment behind the plugin.
    let laws: Vec<_> = laws
        .map(|law| format!("(apply: {}\n)", law.apply.get_ron()))
        .collect();
    let held = scenario.boundary.iter().position(acts);
    let cell = held.and_then(|held| text(&format!("boundary[{held}].apply.cell")));
    let group = text(&format!("rods[{group}]")).expect("the scenario was read from this text");
    source.with(&[
        format!("rods=[{group}]"),
        format!("rods[0].name={rod:?}"),
        "rods[0].at={}".into(),
        "rods[0].direction=(0, 0, 1)".into(),
        "rods[0].normal=(1, 0, 0)".into(),
        format!("laws=[{}]", laws.join(", ")),
        format!(
            "boundary=[(apply: MotorAngle(angle: Constant(0), cell: {})), (apply: Hold(end: Tip, rotation: [Z]))]",
            cell.as_deref().unwrap_or("Rigid")
        ),
        "cylinders=[]".into(),
        "joints=[]".into(),
        "forcing=[]".into(),
        "damping=[]".into(),
        "inputs=None".into(),
        "markers=[]".into(),
        "callbacks=[]".into(),
        "uncertain=[]".into(),
    ])
}

/// What the instruments of the bench show in a state, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Length from end to end, rigid ends included \[m\].
    pub length: f64,
    /// Force with which the rod pushes its tip along \[N\].
    pub push: f64,
    /// Torque about the rod that its tip is kept from turning with, which is the one that turns its start \[N m\].
    pub torque: f64,
}

impl Measured {
    /// Reads them off the model of an experiment after its loads have been evaluated.
    pub fn of(model: &Model) -> Self {
        let rod = model.system.body(model.system.ids()[0]);
        let last = rod.elements();
        let caps =
            [crate::engine::End::Start, crate::engine::End::Tip].map(|end| rod.cap(end).length);
        Self {
            length: (rod.position(last) - rod.position(0)).z + caps.iter().sum::<f64>(),
            push: rod.force(last).z,
            torque: rod.torque(last - 1).z,
        }
    }
}
