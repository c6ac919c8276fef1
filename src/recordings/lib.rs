//! Recordings of the four-rod robot, real or simulated, made ready to stand beside a simulation.
//!
//! A recording is a folder of CSV files in the layout of the public data set of the robot:
//! motor readings and motion capture, one row a sample, about 9.3 Hz. This crate
//!
//! - reads it, with an error that names file, line and field for everything that is wrong
//!   ([`Recording::read`]), and writes it ([`Recording::write`]);
//! - reports what is odd but not fatal: gaps, stale frames, jumps, flips ([`Audit`]);
//! - turns motor ticks into angles ([`MotorAngles`]) and poses into the robot's base frame
//!   ([`BasePoses`]), with the pose at rest as their [`Reference`];
//! - reduces it to steady samples ([`SteadySamples`]): the settled end of every dwell, the
//!   samples that the data set's authors took, or the poses of their published tables.
//!
//! # Frames and units
//! SI throughout: metres, seconds, radians. The *world* is that of the motion capture, y along
//! the robot from base to platform. The *base frame* has its origin on the axis of the robot in
//! the base plane and z along the robot: `p_B = (x_W, -z_W, y_W)`. Rows count from zero; row `i`
//! of a recording is line `i + 1` of its files.
//!
//! # Example
//! ```no_run
//! use auxetica_recordings::{Audit, Recording, RobotGeometry, SettleRule};
//!
//! let recording = Recording::read("recordings/20221011_174514")?;
//! println!("{}", Audit::new(&recording)?);
//! let samples = SettleRule::default().samples(&recording, &RobotGeometry::default())?;
//! for (angles, platform) in samples.angles.iter().zip(&samples.platform) {
//!     println!("{angles:.3?} rad lift the platform to {:.4} m", platform.translation.z);
//! }
//! # Ok::<(), auxetica_recordings::Error>(())
//! ```

mod audit;
mod authors;
mod body;
mod dwells;
mod error;
mod files;
mod frames;
mod geometry;
mod median;
mod mocap;
mod motors;
mod published;
mod recording;
mod reference;
mod settled;
mod simulated;
mod steady;
mod table;
mod writer;

pub use audit::{Audit, BodyAudit, Gap, Jump};
pub use authors::{authors_rows, authors_samples};
pub use body::{Body, Track};
pub use error::Error;
pub use frames::{BasePoses, to_base, to_world};
pub use geometry::RobotGeometry;
pub use motors::{MotorAngles, RADIANS_PER_TICK};
pub use published::PublishedTable;
pub use recording::{Mocap, Recording};
pub use reference::{MarkerFrame, OffsetZ, Reference};
pub use settled::SettleRule;
pub use steady::SteadySamples;

/// A rigid pose: where a body's marker point is and how the body is turned.
pub type Pose = nalgebra::Isometry3<f64>;
