//! Whether a state still resembles rods and rigid bodies.

use crate::bodies::{Bodies, Layout};
use crate::columns::Extent;
use crate::number::Lanes;
use crate::wide::{OverLanes, dispatch};

/// Dilatations beyond which a simulation has blown up.
pub(crate) const STRETCH: std::ops::Range<f64> = 1e-3..1e3;
/// Root mean square of the rotations \[rad\] between a rod's neighbouring elements beyond which a simulation has blown up:
/// frames turned at random have 2.3, a motor's jump by half a turn at one end of ten elements 1.0.
const TANGLED: f64 = 2.0;

impl Bodies {
    /// Whether rates are finite numbers and elements still resemble what the model is made for.
    pub(crate) fn is_sound(&self) -> bool {
        dispatch(self.arch, PlainlySound(self))
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

impl OverLanes for PlainlySound<'_> {
    type Output = bool;

    #[inline(always)]
    fn over<L: Lanes>(self, token: L::Token) -> bool {
        let bodies = self.0;
        let all = Extent::<L>::new(token, bodies.stations());
        let (velocity, omega) = (
            bodies.state.velocity.blocks(all),
            bodies.state.omega.blocks(all),
        );
        let dilatation = bodies.dilatation.blocks(all);
        let turn = bodies.rotation.blocks(all);
        for b in 0..all.count {
            // no number where a rate is infinite or none
            let rates = velocity.at(b) + omega.at(b);
            let zero = (rates.x + rates.y + rates.z) * 0.0;
            let (stretch, turn) = (dilatation.at(b), turn.at(b).squared());
            let least = stretch.constant(STRETCH.start);
            let long = least.at_most(stretch);
            let short = stretch.at_most(stretch.constant(STRETCH.end.next_down()));
            let turned = turn.at_most(turn.constant(TANGLED * TANGLED));
            let shaped = zero.both(zero.both(long, short), turned);
            if !zero.everywhere(zero.both(zero.is_zero(), shaped)) {
                return false;
            }
        }
        true
    }
}
