//! Dissipation.

mod linear_damping;

pub use linear_damping::LinearDamping;
