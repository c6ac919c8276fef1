//! Discrete Cosserat rods and rigid bodies (Gazzola et al. 2018, doi:10.1098/rsos.171628). The engine knows no
//! particular robot: laws, loads, boundary conditions, joints, damping, actuation and callbacks enter through the
//! traits of [`hooks`], as plugins that scenario files name.
//!
//! Conventions: SI units. A frame is a matrix whose rows are the directors `d1, d2, d3` in the world frame; `d3` is
//! along the rod. Forces on nodes are in the world frame; strains, stresses, couples, torques and angular velocities
//! are in the material frame of their element or cell. Indices count from a body's first node.

pub mod bodies;
mod columns;
mod connection;
pub mod critical;
pub mod cylinder;
pub mod elementary;
mod energy;
mod group;
pub mod hooks;
pub mod implicit;
pub mod inputs;
mod kernel;
mod number;
#[cfg(target_arch = "x86_64")]
mod pair;
pub mod rod;
pub mod rotation;
pub mod run;
pub mod scenario;
pub mod site;
mod soundness;
pub mod stability;
pub mod steady;
mod step;
pub mod system;
mod triple;
mod varied;
pub mod vectors;
pub mod view;
mod wide;

pub use auxetica_config::{
    Count, Direction, Finite, Nested, NonNegative, Positive, Profile, Vec3, register,
};
pub use bodies::{Cell, End};
pub use cylinder::Cylinder;
pub use group::BodyId;
pub use hooks::{
    Actuation, BoundaryCondition, Callback, CallbackError, Damping, Drive, Dwell, Forcing, Joint,
    RodLaw, Setting, Snapshot,
};
pub use implicit::{ImplicitOptions, ImplicitReport, ImplicitSolver, MotionSensitivities, NoStep};
pub use inputs::{Inputs, Moment, Series, Signal};
pub use rod::{Rod, Section};
pub use run::{RunError, Summary};
pub use scenario::Model;
pub use site::{JointLoad, Place, Site, Wrench};
pub use steady::{Branch, Sensitivities, Stability, SteadyOptions, SteadyReport, SteadySolver};
pub use step::BlowUp;
pub use system::System;
pub use view::{Body, LawView, LengthSlices, LoadView, PoseView, RateSlices, RateView, ReadBody};
