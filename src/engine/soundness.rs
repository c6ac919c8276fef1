//! Whether a state still resembles rods and rigid bodies.

use crate::bodies::{Bodies, Layout};
use crate::lanes::{LANES, ZERO, triple};
use pulp::{Simd, WithSimd};

/// Dilatations beyond which a simulation has blown up.
pub(crate) const STRETCH: std::ops::Range<f64> = 1e-3..1e3;
/// Root mean square of the rotations \[rad\] between a rod's neighbouring elements beyond which a simulation has blown up:
/// frames turned at random have 2.3, a motor's jump by half a turn at one end of ten elements 1.0.
const TANGLED: f64 = 2.0;

impl Bodies {
    /// Whether rates are finite numbers and elements still resemble what the model is made for.
    pub(crate) fn is_sound(&self) -> bool {
        self.arch.dispatch(PlainlySound(self))
            || (self.state.velocity.all_finite()
                && self.state.omega.all_finite()
                && self
                    .layouts
                    .iter()
                    .flat_map(Layout::element_stations)
                    .all(|k| STRETCH.contains(&self.dilatation[k]))
                && !self.layouts.iter().any(|layout| self.is_tangled(layout)))
    }

    /// Whether a rod's frames have lost all relation to each other.
    pub(crate) fn is_tangled(&self, layout: &Layout) -> bool {
        let squares: f64 = layout
            .cells()
            .map(|k| self.rotation.get(k).norm_squared())
            .sum();
        // at least four, since few cells may well be turned far by one motor
        squares > TANGLED.powi(2) * layout.cells().len().max(4) as f64
    }
}

/// Whether all is sound and not even one cell is turned far.
struct PlainlySound<'a>(&'a Bodies);

impl WithSimd for PlainlySound<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let bodies = self.0;
        let all = bodies.blocks();
        let (velocity, omega) = (
            bodies.state.velocity.blocks(all),
            bodies.state.omega.blocks(all),
        );
        let (dilatation, turn) = (bodies.dilatation.blocks(all), bodies.rotation.blocks(all));
        let mut faults = ZERO;
        for b in 0..all.count {
            let (velocity, omega) = (velocity.at(b), omega.at(b));
            let (dilatation, turn) = (&dilatation[b], turn.at(b));
            for l in 0..LANES {
                // zero, or no number where a rate is infinite or none
                let zero = (velocity.get(l) * 0.0 + omega.get(l) * 0.0).dot(triple(1.0, 1.0, 1.0));
                let sound = (zero == 0.0)
                    & (dilatation[l] >= STRETCH.start)
                    & (dilatation[l] < STRETCH.end)
                    & (turn.get(l).squared() <= TANGLED * TANGLED);
                faults[l] += if sound { 0.0 } else { 1.0 };
            }
        }
        faults.iter().sum::<f64>() < 0.5
    }
}
