//! Orientation of a body that spins about its own x axis: a turn about that axis, then a tilt of it.
//!
//! `R = exp(r) Rx(t)` with the rotation vector `r = [0, r_y, r_z]` of the axis. The three coordinates `[t, r_y, r_z]`
//! \[rad] are free of each other: a held tilt stays where it is, however the body spins.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::scalar::{Scalar, cross};

/// \[rad] rotation vector `[0, r_y, r_z]` of an orientation's x axis.
pub fn of_axis(orientation: &UnitQuaternion<f64>) -> Vector3<f64> {
    let axis = orientation * Vector3::x();
    let across = Vector3::new(0.0, -axis.z, axis.y);
    let sine = across.norm();
    // By the sine, as the cosine of a small angle does not tell it.
    match sine.atan2(axis.x) {
        angle if sine > 0.0 => across * (angle / sine),
        half_turn => Vector3::y() * half_turn,
    }
}

/// \[rad] turn, tilt about y and z of an orientation; the turn is in (-pi, pi].
pub fn coordinates(orientation: &UnitQuaternion<f64>) -> Vector3<f64> {
    let tilt = of_axis(orientation);
    let turn = tilted(&tilt).inverse() * orientation;
    let turn = 2.0 * turn.i.atan2(turn.w);
    // q and -q are the same turn.
    let wrapped = turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round();
    Vector3::new(wrapped, tilt.y, tilt.z)
}

/// Orientation of such coordinates.
pub fn orientation(coordinates: &Vector3<f64>) -> UnitQuaternion<f64> {
    tilted(coordinates) * UnitQuaternion::new(Vector3::x() * coordinates.x)
}

/// [rad/s] angular velocity, world axes, of coordinates and their rates [rad/s].
pub fn angular_velocity(coordinates: &Vector3<f64>, rates: &Vector3<f64>) -> Vector3<f64> {
    columns(coordinates) * rates
}

/// [rad/s] rates of the coordinates of an orientation that turns with an angular velocity \[rad/s], world axes.
pub fn rates(coordinates: &Vector3<f64>, angular_velocity: &Vector3<f64>) -> Vector3<f64> {
    // Singular where the axis has turned around by half a turn.
    columns(coordinates).lu().solve(angular_velocity).unwrap_or_else(Vector3::zeros)
}

/// \[rad] largest tilt that [`columns_of_small`] is exact for.
pub const SMALL: f64 = 0.1;

/// Columns of the angular velocity by the rates of turn and tilt, as [`angular_velocity`] has them, with derivatives: the first is the
/// axis. Of tilts up to [`SMALL`].
pub fn columns_of_small<S: Scalar>(coordinates: &Vector3<S>) -> [Vector3<S>; 3] {
    let r = Vector3::new(S::zero(), coordinates[1], coordinates[2]);
    let square = r[1] * r[1] + r[2] * r[2];
    // sin p/p, (1 - cos p)/p^2 and (p - sin p)/p^3: the next terms are below rounding.
    let sine = square.polynomial(&[1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0]);
    let first = square.polynomial(&[0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40_320.0, 1.0 / 3_628_800.0]);
    let second =
        square.polynomial(&[1.0 / 6.0, -1.0 / 120.0, 1.0 / 5040.0, -1.0 / 362_880.0, 1.0 / 39_916_800.0]);
    let unit = |axis: usize| Vector3::from_fn(|i, _| S::constant(if i == axis { 1.0 } else { 0.0 }));
    let series = |v: Vector3<S>, once_by: S, twice_by: S| {
        let once = cross(&r, &v);
        v + once.map(|c| c * once_by) + cross(&r, &once).map(|c| c * twice_by)
    };
    [series(unit(0), sine, first), series(unit(1), first, second), series(unit(2), first, second)]
}

fn tilted(coordinates: &Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::new(Vector3::new(0.0, coordinates.y, coordinates.z))
}

/// Angular velocity by the rates of turn and tilt: the axis itself, and the columns of the exponential's derivative
/// `I + (1 - cos p)/p^2 [r]x + (p - sin p)/p^3 [r]x^2`, `p = |r|`.
fn columns(coordinates: &Vector3<f64>) -> Matrix3<f64> {
    let r = Vector3::new(0.0, coordinates.y, coordinates.z);
    let square = r.norm_squared();
    let angle = square.sqrt();
    let (first, second) = if angle < 0.1 {
        // Series, where the closed forms are 0/0: the next terms are below rounding.
        let first =
            0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0)));
        let second = 1.0 / 6.0
            - square / 120.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0 * (1.0 - square / 110.0)));
        (first, second)
    } else {
        ((1.0 - angle.cos()) / square, (angle - angle.sin()) / (square * angle))
    };
    let by_tilt = |axis: Vector3<f64>| {
        let once = r.cross(&axis);
        axis + once * first + r.cross(&once) * second
    };
    Matrix3::from_columns(&[tilted(coordinates) * Vector3::x(), by_tilt(Vector3::y()), by_tilt(Vector3::z())])
}

#[cfg(test)]
mod tests {
    use super::*;

    const COORDINATES: [[f64; 3]; 5] =
        [[0.0; 3], [1.2, 1e-3, -2e-7], [-3.0, 0.09, 0.02], [2.0, 0.08, 0.08], [0.4, 1.0, -0.7]];

    #[test]
    fn identity_coordinates_and_orientation_are_inverse() {
        for c in COORDINATES.map(Vector3::from) {
            assert!((coordinates(&orientation(&c)) - c).norm() < 1e-14, "{c}");
            // However many times the body has turned.
            let ahead = c + Vector3::x() * (100.0 * std::f64::consts::TAU);
            assert!((coordinates(&orientation(&ahead)) - c).norm() < 1e-12, "{c}");
        }
    }

    #[test]
    fn identity_angular_velocity_is_the_rate_of_the_orientation() {
        let (change, h) = (Vector3::new(3.0, -0.7, 1.1), 1e-5);
        for c in COORDINATES.map(Vector3::from) {
            let [before, after] = [-h, h].map(|h| orientation(&(c + change * h)));
            let difference = (after * before.inverse()).scaled_axis() / (2.0 * h);
            let exact = angular_velocity(&c, &change);
            assert!((difference - exact).norm() < 1e-8, "{c} {difference} {exact}");
            assert!((rates(&c, &exact) - change).norm() < 1e-13, "{c}");
            if c.yz().norm() <= SMALL {
                let small = Matrix3::from_columns(&columns_of_small(&c));
                assert!((small - columns(&c)).norm() < 1e-15, "{c}");
            }
        }
    }
}
