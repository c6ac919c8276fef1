//! What real rods do that linear elastic ones don't: rod laws that act on top of those before them. Rest lengths and
//! rigidities are as built, or as the laws before have left them; stresses and couples add.

mod base_compliance;
mod branch;
mod coupling;
mod creep;
mod drift;
mod extension;
mod hysteresis;
mod intrinsic;
mod kelvin_voigt;
mod motor_compliance;
mod nonlinear;
mod permanent_set;
mod stiffness;
mod strain_energy;

pub use base_compliance::BaseCompliance;
pub use coupling::Coupling;
pub use creep::Creep;
pub use drift::Drift;
pub use extension::Extension;
pub use hysteresis::Hysteresis;
pub use intrinsic::Intrinsic;
pub use kelvin_voigt::KelvinVoigt;
pub use motor_compliance::MotorCompliance;
pub use nonlinear::Nonlinear;
pub use permanent_set::PermanentSet;
pub use stiffness::Stiffness;
pub use strain_energy::StrainEnergy;
