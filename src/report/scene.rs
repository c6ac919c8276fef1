//! Scenes in perspective: everything is a face or a stroke, drawn from far to near.

use crate::canvas::{self, Area, Hold, fine, size, write};
use crate::legend::{Entry, ROW, draw_legend};
use crate::palette::{BLACK, WHITE};
use crate::{Colour, Picture};
use nalgebra::{Point3, Vector3};

/// Sizes in points: text, titles, room for a title.
const TEXT: f64 = 11.0;
const TITLE: f64 = 13.0;
const ABOVE: f64 = 26.0;
/// Darkest shade of a face, and how much of white the farthest has.
const DARKEST: f64 = 0.45;
const HAZE: f64 = 0.3;
/// By how much a face is enlarged so that none of the background shows between neighbours, in points.
const OVERLAP: f64 = 0.35;

/// By how much strokes are taken for nearer than they are, so that faces that they lie on don't hide them \[m\].
const PROUD: f64 = 4e-3;

/// From where a scene is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// What is in the middle of the picture \[m\].
    pub target: Point3<f64>,
    /// Direction in which the camera stands from there, about z from x \[rad\].
    pub azimuth: f64,
    /// Its height above the target, as an angle \[rad\].
    pub elevation: f64,
    /// How far away it is \[m\].
    pub distance: f64,
    /// Height of the picture at the target \[m\].
    pub height: f64,
    /// What is up.
    pub up: Vector3<f64>,
}

/// A camera ready to look: its place, its axes (right, up, forward), and points per metre and distance.
struct Eye {
    place: Point3<f64>,
    axes: [Vector3<f64>; 3],
    scale: f64,
    middle: (f64, f64),
}

impl Camera {
    fn eye(&self, (width, height): (f64, f64)) -> Eye {
        let up = self.up.normalize();
        // azimuth counts from x where that isn't along the vertical
        let across = (Vector3::x() - up * up.x).normalize();
        let other = up.cross(&across);
        let level = across * self.azimuth.cos() + other * self.azimuth.sin();
        let out = level * self.elevation.cos() + up * self.elevation.sin();
        let right = up.cross(&out).normalize();
        Eye {
            place: self.target + out * self.distance,
            axes: [right, out.cross(&right), -out],
            scale: height / self.height * self.distance,
            middle: (width / 2.0, height / 2.0),
        }
    }
}

impl Eye {
    fn depth(&self, point: &Point3<f64>) -> f64 {
        (point - self.place).dot(&self.axes[2]).max(1e-6)
    }

    fn project(&self, point: &Point3<f64>) -> (f64, f64) {
        let away = point - self.place;
        let scale = self.scale / self.depth(point);
        (
            self.middle.0 + away.dot(&self.axes[0]) * scale,
            self.middle.1 - away.dot(&self.axes[1]) * scale,
        )
    }
}

/// A piece of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Piece {
    /// A flat face with an outward normal; seen from behind it is not drawn.
    Face {
        corners: Vec<Point3<f64>>,
        normal: Vector3<f64>,
        colour: Colour,
        opacity: f64,
    },
    /// A stroke of a width in points, with an arrow's head at its end if `head`.
    Stroke {
        points: Vec<Point3<f64>>,
        colour: Colour,
        opacity: f64,
        width: f64,
        head: bool,
    },
}

impl Piece {
    fn points(&self) -> &[Point3<f64>] {
        match self {
            Self::Face { corners, .. } => corners,
            Self::Stroke { points, .. } => points,
        }
    }

    fn depth(&self, eye: &Eye) -> f64 {
        let points = self.points();
        let nearer = match self {
            Self::Face { .. } => 0.0,
            Self::Stroke { .. } => PROUD,
        };
        points.iter().map(|point| eye.depth(point)).sum::<f64>() / points.len() as f64 - nearer
    }
}

/// Bodies to be drawn together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    pub(crate) pieces: Vec<Piece>,
}

/// A scene as one panel of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Its title.
    pub title: String,
    /// Lines of text below it.
    pub notes: Vec<String>,
    /// What is seen.
    pub scene: Scene,
    /// From where.
    pub camera: Camera,
}

/// Views in rows of so many, with one legend below, in a picture of a size in points.
#[must_use]
pub fn scenes(views: &[View], columns: usize, legend: &[Entry], size: (u32, u32)) -> Picture {
    Picture::draw(size, |area| {
        let rows = Entry::rows(area, legend);
        let (_, height) = canvas::size(area);
        let (above, below) = area.split_vertically(fine(height - ROW * rows as f64));
        let columns = columns.max(1);
        let places = above.split_evenly((views.len().div_ceil(columns), columns));
        for (place, view) in places.iter().zip(views) {
            view.draw(place);
        }
        draw_legend(&below, legend);
    })
}

impl View {
    fn draw(&self, area: &Area<'_>) {
        let (width, height) = size(area);
        let centre = Hold::Centre;
        write(
            area,
            &self.title,
            (width / 2.0, 0.55 * ABOVE),
            TITLE,
            centre,
            true,
            false,
        );
        let notes = 1.5 * TEXT * self.notes.len() as f64;
        let (_, rest) = area.split_vertically(fine(ABOVE));
        let (middle, below) = rest.split_vertically(fine(height - ABOVE - notes));
        self.scene.draw(&middle, &self.camera);
        for (i, note) in self.notes.iter().enumerate() {
            let y = 1.5 * TEXT * (i as f64 + 0.4);
            write(&below, note, (width / 2.0, y), TEXT, centre, false, false);
        }
    }
}

impl Scene {
    /// Draws from far to near.
    fn draw(&self, area: &Area<'_>, camera: &Camera) {
        let eye = camera.eye(size(area));
        let mut order: Vec<(f64, &Piece)> =
            (self.pieces.iter().map(|piece| (piece.depth(&eye), piece))).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (Some((far, _)), Some((near, _))) = (order.first(), order.last()) else {
            return;
        };
        let (far, near) = (*far, *near);
        for (depth, piece) in order {
            let haze = HAZE * (depth - near) / (far - near).max(1e-9);
            piece.draw(area, &eye, haze);
        }
    }
}

impl Piece {
    fn draw(&self, area: &Area<'_>, eye: &Eye, haze: f64) {
        let points: Vec<_> = self.points().iter().map(|p| eye.project(p)).collect();
        match self {
            Self::Face {
                corners,
                normal,
                colour,
                opacity,
            } => {
                let to_eye = (eye.place - corners[0]).normalize();
                let facing = normal.dot(&to_eye);
                if facing <= 0.0 {
                    return;
                }
                // from above the camera's left shoulder
                let light = (eye.axes[1] * 0.6 - eye.axes[0] * 0.5 - eye.axes[2]).normalize();
                let shade = DARKEST * (1.0 - normal.dot(&light).max(0.0));
                let colour = colour.mixed(BLACK, shade).mixed(WHITE, haze);
                let overlap = if *opacity < 1.0 { 0.0 } else { OVERLAP };
                canvas::polygon(area, &enlarged(&points, overlap), colour.filled(*opacity));
            }
            Self::Stroke {
                colour,
                opacity,
                width,
                head,
                ..
            } => {
                let style = colour.mixed(WHITE, 0.5 * haze).stroke(*width, *opacity);
                let [.., (x0, y0), (x1, y1)] = points[..] else {
                    return;
                };
                let length = (x1 - x0).hypot(y1 - y0);
                if !head || length < 1e-3 {
                    canvas::line(area, &points, style);
                    return;
                }
                let (ux, uy) = ((x1 - x0) / length, (y1 - y0) / length);
                let long = (5.0 * width).min(0.95 * length);
                let wide = 0.42 * long;
                let neck = (x1 - ux * long, y1 - uy * long);
                canvas::line(area, &[(x0, y0), neck], style);
                let corners = [
                    (x1, y1),
                    (neck.0 - uy * wide, neck.1 + ux * wide),
                    (neck.0 + uy * wide, neck.1 - ux * wide),
                ];
                canvas::polygon(area, &corners, style.filled());
            }
        }
    }
}

/// A convex polygon with its edges moved outwards.
fn enlarged(corners: &[(f64, f64)], by: f64) -> Vec<(f64, f64)> {
    let n = corners.len();
    let edge = |i: usize| {
        let ((x0, y0), (x1, y1)) = (corners[i % n], corners[(i + 1) % n]);
        (x1 - x0, y1 - y0, x0 * y1 - x1 * y0)
    };
    let side = (0..n).map(|i| edge(i).2).sum::<f64>().signum();
    let normal = |i: usize| {
        let (dx, dy, _) = edge(i);
        let length = dx.hypot(dy);
        (length > 1e-9).then(|| (side * dy / length, -side * dx / length))
    };
    let moved = |i: usize| {
        let (x, y) = corners[i];
        let (before, after) = (normal(i + n - 1), normal(i));
        let (Some(a), Some(b)) = (before.or(after), after.or(before)) else {
            return (x, y);
        };
        // no farther than three times as much at sharp corners
        let share = by / (1.0 + a.0 * b.0 + a.1 * b.1).max(0.5);
        (x + share * (a.0 + b.0), y + share * (a.1 + b.1))
    };
    (0..n).map(moved).collect()
}
