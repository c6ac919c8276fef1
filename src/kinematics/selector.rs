//! Which strains vary, and how.

/// How one strain varies along a rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Variation {
    /// It keeps its value in the straight unstretched rod.
    Rest,
    /// It is the same along the whole rod.
    Constant,
    /// It is constant in every segment, each with its own value.
    Piecewise,
}

use Variation::{Constant, Piecewise, Rest};

/// How each of the six strains `(kx, ky, kz, sx, sy, sz)` varies: the bases `B_cs` and `B_pcs`
/// of eq. 10, whose columns keep this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct StrainSelector(pub [Variation; 6]);

impl StrainSelector {
    /// Constant twist and stretch, curvature by segment, no shear: 7 numbers at two segments.
    pub const UNSHEARED: Self = Self([Piecewise, Piecewise, Constant, Rest, Rest, Constant]);
    /// Constant twist and stretch, curvature and shear by segment: 11 numbers at two segments
    /// (eq. 11).
    pub const SHEARED: Self = Self([
        Piecewise, Piecewise, Constant, Piecewise, Piecewise, Constant,
    ]);
    /// All strains by segment: 13 numbers at two segments.
    pub const PIECEWISE: Self = Self([Piecewise; 6]);

    /// Length of the configuration of a rod of so many segments, the base's angle included.
    #[must_use]
    pub fn dof(&self, segments: usize) -> usize {
        1 + self.count(Constant) + segments * self.count(Piecewise)
    }

    /// Where in the configuration the six strains of a segment are; `None` for one at rest.
    pub(crate) fn columns(&self, segment: usize) -> [Option<usize>; 6] {
        let mut constant = 1..;
        let mut piecewise = 1 + self.count(Constant) + segment * self.count(Piecewise)..;
        self.0.map(|variation| match variation {
            Rest => None,
            Constant => constant.next(),
            Piecewise => piecewise.next(),
        })
    }

    fn count(&self, variation: Variation) -> usize {
        self.0.iter().filter(|&&other| other == variation).count()
    }
}
