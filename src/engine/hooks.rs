//! The traits through which everything specific enters. Each has one method that must be written.

use crate::inputs::{Inputs, Moment, Series};
use crate::site::{JointLoad, Site};
use crate::view::{Body, LawView, LoadView, PoseView, RateView};

/// What a hook is told when a scenario is put together.
pub struct Setting<'a> {
    /// The body that the hook acts on, at rest.
    pub body: Body<'a>,
    /// The scenario's inputs.
    pub inputs: &'a Inputs,
}

/// Constitutive law of a rod. Without one a rod is linear elastic with the rigidities that it was built with.
pub trait RodLaw: Send + Sync {
    /// Sets rest lengths, rest strains and rigidities from the present lengths, rotations and tangents.
    /// Strains, stresses and couples are still those of the evaluation before; rest lengths and rigidities are as built,
    /// or as the laws before this one have left them.
    fn rest(&self, now: &Moment<'_>, rod: &mut LawView<'_>);

    /// Adds to the stresses and couples that the engine has computed from strains and rigidities.
    fn stress(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    /// Whether the law shares out among springs in series what all others make of the rod, and so comes after them,
    /// wherever it is listed.
    fn in_series(&self) -> bool {
        false
    }

    /// How many numbers the law remembers of a rod (viscous strains, largest strains so far); all are 0 at first.
    fn memory(&self, _rod: &Body<'_>) -> usize {
        0
    }

    /// Brings what the law remembers up to date at a state that was reached. It is saved and restored with the state.
    fn remember(&self, _now: &Moment<'_>, _rod: &mut LawView<'_>) {}

    /// What is wrong with the law on this body, in words.
    fn check(&self, _setting: &Setting<'_>) -> Result<(), String> {
        Ok(())
    }
}

/// External forces and torques on one body.
pub trait Forcing: Send + Sync {
    /// Adds loads.
    fn apply(&self, now: &Moment<'_>, body: &mut LoadView<'_>);

    /// What is wrong with the forcing on this body, in words.
    fn check(&self, _setting: &Setting<'_>) -> Result<(), String> {
        Ok(())
    }
}

/// Prescribed positions, frames and rates of one body.
pub trait BoundaryCondition: Send + Sync {
    /// Overwrites the rates of what is held. It must be a projection: what isn't held stays as it is. The steady
    /// solver asks it which degrees of freedom are held.
    fn rates(&self, now: &Moment<'_>, body: &mut RateView<'_>);

    /// Overwrites positions and frames of what is held, whatever they were: where several steps are taken at once, this
    /// is asked for at the middle of each, and at the end of the last only.
    fn values(&self, _now: &Moment<'_>, _body: &mut PoseView<'_>) {}

    /// Adds loads (a motor torque, say).
    fn loads(&self, _now: &Moment<'_>, _body: &mut LoadView<'_>) {}

    /// Remembers what it must of the body at rest, and says in words what is wrong.
    fn attach(&mut self, _setting: &Setting<'_>) -> Result<(), String> {
        Ok(())
    }
}

/// A connection between two bodies.
pub trait Joint: Send + Sync {
    /// Forces and torques on both sides from the poses and rates of both.
    fn load(&self, now: &Moment<'_>, a: &Site, b: &Site) -> JointLoad;

    /// Remembers what it must of both sites at rest, and says in words what is wrong.
    fn attach(&mut self, _a: &Site, _b: &Site, _inputs: &Inputs) -> Result<(), String> {
        Ok(())
    }
}

/// Dissipation that acts on rates once a step, after the loads have changed them.
pub trait Damping: Send + Sync {
    /// Reduces the rates over a step of `dt` \[s\].
    fn damp(&self, dt: f64, body: &mut RateView<'_>);

    /// What is wrong with the damping on this body, in words.
    fn check(&self, _setting: &Setting<'_>) -> Result<(), String> {
        Ok(())
    }
}

/// A source of named inputs (an actuation sequence).
pub trait Actuation: Send + Sync {
    /// The inputs, or in words what is wrong.
    fn inputs(&self) -> Result<Inputs, String>;

    /// When the sequence has come to rest, if it does.
    fn dwells(&self) -> Vec<Dwell> {
        Vec::new()
    }
}

/// What lies between an input as it is given and as the robot has it: play, a lag, a gear's error.
pub trait Drive: Send + Sync {
    /// The input that arrives.
    ///
    /// # Errors
    /// In words, if there is none.
    fn transmit(&self, given: &Series) -> Result<Series, String>;
}

/// A time at which an actuation sequence is at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Dwell {
    /// Time \[s\].
    pub time: f64,
    /// What is reached there, for reports; empty if it has no name.
    pub name: String,
}

/// What a callback sees at a time that it asked for.
pub struct Snapshot<'a> {
    /// Time \[s\].
    pub time: f64,
    /// The bodies that it watches, in the order of the scenario.
    pub bodies: Vec<Body<'a>>,
}

/// Why a callback could not do its work.
#[derive(Debug, thiserror::Error)]
#[error("{what}: {source}")]
pub struct CallbackError {
    /// What it was doing, with the file.
    pub what: String,
    /// The cause.
    #[source]
    pub source: Box<dyn std::error::Error + Send + Sync>,
}

/// Something done with the state now and then: exporting it, above all.
pub trait Callback: Send {
    /// Called once before the run. Relative file names are meant in `out`.
    fn start(&mut self, _out: &std::path::Path, _bodies: &[Body<'_>]) -> Result<(), CallbackError> {
        Ok(())
    }

    /// Called at every time asked for.
    fn record(&mut self, snapshot: &Snapshot<'_>) -> Result<(), CallbackError>;

    /// Called once at the end, also when the run has failed: what was recorded must be kept. Returns the files
    /// written.
    fn finish(&mut self) -> Result<Vec<std::path::PathBuf>, CallbackError> {
        Ok(Vec::new())
    }
}

macro_rules! hooks {
    ($($hook:ident: $noun:literal in $slot:literal),* $(,)?) => {$(
        impl auxetica_config::Hook for dyn $hook {
            const NOUN: &'static str = $noun;
            const SLOT: &'static str = $slot;
        }
    )*};
}
hooks! {
    RodLaw: "rod law" in "laws",
    Forcing: "forcing" in "forcing",
    BoundaryCondition: "boundary condition" in "boundary",
    Joint: "joint" in "joints",
    Damping: "damping" in "damping",
    Actuation: "actuation" in "inputs",
    Drive: "drive" in "drives",
    Callback: "callback" in "callbacks",
}
