//! The auxetic law of Stölzle et al. 2023, section II-B: lengths and rigidities follow the twist.

use crate::trajectory::{Links, Trajectory};
use auxetica_engine::{Finite, LawView, Moment, NonNegative, ReadBody, RodLaw, Setting, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Which way the rod must be twisted to lengthen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Handedness {
    /// h = +1: a motor that turns the start by a positive angle lengthens the rod.
    Right,
    /// h = -1.
    Left,
}

impl Handedness {
    /// h of the paper: +1 or -1.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }
}

/// How the twist of cells is carried over to elements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Averaging {
    /// The operator A^h of the paper (Gazzola et al. 2018, eq. 3.1): half of both neighbours, so that the two end
    /// elements see half of the twist.
    #[default]
    Paper,
    /// As the authors' code does: rest lengths as `Paper`, but shear and axial rigidities see half of one neighbour
    /// only.
    Reference,
    /// The mean of the neighbours that exist: the end elements see all of the twist. Converges at second order.
    Mean,
}

/// Change of rigidities with the winding twist (eq. 5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Slopes {
    /// Of the shear rigidities [N per rad/m].
    pub shear: f64,
    /// Of the axial rigidity [N per rad/m].
    pub axial: f64,
    /// Of the bending rigidities [N m2 per rad/m].
    pub bending: f64,
    /// Of the twist rigidity [N m2 per rad/m].
    pub twist: f64,
}

/// Extension factor of the paper's robot [m/rad] (section II-E).
const PAPER_FACTOR: f64 = 0.01;

/// The auxetic law: the rest length of each element follows the twist along the rod's handedness,
/// `rest = (1 + eps) printed`, `eps = clamp(factor * winding twist, eps_min, eps_max)`; twist stays referred to the
/// printed length. Rods printed semi-closed or open have `links` instead of a factor.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Auxetic {
    /// Which way of twisting lengthens the rod.
    handedness: Handedness,
    /// Extension factor C_eps [m/rad]; 0.01 if left out, that of the paper's robot (section II-E).
    #[serde(default)]
    factor: Option<NonNegative>,
    /// Smallest extension [-]; 0 if left out, for closed HSAs, which only lengthen.
    #[serde(default)]
    eps_min: Option<Finite>,
    /// Largest extension [-]; unlimited if left out.
    #[serde(default)]
    eps_max: Option<NonNegative>,
    /// Leaning links instead of `factor`, `eps_min` and `eps_max`, for semi-closed and open HSAs: the length goes with
    /// the sine of their angle, which follows the twist.
    #[serde(default)]
    links: Option<Links>,
    /// How twist is averaged from cells to elements.
    #[serde(default)]
    averaging: Averaging,
    /// How rigidities change with the winding twist.
    #[serde(default)]
    slopes: Slopes,
    /// Share of the twist couple that the axial force gives in return [-]: 1 makes the law conservative to first order in
    /// the axial strain. The published law has none.
    #[serde(default)]
    reciprocal: Option<Finite>,
}

register!(
    dyn RodLaw: Auxetic,
    example = "Auxetic(handedness: Right, factor: 0.01)",
    source = "Stölzle et al. 2023, eq. 2-5",
);

impl Auxetic {
    fn trajectory(&self) -> Trajectory {
        self.links.map_or_else(
            || Trajectory::Linear {
                factor: self.factor.map_or(PAPER_FACTOR, |factor| *factor),
                least: self.eps_min.map_or(0.0, |least| *least),
                most: self.eps_max.map_or(f64::INFINITY, |most| *most),
            },
            Trajectory::from,
        )
    }

    /// Twist along the handedness of cell `v` [rad/m]: the motor turns the start, so twist and angle are opposite.
    #[inline(always)]
    fn winding(&self, rod: &LawView<'_>, v: usize) -> f64 {
        -self.handedness.sign() * rod.twist(v)
    }

    /// The same, zero where there is no cell.
    #[inline]
    fn winding_or_zero(&self, rod: &LawView<'_>, cells: &Range<usize>, v: usize) -> f64 {
        if cells.contains(&v) {
            self.winding(rod, v)
        } else {
            0.0
        }
    }

    /// Share that element `e` has of the twist of each of its cells that exist.
    #[inline]
    fn share(&self, cells: &Range<usize>, e: usize) -> f64 {
        let whole = cells.contains(&e) && cells.contains(&(e + 1));
        match self.averaging {
            Averaging::Mean if !whole => 1.0,
            _ => 0.5,
        }
    }

    /// Winding twist of element `e` for its rest length [rad/m].
    fn of_element(&self, rod: &LawView<'_>, e: usize) -> f64 {
        let cells = rod.cells();
        let [before, after] = [e, e + 1].map(|v| self.winding_or_zero(rod, &cells, v));
        (before + after) * self.share(&cells, e)
    }

    /// Winding twist of element `e` for its rigidities [rad/m], never negative.
    fn for_rigidity(&self, rod: &LawView<'_>, e: usize) -> f64 {
        let twist = match self.averaging {
            Averaging::Reference => {
                let cell = if e == 0 { 1 } else { e };
                let exists = rod.cells().contains(&cell);
                if exists {
                    self.winding(rod, cell) / 2.0
                } else {
                    0.0
                }
            }
            _ => self.of_element(rod, e),
        };
        twist.max(0.0)
    }
}

impl RodLaw for Auxetic {
    fn rest(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let Slopes {
            shear,
            axial,
            bending,
            twist,
        } = self.slopes;
        let trajectory = self.trajectory();
        let (cells, last) = (rod.cells(), rod.elements() - 1);
        let shares = [0, last].map(|e| self.share(&cells, e));
        let lengths = rod.length_slices();
        let winding =
            |v: usize| -self.handedness.sign() * lengths.turn[v] / lengths.twist_length[v];
        let mut before = winding(0);
        for e in 0..=last {
            let after = winding(e + 1);
            let share = match e {
                0 => shares[0],
                _ if e == last => shares[1],
                _ => 0.5,
            };
            let extension = trajectory.extension((before + after) * share);
            before = after;
            lengths.rest_length[e] = lengths.reference_length[e] * (1.0 + extension);
        }
        if shear != 0.0 || axial != 0.0 {
            for e in 0..=last {
                let change = Vector3::new(shear, shear, axial) * self.for_rigidity(rod, e);
                rod.set_shear_stretch(e, rod.built_shear_stretch(e) + change);
            }
        }
        if bending != 0.0 || twist != 0.0 {
            for v in rod.cells() {
                let winding = self.winding(rod, v).max(0.0);
                let change = Vector3::new(bending, bending, twist) * winding;
                rod.set_bend_twist(v, rod.built_bend_twist(v) + change);
            }
        }
    }

    fn stress(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let share = self.reciprocal.map_or(0.0, f64::from);
        if share == 0.0 {
            return;
        }
        let trajectory = self.trajectory();
        for v in rod.cells() {
            let neighbours = [v.checked_sub(1), (v < rod.elements()).then_some(v)];
            let mut couple = 0.0;
            for e in neighbours.into_iter().flatten() {
                let slope = trajectory.slope(self.of_element(rod, e));
                // the virtual work of the element's force on its rest length, per turn of the cell
                let lengthening = slope * self.share(&rod.cells(), e) * rod.reference_length(e);
                couple += lengthening / rod.twist_length(v) * rod.stress(e).z * rod.dilatation(e);
            }
            rod.add_couple(v, Vector3::z() * (share * self.handedness.sign() * couple));
        }
    }

    fn check(&self, _setting: &Setting<'_>) -> Result<(), String> {
        if let Some(links) = self.links {
            let linear = [
                ("factor", self.factor.is_some()),
                ("eps_min", self.eps_min.is_some()),
                ("eps_max", self.eps_max.is_some()),
            ];
            if let Some((name, _)) = linear.iter().find(|(_, given)| *given) {
                return Err(format!(
                    "`{name}` belongs to the linear law, but `links` are given; leave one of them out"
                ));
            }
            links.check()?;
        }
        if let Trajectory::Linear { least, most, .. } = self.trajectory() {
            if least > most {
                return Err(format!(
                    "eps_min {least} exceeds eps_max {most}; give a smaller eps_min or a larger eps_max"
                ));
            }
            if least <= -1.0 {
                return Err(format!(
                    "eps_min {least} would let an element vanish; give more than -1"
                ));
            }
        }
        let Slopes {
            shear,
            axial,
            bending,
            twist,
        } = self.slopes;
        if [shear, axial, bending, twist].iter().all(|s| s.is_finite()) {
            Ok(())
        } else {
            Err("slopes must be finite numbers; inf and NaN are not allowed".into())
        }
    }
}
