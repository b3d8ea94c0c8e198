//! Turns about the bearing axis: vectors and matrices of a ball turn with its orbit.

use nalgebra::{Matrix6, Vector3, Vector6};

/// A rotation about the world's x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitTurn {
    cos: f64,
    sin: f64,
}

impl OrbitTurn {
    /// The turn that takes the azimuth of one point to that of another; none for a point on the axis.
    #[inline(always)]
    pub fn between(from: &Vector3<f64>, to: &Vector3<f64>) -> Self {
        let (cos, sin) = (from.y * to.y + from.z * to.z, from.y * to.z - from.z * to.y);
        let size = (cos * cos + sin * sin).sqrt();
        if size > 0.0 { Self { cos: cos / size, sin: sin / size } } else { Self { cos: 1.0, sin: 0.0 } }
    }

    /// The opposite turn.
    #[inline(always)]
    pub fn back(self) -> Self {
        Self { sin: -self.sin, ..self }
    }

    /// Turns a vector.
    #[inline(always)]
    pub fn vector(&self, v: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(v.x, self.cos * v.y - self.sin * v.z, self.sin * v.y + self.cos * v.z)
    }

    /// Turns two stacked vectors.
    #[inline(always)]
    pub fn stacked(&self, v: &Vector6<f64>) -> Vector6<f64> {
        let first = self.vector(&Vector3::new(v[0], v[1], v[2]));
        let second = self.vector(&Vector3::new(v[3], v[4], v[5]));
        Vector6::new(first.x, first.y, first.z, second.x, second.y, second.z)
    }

    /// Turns rows and columns of a matrix of two stacked vectors by two.
    #[inline(always)]
    pub fn matrix(&self, m: &Matrix6<f64>) -> Matrix6<f64> {
        let (cos, sin) = (self.cos, self.sin);
        let mut turned = *m;
        for (y, z) in [(1, 2), (4, 5)] {
            for k in 0..6 {
                let (a, b) = (turned[(y, k)], turned[(z, k)]);
                turned[(y, k)] = cos * a - sin * b;
                turned[(z, k)] = sin * a + cos * b;
            }
        }
        for (y, z) in [(1, 2), (4, 5)] {
            for k in 0..6 {
                let (a, b) = (turned[(k, y)], turned[(k, z)]);
                turned[(k, y)] = cos * a - sin * b;
                turned[(k, z)] = sin * a + cos * b;
            }
        }
        turned
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_turn_and_back() {
        let (from, to) = (Vector3::new(5.0, 2.0, 0.0), Vector3::new(-1.0, 0.0, 3.0));
        let turn = OrbitTurn::between(&from, &to);
        assert_eq!(turn.vector(&Vector3::new(1.0, 2.0, 3.0)), Vector3::new(1.0, -3.0, 2.0));
        let v = Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
        assert_eq!(turn.back().stacked(&turn.stacked(&v)), v);
        // Exactly nothing between equal points: a new matrix is used as it is.
        let none = OrbitTurn::between(&from, &from);
        assert_eq!(none.stacked(&v), v);
        assert_eq!(OrbitTurn::between(&Vector3::x(), &to).stacked(&v), v);
        // A turned matrix does to a turned vector what the matrix does to the vector.
        let m = Matrix6::from_fn(|i, k| (i * i + 3 * k) as f64);
        assert_eq!(turn.matrix(&m) * turn.stacked(&v), turn.stacked(&(m * v)));
        assert_eq!(none.matrix(&m), m);
    }
}
