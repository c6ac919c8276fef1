//! Boundary conditions that hold the ends of rods, or rigid bodies.

mod clamp;
mod hold;

pub use clamp::Clamp;
pub use hold::{Axis, Hold};
