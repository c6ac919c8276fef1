//! Scenario files: what they may say, and the [`Model`] that comes of them.

mod assemble;
mod bodies;
mod model;
mod motor_loads;
mod targets;
mod time_step;
mod uncertain;

pub use bodies::{Caps, CylinderSpec, Material, RodGroup};
pub use model::{Model, Watcher};
pub use motor_loads::{MotorLoads, Turn};
pub use targets::Targets;
pub use time_step::{LARGEST_SHARE, StepSize, TimeStep};
pub use uncertain::Uncertain;

use crate::implicit::ImplicitOptions;
use crate::steady::{Branch, SteadyOptions};
use auxetica_config::{Finite, NonNegative, Positive, Vec3};
use ron::value::RawValue;
use serde::Deserialize;

/// A scenario file, its plugins not yet read.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario<'a> {
    /// What the scenario shows, in a line.
    pub title: String,
    /// Groups of equal rods.
    #[serde(default)]
    pub rods: Vec<RodGroup>,
    /// Rigid cylinders.
    #[serde(default)]
    pub cylinders: Vec<CylinderSpec>,
    /// Rod laws; a rod without one is linear elastic.
    #[serde(default, borrow)]
    pub laws: Vec<Applied<'a>>,
    /// External loads.
    #[serde(default, borrow)]
    pub forcing: Vec<Applied<'a>>,
    /// Boundary conditions.
    #[serde(default, borrow)]
    pub boundary: Vec<Applied<'a>>,
    /// Joints.
    #[serde(default, borrow)]
    pub joints: Vec<Connected<'a>>,
    /// Damping; a steady run needs none.
    #[serde(default, borrow)]
    pub damping: Vec<Applied<'a>>,
    /// The source of named inputs.
    #[serde(default, borrow)]
    pub inputs: Option<&'a RawValue>,
    /// What lies between the inputs as given and as they arrive, in the order of the list.
    #[serde(default, borrow)]
    pub drives: Vec<Applied<'a>>,
    /// How motion capture sees the robot.
    #[serde(default)]
    pub capture: Capture,
    /// What motors report as their loads; unknown if absent.
    #[serde(default)]
    pub motor_loads: Option<MotorLoads>,
    /// Named points that recordings are compared at.
    #[serde(default)]
    pub markers: Vec<Marker>,
    /// Numbers that measurements are to tell.
    #[serde(default)]
    pub uncertain: Vec<Uncertain>,
    /// How the scenario is solved.
    pub solver: Solver,
    /// What is done with the results.
    #[serde(default, borrow)]
    pub callbacks: Vec<Watched<'a>>,
}

/// A plugin and the bodies that it acts on.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Applied<'a> {
    /// Bodies or groups by name; all that it can act on if absent.
    #[serde(default)]
    pub on: Targets,
    /// The plugin.
    #[serde(borrow)]
    pub apply: &'a RawValue,
}

/// A joint and what it connects.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Connected<'a> {
    /// Two bodies: `("rod_1", "platform")`. A rod is joined at its tip unless the name is followed by `.start` or by
    /// a node, as in `rod_1[12]`. A group on the first side gives one joint for each of its rods.
    pub between: (String, String),
    /// The plugin.
    #[serde(borrow)]
    pub apply: &'a RawValue,
}

/// A callback, when it is called and what it sees.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Watched<'a> {
    /// Time between calls \[s\] of a dynamic run; a steady run calls at every steady state.
    #[serde(default = "hundredth")]
    pub every: Positive,
    /// Bodies or groups by name; all if absent.
    #[serde(default)]
    pub on: Targets,
    /// The plugin.
    #[serde(borrow)]
    pub apply: &'a RawValue,
}

fn hundredth() -> Positive {
    Positive::new(0.01).expect("the default is positive")
}

/// How motion capture sees the robot.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Capture {
    /// Rotation vector of what is seen, about the origin, against the base frame \[rad\].
    pub turn: Option<Vec3>,
    /// Shift of what is seen \[m\].
    pub shift: Option<Vec3>,
}

/// What a marker's pose counts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Datum {
    /// Markers sit anywhere on their body, at any angle: rotations count from rest, and the simulated point is put where
    /// the recorded one is at rest.
    #[default]
    Rest,
    /// Markers sit exactly where the scenario says, and their frame is the body's.
    Body,
}

/// A point fixed to a body, with the body's frame there.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Marker {
    /// What recordings call it: `platform`, `ring`.
    pub name: String,
    /// Name of the body.
    pub on: String,
    /// Where along a rod, as a fraction of its length between first and last node; ignored on rigid bodies.
    #[serde(default)]
    pub along: NonNegative,
    /// Offset from there, in the frame there \[m\].
    #[serde(default = "origin")]
    pub offset: Vec3,
    /// What its recorded pose counts from.
    #[serde(default)]
    pub datum: Datum,
}

fn origin() -> Vec3 {
    Vec3::new([0.0; 3]).expect("zero is finite")
}

/// How a scenario is solved.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Solver {
    /// Explicit position Verlet through time.
    Dynamic {
        /// Duration \[s\].
        duration: Positive,
        /// Time step \[s\], or `Auto` for 0.9 of the stability limit at the start.
        #[serde(default)]
        dt: TimeStep,
        /// Whether a time step beyond the stability limit is taken all the same.
        #[serde(default)]
        unstable: bool,
    },
    /// Through time by implicit steps of any length (generalised-alpha).
    Implicit {
        /// Duration \[s\].
        duration: Positive,
        /// Time step \[s\]: a small share of the shortest period of interest.
        dt: Positive,
        /// Share that a step leaves of vibrations much faster than it, 0 to 1.
        #[serde(default)]
        spectral_radius: SpectralRadius,
        /// Error of a step that is left by its iterations: rotations \[rad\], and displacements in element lengths.
        #[serde(default = "step_tolerance")]
        tolerance: Positive,
    },
    /// Static equilibria by Newton's method.
    Steady {
        /// Times \[s\] of inputs and ramps at which the steady state is sought, in this order; by default where the
        /// inputs dwell, or else time 0.
        #[serde(default)]
        at: Vec<Finite>,
        /// Last correction accepted: rotations \[rad\], and displacements in element lengths.
        #[serde(default = "tolerance")]
        tolerance: Positive,
        /// Which of several equilibria is sought.
        #[serde(default)]
        branch: Branch,
    },
}

impl Solver {
    /// How steady states are sought; a dynamic scenario has the defaults.
    pub fn steady_options(&self) -> SteadyOptions {
        let defaults = SteadyOptions::default();
        match self {
            Self::Steady {
                tolerance, branch, ..
            } => SteadyOptions {
                tolerance: **tolerance,
                branch: *branch,
                ..defaults
            },
            Self::Dynamic { .. } | Self::Implicit { .. } => defaults,
        }
    }

    /// How implicit steps are taken; other scenarios have the defaults.
    pub fn implicit_options(&self) -> ImplicitOptions {
        let defaults = ImplicitOptions::default();
        match self {
            Self::Implicit {
                spectral_radius,
                tolerance,
                ..
            } => ImplicitOptions {
                spectral_radius: spectral_radius.0,
                tolerance: **tolerance,
                ..defaults
            },
            Self::Dynamic { .. } | Self::Steady { .. } => defaults,
        }
    }
}

fn step_tolerance() -> Positive {
    Positive::new(ImplicitOptions::default().tolerance).expect("the default is positive")
}

fn tolerance() -> Positive {
    Positive::new(1e-9).expect("the default is positive")
}

/// A share from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "f64")]
pub struct SpectralRadius(f64);

impl TryFrom<f64> for SpectralRadius {
    type Error = String;

    fn try_from(radius: f64) -> Result<Self, String> {
        if (0.0..=1.0).contains(&radius) {
            Ok(Self(radius))
        } else {
            Err(format!(
                "expected a spectral radius from 0 to 1, found {radius}; 0.5 suits most runs, 1 keeps all vibrations"
            ))
        }
    }
}

impl Default for SpectralRadius {
    fn default() -> Self {
        Self(ImplicitOptions::default().spectral_radius)
    }
}
