//! Small motions of balls that ideal cages keep apart, from those of free ones.

use nalgebra::DMatrix;

/// Unknowns of a ball: place, velocity, angular velocity.
pub const OF_BALL: usize = 9;
/// Which of its places are along the radius and along the orbit.
const RADIAL: usize = 1;
const ALONG: usize = 2;

/// The balls of a bearing, and the mean speed of their orbits [rad/s] where an ideal cage keeps them apart.
pub struct Caged {
    /// Their number.
    pub balls: usize,
    /// That speed.
    pub speed: Option<f64>,
}

/// Equations of balls that ideal cages keep apart, from those of free ones, and all unknowns by those that are left. Pockets act on the rates
/// along the orbit, and their sum is nothing.
pub fn kept_apart(
    free: DMatrix<f64>,
    first: usize,
    bearings: &[Caged],
) -> (DMatrix<f64>, Option<DMatrix<f64>>) {
    let ideal: usize = bearings.iter().filter(|of| of.speed.is_some()).map(|of| of.balls - 1).sum();
    if ideal == 0 {
        return (free, None);
    }
    let left = free.nrows() - 2 * ideal;
    let (mut lift, mut fall) = (DMatrix::zeros(free.nrows(), left), DMatrix::zeros(left, free.nrows()));
    let [mut from, mut to] = [first; 2];
    for k in 0..first {
        (lift[(k, k)], fall[(k, k)]) = (1.0, 1.0);
    }
    for Caged { balls: count, speed } in bearings {
        let (count, apart) = (*count, speed.is_some());
        // In an ideal cage all have `u_along = s` and `v_along = s' + W u_radial`: s and s' take the places of those of the first ball.
        let (speed, share, common) = (speed.unwrap_or(0.0), 1.0 / count as f64, to);
        for ball in 0..count {
            let mut radial = 0;
            for k in 0..OF_BALL {
                if !apart || ball == 0 || (k != ALONG && k != 3 + ALONG) {
                    if k == RADIAL {
                        radial = to;
                    }
                    let own = apart && (k == ALONG || k == 3 + ALONG);
                    (lift[(from + k, to)], fall[(to, from + k)]) =
                        if own { (1.0, share) } else { (1.0, 1.0) };
                    to += 1;
                } else {
                    let shared = common + k;
                    (lift[(from + k, shared)], fall[(shared, from + k)]) = (1.0, share);
                }
            }
            if apart {
                lift[(from + 3 + ALONG, radial)] = speed;
                fall[(common + 3 + ALONG, from + RADIAL)] = -share * speed;
            }
            from += OF_BALL;
        }
    }
    (&fall * free * &lift, Some(lift))
}
