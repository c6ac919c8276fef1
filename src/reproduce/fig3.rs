//! Figure 3: characteristics of the five rods against the twist angle, as measured by Good et al. 2022, as simulated by
//! the paper's authors, and as simulated here.

use super::rods::{ROWS, rod};
use super::{Data, ReproduceError, Shown, Table, Tally, Ticker};
use crate::characterise::{Bench, Curves, Point, Quantity};
use crate::report::{Axis, Chart, Colour, Curve, Line, Marker, Picture, charts, palette};
use rayon::prelude::*;
use serde_json::json;
use std::ops::ControlFlow;
use std::path::Path;

/// Force \[N\] that spring constants are measured with, the authors'.
const PULL: f64 = 1.0;
/// The authors' simulated points, in the data.
const AUTHORS: &str =
    "reference_simulations/pyelastica/hsa_rod_characterisation_stored_pickles.csv";

/// A point that the authors simulated, SI units.
#[derive(Clone, Copy)]
struct Stored {
    rows: u32,
    quantity: Quantity,
    angle: f64,
    value: f64,
}

/// One of the twenty curves. Simulated values are missing where there is no steady state.
struct Characteristic {
    rows: u32,
    quantity: Quantity,
    measured: Vec<(Point, Option<f64>)>,
    stored: Vec<(Stored, Option<f64>)>,
}

pub(super) fn reproduce(data: &Data, ticker: Ticker<'_>) -> Result<Shown, ReproduceError> {
    let (stored, absent) = match data.find(AUTHORS) {
        Ok(path) => (read(&path)?, None),
        Err(missing) => (Vec::new(), Some(missing.to_string())),
    };
    let tally = Tally::new(ROWS.len() as f64, ticker);
    let curves: Result<Vec<Vec<Characteristic>>, ReproduceError> = (ROWS.par_iter())
        .map(|&rows| {
            let of_rod: Vec<Stored> = (stored.iter().copied())
                .filter(|point| point.rows == rows)
                .collect();
            let curves = characteristics(rows, &of_rod)?;
            tally.add(1.0)?;
            Ok(curves)
        })
        .collect();
    let curves: Vec<Characteristic> = curves?.into_iter().flatten().collect();
    let mut notes = notes(&curves);
    notes
        .extend(absent.map(|missing| format!("Without the authors' simulated points: {missing}.")));
    Ok(Shown {
        title: "Figure 3: characteristics of the five rods against the twist angle",
        tables: vec![table(&curves)],
        notes,
        json: curves.iter().map(Characteristic::json).collect(),
        pictures: vec![("fig3".into(), picture(&curves))],
    })
}

/// The four curves of a rod.
fn characteristics(rows: u32, stored: &[Stored]) -> Result<Vec<Characteristic>, ReproduceError> {
    let measured = Curves::good2022(rows).expect("all five rods were measured");
    let angles = measured.points.iter().map(|point| point.angle);
    let angles: Vec<f64> = angles
        .chain(stored.iter().map(|point| point.angle))
        .collect();
    let bench = Bench::new(&rod(rows)?, None, PULL)?;
    let simulated = bench.characterise(&angles, &mut |_| ControlFlow::Continue(()))?;
    // in the order of `angles`: the measured points, then the stored ones
    let value = |i: usize, quantity| simulated[i].get(quantity).ok();
    let first_stored = measured.points.len();
    let of = |quantity| Characteristic {
        rows,
        quantity,
        measured: (measured.points.iter().enumerate())
            .filter(|(_, point)| point.quantity == quantity)
            .map(|(i, point)| (*point, value(i, quantity)))
            .collect(),
        stored: (stored.iter().enumerate())
            .filter(|(_, point)| point.quantity == quantity)
            .map(|(i, point)| (*point, value(first_stored + i, quantity)))
            .collect(),
    };
    Ok(Quantity::ALL.map(of).into())
}

/// Reads the authors' points.
fn read(path: &Path) -> Result<Vec<Stored>, ReproduceError> {
    #[derive(serde::Deserialize)]
    struct Line {
        rod: String,
        twist_angle_rad: f64,
        quantity: String,
        value: f64,
    }
    let damaged = |reason: String| ReproduceError::Damaged {
        path: path.into(),
        reason,
    };
    let mut reader = csv::Reader::from_path(path).map_err(|e| damaged(e.to_string()))?;
    let points = reader.deserialize::<Line>().map(|line| {
        let line = line.map_err(|e| damaged(e.to_string()))?;
        let rows = ROWS
            .into_iter()
            .find(|rows| line.rod.ends_with(&format!("_{rows}ROWS")));
        let quantity = Quantity::ALL
            .into_iter()
            .find(|q| q.name() == line.quantity);
        let (Some(rows), Some(quantity)) = (rows, quantity) else {
            return Err(damaged(format!(
                "nothing is known of {} of {}",
                line.quantity, line.rod
            )));
        };
        if !(line.twist_angle_rad.is_finite() && line.value.is_finite()) {
            return Err(damaged("it holds a number that is not finite".into()));
        }
        Ok(Stored {
            rows,
            quantity,
            angle: line.twist_angle_rad,
            value: line.value,
        })
    });
    points.collect()
}

impl Characteristic {
    /// In the unit of tables.
    fn shown(&self, si: f64) -> f64 {
        si / self.quantity.in_si()
    }

    /// Simulated points inside the error bars.
    fn inside(&self) -> usize {
        let inside = |(point, value): &&(Point, Option<f64>)| value.is_some_and(|v| point.holds(v));
        self.measured.iter().filter(inside).count()
    }

    /// The authors' simulated points inside the error bars of the measured point nearby.
    fn authors_inside(&self) -> usize {
        let pairs = self.measured.iter().zip(&self.stored);
        pairs
            .filter(|((point, _), (stored, _))| point.holds(stored.value))
            .count()
    }

    /// Largest difference from the authors' points, as a share of the curve's largest value.
    fn largest_difference(&self) -> Option<f64> {
        let most = self
            .stored
            .iter()
            .fold(0.0_f64, |most, (s, _)| most.max(s.value.abs()));
        let differences = self.stored.iter().map(|(stored, value)| {
            let difference = (value.unwrap_or(f64::NAN) - stored.value).abs();
            // a force or torque without twist is nothing: compared with the curve as a whole
            if stored.value.abs() > 1e-6 * most {
                difference / stored.value.abs()
            } else {
                difference / most
            }
        });
        differences.reduce(f64::max)
    }

    fn json(&self) -> serde_json::Value {
        let measured = self.measured.iter().map(|(point, value)| {
            json!({
                "twist_angle_deg": point.angle.to_degrees(),
                "measured": self.shown(point.value),
                "error_minus": self.shown(point.error_minus),
                "error_plus": self.shown(point.error_plus),
                "simulated": value.map(|v| self.shown(v)),
                "inside": value.map(|v| point.holds(v)),
            })
        });
        let stored = self.stored.iter().map(|(stored, value)| {
            json!({
                "twist_angle_deg": stored.angle.to_degrees(),
                "authors": self.shown(stored.value),
                "simulated": value.map(|v| self.shown(v)),
            })
        });
        json!({
            "rows": self.rows,
            "quantity": self.quantity.name(),
            "unit": self.quantity.unit(),
            "points": measured.collect::<Vec<_>>(),
            "authors": stored.collect::<Vec<_>>(),
            "inside": self.inside(),
            "largest_relative_difference": self.largest_difference(),
        })
    }
}

fn table(curves: &[Characteristic]) -> Table {
    let row = |curve: &Characteristic| {
        let authors = curve.stored.len();
        vec![
            curve.quantity.to_string(),
            curve.rows.to_string(),
            curve.measured.len().to_string(),
            curve.inside().to_string(),
            if authors > 0 {
                curve.authors_inside().to_string()
            } else {
                "-".into()
            },
            (curve.largest_difference()).map_or("-".into(), |d| format!("{:.3} %", 1e2 * d)),
        ]
    };
    let mut order: Vec<&Characteristic> = curves.iter().collect();
    order.sort_by_key(|curve| (curve.quantity, curve.rows));
    Table {
        caption: "Simulated values within the measured error bars (Good et al. 2022, Fig. 4), and how far Auxetica is \
                  from the authors' simulated points at most"
            .into(),
        header: ["quantity", "rows", "measured", "Auxetica within", "authors within", "off the authors'"]
            .map(String::from)
            .into(),
        rows: order.into_iter().map(row).collect(),
    }
}

fn notes(curves: &[Characteristic]) -> Vec<String> {
    let mut notes = Vec::new();
    for quantity in Quantity::ALL {
        let of: Vec<_> = curves.iter().filter(|c| c.quantity == quantity).collect();
        let sum =
            |count: &dyn Fn(&Characteristic) -> usize| of.iter().map(|c| count(c)).sum::<usize>();
        let above = sum(&|c| {
            let above =
                |(p, v): &&(Point, Option<f64>)| v.is_some_and(|v| v > p.value + p.error_plus);
            c.measured.iter().filter(above).count()
        });
        let (all, inside) = (sum(&|c| c.measured.len()), sum(&Characteristic::inside));
        notes.push(format!(
            "{quantity}: {inside} of {all} within the error bars, {above} above them{}.",
            if quantity == Quantity::BlockedForce {
                ": overestimated, as the paper says of its own"
            } else {
                ""
            }
        ));
    }
    notes.push(
        "Steady states with `averaging: Reference`, by which Table I was tuned. The authors' points are the last state \
         of runs of 10 to 20 s, which had not quite settled."
            .into(),
    );
    notes
}

fn picture(curves: &[Characteristic]) -> Picture {
    const COLOURS: [Colour; 5] = [
        palette::BLACK,
        palette::BLUE,
        palette::VERMILION,
        palette::GREEN,
        palette::PURPLE,
    ];
    let panel = |quantity: Quantity| {
        let of = |rows: u32| {
            curves
                .iter()
                .find(|c| c.quantity == quantity && c.rows == rows)
        };
        let mut drawn = Vec::new();
        for (rows, colour) in ROWS.into_iter().zip(COLOURS) {
            let Some(curve) = of(rows) else { continue };
            let at = |angle: f64, value: f64| (angle.to_degrees(), curve.shown(value));
            drawn.push(Curve {
                errors: (curve.measured.iter())
                    .map(|(p, _)| (curve.shown(p.error_minus), curve.shown(p.error_plus)))
                    .collect(),
                ..Curve::new(
                    &format!("{rows} rows, measured"),
                    colour,
                    curve
                        .measured
                        .iter()
                        .map(|(p, _)| at(p.angle, p.value))
                        .collect(),
                )
            });
            drawn.push(Curve {
                line: Line::Dashed,
                marker: Marker::None,
                ..Curve::new(
                    &format!("{rows} rows, Auxetica"),
                    colour,
                    (curve.measured.iter())
                        .filter_map(|(p, value)| Some(at(p.angle, (*value)?)))
                        .collect(),
                )
            });
        }
        for (rows, colour) in ROWS.into_iter().zip(COLOURS) {
            let Some(curve) = of(rows) else { continue };
            drawn.push(Curve {
                line: Line::None,
                marker: Marker::Ring,
                ..Curve::new(
                    "authors' simulation (ring, same colour)",
                    colour,
                    curve
                        .stored
                        .iter()
                        .map(|(s, _)| at_degrees(s, curve))
                        .collect(),
                )
            });
        }
        drawn.retain(|curve| !curve.points.is_empty());
        Chart {
            title: capitalised(&quantity.to_string()),
            x: Axis::new("twist angle [deg]").over(-8.0..188.0),
            y: Axis::new(&format!("{quantity} [{}]", quantity.unit())),
            curves: drawn,
        }
    };
    use Quantity::{BlockedForce, HoldingTorque, MinimumEnergyLength, SpringConstant};
    let order = [
        BlockedForce,
        MinimumEnergyLength,
        HoldingTorque,
        SpringConstant,
    ];
    charts(&order.map(panel), 2, (1100, 860))
}

fn at_degrees(stored: &Stored, curve: &Characteristic) -> (f64, f64) {
    (stored.angle.to_degrees(), curve.shown(stored.value))
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| {
        first.to_uppercase().chain(letters).collect()
    })
}
