//! What can be recorded of a body.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Deref;

/// A quantity of a body's nodes, elements, Voronoi cells or frames (one an element, or the one of a rigid body).
/// World components are along `x, y, z`, material ones along the directors `d1, d2, d3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Quantity {
    /// Position of nodes, world frame, in m.
    Position,
    /// Velocity of nodes, world frame, in m/s.
    Velocity,
    /// Frames: directors d1, d2, d3 (the rows) in the world frame.
    Director,
    /// Angular velocity of frames, material frame, in rad/s.
    Omega,
    /// Mass of nodes, rigid ends included, in kg.
    Mass,
    /// Moments of inertia of frames about the directors, rigid ends included, in kg m2.
    Inertia,
    /// Present length of elements, in m.
    Length,
    /// Length of elements as built, in m.
    ReferenceLength,
    /// Rest length of elements: as built unless a rod law sets it, in m.
    RestLength,
    /// Dilatation of elements: present over rest length.
    Dilatation,
    /// Unit tangent of elements, world frame.
    Tangent,
    /// Shear and stretch strains of elements, material frame.
    Sigma,
    /// Internal force of elements, material frame, in N.
    Stress,
    /// Curvatures and twist of cells, material frame, in rad/m.
    Kappa,
    /// Rotation vector across cells, material frame, in rad.
    Rotation,
    /// Twist of cells, referred to their twist length, in rad/m.
    Twist,
    /// Internal couple of cells, material frame, in N m.
    Couple,
    /// Rest length of cells, in m.
    RestVoronoi,
    /// Length that the twist of cells is referred to, in m.
    TwistLength,
    /// Shear, shear and axial rigidities of elements as built, in N.
    BuiltShearStretch,
    /// Bending, bending and twist rigidities of cells as built, in N m2.
    BuiltBendTwist,
    /// Total force on nodes, world frame, in N.
    Force,
    /// Total torque on frames, material frame, in N m.
    Torque,
}

/// At least one quantity, each once; position and frame unless named.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(try_from = "Vec<Quantity>", into = "Vec<Quantity>")]
#[schemars(with = "Vec<Quantity>")]
pub(crate) struct Quantities(Vec<Quantity>);

impl Default for Quantities {
    fn default() -> Self {
        Self(vec![Quantity::Position, Quantity::Director])
    }
}

impl TryFrom<Vec<Quantity>> for Quantities {
    type Error = String;

    fn try_from(quantities: Vec<Quantity>) -> Result<Self, String> {
        if quantities.is_empty() {
            return Err("name at least one quantity".into());
        }
        let again = (1..quantities.len()).find(|i| quantities[..*i].contains(&quantities[*i]));
        match again {
            Some(i) => Err(format!("{:?} is named twice; name it once", quantities[i])),
            None => Ok(Self(quantities)),
        }
    }
}

impl From<Quantities> for Vec<Quantity> {
    fn from(quantities: Quantities) -> Self {
        quantities.0
    }
}

impl Deref for Quantities {
    type Target = [Quantity];

    fn deref(&self) -> &[Quantity] {
        &self.0
    }
}
