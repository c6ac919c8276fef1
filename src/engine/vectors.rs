//! Struct-of-arrays storage of 3-vectors and 3x3 matrices.

use nalgebra::{Matrix3, Vector3};

/// `n` 3-vectors, one flat array a component.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vectors {
    components: [Vec<f64>; 3],
}

impl Vectors {
    /// `n` zero vectors.
    pub fn zeros(n: usize) -> Self {
        Self {
            components: std::array::from_fn(|_| vec![0.0; n]),
        }
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.components[0].len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.components[0].is_empty()
    }

    /// Vector `i`.
    #[inline]
    pub fn get(&self, i: usize) -> Vector3<f64> {
        let [x, y, z] = &self.components;
        Vector3::new(x[i], y[i], z[i])
    }

    /// Replaces vector `i`.
    #[inline]
    pub fn set(&mut self, i: usize, v: Vector3<f64>) {
        let [x, y, z] = &mut self.components;
        (x[i], y[i], z[i]) = (v.x, v.y, v.z);
    }

    /// Adds `v` to vector `i`.
    #[inline]
    pub fn add(&mut self, i: usize, v: Vector3<f64>) {
        self.set(i, self.get(i) + v);
    }

    /// Appends a vector.
    pub fn push(&mut self, v: Vector3<f64>) {
        for (component, value) in self.components.iter_mut().zip(v.iter()) {
            component.push(*value);
        }
    }

    /// Sets every vector to zero.
    pub fn clear_to_zero(&mut self) {
        for component in &mut self.components {
            component.fill(0.0);
        }
    }

    /// `self += factor * other`, array by array.
    pub fn add_scaled(&mut self, factor: f64, other: &Self) {
        for (own, others) in self.components.iter_mut().zip(&other.components) {
            for (a, b) in own.iter_mut().zip(others) {
                *a += factor * b;
            }
        }
    }

    /// Whether every number is finite. A sum is enough: an infinity or a NaN survives it.
    pub fn all_finite(&self) -> bool {
        self.components
            .iter()
            .map(|c| c.iter().map(|v| v * 0.0).sum::<f64>())
            .sum::<f64>()
            == 0.0
    }
}

/// `n` 3x3 matrices, one flat array an entry (row-major). Directors: row `j` is director `d_j` in the world frame,
/// so a matrix takes world components to material ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matrices {
    rows: [Vectors; 3],
}

impl Matrices {
    /// Matrix `i`.
    #[inline]
    pub fn get(&self, i: usize) -> Matrix3<f64> {
        let [a, b, c] = &self.rows;
        Matrix3::from_rows(&[
            a.get(i).transpose(),
            b.get(i).transpose(),
            c.get(i).transpose(),
        ])
    }

    /// Replaces matrix `i`.
    #[inline]
    pub fn set(&mut self, i: usize, m: Matrix3<f64>) {
        for (j, row) in self.rows.iter_mut().enumerate() {
            row.set(i, m.row(j).transpose());
        }
    }

    /// Appends a matrix.
    pub fn push(&mut self, m: Matrix3<f64>) {
        for (j, row) in self.rows.iter_mut().enumerate() {
            row.push(m.row(j).transpose());
        }
    }
}
