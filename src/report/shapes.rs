//! Bodies that scenes are made of.

use crate::palette::AXES;
use crate::scene::Piece;
use crate::{Colour, Pose, Scene};
use nalgebra::{Point3, Vector3};
use std::f64::consts::TAU;

/// Pieces of a disc: around, and from its middle to its rim.
const AROUND_DISC: usize = 36;
const RINGS: usize = 4;
/// Where an arrow is cut, so that bodies may hide a part of it; its head is in the last piece.
const CUTS: [f64; 5] = [0.0, 0.2, 0.4, 0.6, 1.0];

/// Stripes along a tube, fixed to its material, so that they show its twist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stripes {
    /// Colour of the tube.
    pub ground: Colour,
    /// Colour of the stripes.
    pub stripe: Colour,
    /// Their number.
    pub count: usize,
}

/// Facets between the middles of two neighbouring stripes.
const FACETS: usize = 4;

impl Scene {
    /// Adds the bodies of another scene.
    pub fn extend(&mut self, other: Self) {
        self.pieces.extend(other.pieces);
    }

    /// A tube through cross-sections: the frames' origins are their middles, their z the tube's.
    pub fn tube(&mut self, sections: &[Pose], radius: f64, stripes: Stripes, opacity: f64) {
        let facets = FACETS * stripes.count.max(2);
        let around = |i: usize| {
            let angle = TAU * i as f64 / facets as f64;
            Vector3::new(angle.cos(), angle.sin(), 0.0)
        };
        for pair in sections.windows(2) {
            for i in 0..facets {
                let corners = vec![
                    pair[0] * Point3::from(around(i) * radius),
                    pair[0] * Point3::from(around(i + 1) * radius),
                    pair[1] * Point3::from(around(i + 1) * radius),
                    pair[1] * Point3::from(around(i) * radius),
                ];
                let mut normal = (corners[2] - corners[0]).cross(&(corners[3] - corners[1]));
                // with the outside, whichever way the sections go
                if normal.dot(&(pair[0] * (around(i) + around(i + 1)))) < 0.0 {
                    normal = -normal;
                }
                let colour = if i % FACETS == 0 {
                    stripes.stripe
                } else {
                    stripes.ground
                };
                self.face(corners, normal, colour, opacity);
            }
        }
    }

    /// The ends of a tube.
    pub fn ends(&mut self, sections: &[Pose], radius: f64, colour: Colour, opacity: f64) {
        let (Some(first), Some(last)) = (sections.first(), sections.last()) else {
            return;
        };
        for (end, way) in [(first, -1.0), (last, 1.0)] {
            let corner = |i: usize| {
                let angle = TAU * i as f64 / AROUND_DISC as f64;
                end * Point3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
            };
            let corners = (0..AROUND_DISC).map(corner).collect();
            self.face(corners, end * (Vector3::z() * way), colour, opacity);
        }
    }

    /// A disc about the frame's z, its middle at the origin.
    pub fn disc(&mut self, pose: &Pose, radius: f64, thickness: f64, colour: Colour) {
        let around = |i: usize, z: f64, share: f64| {
            let angle = TAU * i as f64 / AROUND_DISC as f64;
            pose * Point3::new(
                share * radius * angle.cos(),
                share * radius * angle.sin(),
                z,
            )
        };
        let half = thickness / 2.0;
        for i in 0..AROUND_DISC {
            // in small pieces, so that what is near one of them is rightly before or behind it
            for ring in 0..RINGS {
                let [inner, outer] = [ring, ring + 1].map(|r| r as f64 / RINGS as f64);
                for (z, way) in [(half, 1.0), (-half, -1.0)] {
                    let corners = vec![
                        around(i, z, inner),
                        around(i, z, outer),
                        around(i + 1, z, outer),
                        around(i + 1, z, inner),
                    ];
                    self.face(corners, pose * (Vector3::z() * way), colour, 1.0);
                }
            }
            let corners = vec![
                around(i, -half, 1.0),
                around(i + 1, -half, 1.0),
                around(i + 1, half, 1.0),
                around(i, half, 1.0),
            ];
            let angle = TAU * (i as f64 + 0.5) / AROUND_DISC as f64;
            let normal = pose * Vector3::new(angle.cos(), angle.sin(), 0.0);
            self.face(corners, normal, colour, 1.0);
        }
    }

    /// Arrows along the first `axes` of a frame's x, y and z: red, green, blue.
    pub fn frame(&mut self, pose: &Pose, length: f64, axes: usize, width: f64, opacity: f64) {
        let ways = [Vector3::x(), Vector3::y(), Vector3::z()];
        for (way, colour) in ways.into_iter().zip(AXES).take(axes) {
            let at = |share: f64| pose * Point3::from(way * (length * share));
            for (piece, cut) in CUTS.windows(2).enumerate() {
                self.pieces.push(Piece::Stroke {
                    points: vec![at(cut[0]), at(cut[1])],
                    colour,
                    opacity,
                    width,
                    head: piece + 2 == CUTS.len(),
                });
            }
        }
    }

    /// A line through points.
    pub fn line(&mut self, points: &[Point3<f64>], colour: Colour, width: f64, opacity: f64) {
        for pair in points.windows(2) {
            self.pieces.push(Piece::Stroke {
                points: pair.to_vec(),
                colour,
                opacity,
                width,
                head: false,
            });
        }
    }

    fn face(
        &mut self,
        corners: Vec<Point3<f64>>,
        normal: Vector3<f64>,
        colour: Colour,
        opacity: f64,
    ) {
        if let Some(normal) = normal.try_normalize(1e-15) {
            self.pieces.push(Piece::Face {
                corners,
                normal,
                colour,
                opacity,
            });
        }
    }
}
