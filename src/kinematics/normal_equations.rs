//! The cost of a fit and its Gauss-Newton equations.

use nalgebra::{DMatrix, DVector, Matrix6xX};

use crate::{Observed, Spcs, Weights};

/// Cost, its gradient and Gauss-Newton's approximation of its curvature at a configuration.
#[derive(Debug, Clone)]
pub struct NormalEquations {
    pub cost: f64,
    pub gradient: DVector<f64>,
    pub curvature: DMatrix<f64>,
}

impl NormalEquations {
    pub fn new(dof: usize) -> Self {
        Self {
            cost: 0.0,
            gradient: DVector::zeros(dof),
            curvature: DMatrix::zeros(dof, dof),
        }
    }

    /// Sets them at `q`; `jacobian` is room to work in.
    pub fn evaluate(
        &mut self,
        rod: &Spcs,
        observed: &Observed<'_>,
        weights: &Weights,
        q: &[f64],
        jacobian: &mut Matrix6xX<f64>,
    ) {
        self.cost = 0.0;
        self.gradient.fill(0.0);
        self.curvature.fill(0.0);
        for (s, measured) in observed.points() {
            let pose = rod.pose_and_jacobian_into(q, s, jacobian);
            let modelled = pose.rotation.into_inner();
            let mut seen = measured.rotation.into_inner();
            if seen.dot(&modelled) < 0.0 {
                seen = -seen;
            }
            let offset = (measured.translation.vector - pose.translation.vector) * weights.position;
            let turn = (seen - modelled).norm() * weights.quaternion;
            self.cost += 0.5 * (offset.norm_squared() + turn * turn);

            // A turn by w moves the quaternion Q by (0, w/2) Q. Seen from Q that is w/2, and the
            // difference of quaternions the vector part of Q_seen Q^-1.
            let relative = (seen * modelled.conjugate()).imag() * weights.quaternion;
            let mut rows = jacobian.fixed_rows_mut::<3>(0);
            rows *= 0.5 * weights.quaternion;
            let mut rows = jacobian.fixed_rows_mut::<3>(3);
            rows *= weights.position;
            for i in 0..jacobian.ncols() {
                let column = jacobian.fixed_view::<6, 1>(0, i);
                self.gradient[i] -= column.fixed_rows::<3>(0).dot(&relative)
                    + column.fixed_rows::<3>(3).dot(&offset);
                for j in 0..=i {
                    self.curvature[(i, j)] += column.dot(&jacobian.fixed_view::<6, 1>(0, j));
                }
            }
        }
        self.curvature.fill_upper_triangle_with_lower_triangle();
    }
}
