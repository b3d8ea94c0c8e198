//! Parts of Craig's and Bampton's reduction that bending and torsion share.

use nalgebra::{DMatrix, DVector};

use crate::numerics::size::ascending;

/// Modes of a stiffness and a mass matrix up to an angular frequency, with unit generalised mass, by ascending frequency.
pub fn modes(stiffness: &DMatrix<f64>, mass: &DMatrix<f64>, highest: f64) -> (DMatrix<f64>, Vec<f64>) {
    let none = (DMatrix::zeros(mass.nrows(), 0), vec![]);
    let Some(cholesky) = mass.clone().cholesky() else { return none };
    let lower = cholesky.l();
    let Some(half) = lower.solve_lower_triangular(stiffness) else { return none };
    let Some(scaled) = lower.solve_lower_triangular(&half.transpose()) else { return none };
    let eigen = symmetric(&scaled).symmetric_eigen();
    let mut order = ascending(eigen.eigenvalues.as_slice());
    order.retain(|k| eigen.eigenvalues[*k] <= highest * highest);
    let frequencies = order.iter().map(|k| eigen.eigenvalues[*k].max(0.0).sqrt()).collect();
    let columns: Vec<DVector<f64>> =
        order.iter().map(|k| eigen.eigenvectors.column(*k).into_owned()).collect();
    if columns.is_empty() {
        return none;
    }
    let shapes = lower.tr_solve_lower_triangular(&DMatrix::from_columns(&columns));
    shapes.map_or(none, |shapes| (shapes, frequencies))
}

/// A matrix without what rounding has left of asymmetry.
pub fn symmetric(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    (matrix + matrix.transpose()) * 0.5
}
