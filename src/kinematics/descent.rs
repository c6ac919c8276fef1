//! The paper's own inverse kinematics, repeated as its authors ran it.

use nalgebra::{Isometry3, Matrix6xX, Vector3, Vector4};

use crate::{Observed, Spcs};

/// The descent of eq. 14, `q += Gamma J^T e`, a fixed number of times in single precision.
///
/// For the paper's numbers only: it needs thousands of steps, stops before the optimum and tends
/// to a point that is not quite the optimum of its cost, as [`LeastSquares`](crate::LeastSquares)
/// finds it. Two habits of the authors make the difference. Their quaternions are
/// `sign(x) sqrt(x^2 + 5 e)`, `e` the machine's epsilon; and the Jacobian is taken with a
/// thousand times that epsilon, of which it is also ahead in every entry of `q`. This weakens
/// its rows of small rotations.
#[derive(Debug, Clone)]
pub struct Descent {
    rod: Spcs<f32>,
    /// Step size of each entry of the configuration.
    gains: Vec<f32>,
}

/// Steps a sample.
const STEPS: usize = 5000;
/// Added to the squares of a quaternion's entries.
const SOFTENING: f32 = 5.0 * f32::EPSILON;
/// How much larger epsilon is in the Jacobian.
const COARSER: f32 = 1e3;

impl Descent {
    /// The paper's: gains of 2, 10 on the twist, none on the base's angle.
    #[must_use]
    pub fn new(rod: &Spcs) -> Self {
        let lengths: Vec<f32> = rod.lengths().iter().map(|&length| length as f32).collect();
        let rod = Spcs::new(rod.selector(), &lengths);
        let mut gains = vec![2.0; rod.dof()];
        gains[0] = 0.0;
        for twist in rod.columns().iter().filter_map(|columns| columns[2]) {
            gains[twist] = 10.0;
        }
        Self { rod, gains }
    }

    /// Configurations of samples one after the other, each from the one before, the first from
    /// the straight unstretched rod.
    ///
    /// A base's angle that is not known stays as it was before.
    #[must_use]
    pub fn fit_sequence(&self, samples: &[Observed<'_>]) -> Vec<Vec<f64>> {
        let mut q = vec![0.0; self.rod.dof()];
        let mut jacobian = Matrix6xX::zeros(self.rod.dof());
        samples
            .iter()
            .map(|sample| {
                if let Some(angle) = sample.base_angle {
                    q[0] = angle as f32;
                }
                let points: Vec<(f32, Isometry3<f32>)> = (sample.points())
                    .map(|(s, pose)| (s as f32, pose.cast()))
                    .collect();
                for _ in 0..STEPS {
                    self.step(&mut q, &points, &mut jacobian);
                }
                q.iter().map(|&entry| f64::from(entry)).collect()
            })
            .collect()
    }

    fn step(&self, q: &mut [f32], points: &[(f32, Isometry3<f32>)], jacobian: &mut Matrix6xX<f32>) {
        let ahead: Vec<f32> = (q.iter())
            .map(|&entry| {
                let sign = if entry + f32::EPSILON > 0.0 {
                    1.0
                } else {
                    -1.0
                };
                entry + sign * COARSER * f32::EPSILON
            })
            .collect();
        let mut descent = vec![0.0; q.len()];
        for (s, measured) in points {
            let pose = self.rod.pose(q, *s);
            let offset = measured.translation.vector - pose.translation.vector;
            let turn = softened(measured) - softened(&pose);

            let pose = self.rod.pose_and_jacobian_into(&ahead, *s, jacobian);
            let exact = quaternion(&pose);
            let soft = exact.map(|x| (x * x + COARSER * SOFTENING).sqrt());
            let turn = turn.component_mul(&exact.abs().component_div(&soft));
            for (column, sum) in jacobian.column_iter().zip(&mut descent) {
                let turning: Vector3<f32> = column.fixed_rows::<3>(0).into();
                let moving = column.fixed_rows::<3>(3);
                *sum += quaternion_rate(&exact, &turning).dot(&turn) + moving.dot(&offset);
            }
        }
        for ((entry, gain), descent) in q.iter_mut().zip(&self.gains).zip(descent) {
            *entry += gain * descent;
        }
    }
}

/// Quaternion (x, y, z, w) with w >= 0.
fn quaternion(pose: &Isometry3<f32>) -> Vector4<f32> {
    let coords = pose.rotation.coords;
    if coords.w < 0.0 { -coords } else { coords }
}

/// The quaternion as the authors have it.
fn softened(pose: &Isometry3<f32>) -> Vector4<f32> {
    quaternion(pose).map(|x| (x * x + SOFTENING).sqrt() * if x == 0.0 { 0.0 } else { x.signum() })
}

/// How a quaternion changes when its frame turns (rad, in the base frame): `(w/2, 0) Q`.
fn quaternion_rate(quaternion: &Vector4<f32>, turning: &Vector3<f32>) -> Vector4<f32> {
    let vector = quaternion.xyz();
    let half = turning * 0.5;
    let rate = half * quaternion.w + half.cross(&vector);
    Vector4::new(rate.x, rate.y, rate.z, -half.dot(&vector))
}
