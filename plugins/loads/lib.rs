//! External loads.

mod end_load;
mod gravity;
mod uniform_force;

pub use end_load::{EndForce, EndTorque, Frame};
pub use gravity::Gravity;
pub use uniform_force::UniformForce;
