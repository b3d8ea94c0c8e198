//! Finds the parameters of the regularised law's spin coupling from Kalker's nonlinear theory (paper section 3.1.3).
//!
//! As the paper says: least squares over fifty uniformly spaced contacts with one creepage only, spin for eta and beta,
//! lateral creepage for alpha. In Kalker's scale load, size and friction drop out, so that one set serves an axis
//! ratio whatever the friction; it does not serve all axis ratios (the paper says the opposite of both).

use nalgebra::{SMatrix, SVector};

use super::regularised::{Parameters, lateral_by_spin, moment_by_lateral, moment_by_spin};
use crate::kalker::LinearError;
use crate::kalker::linear::Scales;
use crate::kalker::table::CreepTable;
use crate::kalker::{Patch, ScaledCreepage, ScaledForces};
use crate::numerics::scalar::{Dual, Scalar};

/// Contacts of a sweep (paper section 3.1.3).
const SAMPLES: usize = 50;
/// [-] largest scaled spin and lateral creepage of the sweeps: from rest to well into complete sliding.
const RANGES: [f64; 2] = [15.0, 2.1];

/// A fitted function: argument, value of the nonlinear theory, value of the fit.
pub type Samples = Vec<[f64; 3]>;

/// Parameters and how well they fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Identification {
    /// The parameters.
    pub parameters: Parameters,
    /// phi_yz (eta), phi_z (beta) and phi_zy (alpha) at the samples.
    pub samples: [Samples; 3],
}

impl Identification {
    /// Root mean square and largest residual of phi_yz, phi_z and phi_zy [-].
    pub fn residuals(&self) -> [[f64; 2]; 3] {
        self.samples.each_ref().map(|samples| {
            let errors = || samples.iter().map(|[_, theory, fit]| (fit - theory).abs());
            let mean_square = errors().map(|e| e * e).sum::<f64>() / samples.len() as f64;
            [mean_square.sqrt(), errors().fold(0.0, f64::max)]
        })
    }
}

/// Identifies the parameters of a patch against a nonlinear theory.
///
/// # Errors
/// Errors of the theory, and if the patch is out of range.
pub fn identify<E: From<LinearError>>(
    patch: &Patch,
    theory: impl Fn(&ScaledCreepage) -> Result<ScaledForces, E>,
) -> Result<Identification, E> {
    let scales = Scales::new(patch)?;
    let sweep = |range: f64| (1..=SAMPLES).map(move |k| range * k as f64 / SAMPLES as f64);
    let (mut by_spin, mut own, mut by_lateral) = (vec![], vec![], vec![]);
    for spin in sweep(RANGES[0]) {
        let forces = theory(&ScaledCreepage { spin, ..Default::default() })?;
        by_spin.push((0.5 * spin * scales.c23, forces.fy));
        own.push((spin * scales.c33 / scales.moment, forces.mz / scales.moment));
    }
    for y in sweep(RANGES[1]) {
        let forces = theory(&ScaledCreepage { y, ..Default::default() })?;
        by_lateral.push((y * scales.c23 / scales.moment, -forces.mz / scales.moment));
    }
    let (eta, first) = fit([0.2, 0.5, 5.0], &by_spin, lateral_by_spin);
    let (beta, second) = fit([0.8, 1.0], &own, moment_by_spin);
    let (alpha, third) = fit([0.8, 5.0, 5.0], &by_lateral, moment_by_lateral);
    Ok(Identification {
        parameters: Parameters { eta, beta, alpha, coupling: 1.0 },
        samples: [first, second, third],
    })
}

/// Identifies the parameters of a patch against the table of the nonlinear theory.
///
/// # Errors
/// If the patch is out of range.
pub fn identify_by_table(patch: &Patch) -> Result<Identification, LinearError> {
    let table = CreepTable::new(patch)?;
    let Scales { c11, c22, c33, moment, .. } = Scales::new(patch)?;
    identify(patch, |h: &ScaledCreepage| {
        let ([fx, fy, mz], _) = table.evaluate([h.x * c11, h.y * c22, h.spin * c33 / moment]);
        Ok(ScaledForces { fx, fy, mz: mz * moment, second_moment: 0.0 })
    })
}

/// Least squares by Levenberg and Marquardt's method: parameters and samples with the fit.
fn fit<const N: usize>(
    start: [f64; N],
    data: &[(f64, f64)],
    model: impl Fn([Dual<N>; N], Dual<N>) -> Dual<N>,
) -> ([f64; N], Samples) {
    let at = |p: &SVector<f64, N>, x: f64| {
        model(std::array::from_fn(|k| Dual::variable(p[k], k, 1.0)), Dual::constant(x))
    };
    let cost = |p: &SVector<f64, N>| -> f64 { data.iter().map(|&(x, y)| (at(p, x).value - y).powi(2)).sum() };
    let mut p = SVector::from(start);
    let mut damping = 1e-3;
    let mut now = cost(&p);
    for _ in 0..500 {
        let mut normal = SMatrix::<f64, N, N>::zeros();
        let mut gradient = SVector::<f64, N>::zeros();
        for &(x, y) in data {
            let f = at(&p, x);
            let row = SVector::from(f.derivatives);
            normal += row * row.transpose();
            gradient += row * (f.value - y);
        }
        for k in 0..N {
            normal[(k, k)] *= 1.0 + damping;
        }
        let trial = normal.cholesky().map(|factor| p - factor.solve(&gradient));
        let reached = trial.as_ref().map_or(f64::INFINITY, cost);
        if let (Some(trial), true) = (trial, reached < now) {
            let done = now - reached <= 1e-14 * now;
            (p, now) = (trial, reached);
            damping *= 0.1;
            if done {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e12 {
                break;
            }
        }
    }
    (p.into(), data.iter().map(|&(x, y)| [x, y, at(&p, x).value]).collect())
}
