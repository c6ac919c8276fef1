//! Joints between bodies.

mod clearance;
mod spring_damper;

pub use spring_damper::SpringDamper;
