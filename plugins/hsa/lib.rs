//! Handed shearing auxetics: rods that lengthen when they are twisted along their handedness.

mod auxetic;
mod trajectory;

pub use auxetic::{Auxetic, Averaging, Handedness, Slopes};
pub use trajectory::Links;
