//! Unknowns of linear equations that are given.

use nalgebra::DMatrix;

/// Takes given unknowns out of a square matrix: their rows and columns are zero but for this number on the diagonal.
pub fn take_out(matrix: &mut DMatrix<f64>, unknowns: impl IntoIterator<Item = usize>, diagonal: f64) {
    for k in unknowns {
        matrix.row_mut(k).fill(0.0);
        matrix.column_mut(k).fill(0.0);
        matrix[(k, k)] = diagonal;
    }
}
