//! Directions across the axis of a bearing among the unknowns of a ball.

use nalgebra::{Matrix6, Vector6};

/// A unit vector across the axis among the six unknowns of a ball: of all six, those along y and z are not 0.
#[derive(Clone, Copy, Debug)]
pub struct Across(pub [f64; 2]);

impl Across {
    /// A multiple of it.
    pub fn times(&self, factor: f64) -> Vector6<f64> {
        let [y, z] = self.0;
        Vector6::new(0.0, y * factor, z * factor, 0.0, 0.0, 0.0)
    }

    /// Its product with a vector.
    pub fn dot(&self, other: &Vector6<f64>) -> f64 {
        let [y, z] = self.0;
        y * other[1] + z * other[2]
    }

    /// A matrix times it.
    pub fn column_of(&self, matrix: &Matrix6<f64>) -> Vector6<f64> {
        let [y, z] = self.0;
        matrix.column(1) * y + matrix.column(2) * z
    }

    /// The transpose of a matrix times it.
    pub fn row_of(&self, matrix: &Matrix6<f64>) -> Vector6<f64> {
        let [y, z] = self.0;
        Vector6::from_fn(|k, _| y * matrix[(1, k)] + z * matrix[(2, k)])
    }

    /// Adds `vector` times its transpose.
    pub fn add_to_columns(&self, matrix: &mut Matrix6<f64>, vector: &Vector6<f64>) {
        for (k, number) in self.0.into_iter().enumerate() {
            let mut column = matrix.column_mut(1 + k);
            column += vector * number;
        }
    }

    /// Adds it times the transpose of `vector`.
    pub fn add_to_rows(&self, matrix: &mut Matrix6<f64>, vector: &Vector6<f64>) {
        let [y, z] = self.0;
        for (k, number) in vector.iter().enumerate() {
            matrix[(1, k)] += y * number;
            matrix[(2, k)] += z * number;
        }
    }
}
