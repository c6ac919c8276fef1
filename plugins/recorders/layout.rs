//! How a quantity is read from a body and laid out in columns and arrays.

use crate::quantity::Quantity;
use auxetica_engine::{Body, ReadBody};
use nalgebra::{Matrix3, Vector3};

/// What of a body has a quantity.
#[derive(Clone, Copy)]
enum Place {
    Node,
    Frame,
    Element,
    Cell,
}

/// Reads a quantity at an index.
#[derive(Clone, Copy)]
enum Read {
    Number(fn(&Body<'_>, usize) -> f64),
    /// Components along the world's axes.
    World(fn(&Body<'_>, usize) -> Vector3<f64>),
    /// Components along the directors.
    Material(fn(&Body<'_>, usize) -> Vector3<f64>),
    /// Rows are directors in the world frame.
    Directors(fn(&Body<'_>, usize) -> Matrix3<f64>),
}

/// Name, unit and source of a quantity.
#[derive(Clone, Copy)]
pub(crate) struct Layout {
    /// Name of the quantity, without its unit.
    pub(crate) name: &'static str,
    unit: &'static str,
    place: Place,
    read: Read,
}

impl From<Quantity> for Layout {
    #[rustfmt::skip]
    fn from(quantity: Quantity) -> Self {
        use Place::{Cell, Element, Frame, Node};
        use Read::{Directors, Material, Number, World};
        let (name, unit, place, read) = match quantity {
            Quantity::Position => ("position", "_m", Node, World(|b, i| b.position(i))),
            Quantity::Velocity => ("velocity", "_m_per_s", Node, World(|b, i| b.velocity(i))),
            Quantity::Director => ("director", "", Frame, Directors(|b, e| b.director(e))),
            Quantity::Omega => ("omega", "_rad_per_s", Frame, Material(|b, e| b.omega(e))),
            Quantity::Mass => ("mass", "_kg", Node, Number(|b, i| b.mass(i))),
            Quantity::Inertia => ("inertia", "_kg_m2", Frame, Material(|b, e| b.inertia(e))),
            Quantity::Length => ("length", "_m", Element, Number(|b, e| b.length(e))),
            Quantity::ReferenceLength => ("reference_length", "_m", Element, Number(|b, e| b.reference_length(e))),
            Quantity::RestLength => ("rest_length", "_m", Element, Number(|b, e| b.rest_length(e))),
            Quantity::Dilatation => ("dilatation", "", Element, Number(|b, e| b.dilatation(e))),
            Quantity::Tangent => ("tangent", "", Element, World(|b, e| b.tangent(e))),
            Quantity::Sigma => ("sigma", "", Element, Material(|b, e| b.sigma(e))),
            Quantity::Stress => ("stress", "_N", Element, Material(|b, e| b.stress(e))),
            Quantity::Kappa => ("kappa", "_rad_per_m", Cell, Material(|b, v| b.kappa(v))),
            Quantity::Rotation => ("rotation", "_rad", Cell, Material(|b, v| b.rotation(v))),
            Quantity::Twist => ("twist", "_rad_per_m", Cell, Number(|b, v| b.twist(v))),
            Quantity::Couple => ("couple", "_N_m", Cell, Material(|b, v| b.couple(v))),
            Quantity::RestVoronoi => ("rest_voronoi", "_m", Cell, Number(|b, v| b.rest_voronoi(v))),
            Quantity::TwistLength => ("twist_length", "_m", Cell, Number(|b, v| b.twist_length(v))),
            Quantity::BuiltShearStretch => ("built_shear_stretch", "_N", Element, Material(|b, e| b.built_shear_stretch(e))),
            Quantity::BuiltBendTwist => ("built_bend_twist", "_N_m2", Cell, Material(|b, v| b.built_bend_twist(v))),
            Quantity::Force => ("force", "_N", Node, World(|b, i| b.force(i))),
            Quantity::Torque => ("torque", "_N_m", Frame, Material(|b, e| b.torque(e))),
        };
        Self { name, unit, place, read }
    }
}

impl Layout {
    /// Names of the columns, one a component: `position_x_m`.
    pub(crate) fn columns(self) -> impl Iterator<Item = String> {
        let components: &[_] = match self.read {
            Read::Number(_) => &[""],
            Read::World(_) => &["_x", "_y", "_z"],
            Read::Material(_) => &["_d1", "_d2", "_d3"],
            Read::Directors(_) => &[
                "_d1_x", "_d1_y", "_d1_z", "_d2_x", "_d2_y", "_d2_z", "_d3_x", "_d3_y", "_d3_z",
            ],
        };
        components
            .iter()
            .map(move |component| format!("{}{component}{}", self.name, self.unit))
    }

    /// Shape of one value.
    pub(crate) fn shape(self) -> &'static [u64] {
        match self.read {
            Read::Number(_) => &[],
            Read::World(_) | Read::Material(_) => &[3],
            Read::Directors(_) => &[3, 3],
        }
    }

    /// Past the last index that has a value in `body`: 0 if none can have one. Cells count those at the ends, whether
    /// or not a wall holds them.
    pub(crate) fn end(self, body: &Body<'_>) -> usize {
        match self.place {
            Place::Node => body.nodes(),
            Place::Frame => body.directors(),
            Place::Element => body.elements(),
            Place::Cell if body.is_rod() => body.nodes(),
            Place::Cell => 0,
        }
    }

    fn exists(self, body: &Body<'_>, index: usize) -> bool {
        match self.place {
            Place::Cell => body.cells().contains(&index),
            _ => index < self.end(body),
        }
    }

    /// Appends the components at `index`, row by row; `None` for each where the body has no such value.
    pub(crate) fn append(self, body: &Body<'_>, index: usize, to: &mut Vec<Option<f64>>) {
        if !self.exists(body, index) {
            let components: u64 = self.shape().iter().product();
            to.extend((0..components).map(|_| None));
            return;
        }
        match self.read {
            Read::Number(read) => to.push(Some(read(body, index))),
            Read::World(read) | Read::Material(read) => {
                to.extend(read(body, index).iter().copied().map(Some));
            }
            // iteration is column by column
            Read::Directors(read) => {
                to.extend(read(body, index).transpose().iter().copied().map(Some));
            }
        }
    }
}
