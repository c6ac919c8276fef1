//! What everything is drawn on.

use crate::Colour;
use plotters::coord::Shift;
use plotters::drawing::DrawingArea;
use plotters::element::{PathElement, Polygon, Text};
use plotters::prelude::SVGBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontFamily, FontStyle, FontTransform, IntoFont, RGBColor, ShapeStyle, TextStyle,
    register_font,
};
use std::sync::Once;

/// Backends count in whole numbers, so a point of the picture is this many of theirs.
pub const FINE: f64 = 4.0;
/// The font, and what browsers take where they haven't got it.
pub const FONT: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Drawing into memory can't fail.
pub const IN_MEMORY: &str = "the picture is drawn in memory";

/// Points of the picture in the backend's unit.
pub fn fine(points: f64) -> i32 {
    (points * FINE).round() as i32
}

/// Tells plotters how wide letters are.
pub fn know_the_font() {
    static KNOWN: Once = Once::new();
    KNOWN.call_once(|| {
        for (style, bytes) in [
            (FontStyle::Normal, dejavu::sans::regular()),
            (FontStyle::Bold, dejavu::sans::bold()),
        ] {
            // a font that can't be read costs nothing but the legend's alignment
            let _ = register_font(FONT, style, bytes);
        }
    });
}

impl Colour {
    pub(crate) fn rgb(self) -> RGBColor {
        RGBColor(self.0, self.1, self.2)
    }

    /// A stroke of a width in points.
    pub(crate) fn stroke(self, width: f64, opacity: f64) -> ShapeStyle {
        ShapeStyle::from(self.rgb().mix(opacity)).stroke_width(fine(width) as u32)
    }

    pub(crate) fn filled(self, opacity: f64) -> ShapeStyle {
        self.rgb().mix(opacity).filled()
    }
}

/// Where a text is held.
#[derive(Clone, Copy)]
pub enum Hold {
    Left,
    Centre,
}

/// A text of so many points.
pub fn font(size: f64, style: FontStyle) -> TextStyle<'static> {
    // plotters takes 1.24 times the size that it writes
    let family = FontFamily::Name(FONT);
    (family, size * FINE * 1.24, style).into_font().into()
}

/// Writes at a point of the area, upwards if `turned`.
pub fn write(
    area: &Area<'_>,
    text: &str,
    (x, y): (f64, f64),
    size: f64,
    hold: Hold,
    bold: bool,
    turned: bool,
) {
    let style = if bold {
        FontStyle::Bold
    } else {
        FontStyle::Normal
    };
    let h = match hold {
        Hold::Left => HPos::Left,
        Hold::Centre => HPos::Center,
    };
    let mut style = font(size, style).pos(Pos::new(h, VPos::Center));
    if turned {
        style = style.transform(FontTransform::Rotate270);
    }
    area.draw(&Text::new(text.to_owned(), (fine(x), fine(y)), style))
        .expect(IN_MEMORY);
}

/// Width of a text in points.
pub fn width(area: &Area<'_>, text: &str, size: f64) -> f64 {
    area.estimate_text_size(text, &font(size, FontStyle::Normal))
        .map_or(0.6 * size * text.len() as f64, |(w, _)| f64::from(w) / FINE)
}

pub fn line(area: &Area<'_>, points: &[(f64, f64)], style: ShapeStyle) {
    let points: Vec<_> = points.iter().map(|&(x, y)| (fine(x), fine(y))).collect();
    area.draw(&PathElement::new(points, style))
        .expect(IN_MEMORY);
}

pub fn polygon(area: &Area<'_>, points: &[(f64, f64)], style: ShapeStyle) {
    let points: Vec<_> = points.iter().map(|&(x, y)| (fine(x), fine(y))).collect();
    area.draw(&Polygon::new(points, style)).expect(IN_MEMORY);
}

/// Size of an area in points.
pub fn size(area: &Area<'_>) -> (f64, f64) {
    let (w, h) = area.dim_in_pixel();
    (f64::from(w) / FINE, f64::from(h) / FINE)
}
