//! Turns about the bearing axis: vectors and matrices of a ball turn with its orbit.

use nalgebra::Vector3;

use super::arrowhead::block::{Six, Square};
use super::scalar::Scalar;

/// A rotation about the world's x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitTurn<S: Scalar = f64> {
    cos: S,
    sin: S,
}

impl<S: Scalar> OrbitTurn<S> {
    /// The turn that takes the azimuth of one point to that of another; none for a point on the axis.
    #[inline(always)]
    pub fn between(from: &Vector3<S>, to: &Vector3<S>) -> Self {
        let (cos, sin) = (from.y * to.y + from.z * to.z, from.y * to.z - from.z * to.y);
        let size = (cos * cos + sin * sin).sqrt();
        let divisor = size.where_positive(size, S::one());
        Self {
            cos: (cos / divisor).where_positive(size, S::one()),
            sin: (sin / divisor).where_positive(size, S::zero()),
        }
    }

    /// The opposite turn.
    #[inline(always)]
    pub fn back(self) -> Self {
        Self { sin: -self.sin, ..self }
    }

    /// Turns two components of a vector across the axis.
    #[inline(always)]
    fn pair(&self, y: S, z: S) -> [S; 2] {
        [self.cos * y - self.sin * z, self.sin * y + self.cos * z]
    }

    /// Turns two stacked vectors.
    #[inline(always)]
    pub fn stacked(&self, v: &Six<S>) -> Six<S> {
        let ([b, c], [e, f]) = (self.pair(v[1], v[2]), self.pair(v[4], v[5]));
        [v[0], b, c, v[3], e, f]
    }

    /// Adds a matrix of two stacked vectors by two, with its rows and columns turned, to a sum.
    #[inline(always)]
    pub fn add_matrix(&self, m: &Square<S>, sum: &mut Square<S>) {
        for first in [0, 3] {
            let column = |k: usize| self.stacked(&m[first + k]);
            let (x, y, z) = (column(0), column(1), column(2));
            for i in 0..6 {
                let [y, z] = self.pair(y[i], z[i]);
                sum[first][i] += x[i];
                sum[first + 1][i] += y;
                sum[first + 2][i] += z;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix6, Vector6};

    use super::*;
    use crate::numerics::lanes::Lanes;

    #[test]
    fn closed_form_turn_and_back() {
        let (from, to) = (Vector3::new(5.0, 2.0, 0.0), Vector3::new(-1.0, 0.0, 3.0));
        let turn = OrbitTurn::between(&from, &to);
        let v = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        assert_eq!(turn.stacked(&v), [1.0, -3.0, 2.0, 4.0, -6.0, 5.0]);
        assert_eq!(turn.back().stacked(&turn.stacked(&v)), v);
        // Exactly nothing between equal points: a new matrix is used as it is.
        let none = OrbitTurn::between(&from, &from);
        assert_eq!(none.stacked(&v), v);
        assert_eq!(OrbitTurn::between(&Vector3::x(), &to).stacked(&v), v);
        // A turned matrix does to a turned vector what the matrix does to the vector.
        let m = Matrix6::from_fn(|i, k| (i * i + 3 * k) as f64);
        let turned = |turn: &OrbitTurn| {
            let mut sum = [[0.0; 6]; 6];
            turn.add_matrix(&m.into(), &mut sum);
            Matrix6::from(sum)
        };
        let product = turned(&turn) * Vector6::from(turn.stacked(&v));
        assert_eq!(product, Vector6::from(turn.stacked(&(m * Vector6::from(v)).into())));
        assert_eq!(turned(&none), m);
    }

    #[test]
    fn identity_of_several_turns_and_of_each() {
        let points = |shift: f64| {
            // A point on the axis in the last lane.
            let point = |lane: usize| {
                Vector3::new(1.0, 0.3 * lane as f64 + shift, 2.0 - shift) * if lane < 3 { 1.0 } else { 0.0 }
            };
            (0..4).map(point).collect::<Vec<_>>()
        };
        let (from, to) = (points(0.1), points(0.7));
        let lanes = |points: &[Vector3<f64>]| Lanes::vector(|lane| points[lane]);
        let turns = OrbitTurn::between(&lanes(&from), &lanes(&to));
        for lane in 0..4 {
            let one = OrbitTurn::between(&from[lane], &to[lane]);
            assert_eq!((turns.cos.0[lane], turns.sin.0[lane]), (one.cos, one.sin));
        }
    }
}
