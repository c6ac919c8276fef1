//! External loads.

mod end_load;
mod gravity;
mod obstacle;
mod payload;
mod tether;
mod uniform_force;

pub use end_load::{EndForce, EndTorque, Frame};
pub use gravity::Gravity;
pub use obstacle::Obstacle;
pub use payload::Payload;
pub use tether::Tether;
pub use uniform_force::UniformForce;
