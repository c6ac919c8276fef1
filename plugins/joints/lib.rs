//! Joints between bodies.

mod spring_damper;

pub use spring_damper::SpringDamper;
