//! What the colours and signs of a picture stand for.

use crate::canvas::{Area, Hold, size, width, write};
use crate::{Colour, Curve, Line, Marker};

/// Height of a row of the legend, its text, and the room of a sign and between entries, in points.
pub const ROW: f64 = 22.0;
const TEXT: f64 = 11.0;
const SIGN: f64 = 30.0;
const GAP: f64 = 18.0;

/// An entry of a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What it stands for.
    pub label: String,
    /// Its colour.
    pub colour: Colour,
    /// Its line.
    pub line: Line,
    /// Its marker.
    pub marker: Marker,
}

impl Entry {
    /// A patch of a colour.
    #[must_use]
    pub fn patch(label: &str, colour: Colour) -> Self {
        Self {
            label: label.into(),
            colour,
            line: Line::None,
            marker: Marker::Square,
        }
    }

    /// A line of a colour.
    #[must_use]
    pub fn line(label: &str, colour: Colour) -> Self {
        Self {
            line: Line::Solid,
            marker: Marker::None,
            ..Self::patch(label, colour)
        }
    }

    pub(crate) fn of(curve: &Curve) -> Self {
        Self {
            label: curve.label.clone(),
            colour: curve.colour,
            line: curve.line,
            marker: curve.marker,
        }
    }

    fn width(&self, area: &Area<'_>) -> f64 {
        SIGN + width(area, &self.label, TEXT) + GAP
    }

    /// Number of rows that entries take.
    pub(crate) fn rows(area: &Area<'_>, entries: &[Self]) -> usize {
        broken(area, entries).len()
    }
}

/// The entries in rows that fit.
fn broken<'e>(area: &Area<'_>, entries: &'e [Entry]) -> Vec<Vec<(&'e Entry, f64)>> {
    let (room, _) = size(area);
    let mut rows: Vec<Vec<(&Entry, f64)>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in entries {
        let width = entry.width(area);
        if used + width > room {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += width;
        if let Some(row) = rows.last_mut() {
            row.push((entry, width));
        }
    }
    rows
}

/// Draws entries in centred rows.
pub fn draw_legend(area: &Area<'_>, entries: &[Entry]) {
    let (room, _) = size(area);
    for (i, row) in broken(area, entries).iter().enumerate() {
        let y = ROW * (i as f64 + 0.4);
        let used: f64 = row.iter().map(|(_, width)| width).sum();
        let mut x = (room - used + GAP) / 2.0;
        for (entry, width) in row {
            entry
                .line
                .draw(area, &[(x, y), (x + SIGN - 6.0, y)], entry.colour);
            entry
                .marker
                .draw(area, (x + (SIGN - 6.0) / 2.0, y), entry.colour);
            write(
                area,
                &entry.label,
                (x + SIGN, y),
                TEXT,
                Hold::Left,
                false,
                false,
            );
            x += width;
        }
    }
}
