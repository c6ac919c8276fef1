//! Measured points beside simulated ones.

use super::{Characteristics, Curves, Point, Quantity};

/// Measured points and what was simulated there.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Where the measurements come from.
    pub origin: String,
    /// Every measured point, in its order.
    pub points: Vec<Beside>,
    /// Quantity by quantity, those that were measured.
    pub mismatches: Vec<Mismatch>,
}

/// A measured point and what was simulated there.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// The measurement.
    pub measured: Point,
    /// One standard deviation that the measurement is weighted with, SI units; see [`Comparison::new`].
    pub deviation: f64,
    /// The simulated value, SI units; or why there is none.
    pub simulated: Result<f64, String>,
}

/// How far a quantity is off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mismatch {
    /// The quantity.
    pub quantity: Quantity,
    /// Points that were simulated.
    pub points: usize,
    /// Points that were measured and have no steady state.
    pub unsolved: usize,
    /// Points inside their error bar.
    pub inside: usize,
    /// Root of the mean square of the differences, SI units.
    pub rms: f64,
    /// Sum of the squares of the differences in units of their deviations.
    pub chi2: f64,
}

/// Least deviation, as a share of the largest value of the same quantity: no instrument has an error of none.
pub const LEAST_DEVIATION: f64 = 1e-3;

impl Beside {
    /// Simulated less measured in units of the deviation, or why there is none.
    pub fn residual(&self) -> Result<f64, &str> {
        let simulated = self.simulated.as_ref().map_err(String::as_str)?;
        Ok((simulated - self.measured.value) / self.deviation)
    }

    /// Whether the simulated value lies inside the error bar.
    pub fn inside(&self) -> bool {
        self.simulated
            .as_ref()
            .is_ok_and(|value| self.measured.holds(*value))
    }
}

impl Mismatch {
    /// Root of the mean square of the differences, in units of the error bars.
    pub fn rms_in_bars(&self) -> f64 {
        (self.chi2 / self.points as f64).sqrt()
    }
}

impl Comparison {
    /// Puts measured points beside what was simulated at their angles. One standard deviation of a measurement is the
    /// mean of both halves of its error bar, but not less than [`LEAST_DEVIATION`] of the quantity's largest value.
    ///
    /// # Panics
    /// If `simulated` lacks the angle of a measured point.
    pub fn new(curves: &Curves, simulated: &[Characteristics]) -> Self {
        let largest = |quantity| {
            let of_quantity = curves.points.iter().filter(|p| p.quantity == quantity);
            of_quantity.fold(0.0_f64, |most, p| most.max(p.value.abs()))
        };
        let largest = Quantity::ALL.map(largest);
        let points: Vec<_> = (curves.points.iter())
            .map(|point| {
                let least = LEAST_DEVIATION * largest[point.quantity as usize];
                let here = simulated
                    .iter()
                    .find(|s| (s.angle - point.angle).abs() < 1e-9);
                let here = here.expect("every measured angle was simulated");
                Beside {
                    measured: *point,
                    deviation: point.deviation().max(least),
                    simulated: here.get(point.quantity).map_err(str::to_owned),
                }
            })
            .collect();
        let mismatches = Quantity::ALL
            .into_iter()
            .filter_map(|q| Mismatch::of(q, &points))
            .collect();
        Self {
            origin: curves.origin.clone(),
            points,
            mismatches,
        }
    }

    /// Sum over all quantities of the squares of the differences in units of their deviations.
    pub fn chi2(&self) -> f64 {
        self.mismatches.iter().map(|mismatch| mismatch.chi2).sum()
    }
}

impl Mismatch {
    fn of(quantity: Quantity, points: &[Beside]) -> Option<Self> {
        let of_quantity: Vec<_> = points
            .iter()
            .filter(|p| p.measured.quantity == quantity)
            .collect();
        let solved: Vec<_> = of_quantity.iter().filter(|p| p.simulated.is_ok()).collect();
        let sum = |of: &dyn Fn(&Beside) -> f64| solved.iter().map(|p| of(p)).sum::<f64>();
        let square = |p: &Beside| p.residual().map_or(0.0, |r| r * r);
        let n = solved.len();
        (!of_quantity.is_empty()).then(|| Self {
            quantity,
            points: n,
            unsolved: of_quantity.len() - n,
            inside: solved.iter().filter(|p| p.inside()).count(),
            rms: (sum(&|p| square(p) * p.deviation.powi(2)) / n as f64).sqrt(),
            chi2: sum(&square),
        })
    }
}
