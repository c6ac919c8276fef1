//! The auxetic trajectory of Stölzle et al. 2023, section II-B.

use auxetica_engine::{Finite, LawView, Moment, NonNegative, ReadBody, RodLaw, Setting, register};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which way the rod must be twisted to lengthen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum Handedness {
    /// h = +1: a motor that turns the start by a positive angle lengthens the rod.
    Right,
    /// h = -1.
    Left,
}

impl Handedness {
    fn sign(self) -> f64 {
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

fn paper_factor() -> NonNegative {
    NonNegative::new(0.01).expect("the paper's factor is positive")
}

/// The auxetic law: the rest length of each element follows the twist along the rod's handedness,
/// `rest = (1 + eps) printed`, `eps = clamp(factor * winding twist, eps_min, eps_max)`; twist stays referred to the
/// printed length.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Auxetic {
    /// Which way of twisting lengthens the rod.
    handedness: Handedness,
    /// Extension factor C_eps [m/rad]; by default that of the paper's robot (section II-E).
    #[serde(default = "paper_factor")]
    factor: NonNegative,
    /// Smallest extension [-]; 0 for closed HSAs, which only lengthen.
    #[serde(default)]
    eps_min: Finite,
    /// Largest extension [-]; unlimited if left out.
    #[serde(default)]
    eps_max: Option<NonNegative>,
    /// How twist is averaged from cells to elements.
    #[serde(default)]
    averaging: Averaging,
    /// How rigidities change with the winding twist.
    #[serde(default)]
    slopes: Slopes,
    /// Whether the axial force gives a twist couple in return, which makes the law conservative to first order in the
    /// axial strain. The published law has none.
    #[serde(default)]
    reciprocal: bool,
}

register!(
    dyn RodLaw: Auxetic,
    example = "Auxetic(handedness: Right, factor: 0.01)",
    source = "Stölzle et al. 2023, eq. 2-5",
);

impl Auxetic {
    /// Twist along the handedness of cell `v` [rad/m]: the motor turns the start, so twist and angle are opposite.
    fn winding(&self, rod: &LawView<'_>, v: usize) -> f64 {
        -self.handedness.sign() * rod.twist(v)
    }

    /// Winding twist of element `e` for its rest length.
    fn of_element(&self, rod: &LawView<'_>, e: usize) -> f64 {
        let cells = rod.cells();
        let (mut sum, mut count) = (0.0, 0);
        for v in [e, e + 1] {
            if cells.contains(&v) {
                sum += self.winding(rod, v);
                count += 1;
            }
        }
        match self.averaging {
            Averaging::Mean if count == 1 => sum,
            _ => sum / 2.0,
        }
    }

    /// Winding twist of element `e` for its rigidities, never negative.
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

    fn extension(&self, rod: &LawView<'_>, e: usize) -> f64 {
        (*self.factor * self.of_element(rod, e)).clamp(*self.eps_min, self.eps_max())
    }

    fn eps_max(&self) -> f64 {
        self.eps_max.map_or(f64::INFINITY, |most| *most)
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
        for e in 0..rod.elements() {
            let extension = self.extension(rod, e);
            rod.set_rest_length(e, rod.reference_length(e) * (1.0 + extension));
            if shear != 0.0 || axial != 0.0 {
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
        if !self.reciprocal {
            return;
        }
        let gain = self.handedness.sign() * *self.factor;
        for v in rod.cells() {
            let neighbours = [v.checked_sub(1), (v < rod.elements()).then_some(v)];
            let mut axial = 0.0;
            for e in neighbours.into_iter().flatten() {
                let free = *self.factor * self.of_element(rod, e);
                if (*self.eps_min..self.eps_max()).contains(&free) {
                    axial += rod.stress(e).z * rod.dilatation(e) / 2.0;
                }
            }
            rod.add_couple(v, Vector3::z() * (gain * axial));
        }
    }

    fn check(&self, _setting: &Setting<'_>) -> Result<(), String> {
        if *self.eps_min > self.eps_max() {
            return Err(format!(
                "eps_min {} exceeds eps_max {}; give a smaller eps_min or a larger eps_max",
                *self.eps_min,
                self.eps_max()
            ));
        }
        if *self.eps_min <= -1.0 {
            return Err(format!(
                "eps_min {} would let an element vanish; give more than -1",
                *self.eps_min
            ));
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
