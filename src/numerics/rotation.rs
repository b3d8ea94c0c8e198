//! Finite rotations by the conformal rotation vector `c = 4 tan(theta/4) n` (paper section 2 and its reference 17,
//! Geradin and Cardona 1988).
//!
//! Free of singularity below one full turn. Time integration uses it incrementally, from zero in every step, with a
//! unit quaternion as memory, so that rotations of any magnitude never come near the singularity; the absolute
//! vector of the paper, with the correction that keeps it below half a turn, converts to and from that quaternion.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::numerics::scalar::{Scalar, cross, dot};

/// `c0 = 2 - c.c/8`, the scalar companion of c in the formulas of the reference.
#[inline(always)]
fn c0<S: Scalar>(c: &Vector3<S>) -> S {
    S::constant(2.0) - dot(c, c).scale(0.125)
}

/// Rotates a vector by a constant rotation.
pub fn turn<S: Scalar>(q: &UnitQuaternion<f64>, v: &Vector3<S>) -> Vector3<S> {
    turn_by(q.to_rotation_matrix().matrix(), v)
}

/// Rotates a vector by a constant rotation matrix.
#[inline(always)]
pub fn turn_by<S: Scalar>(matrix: &Matrix3<f64>, v: &Vector3<S>) -> Vector3<S> {
    let row = |i: usize| v[0].scale(matrix[(i, 0)]) + v[1].scale(matrix[(i, 1)]) + v[2].scale(matrix[(i, 2)]);
    Vector3::new(row(0), row(1), row(2))
}

/// Rotates a vector by the inverse of a constant rotation matrix.
#[inline(always)]
pub fn turn_back_by<S: Scalar>(matrix: &Matrix3<f64>, v: &Vector3<S>) -> Vector3<S> {
    let row = |i: usize| v[0].scale(matrix[(0, i)]) + v[1].scale(matrix[(1, i)]) + v[2].scale(matrix[(2, i)]);
    Vector3::new(row(0), row(1), row(2))
}

/// Rotates a vector by the rotation of `c`.
#[inline(always)]
pub fn rotate<S: Scalar>(c: &Vector3<S>, v: &Vector3<S>) -> Vector3<S> {
    // R = [(c0^2 + 8 c0 - 16) I + 2 c c^T + 2 c0 [c]x] / (4 - c0)^2
    let c0 = c0(c);
    let d = S::constant(4.0) - c0;
    let scale = S::one() / d.square();
    let diagonal = c0.square() + c0.scale(8.0) - S::constant(16.0);
    let (along, across, twice) = (dot(c, v).scale(2.0), cross(c, v), c0.scale(2.0));
    let component = |i: usize| (v[i] * diagonal + c[i] * along + across[i] * twice) * scale;
    Vector3::new(component(0), component(1), component(2))
}

/// Conformal vector of the rotation `first` after that of `c`: `R = R(first) R(c)`, of a turn below half a turn.
#[inline(always)]
pub fn conformal_product<S: Scalar>(first: &UnitQuaternion<f64>, c: &Vector3<S>) -> Vector3<S> {
    // As quaternions of c: (c0, c)/(4 - c0).
    let c0 = c0(c);
    let over = S::one() / (S::constant(4.0) - c0);
    let (scalar, vector) = (c0 * over, c * over);
    // The quaternion of the smaller turn.
    let sign = if first.w < 0.0 { -1.0 } else { 1.0 };
    let (w, v): (f64, Vector3<S>) = (sign * first.w, (first.imag() * sign).map(S::constant));
    let real = scalar.scale(w) - v.dot(&vector);
    let imaginary = vector.map(|x| x.scale(w)) + v * scalar + v.cross(&vector);
    imaginary * (S::constant(4.0) / (S::one() + real))
}

/// Tangent operator: material angular velocity `Omega = T(c) c'` (paper eq. 25).
#[inline(always)]
pub fn tangent<S: Scalar>(c: &Vector3<S>, v: &Vector3<S>) -> Vector3<S> {
    // T = 2/(4 - c0)^2 (c0 I - [c]x + c c^T/4)
    let c0 = c0(c);
    let d = S::constant(4.0) - c0;
    (v * c0 - c.cross(v) + c * c.dot(v).scale(0.25)) * (S::constant(2.0) / d.square())
}

/// Inverse of the tangent operator: `c' = T^-1(c) Omega`.
#[inline(always)]
pub fn tangent_inverse<S: Scalar>(c: &Vector3<S>, v: &Vector3<S>) -> Vector3<S> {
    // T^-1 = 1/2 (c0 I + [c]x + c c^T/4)
    (v * c0(c) + c.cross(v) + c * c.dot(v).scale(0.25)) * S::constant(0.5)
}

/// Transposed inverse of the tangent operator: the moment in the body's axes of a potential whose gradient by c is `v`.
#[inline(always)]
pub fn tangent_inverse_transposed<S: Scalar>(c: &Vector3<S>, v: &Vector3<S>) -> Vector3<S> {
    (v * c0(c) - c.cross(v) + c * c.dot(v).scale(0.25)) * S::constant(0.5)
}

/// Rate of change of the tangent operator along `rate` = c', applied to `v`: `Omega' = T c'' + T' c'`.
#[inline(always)]
pub fn tangent_rate<S: Scalar>(c: &Vector3<S>, rate: &Vector3<S>, v: &Vector3<S>) -> Vector3<S> {
    let c0_rate = -c.dot(rate).scale(0.25);
    let d = S::constant(4.0) - c0(c);
    let scale = S::constant(2.0) / d.square();
    let inner = v * c0_rate - rate.cross(v) + (rate * c.dot(v) + c * rate.dot(v)) * S::constant(0.25);
    tangent(c, v) * (c0_rate.scale(2.0) / d) + inner * scale
}

/// Conformal rotation vector of a rotation vector (axis times angle): `c = x tan(|x|/4)/(|x|/4)`.
#[inline(always)]
pub fn from_rotation_vector<S: Scalar>(x: &Vector3<S>) -> Vector3<S> {
    // f(s) with s = |x|^2, by its series where the closed form is 0/0.
    let factor = dot(x, x).map_smooth(|s| {
        if s < 1e-4 {
            return (1.0 + s / 48.0 + s * s / 1920.0, 1.0 / 48.0 + s / 960.0);
        }
        let quarter = 0.25 * s.sqrt();
        let tan = quarter.tan();
        let slope = ((1.0 + tan * tan) * quarter - tan) / (2.0 * s * quarter);
        (tan / quarter, slope)
    });
    x * factor
}

/// Conformal rotation vector of a unit quaternion, of the turn below or equal to half a turn.
pub fn from_quaternion(q: &UnitQuaternion<f64>) -> Vector3<f64> {
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    q.imag() * (4.0 * sign / (1.0 + q.w.abs()))
}

/// Unit quaternion of a conformal rotation vector.
pub fn to_quaternion(c: &Vector3<f64>) -> UnitQuaternion<f64> {
    let c0 = c0(c);
    UnitQuaternion::new_normalize(Quaternion::from_parts(c0 / (4.0 - c0), c / (4.0 - c0)))
}

/// The paper's correction for rotations of any magnitude: above half a turn (`|c| > 4`) the same rotation is
/// described from the other side, `c* = -16 c/|c|^2`.
pub fn correct(c: &Vector3<f64>) -> Vector3<f64> {
    let square = c.norm_squared();
    if square > 16.0 { c * (-16.0 / square) } else { *c }
}

/// Composition: the vector of the rotation `second` after `first` seen in the rotated frame, `R = R(first) R(second)`.
pub fn compose(first: &Vector3<f64>, second: &Vector3<f64>) -> Vector3<f64> {
    from_quaternion(&(to_quaternion(first) * to_quaternion(second)))
}

/// The shortest rotation that carries the x axis to another one, exact for the smallest tilts: an arc cosine would lose those below
/// 1e-8 rad.
pub fn tilt_to(axis: &Vector3<f64>) -> UnitQuaternion<f64> {
    let w = 1.0 + axis.x;
    if w < 1e-6 {
        return UnitQuaternion::rotation_between(&Vector3::x(), axis).unwrap_or_default();
    }
    UnitQuaternion::new_normalize(Quaternion::new(w, 0.0, -axis.z, axis.y))
}

/// Rotation matrix of a conformal rotation vector.
pub fn matrix(c: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_columns(&[Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| rotate(c, &axis)))
}

#[cfg(test)]
mod tests {
    use num_traits::Zero;

    use super::*;
    use crate::numerics::scalar::Dual;

    fn vectors() -> impl Iterator<Item = Vector3<f64>> {
        [0.0, 1e-9, 0.1, 1.0, 3.0, 3.9]
            .into_iter()
            .flat_map(|size| [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.6, -0.64, 0.48)].map(|n| n * size))
    }

    #[test]
    fn closed_form_rotation_agrees_with_axis_and_angle() {
        for c in vectors() {
            let angle = 4.0 * (c.norm() / 4.0).atan();
            let axis = c.try_normalize(0.0).unwrap_or_else(Vector3::x);
            let exact = UnitQuaternion::new(axis * angle);
            assert!((matrix(&c) - exact.to_rotation_matrix().matrix()).norm() < 1e-14);
            assert!(to_quaternion(&c).angle_to(&exact) < 1e-7);
            assert!((from_quaternion(&exact) - c).norm() < 1e-13);
            assert!((from_rotation_vector(&(axis * angle)) - c).norm() < 1e-13);
        }
    }

    #[test]
    fn identity_inverse_of_the_tangent_operator() {
        let v = Vector3::new(0.3, -1.1, 0.7);
        for c in vectors() {
            assert!((tangent_inverse(&c, &tangent(&c, &v)) - v).norm() < 1e-13);
        }
    }

    #[test]
    fn identity_tangent_operator_is_the_rotation_rate() {
        // R^T R' = [Omega]x, the derivative by central differences
        let (rate, h) = (Vector3::new(0.3, -1.1, 0.7), 1e-5);
        for c in vectors() {
            let difference = (matrix(&(c + rate * h)) - matrix(&(c - rate * h))) / (2.0 * h);
            let skew = matrix(&c).transpose() * difference;
            let omega = Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]);
            assert!((omega - tangent(&c, &rate)).norm() < 1e-8, "{c}");
            let v = Vector3::new(-0.2, 0.5, 0.9);
            let slope = (tangent(&(c + rate * h), &v) - tangent(&(c - rate * h), &v)) / (2.0 * h);
            assert!((slope - tangent_rate(&c, &rate, &v)).norm() < 1e-8, "{c}");
        }
    }

    #[test]
    fn identity_product_with_a_constant_rotation_and_transposed_inverse() {
        for first in vectors().filter(|c| c.norm() < 3.5) {
            for second in vectors().filter(|c| c.norm() < 0.5) {
                let product = conformal_product(&to_quaternion(&first), &second);
                assert!((product - compose(&first, &second)).norm() < 1e-13, "{first} {second}");
                let other_sign = UnitQuaternion::new_unchecked(-to_quaternion(&first).into_inner());
                assert!((conformal_product(&other_sign, &second) - product).norm() < 1e-15);
            }
            let (v, w) = (Vector3::new(0.3, -1.1, 0.7), Vector3::new(0.9, 0.2, -0.4));
            let power = v.dot(&tangent_inverse(&first, &w));
            assert!((tangent_inverse_transposed(&first, &v).dot(&w) - power).abs() < 1e-13);
        }
    }

    #[test]
    fn closed_form_the_shortest_tilt() {
        // Near half a turn the shortest rotation is hardly defined.
        for angle in [0.0, 1e-12, 1e-9, 1e-3, 1.0, 2.0] {
            let exact = UnitQuaternion::new(Vector3::new(0.0, 0.6, -0.8) * angle);
            let tilt = tilt_to(&(exact * Vector3::x()));
            assert!((tilt.into_inner() - exact.into_inner()).norm() < 2e-15, "{angle}");
        }
    }

    #[test]
    fn identity_derivative_of_the_conversion() {
        for x in [Vector3::new(2e-3, -1e-3, 3e-3), Vector3::new(0.3, 0.5, -0.7)] {
            let dual = x.map(Dual::<1>::constant)
                + Vector3::new(Dual::variable(0.0, 0, 1.0), Dual::zero(), Dual::zero());
            let h = Vector3::x() * 1e-6;
            let difference = (from_rotation_vector(&(x + h)) - from_rotation_vector(&(x - h))) / 2e-6;
            let exact = from_rotation_vector(&dual).map(|c| c.derivatives[0]);
            assert!((difference - exact).norm() < 1e-9, "{difference} {exact}");
        }
    }

    #[test]
    fn identity_composition_and_correction() {
        for first in vectors() {
            for second in vectors() {
                let product = matrix(&first) * matrix(&second);
                assert!((matrix(&compose(&first, &second)) - product).norm() < 1e-13);
            }
        }
        let beyond = Vector3::new(3.0, -4.0, 5.0);
        assert!(beyond.norm() > 4.0 && correct(&beyond).norm() < 4.0);
        assert!((matrix(&beyond) - matrix(&correct(&beyond))).norm() < 1e-14);
    }
}
