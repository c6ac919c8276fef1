//! Motors at the start of a rod, and the sequences of angles that drive them.

mod channels;
mod motor_angle;
mod motor_torque;
mod primitives;

pub use channels::Channels;
pub use motor_angle::MotorAngle;
pub use motor_torque::MotorTorque;
pub use primitives::{MotionPrimitives, Primitive};
