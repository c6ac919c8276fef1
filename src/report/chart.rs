//! Curves over axes.

use crate::canvas::{self, Area, FINE, IN_MEMORY, fine, size, write};
use crate::legend::{Entry, ROW, draw_legend};
use crate::palette::GREY;
use crate::{Colour, Picture};
use plotters::chart::ChartBuilder;
use plotters::element::{Circle, DashedPathElement};
use plotters::style::FontStyle;
use std::ops::Range;

/// Sizes in points: text, panel titles, width of curves, radius of markers.
const TEXT: f64 = 11.0;
const TITLE: f64 = 12.5;
const CURVE: f64 = 1.6;
const DOT: f64 = 3.4;
/// Room for the title above a panel, for labels left of it and below it, and to its right.
const ABOVE: f64 = 26.0;
const LEFT: f64 = 58.0;
const BELOW: f64 = 42.0;
const RIGHT: f64 = 14.0;

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it shows, unit included.
    pub label: String,
    /// From where to where; by default all that the curves hold, and a little room.
    pub range: Option<Range<f64>>,
    /// Whether it is logarithmic; what isn't positive is left out then.
    pub logarithmic: bool,
    /// Names at 1, 2, 3 and on, instead of numbers.
    pub names: Vec<String>,
}

impl Axis {
    /// A linear axis over all that the curves hold.
    #[must_use]
    pub fn new(label: &str) -> Self {
        Self {
            label: label.into(),
            range: None,
            logarithmic: false,
            names: Vec::new(),
        }
    }

    /// This axis over a range.
    #[must_use]
    pub fn over(mut self, range: Range<f64>) -> Self {
        self.range = Some(range);
        self
    }

    /// This axis on a logarithmic scale.
    #[must_use]
    pub fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    /// This axis with names at 1, 2, 3 and on, instead of numbers.
    #[must_use]
    pub fn named(mut self, names: Vec<String>) -> Self {
        self.names = names;
        self
    }

    /// A value's place along the axis: its logarithm where it is logarithmic.
    fn scaled(&self, value: f64) -> f64 {
        if self.logarithmic {
            value.log10()
        } else {
            value
        }
    }

    /// The range of places of values: a twentieth of room, or whole decades.
    fn range_of(&self, values: impl Iterator<Item = f64>) -> Range<f64> {
        if let Some(range) = &self.range {
            return self.scaled(range.start)..self.scaled(range.end);
        }
        let places = values
            .map(|value| self.scaled(value))
            .filter(|place| place.is_finite());
        let (least, most) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        });
        if least > most {
            return 0.0..1.0;
        }
        if self.logarithmic {
            return least.floor()..most.ceil().max(least.floor() + 1.0);
        }
        let room = match most - least {
            0.0 => 0.5 * most.abs().max(1.0),
            span => 0.05 * span,
        };
        least - room..most + room
    }

    /// Ticks over a range of places: every decade, or a handful.
    fn ticks(&self, range: &Range<f64>) -> usize {
        if self.logarithmic {
            (range.end - range.start).round() as usize + 1
        } else {
            7
        }
    }

    /// How a tick is labelled.
    fn tick(&self, place: f64, range: &Range<f64>) -> String {
        let whole = (place - place.round()).abs() < 1e-6;
        if !self.names.is_empty() {
            let name = |i: f64| self.names.get(i as usize).filter(|_| i >= 0.0);
            return name(place.round() - 1.0)
                .filter(|_| whole)
                .cloned()
                .unwrap_or_default();
        }
        let (value, digits) = if self.logarithmic {
            if !whole {
                return String::new(); // only decades are labelled
            }
            (10f64.powf(place), -place.round())
        } else {
            (place, (1.0 - (range.end - range.start).log10()).ceil())
        };
        let text = format!("{value:.0$}", digits.max(0.0) as usize);
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').into()
        } else {
            text
        }
    }
}

/// How a curve's points are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// They aren't.
    None,
    /// By a line.
    Solid,
    /// By a broken line.
    Dashed,
}

/// What stands at a curve's points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Nothing.
    None,
    /// A dot.
    Dot,
    /// An open circle, wide enough to be seen around another marker.
    Ring,
    /// A square.
    Square,
    /// A triangle.
    Triangle,
    /// A square on its corner.
    Diamond,
    /// A triangle that points down.
    Wedge,
    /// A cross.
    Cross,
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name in the legend; curves that share one share the entry, one without has none.
    pub label: String,
    /// Its colour.
    pub colour: Colour,
    /// How the points are joined.
    pub line: Line,
    /// What stands at the points.
    pub marker: Marker,
    /// Points (x, y).
    pub points: Vec<(f64, f64)>,
    /// How far the error bar of each point reaches down and up; empty for none.
    pub errors: Vec<(f64, f64)>,
}

/// Curves over one pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Title.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves, drawn in this order.
    pub curves: Vec<Curve>,
}

/// Charts in rows of so many, with one legend below, in a picture of a size in points.
#[must_use]
pub fn charts(panels: &[Chart], columns: usize, size: (u32, u32)) -> Picture {
    let mut entries: Vec<Entry> = Vec::new();
    for curve in panels.iter().flat_map(|chart| &chart.curves) {
        if !curve.label.is_empty() && entries.iter().all(|entry| entry.label != curve.label) {
            entries.push(Entry::of(curve));
        }
    }
    Picture::draw(size, |area| {
        let rows = Entry::rows(area, &entries);
        let (_, height) = canvas::size(area);
        let (above, below) = area.split_vertically(fine(height - ROW * rows as f64));
        let columns = columns.max(1);
        let places = above.split_evenly((panels.len().div_ceil(columns), columns));
        for (place, chart) in places.iter().zip(panels) {
            chart.draw(place);
        }
        draw_legend(&below, &entries);
    })
}

impl Chart {
    fn draw(&self, area: &Area<'_>) {
        let points = || self.curves.iter().flat_map(Curve::reach);
        let x = self.x.range_of(points().map(|(x, _)| x));
        let y = self.y.range_of(points().map(|(_, y)| y));
        let mut chart = ChartBuilder::on(area)
            .margin_top(fine(ABOVE))
            .margin_right(fine(RIGHT))
            .x_label_area_size(fine(BELOW))
            .y_label_area_size(fine(LEFT))
            .build_cartesian_2d(x.clone(), y.clone())
            .expect(IN_MEMORY);
        chart
            .configure_mesh()
            .axis_style(GREY.stroke(0.8, 1.0))
            .bold_line_style(GREY.stroke(0.6, 0.25))
            .max_light_lines(0)
            .set_all_tick_mark_size(fine(4.0))
            .x_labels(self.x.ticks(&x))
            .y_labels(self.y.ticks(&y))
            .x_label_formatter(&|place| self.x.tick(*place, &x))
            .y_label_formatter(&|place| self.y.tick(*place, &y))
            .label_style(canvas::font(TEXT, FontStyle::Normal))
            .draw()
            .expect(IN_MEMORY);
        let (left, top) = area.get_base_pixel();
        // what the axes don't reach is left out
        let at = |&(a, b): &(f64, f64)| {
            let place = (self.x.scaled(a), self.y.scaled(b));
            let inside =
                (x.start..=x.end).contains(&place.0) && (y.start..=y.end).contains(&place.1);
            let (x, y) = inside.then(|| chart.backend_coord(&place))?;
            Some((f64::from(x - left) / FINE, f64::from(y - top) / FINE))
        };
        for curve in &self.curves {
            curve.draw(area, &at);
        }
        let (width, height) = size(area);
        let (across, down) = (
            LEFT + (width - LEFT - RIGHT) / 2.0,
            ABOVE + (height - ABOVE - BELOW) / 2.0,
        );
        let centred = |text: &str, at, size, bold, turned| {
            write(area, text, at, size, canvas::Hold::Centre, bold, turned);
        };
        centred(&self.title, (across, 0.55 * ABOVE), TITLE, true, false);
        centred(
            &self.x.label,
            (across, height - 0.28 * BELOW),
            TEXT,
            false,
            false,
        );
        centred(&self.y.label, (0.22 * LEFT, down), TEXT, false, true);
    }
}

/// Where a point (x, y) is in the picture, if the axes reach it.
type Place<'a> = dyn Fn(&(f64, f64)) -> Option<(f64, f64)> + 'a;

impl Curve {
    /// A curve of dots joined by a line.
    #[must_use]
    pub fn new(label: &str, colour: Colour, points: Vec<(f64, f64)>) -> Self {
        Self {
            label: label.into(),
            colour,
            line: Line::Solid,
            marker: Marker::Dot,
            points,
            errors: Vec::new(),
        }
    }

    /// The points and the ends of their error bars.
    fn reach(&self) -> impl Iterator<Item = (f64, f64)> {
        let bars = self.points.iter().zip(&self.errors);
        let bars = bars.flat_map(|(&(x, y), (down, up))| [(x, y - down), (x, y + up)]);
        self.points.iter().copied().chain(bars)
    }

    /// Draws what `at` has a place for.
    fn draw(&self, area: &Area<'_>, at: &Place<'_>) {
        for (&(x, y), (down, up)) in self.points.iter().zip(&self.errors) {
            if let (Some((x, low)), Some((_, high))) = (at(&(x, y - down)), at(&(x, y + up))) {
                let style = self.colour.stroke(1.0, 0.8);
                canvas::line(area, &[(x, low), (x, high)], style);
                for y in [low, high] {
                    canvas::line(area, &[(x - 3.0, y), (x + 3.0, y)], style);
                }
            }
        }
        let points: Vec<_> = self.points.iter().filter_map(at).collect();
        self.line.draw(area, &points, self.colour);
        for point in &points {
            self.marker.draw(area, *point, self.colour);
        }
    }
}

impl Line {
    pub(crate) fn draw(self, area: &Area<'_>, points: &[(f64, f64)], colour: Colour) {
        let style = colour.stroke(CURVE, 1.0);
        match self {
            Self::None => {}
            Self::Solid => canvas::line(area, points, style),
            Self::Dashed => {
                let points: Vec<_> = points.iter().map(|&(x, y)| (fine(x), fine(y))).collect();
                area.draw(&DashedPathElement::new(points, fine(5.0), fine(3.0), style))
                    .expect(IN_MEMORY);
            }
        }
    }
}

impl Marker {
    pub(crate) fn draw(self, area: &Area<'_>, (x, y): (f64, f64), colour: Colour) {
        let filled = colour.filled(1.0);
        let circle = |radius: f64, style| {
            area.draw(&Circle::new((fine(x), fine(y)), fine(radius), style))
                .expect(IN_MEMORY);
        };
        let shape = |corners: &[(f64, f64)]| {
            let corners: Vec<_> = corners
                .iter()
                .map(|(a, b)| (x + a * DOT, y + b * DOT))
                .collect();
            canvas::polygon(area, &corners, filled);
        };
        match self {
            Self::None => {}
            Self::Dot => circle(DOT, filled),
            Self::Ring => circle(1.6 * DOT, colour.stroke(1.2, 1.0)),
            Self::Square => shape(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
            Self::Triangle => shape(&[(-1.1, 0.8), (1.1, 0.8), (0.0, -1.2)]),
            Self::Wedge => shape(&[(-1.1, -0.8), (1.1, -0.8), (0.0, 1.2)]),
            Self::Cross => {
                for (a, b) in [(1.0, 1.0), (1.0, -1.0)] {
                    let ends = [(x - a * DOT, y - b * DOT), (x + a * DOT, y + b * DOT)];
                    canvas::line(area, &ends, colour.stroke(1.4, 1.0));
                }
            }
            Self::Diamond => shape(&[(-1.2, 0.0), (0.0, -1.2), (1.2, 0.0), (0.0, 1.2)]),
        }
    }
}
