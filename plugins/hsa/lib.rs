//! Handed shearing auxetics: rods that lengthen when they are twisted along their handedness.

mod auxetic;

pub use auxetic::{Auxetic, Averaging, Handedness, Slopes};
