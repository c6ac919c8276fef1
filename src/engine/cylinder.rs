//! A rigid cylinder, the engine's rigid body.

use nalgebra::{Matrix3, Vector3};

/// A rigid body with the inertia of a cylinder (or whatever `inertia` says).
#[derive(Clone, Debug, PartialEq)]
pub struct Cylinder {
    /// Unique name.
    pub name: String,
    /// Centre of mass in the world frame \[m\].
    pub centre: Vector3<f64>,
    /// Directors in the world frame, `d3` along the axis.
    pub director: Matrix3<f64>,
    /// Mass \[kg\].
    pub mass: f64,
    /// Principal moments of inertia about `d1, d2, d3` \[kg m2\].
    pub inertia: Vector3<f64>,
}

impl Cylinder {
    /// Moments of inertia \[kg m2\] of a solid cylinder of `mass` \[kg\], `radius` and `thickness` \[m\].
    pub fn solid_inertia(mass: f64, radius: f64, thickness: f64) -> Vector3<f64> {
        let transverse = mass * (3.0 * radius.powi(2) + thickness.powi(2)) / 12.0;
        Vector3::new(transverse, transverse, mass * radius.powi(2) / 2.0)
    }
}
