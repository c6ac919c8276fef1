//! Forward kinematics of a rod of segments of constant strain.

use nalgebra::{Isometry3, Matrix6xX, RealField, UnitQuaternion, Vector3, Vector6, convert};
use rayon::prelude::*;

use crate::StrainSelector;
use crate::exponential::{exponential, exponential_and_derivatives};

/// A rod of segments of constant strain (eq. 8-13).
///
/// Configurations are slices `q = (phi0, q_cs, q_1, q_2, ...)` of length [`dof`](Self::dof).
/// `f64` is the precision to work in; `f32` is that of the paper's results.
#[derive(Debug, Clone, PartialEq)]
pub struct Spcs<T: RealField + Copy = f64> {
    selector: StrainSelector,
    /// Unstretched lengths of the segments (m).
    lengths: Vec<T>,
    /// Where in the configuration each segment's strains are.
    columns: Vec<[Option<usize>; 6]>,
}

impl<T: RealField + Copy> Spcs<T> {
    /// A rod of segments of these unstretched lengths (m), from the base on.
    ///
    /// # Panics
    /// When there is no segment, or one's length is not positive.
    #[must_use]
    pub fn new(selector: StrainSelector, lengths: &[T]) -> Self {
        assert!(
            !lengths.is_empty() && lengths.iter().all(|&length| length > T::zero()),
            "a rod needs segments, and they need length: {lengths:?}"
        );
        Self {
            selector,
            lengths: lengths.into(),
            columns: (0..lengths.len()).map(|i| selector.columns(i)).collect(),
        }
    }

    /// A rod of unstretched length `length` (m) in equal segments.
    ///
    /// # Panics
    /// When there is no segment or no length.
    #[must_use]
    pub fn uniform(selector: StrainSelector, length: T, segments: usize) -> Self {
        let each = length / convert(segments as f64);
        Self::new(selector, &vec![each; segments])
    }

    /// Which strains vary.
    #[must_use]
    pub fn selector(&self) -> StrainSelector {
        self.selector
    }

    /// Unstretched lengths of the segments (m).
    #[must_use]
    pub fn lengths(&self) -> &[T] {
        &self.lengths
    }

    /// Length of a configuration.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.selector.dof(self.lengths.len())
    }

    /// Strains `(kx, ky, kz, sx, sy, sz)` of a segment (eq. 10), in rad/m and unitless.
    ///
    /// # Panics
    /// When the configuration's length is wrong or there is no such segment.
    #[must_use]
    pub fn strains(&self, q: &[T], segment: usize) -> Vector6<T> {
        self.check(q);
        let mut strains = Vector6::zeros();
        strains[5] = T::one();
        for (strain, column) in strains.iter_mut().zip(self.columns[segment]) {
            if let Some(column) = column {
                *strain += q[column];
            }
        }
        strains
    }

    /// Pose at arc length `s` (m, of the unstretched rod) in the base frame (eq. 13). Before the
    /// base it is that of the base, past the tip that of the tip.
    ///
    /// # Panics
    /// When the configuration's length is wrong.
    #[must_use]
    pub fn pose(&self, q: &[T], s: T) -> Isometry3<T> {
        let mut pose = self.base(q);
        for (segment, length) in self.pieces(s) {
            let (theta, rho) = self.piece(q, segment, length);
            pose *= exponential(&theta, &rho);
        }
        pose
    }

    /// [`pose`](Self::pose) and its Jacobian.
    ///
    /// The Jacobian has a column for each entry of `q`: rows 0 to 2 are the frame's angular
    /// velocity in the base frame (rad), rows 3 to 5 the velocity of the point (m), per unit of
    /// the entry.
    ///
    /// # Panics
    /// When the configuration's length is wrong.
    #[must_use]
    pub fn pose_and_jacobian(&self, q: &[T], s: T) -> (Isometry3<T>, Matrix6xX<T>) {
        let mut jacobian = Matrix6xX::zeros(self.dof());
        let pose = self.pose_and_jacobian_into(q, s, &mut jacobian);
        (pose, jacobian)
    }

    /// [`pose_and_jacobian`](Self::pose_and_jacobian) into a matrix that is there already.
    ///
    /// # Panics
    /// When the length of the configuration or the number of columns is wrong.
    pub fn pose_and_jacobian_into(
        &self,
        q: &[T],
        s: T,
        jacobian: &mut Matrix6xX<T>,
    ) -> Isometry3<T> {
        assert_eq!(jacobian.ncols(), self.dof(), "columns of the Jacobian");
        jacobian.fill(T::zero());
        let mut pose = self.base(q);
        jacobian[(2, 0)] = T::one();
        // Each column is the angular velocity and the velocity of the body at the origin first:
        // those of a strain that several segments share add up.
        for (segment, length) in self.pieces(s) {
            let (theta, rho) = self.piece(q, segment, length);
            let (piece, derivatives) = exponential_and_derivatives(&theta, &rho);
            let turn = *pose.rotation.to_rotation_matrix().matrix() * length;
            pose *= piece;
            let left = turn * derivatives.left;
            let bend = turn * derivatives.bend;
            for (strain, column) in self.columns[segment].iter().enumerate() {
                let Some(column) = *column else { continue };
                let mut twist = jacobian.fixed_view_mut::<6, 1>(0, column);
                if strain < 3 {
                    let angular = left.column(strain);
                    let at_origin = bend.column(strain) + pose.translation.vector.cross(&angular);
                    let mut rows = twist.fixed_rows_mut::<3>(0);
                    rows += angular;
                    let mut rows = twist.fixed_rows_mut::<3>(3);
                    rows += at_origin;
                } else {
                    let mut rows = twist.fixed_rows_mut::<3>(3);
                    rows += left.column(strain - 3);
                }
            }
        }
        for mut twist in jacobian.column_iter_mut() {
            let carried = twist.fixed_rows::<3>(0).cross(&pose.translation.vector);
            let mut velocity = twist.fixed_rows_mut::<3>(3);
            velocity += carried;
        }
        pose
    }

    /// Poses of many configurations, each at all arc lengths (m), computed in parallel.
    ///
    /// # Panics
    /// When a configuration's length is wrong.
    #[must_use]
    pub fn poses<Q: AsRef<[T]> + Sync>(
        &self,
        configurations: &[Q],
        arc_lengths: &[T],
    ) -> Vec<Vec<Isometry3<T>>> {
        configurations
            .par_iter()
            .map(|q| {
                (arc_lengths.iter())
                    .map(|&s| self.pose(q.as_ref(), s))
                    .collect()
            })
            .collect()
    }

    /// [`pose_and_jacobian`](Self::pose_and_jacobian) of many configurations, each at all arc
    /// lengths (m), computed in parallel.
    ///
    /// # Panics
    /// When a configuration's length is wrong.
    #[must_use]
    pub fn poses_and_jacobians<Q: AsRef<[T]> + Sync>(
        &self,
        configurations: &[Q],
        arc_lengths: &[T],
    ) -> Vec<Vec<(Isometry3<T>, Matrix6xX<T>)>> {
        configurations
            .par_iter()
            .map(|q| {
                let at = |&s| self.pose_and_jacobian(q.as_ref(), s);
                arc_lengths.iter().map(at).collect()
            })
            .collect()
    }

    /// Where each segment's strains are in the configuration.
    pub(crate) fn columns(&self) -> &[[Option<usize>; 6]] {
        &self.columns
    }

    fn check(&self, q: &[T]) {
        assert_eq!(q.len(), self.dof(), "length of the configuration");
    }

    /// The rod's beginning, turned by `phi0`.
    fn base(&self, q: &[T]) -> Isometry3<T> {
        self.check(q);
        Isometry3::from_parts(
            Vector3::zeros().into(),
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), q[0]),
        )
    }

    /// The segments before `s` and how much of each is.
    fn pieces(&self, s: T) -> impl Iterator<Item = (usize, T)> {
        let mut left = s;
        (self.lengths.iter().enumerate()).map_while(move |(segment, &length)| {
            let piece = length.min(left);
            left -= length;
            (piece > T::zero()).then_some((segment, piece))
        })
    }

    /// Rotation vector (rad) and linear strain times length (m) of a piece of a segment.
    fn piece(&self, q: &[T], segment: usize, length: T) -> (Vector3<T>, Vector3<T>) {
        let strains = self.strains(q, segment) * length;
        (
            strains.fixed_rows::<3>(0).into(),
            strains.fixed_rows::<3>(3).into(),
        )
    }
}
