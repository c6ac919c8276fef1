//! Motors at the start of a rod, and the sequences of angles that drive them.

mod backlash;
mod channels;
mod defaults;
mod gear;
mod lag;
mod motor_angle;
mod motor_torque;
mod primitives;
mod random;
mod rods;
mod sequence;
mod together;
mod visits;

pub use backlash::Backlash;
pub use channels::Channels;
pub use gear::Gear;
pub use lag::{Delay, Lag};
pub use motor_angle::MotorAngle;
pub use motor_torque::MotorTorque;
pub use primitives::{MotionPrimitives, Primitive};
pub use rods::RodPlace;
pub use sequence::{ActuationSequence, Course};
pub use together::Together;
