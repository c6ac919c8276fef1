//! Selective piecewise constant strain (SPCS) kinematics of slender rods.
//!
//! A rod is cut into segments of constant strain; a few of the six strains stay the same along
//! the whole rod, others differ from segment to segment, the rest keep the value they have in
//! the straight unstretched rod ([`StrainSelector`]). That describes the shape of a handed
//! shearing auxetic with 7 to 13 numbers (Stölzle et al. 2023, section III). This crate
//!
//! - gives poses along such a rod and how they change with its configuration ([`Spcs`]);
//! - finds the configuration that fits measured poses best ([`LeastSquares`]), or the one that
//!   the paper's own descent arrives at ([`Descent`]);
//! - measures how well it fits ([`Metrics`]), and repeats the paper's Table II ([`table2`]).
//!
//! # Frames and units
//! SI and radians. Poses map the local frame at an arc length, z along the rod, to the base
//! frame; arc lengths are those of the unstretched rod (m). The strains per unstretched metre are
//! `(kx, ky, kz, sx, sy, sz)`: curvatures and twist (rad/m), shears and axial stretch (-), at
//! rest `(0, 0, 0, 0, 0, 1)`. The configuration `q = (phi0, q_cs, q_1, q_2, ...)` holds the
//! base's turn about z (rad), the strains' offsets from rest that are constant along the rod,
//! then segment by segment those that are not.
//!
//! # Example
//! ```
//! use auxetica_kinematics::{LeastSquares, Observed, Spcs, StrainSelector};
//!
//! let rod = Spcs::uniform(StrainSelector::SHEARED, 0.06, 2);
//! let q = [1.0, -16.0, 0.2, 3.0, -1.0, 0.02, 0.0, 5.0, 2.0, 0.0, 0.03];
//! let arc_lengths = [0.03, 0.06];
//! let poses = arc_lengths.map(|s| rod.pose(&q, s));
//!
//! let observed = Observed { arc_lengths: &arc_lengths, poses: &poses, base_angle: Some(1.0) };
//! let fit = LeastSquares::new(rod).fit(&observed, None);
//! assert!(fit.converged);
//! for (found, set) in fit.configuration.iter().zip(q) {
//!     assert!((found - set).abs() < 1e-9);
//! }
//! ```

mod descent;
mod exponential;
mod fit;
mod guess;
mod least_squares;
mod metrics;
mod normal_equations;
mod observed;
mod selector;
mod spcs;
pub mod table2;
mod weights;

pub use descent::Descent;
pub use fit::Fit;
pub use least_squares::LeastSquares;
pub use metrics::Metrics;
pub use observed::Observed;
pub use selector::{StrainSelector, Variation};
pub use spcs::Spcs;
pub use weights::Weights;

/// A rigid pose: a point on the rod and how the rod's local frame is turned there.
pub type Pose = nalgebra::Isometry3<f64>;
