//! Whether a steady state is stable: the least eigenvalue of its stiffness against inertia.
//!
//! Arnoldi's method on the inverse of the stiffness finds the eigenvalues next to zero, on both sides of it.

use super::{NotSteady, SteadyReport, SteadySolver};
use crate::stability::seed;
use crate::system::System;
use nalgebra::{Complex, DMatrix, DVector};

/// Vectors of the Krylov space.
const VECTORS: usize = 30;
/// Residual, over the eigenvalue, at which one counts as found.
const FOUND: f64 = 0.1;
/// Length of a vector, over that before it was made orthogonal to the others, below which it lies among them.
const NOTHING_NEW: f64 = 1e-10;

/// How a steady state answers to a small disturbance, without damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stability {
    /// Least real part of an eigenvalue of stiffness over inertia \[1/s2\]: a squared angular frequency, or if negative a
    /// squared rate of growth. Flutter, which takes forces that have no potential, does not show in it.
    pub least: f64,
}

impl Stability {
    /// Whether disturbances stay small.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.least > 0.0
    }

    /// Time \[s\] within which a disturbance grows, or swings by a radian.
    pub(super) fn time(&self) -> f64 {
        self.least.abs().sqrt().recip()
    }
}

impl SteadySolver {
    /// The stability of the steady state of `system` that this solver has found.
    ///
    /// # Errors
    /// If the state is singular, as at a limit point.
    pub fn stability(&mut self, system: &mut System) -> Result<Stability, NotSteady> {
        let time = system.time;
        // laws had not remembered the state yet when it was sought
        system.swap_memory(&mut self.memory);
        let found = self.stability_of(system);
        system.swap_memory(&mut self.memory);
        found.map_err(|reason| NotSteady { time, reason })
    }

    /// The same with what laws remember now.
    pub(super) fn stability_of(&mut self, system: &mut System) -> Result<Stability, String> {
        self.factorise(system, &mut SteadyReport::default())?;
        system.evaluate();
        let mut inertia = vec![0.0; self.loads.len()];
        self.unknowns.read_inertia(&system.groups, &mut inertia);
        let (hessenberg, beyond) = self
            .arnoldi(&inertia)
            .ok_or("the tangent matrix is singular")?;
        Ok(Stability {
            least: least(&hessenberg, beyond),
        })
    }

    /// The inverse of the stiffness times inertia, projected on its Krylov space, and what of it leads out of that;
    /// nothing if the stiffness is singular. Vectors are orthogonal with respect to inertia.
    fn arnoldi(&self, inertia: &[f64]) -> Option<(DMatrix<f64>, f64)> {
        let inertia = DVector::from_column_slice(inertia);
        let dot = |a: &DVector<f64>, b: &DVector<f64>| a.component_mul(&inertia).dot(b);
        let mut first = DVector::from_vec(seed(inertia.len()));
        self.freedom.project(first.as_mut_slice());
        first /= dot(&first, &first).sqrt();
        let mut basis = vec![first];
        let mut h = DMatrix::zeros(VECTORS + 1, VECTORS);
        for j in 0..VECTORS {
            let mut next = -basis[j].component_mul(&inertia);
            self.freedom.project(next.as_mut_slice());
            if !self.tangent.solve(next.as_mut_slice()) {
                return None;
            }
            let whole = dot(&next, &next).sqrt();
            // twice, or rounding brings back what was taken off
            for _ in 0..2 {
                for (i, vector) in basis.iter().enumerate() {
                    let share = dot(vector, &next);
                    h[(i, j)] += share;
                    next.axpy(-share, vector, 1.0);
                }
            }
            let left = dot(&next, &next).sqrt();
            let last = j + 1 == VECTORS || left < NOTHING_NEW * whole;
            if last || !left.is_finite() {
                let square = h.view((0, 0), (j + 1, j + 1)).into_owned();
                return left.is_finite().then_some((square, left));
            }
            h[(j + 1, j)] = left;
            basis.push(next / left);
        }
        None
    }
}

/// Least real part of the inverse eigenvalues that the projection shows well.
fn least(h: &DMatrix<f64>, beyond: f64) -> f64 {
    let size = h.nrows();
    let complex = h.map(|x| Complex::new(x, 0.0));
    let found = |value: &&Complex<f64>| {
        // the eigenvector by inverse iteration, from a little beside the eigenvalue
        let beside = **value * (1.0 + 1e-10);
        let shifted = &complex - DMatrix::identity(size, size) * beside;
        let vector = shifted
            .lu()
            .solve(&DVector::repeat(size, Complex::new(1.0, 0.0)));
        let residual = vector.map_or(0.0, |v| beyond * v[size - 1].norm() / v.norm());
        residual < FOUND * value.norm()
    };
    let values = h.complex_eigenvalues();
    let inverses = values.iter().filter(found).map(|value| value.inv().re);
    inverses.fold(f64::INFINITY, f64::min)
}
