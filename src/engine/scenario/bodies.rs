//! Rods and rigid bodies as scenarios describe them.

use crate::cylinder::Cylinder;
use crate::rod::{Rod, Section};
use auxetica_config::{Count, Direction, NonNegative, Positive, Profile, Vec3};
use nalgebra::{Matrix3, Rotation3, Vector3};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Equal straight rods at several places. A number that may differ along a rod is one number, or a list with one an
/// element.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RodGroup {
    /// Name of the group.
    pub name: String,
    /// Name and position of the first node \[m\] of each rod; by default one rod of the group's name at the origin.
    #[serde(default)]
    pub at: BTreeMap<String, Vec3>,
    /// Direction of the rods.
    #[serde(default = "z")]
    pub direction: Direction,
    /// Direction of `d1`, made normal to the rod; by default x, or y for a rod along x.
    #[serde(default)]
    pub normal: Option<Direction>,
    /// Length between first and last node, undeformed \[m\].
    pub length: Positive,
    /// Elements a rod.
    pub elements: Count,
    /// Outside radius \[m\].
    pub radius: Profile,
    /// Wall thickness of a hollow rod \[m\].
    #[serde(default)]
    pub wall: Option<Profile>,
    /// Density \[kg/m3\].
    pub density: Profile,
    /// Stiffness.
    pub material: Material,
    /// Rigid ends.
    #[serde(default)]
    pub caps: Caps,
    /// Intrinsic shear and stretch strains \[-\].
    #[serde(default)]
    pub rest_strain: Option<Vec3>,
    /// Intrinsic curvatures and twist \[rad/m\].
    #[serde(default)]
    pub rest_curvature: Option<Vec3>,
}

/// Stiffness of a rod.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Material {
    /// An isotropic material, by its moduli and the section; single rigidities may be given instead.
    Moduli {
        /// Young's modulus \[Pa\].
        youngs: Profile,
        /// Shear modulus \[Pa\].
        shear: Profile,
        /// Bending rigidity instead of `E I` \[N m2\].
        #[serde(default)]
        bending: Option<Profile>,
        /// Twist rigidity instead of `G J` \[N m2\].
        #[serde(default)]
        twist: Option<Profile>,
    },
    /// Rigidities as they are.
    Rigidities {
        /// Of shear \[N\].
        shear: Profile,
        /// Of stretch \[N\].
        axial: Profile,
        /// Of bending \[N m2\].
        bending: Profile,
        /// Of twist \[N m2\].
        twist: Profile,
    },
}

impl Material {
    fn profiles(&self) -> Vec<&Profile> {
        match self {
            Self::Moduli {
                youngs,
                shear,
                bending,
                twist,
            } => [Some(youngs), Some(shear), bending.as_ref(), twist.as_ref()]
                .into_iter()
                .flatten()
                .collect(),
            Self::Rigidities {
                shear,
                axial,
                bending,
                twist,
            } => vec![shear, axial, bending, twist],
        }
    }

    /// Shear and stretch rigidities \[N\], bending and twist rigidities \[N m2\] of element `e`.
    fn rigidities(&self, section: &Section, e: usize) -> (Vector3<f64>, Vector3<f64>) {
        match self {
            Self::Moduli {
                youngs,
                shear,
                bending,
                twist,
            } => {
                let (shear_stretch, mut bend_twist) = section.rigidities(youngs.at(e), shear.at(e));
                if let Some(bending) = bending {
                    (bend_twist.x, bend_twist.y) = (bending.at(e), bending.at(e));
                }
                if let Some(twist) = twist {
                    bend_twist.z = twist.at(e);
                }
                (shear_stretch, bend_twist)
            }
            Self::Rigidities {
                shear,
                axial,
                bending,
                twist,
            } => (
                Vector3::new(shear.at(e), shear.at(e), axial.at(e)),
                Vector3::new(bending.at(e), bending.at(e), twist.at(e)),
            ),
        }
    }
}

/// Rigid ends of a rod.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Caps {
    /// Length before the first node \[m\].
    pub start: NonNegative,
    /// Length after the last node \[m\].
    pub tip: NonNegative,
}

/// A rigid cylinder.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CylinderSpec {
    /// Name of the body.
    pub name: String,
    /// Centre of mass \[m\].
    pub centre: Vec3,
    /// Direction of the axis.
    #[serde(default = "z")]
    pub axis: Direction,
    /// Direction of `d1`, made normal to the axis; by default x, turned as z is onto the axis.
    #[serde(default)]
    pub normal: Option<Direction>,
    /// Radius \[m\].
    pub radius: Positive,
    /// Thickness along the axis \[m\].
    pub thickness: Positive,
    /// Density \[kg/m3\]; or give `mass`.
    #[serde(default)]
    pub density: Option<Positive>,
    /// Mass \[kg\]; or give `density`.
    #[serde(default)]
    pub mass: Option<Positive>,
}

fn z() -> Direction {
    Direction::new([0.0, 0.0, 1.0]).expect("z is a direction")
}

impl RodGroup {
    /// Names of the rods.
    pub fn names(&self) -> Vec<&str> {
        if self.at.is_empty() {
            vec![&self.name]
        } else {
            self.at.keys().map(String::as_str).collect()
        }
    }

    /// Direction that `d1` comes of.
    pub fn normal(&self) -> Vector3<f64> {
        match self.normal {
            Some(normal) => Vector3::from(*normal),
            None if self.direction[0].abs() < 0.9 => Vector3::x(),
            None => Vector3::y(),
        }
    }

    /// The rods, or the field that is wrong and why.
    pub fn rods(&self) -> Result<Vec<Rod>, (&'static str, String)> {
        let n = *self.elements;
        self.radius.check_len(n).map_err(|e| ("radius", e))?;
        self.density.check_len(n).map_err(|e| ("density", e))?;
        for profile in self.material.profiles() {
            profile.check_len(n).map_err(|e| ("material", e))?;
        }
        let mut inside = vec![0.0; n];
        if let Some(wall) = &self.wall {
            wall.check_len(n).map_err(|e| ("wall", e))?;
            for (e, inside) in inside.iter_mut().enumerate() {
                *inside = self.radius.at(e) - wall.at(e);
                if *inside < 0.0 {
                    return Err((
                        "wall",
                        format!(
                            "the wall {} m is thicker than the radius {} m; leave it out for a solid rod",
                            wall.at(e),
                            self.radius.at(e)
                        ),
                    ));
                }
            }
        }
        let direction = Vector3::from(*self.direction);
        let normal = across(&self.normal(), &direction).ok_or_else(|| {
            (
                "normal",
                "the normal lies along the rod; give another".into(),
            )
        })?;
        let sections: Vec<_> = (0..n)
            .map(|e| Section {
                outside: self.radius.at(e),
                inside: inside[e],
            })
            .collect();
        let (shear_stretch, bend_twist) = sections
            .iter()
            .enumerate()
            .map(|(e, section)| self.material.rigidities(section, e))
            .unzip();
        let vector = |v: Option<Vec3>| v.map_or(Vector3::zeros(), |v| Vector3::from(*v));
        let rod = Rod {
            name: self.name.clone(),
            start: Vector3::zeros(),
            direction,
            normal,
            length: *self.length,
            outside_radius: sections.iter().map(|s| s.outside).collect(),
            inside_radius: inside,
            density: (0..n).map(|e| self.density.at(e)).collect(),
            shear_stretch,
            bend_twist,
            rest_sigma: vector(self.rest_strain),
            rest_kappa: vector(self.rest_curvature),
            caps: [*self.caps.start, *self.caps.tip],
        };
        rod.check().map_err(|e| {
            let message =
                format!("{e}; check length, radius, density and material, all in SI units");
            ("name", message)
        })?;
        if self.at.is_empty() {
            return Ok(vec![rod]);
        }
        let placed = self.at.iter().map(|(name, start)| Rod {
            name: name.clone(),
            start: Vector3::from(**start),
            ..rod.clone()
        });
        Ok(placed.collect())
    }
}

/// The part of a direction that is normal to an axis, of unit length.
fn across(direction: &Vector3<f64>, axis: &Vector3<f64>) -> Option<Vector3<f64>> {
    let normal = direction - axis * direction.dot(axis);
    (normal.norm() >= 1e-6).then(|| normal.normalize())
}

impl CylinderSpec {
    /// Direction that `d1` comes of.
    pub fn normal(&self) -> Vector3<f64> {
        if let Some(normal) = self.normal {
            return Vector3::from(*normal);
        }
        let axis = Vector3::from(*self.axis);
        let turn = Rotation3::rotation_between(&Vector3::z(), &axis).unwrap_or_else(|| {
            Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
        });
        turn * Vector3::x()
    }

    /// The body, or the field that is wrong and why.
    pub fn cylinder(&self) -> Result<Cylinder, (&'static str, String)> {
        let volume = std::f64::consts::PI * self.radius.powi(2) * *self.thickness;
        let mass = match (self.mass, self.density) {
            (Some(mass), None) => *mass,
            (None, Some(density)) => *density * volume,
            (Some(_), Some(_)) => {
                let message = "both `density` and `mass` are given; leave one out";
                return Err(("mass", message.into()));
            }
            (None, None) => {
                let message = "neither `density` nor `mass` is given; add one of them";
                return Err(("name", message.into()));
            }
        };
        let axis = Vector3::from(*self.axis);
        let normal = across(&self.normal(), &axis).ok_or_else(|| {
            (
                "normal",
                "the normal lies along the axis; give another".into(),
            )
        })?;
        let directors = [normal, axis.cross(&normal), axis];
        Ok(Cylinder {
            name: self.name.clone(),
            centre: Vector3::from(*self.centre),
            director: Matrix3::from_rows(&directors.map(|d| d.transpose())),
            mass,
            inertia: Cylinder::solid_inertia(mass, *self.radius, *self.thickness),
        })
    }
}
