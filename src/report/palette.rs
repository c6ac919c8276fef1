//! Colours that stay distinct for people of all kinds of colour vision (Okabe and Ito 2008, "Color Universal Design").

/// A colour: red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub u8, pub u8, pub u8);

/// Black.
pub const BLACK: Colour = Colour(0, 0, 0);
/// Orange.
pub const ORANGE: Colour = Colour(230, 159, 0);
/// Sky blue.
pub const SKY: Colour = Colour(86, 180, 233);
/// Bluish green.
pub const GREEN: Colour = Colour(0, 158, 115);
/// Blue.
pub const BLUE: Colour = Colour(0, 114, 178);
/// Vermilion.
pub const VERMILION: Colour = Colour(213, 94, 0);
/// Reddish purple.
pub const PURPLE: Colour = Colour(204, 121, 167);
/// Grey, for what is beside the point.
pub const GREY: Colour = Colour(120, 120, 120);
/// White.
pub const WHITE: Colour = Colour(255, 255, 255);

/// Axes x, y and z of a frame: red, green and blue, as in robotics everywhere.
pub const AXES: [Colour; 3] = [Colour(204, 20, 40), Colour(0, 140, 60), Colour(20, 80, 220)];

impl Colour {
    /// This colour with a share of another in it.
    #[must_use]
    pub fn mixed(self, other: Self, share: f64) -> Self {
        let mix =
            |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * share).round() as u8;
        Self(
            mix(self.0, other.0),
            mix(self.1, other.1),
            mix(self.2, other.2),
        )
    }
}
