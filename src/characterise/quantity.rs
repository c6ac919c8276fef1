//! What is measured of a rod.

use serde::Serialize;
use std::fmt;

/// A characteristic of a rod at a twist angle (Stölzle et al. 2023, section II-C).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
#[value(rename_all = "snake_case")]
pub enum Quantity {
    /// Torque about the rod that holds its start at the angle, its tip free to move \[N m\].
    HoldingTorque,
    /// Length of the free rod, rigid ends included \[m\].
    MinimumEnergyLength,
    /// Small pull at the tip over the lengthening that it causes \[N/m\].
    SpringConstant,
    /// Force with which the rod pushes when it is kept from lengthening \[N\].
    BlockedForce,
}

impl Quantity {
    /// All of them, in the order in which they are shown.
    pub const ALL: [Self; 4] = [
        Self::HoldingTorque,
        Self::MinimumEnergyLength,
        Self::SpringConstant,
        Self::BlockedForce,
    ];

    /// As tables and files name it: `holding_torque`.
    pub fn name(self) -> &'static str {
        match self {
            Self::HoldingTorque => "holding_torque",
            Self::MinimumEnergyLength => "minimum_energy_length",
            Self::SpringConstant => "spring_constant",
            Self::BlockedForce => "blocked_force",
        }
    }

    /// The unit of tables and files.
    pub fn unit(self) -> &'static str {
        match self {
            Self::HoldingTorque => "N mm",
            Self::MinimumEnergyLength => "mm",
            Self::SpringConstant => "N/mm",
            Self::BlockedForce => "N",
        }
    }

    /// That unit in SI units.
    pub fn in_si(self) -> f64 {
        match self {
            Self::HoldingTorque | Self::MinimumEnergyLength => 1e-3,
            Self::SpringConstant => 1e3,
            Self::BlockedForce => 1.0,
        }
    }
}

impl fmt::Display for Quantity {
    /// In words: `holding torque`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name().replace('_', " "))
    }
}
