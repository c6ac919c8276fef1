//! Auxetica simulates slender soft robots: discrete Cosserat rods, handed shearing auxetics, and real recordings
//! beside them. This crate is the facade: it links every shipped plugin and holds the command line.
//!
//! A program of your own with a plugin of yours in it:
//! ```no_run
//! # mod my_plugin {}
//! use my_plugin as _;
//! fn main() -> std::process::ExitCode {
//!     auxetica::cli::main()
//! }
//! ```

pub mod challenge;
pub mod characterise;
pub mod cli;
pub mod compare;
pub mod diagnose;
pub mod poses;
pub mod reproduce;
pub mod sweep;

pub use auxetica_config as config;
pub use auxetica_engine as engine;
pub use auxetica_identify as identify;
pub use auxetica_kinematics as kinematics;
pub use auxetica_recordings as recordings;
pub use auxetica_report as report;

// A plugin crate that nothing names is not linked, so each shipped one is named here.
pub use auxetica_clamps as clamps;
pub use auxetica_damping as damping;
pub use auxetica_effects as effects;
pub use auxetica_hsa as hsa;
pub use auxetica_joints as joints;
pub use auxetica_loads as loads;
pub use auxetica_materials as materials;
pub use auxetica_motors as motors;
pub use auxetica_recorders as recorders;
