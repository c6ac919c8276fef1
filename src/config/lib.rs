//! Scenarios: RON files whose slots name plugins, turned into typed values with errors that tell
//! where, what and what to do.
//!
//! The text of a scenario is loaded as a [`Source`], which resolves `base:` and `set:` and the
//! `--set path=value` of a command line by splicing text. [`Source::parse`] reads the core types,
//! which hold a `&ron::value::RawValue` wherever a plugin goes; [`Source::build`] then reads each
//! slot as the [`Plugin`] that it names. Crates add plugins with [`register!`]; the program that
//! reads scenarios need not know them.
//!
//! ```
//! use auxetica_config::{Hook, Source, Vec3, register};
//! use ron::value::RawValue;
//! use schemars::JsonSchema;
//! use serde::Deserialize;
//!
//! // The program that reads scenarios:
//! pub trait Forcing {
//!     fn acceleration(&self) -> [f64; 3];
//! }
//! impl Hook for dyn Forcing {
//!     const NOUN: &'static str = "forcing";
//!     const SLOT: &'static str = "forcing";
//! }
//! #[derive(Deserialize)]
//! #[serde(deny_unknown_fields)]
//! struct Scenario<'a> {
//!     #[serde(borrow)]
//!     forcing: Vec<&'a RawValue>,
//! }
//!
//! // Any crate:
//! /// Uniform gravity.
//! #[derive(Deserialize, JsonSchema)]
//! #[serde(deny_unknown_fields)]
//! struct Gravity {
//!     /// Acceleration in m/s², world frame.
//!     g: Vec3,
//! }
//! impl Forcing for Gravity {
//!     fn acceleration(&self) -> [f64; 3] {
//!         *self.g
//!     }
//! }
//! register!(dyn Forcing: Gravity, example = "Gravity(g: (0, 0, -9.81))", source = "Newton 1687");
//!
//! let text = "(forcing: [Gravity(g: (0, 0, -9.81))])";
//! let source = Source::from_text("example", text, &["forcing[0].g[2]=-1.62".to_owned()])?;
//! let scenario: Scenario = source.parse()?;
//! let forcing = source.build::<dyn Forcing>(scenario.forcing[0])?;
//! assert_eq!(forcing.acceleration(), [0.0, 0.0, -1.62]);
//! # Ok::<(), auxetica_config::Problems>(())
//! ```
//!
//! The number types ([`Positive`], [`Vec3`], [`Profile`] ..) refuse what makes no sense while ron
//! still knows the place.

mod derived;
mod diagnose;
mod fields;
mod finding;
mod follow;
mod literal;
mod nested;
mod node;
mod number;
mod overrides;
mod patchwork;
mod path;
mod places;
mod plugin;
mod problem;
mod profile;
mod repair;
mod scan;
mod source;
mod suggest;
mod vector;

pub use fields::FieldDoc;
pub use nested::Nested;
pub use number::{Count, Finite, NonNegative, Positive};
pub use places::Tied;
pub use plugin::{Build, Hook, Plugin, plugins};
pub use problem::{Problem, Problems};
pub use profile::Profile;
pub use source::{Source, options};
pub use suggest::remedy;
pub use vector::{Direction, Vec3};

// For `register!`, which expands in crates that may not depend on these themselves.
#[doc(hidden)]
pub use {inventory, schemars};
