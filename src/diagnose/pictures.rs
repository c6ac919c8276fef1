//! Pictures of where simulation and recordings differ.

use super::verdict::{Diagnosis, Trace};
use crate::report::{Axis, Chart, Colour, Curve, Line, Marker, charts, palette};

/// Size of a panel in points, and how many stand side by side.
const PANEL: (u32, u32) = (470, 220);
const COLUMNS: usize = 2;

/// The platform's error over time, a panel for each recording, as SVG.
pub(super) fn over_time(d: &Diagnosis) -> String {
    picture(d, "time [s]", Line::Solid, |trace| &trace.time)
}

/// The platform's error over how far the rods are wound, a panel for each recording, as SVG.
pub(super) fn over_winding(d: &Diagnosis) -> String {
    picture(
        d,
        "mean winding of the rods [degrees]",
        Line::None,
        |trace| &trace.winding_deg,
    )
}

fn picture(d: &Diagnosis, label: &str, line: Line, x: fn(&Trace) -> &[f64]) -> String {
    let named = !d.effects.is_empty();
    let panel = |trace: &Trace| {
        let curve = |label: &str, colour: Colour, y: &[f64]| Curve {
            label: label.to_owned(),
            colour,
            line,
            marker: if line == Line::None {
                Marker::Dot
            } else {
                Marker::None
            },
            points: x(trace).iter().copied().zip(y.iter().copied()).collect(),
            errors: vec![],
        };
        let after = named.then(|| curve("with what was left out", palette::BLUE, &trace.after_mm));
        let before = curve("calibrated scenario", palette::VERMILION, &trace.before_mm);
        Chart {
            title: match trace.role.as_str() {
                "holdout" => format!("{}, held out", trace.recording),
                _ => format!("{}, trained on", trace.recording),
            },
            x: Axis::new(label),
            y: Axis::new("platform's error [mm]"),
            curves: std::iter::once(before).chain(after).collect(),
        }
    };
    let panels: Vec<Chart> = d.traces.iter().map(panel).collect();
    let rows = panels.len().div_ceil(COLUMNS) as u32;
    let size = (COLUMNS as u32 * PANEL.0, rows * PANEL.1 + 30);
    charts(&panels, COLUMNS, size).svg().to_owned()
}
