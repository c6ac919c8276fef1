//! How far a twisted rod lengthens at rest.

use auxetica_engine::Positive;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cells of links that lean, for rods printed semi-closed or open, which have a limit either way. A cell's height and
/// girth go with the sine of the links' angle (Poisson's ratio -1, as rotating squares have), and a row shears by its
/// links' turn times its height. Over the radius, which grows with the girth, this is twist: the angle follows the
/// winding twist `w` linearly, `theta = printed + gain w`, where `gain` is the printed radius of the links, and
/// `eps = sin(theta) / sin(printed) - 1`.
///
/// At 90 degrees the rod is longest, as every shearing auxetic is at some phase angle (Lipton et al. 2018,
/// doi:10.1126/science.aar4586); past it links lean the other way and the rod shortens again. At the angle `closed`,
/// to either side, cells touch and the length stays.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Links {
    /// Angle of the links from the girth as printed [degrees]: that of `closed` for a closed rod, 90 for an open one.
    printed: Positive,
    /// Angle at which cells touch [degrees], up to 90.
    closed: Positive,
    /// Turn of the links per winding twist [m].
    gain: Positive,
}

impl Links {
    pub(crate) fn check(&self) -> Result<(), String> {
        let (printed, closed) = (*self.printed, *self.closed);
        if closed >= 90.0 {
            return Err(format!(
                "links.closed is {closed} degrees, so cells couldn't open; give less than 90"
            ));
        }
        if !(closed..=180.0 - closed).contains(&printed) {
            return Err(format!(
                "links.printed is {printed} degrees, where cells overlap; give {closed} to {}",
                180.0 - closed
            ));
        }
        Ok(())
    }
}

/// Extension at rest against winding twist [rad/m].
pub(crate) enum Trajectory {
    /// `eps = clamp(factor w, least, most)` (Stölzle et al. 2023, eq. 2).
    Linear { factor: f64, least: f64, most: f64 },
    /// See [`Links`]; angles in rad.
    Links {
        printed: f64,
        closed: f64,
        gain: f64,
    },
}

impl From<Links> for Trajectory {
    fn from(links: Links) -> Self {
        Self::Links {
            printed: links.printed.to_radians(),
            closed: links.closed.to_radians(),
            gain: *links.gain,
        }
    }
}

impl Trajectory {
    /// Extension [-] at a winding twist [rad/m].
    #[inline]
    pub(crate) fn extension(&self, winding: f64) -> f64 {
        match *self {
            Self::Linear {
                factor,
                least,
                most,
            } => (factor * winding).clamp(least, most),
            Self::Links {
                printed,
                closed,
                gain,
            } => {
                let angle = printed + gain * winding;
                let angle = angle.clamp(closed, std::f64::consts::PI - closed);
                angle.sin() / printed.sin() - 1.0
            }
        }
    }

    /// Derivative of [`Trajectory::extension`] by the winding twist [m/rad]; 0 beyond limits.
    #[inline]
    pub(crate) fn slope(&self, winding: f64) -> f64 {
        match *self {
            Self::Linear {
                factor,
                least,
                most,
            } => {
                let free = (least..most).contains(&(factor * winding));
                if free { factor } else { 0.0 }
            }
            Self::Links {
                printed,
                closed,
                gain,
            } => {
                let angle = printed + gain * winding;
                let free = (closed..std::f64::consts::PI - closed).contains(&angle);
                if free {
                    gain * angle.cos() / printed.sin()
                } else {
                    0.0
                }
            }
        }
    }
}
