//! Stiffness by differences of equilibria.

use nalgebra::SMatrix;

use roulement::equilibrium::{self, EquilibriumInput, Prescribed};
use roulement::model::Model;

/// Central differences of the load of displaced races: rows and columns x, y, z, ry, rz.
pub fn load_differences(model: &Model, input: &EquilibriumInput, place: &[f64; 5]) -> SMatrix<f64, 5, 5> {
    let load = |k: usize, change: f64| {
        let mut displaced = *place;
        displaced[k] += change;
        let input = EquilibriumInput { conditions: displaced.map(Prescribed::Motion), ..input.clone() };
        equilibrium::solve(model, &input).unwrap().load
    };
    let mut differences = SMatrix::zeros();
    for k in 0..5 {
        let change = if k < 3 { 2e-9 } else { 1e-7 };
        let (plus, minus) = (load(k, change), load(k, -change));
        for i in 0..5 {
            differences[(i, k)] = (plus[i] - minus[i]) / (2.0 * change);
        }
    }
    differences
}
