//! Pictures for people: charts, and scenes of slender robots in perspective.
//!
//! Everything is drawn once, by [`plotters`], into an SVG that needs nothing beside it; the PNG is made of that very
//! SVG with a font that is built in, so that no picture depends on the machine's fonts.
//!
//! - [`charts`] draws panels of curves with markers, error bars and one legend;
//! - a [`Scene`] collects tubes, discs, boxes and frames, seen by a [`Camera`]; [`scenes`] draws panels of them;
//! - a [`Picture`] is saved as both files.
//!
//! Colours are those of Okabe and Ito ([`palette`]), which people of all kinds of colour vision can tell apart.

mod canvas;
mod chart;
mod legend;
pub mod palette;
mod picture;
mod scene;
mod shapes;

pub use chart::{Axis, Chart, Curve, Line, Marker, charts};
pub use legend::Entry;
pub use palette::Colour;
pub use picture::Picture;
pub use scene::{Camera, Scene, View, scenes};
pub use shapes::Stripes;

/// A rigid pose: maps a body's own axes to the scene's.
pub type Pose = nalgebra::Isometry3<f64>;
