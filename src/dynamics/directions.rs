//! Directions of differentiation of a pair: what its forces depend on, and how derivatives become matrices.
//!
//! Translation (0 to 2) and rotation (3 to 5) of the first body, rotation of the second (6 to 8). Forces depend on the
//! relative translation alone, so that the derivative by the second body's translation is minus that by the first's: nine
//! directions do the work of twelve.

use nalgebra::{Matrix6, Vector3};

use crate::contact::BallMotion;
use crate::numerics::hht::HhtStep;
use crate::numerics::scalar::{Dual, WIDTH};

/// Directions of differentiation.
pub const DIRECTIONS: usize = WIDTH;
/// First direction of the first body's rotation.
const FIRST_ROTATION: usize = 3;
/// First direction of the second body's rotation.
pub const SECOND_ROTATION: usize = 6;

/// A number with its derivatives in all directions.
pub type D = Dual<DIRECTIONS>;

/// A ball's motion as a function of its own unknowns: the first body of a pair.
pub fn seed<const N: usize>(motion: &BallMotion<f64>, step: &HhtStep, radius: f64) -> BallMotion<Dual<N>> {
    let variable = |v: &Vector3<f64>, first: usize, gain: f64| {
        Vector3::from_fn(|i, _| Dual::variable(v[i], first + i, gain))
    };
    BallMotion {
        position: variable(&motion.position, 0, step.position_gain()),
        velocity: variable(&motion.velocity, 0, step.velocity_gain()),
        angular_velocity: variable(&motion.angular_velocity, FIRST_ROTATION, step.velocity_gain() / radius),
    }
}

/// Derivatives of force (rows 0 to 2) and moment (rows 3 to 5) by the first body's unknowns.
#[inline(always)]
pub fn by_first<const N: usize>(force: &Vector3<Dual<N>>, moment: &Vector3<Dual<N>>) -> Matrix6<f64> {
    Matrix6::from_fn(|i, k| {
        let row = if i < 3 { &force[i] } else { &moment[i - 3] };
        row.derivatives[k]
    })
}

/// Derivatives of force (rows 0 to 2) and moment (rows 3 to 5) by the second body's unknowns.
#[inline(always)]
pub fn by_second(force: &Vector3<D>, moment: &Vector3<D>) -> Matrix6<f64> {
    Matrix6::from_fn(|i, k| by_second_unknown(if i < 3 { &force[i] } else { &moment[i - 3] }, k))
}

/// Derivative by unknown k of the second body: translation (0 to 2), rotation (3 to 5).
#[inline(always)]
pub fn by_second_unknown(x: &D, k: usize) -> f64 {
    if k < 3 { -x.derivatives[k] } else { x.derivatives[SECOND_ROTATION + k - 3] }
}

/// A number with first and second body exchanged: the relative translation changes sign, and the rotations change places.
pub fn exchange_bodies(x: D) -> D {
    let mut exchanged = x;
    for i in 0..3 {
        exchanged.derivatives[i] = -x.derivatives[i];
        exchanged.derivatives[FIRST_ROTATION + i] = x.derivatives[SECOND_ROTATION + i];
        exchanged.derivatives[SECOND_ROTATION + i] = x.derivatives[FIRST_ROTATION + i];
    }
    exchanged
}

/// Divides the moment rows by a length.
pub fn scale_moments(mut matrix: Matrix6<f64>, length: f64) -> Matrix6<f64> {
    matrix.fixed_rows_mut::<3>(3).scale_mut(1.0 / length);
    matrix
}
