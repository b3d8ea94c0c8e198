//! Number types of the contact kernel: `f64` for values, [`Dual`] for values with exact first derivatives.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use nalgebra::Vector3;

use super::called::Called;
use super::lanes::Lanes;

/// Arithmetic of the contact kernel. It has no branches, so that vectors of several numbers can implement it.
pub trait Scalar:
    Copy
    + Debug
    + PartialEq
    + 'static
    + num_traits::Zero
    + num_traits::One
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// The same number for code that runs seldom: smaller to compile, same bits.
    type Apart: Scalar;

    /// As such a number.
    fn apart(self) -> Self::Apart;

    /// From such a number.
    fn back(apart: Self::Apart) -> Self;

    /// A constant: all derivatives are zero.
    fn constant(value: f64) -> Self;

    /// A constant for each of the numbers that are computed with together, by its place among them.
    fn by_lane(of: impl FnMut(usize) -> f64) -> Self;

    /// Multiplies by a constant.
    fn scale(self, factor: f64) -> Self;

    /// Square root; the derivative at 0 is taken as 0, for quantities that are switched on at 0.
    fn sqrt(self) -> Self;

    /// A smooth function of this number, given as value and slope.
    fn map_smooth(self, function: impl Fn(f64) -> (f64, f64)) -> Self;

    /// Smooth functions of several numbers, given as values and gradients.
    fn map_smooth_many<const K: usize, const M: usize>(
        x: [Self; K],
        function: impl FnMut([f64; K]) -> ([f64; M], [[f64; K]; M]),
    ) -> [Self; M];

    /// Smooth functions of several numbers whose values alone are cheaper than with their gradients.
    fn apply<const K: usize, const M: usize>(map: &impl SmoothMap<K, M>, x: [Self; K]) -> [Self; M];

    /// A polynomial of this number, coefficients by ascending powers.
    fn polynomial<const K: usize>(self, coefficients: &[f64; K]) -> Self;

    /// `self` where `condition > 0`, `other` elsewhere.
    fn where_positive(self, condition: Self, other: Self) -> Self;

    /// Is the size of a number above a fraction of a limit, of several at a time that of any?
    fn any_beyond(self, fraction: f64, limit: Self) -> bool;

    /// `max(self, 0)`.
    fn positive_part(self) -> Self {
        self.where_positive(self, Self::zero())
    }

    /// `self` limited to `[low, high]`.
    fn clamp_to(self, low: f64, high: f64) -> Self {
        let (low, high) = (Self::constant(low), Self::constant(high));
        let bounded = self.where_positive(self - low, low);
        bounded.where_positive(high - bounded, high)
    }

    /// `1 - x`.
    fn one_minus(x: Self) -> Self {
        Self::one() - x
    }

    /// `self * self`.
    fn square(self) -> Self {
        self * self
    }
}

/// Smooth functions of several numbers.
pub trait SmoothMap<const K: usize, const M: usize> {
    /// Values of the functions.
    fn values<V: Values>(&self, x: [V; K]) -> [V; M];

    /// Values and gradients of the functions, row by function.
    fn with_gradient(&self, x: [f64; K]) -> ([f64; M], [[f64; K]; M]);
}

/// Numbers without derivatives, one or several at a time.
pub trait Values: Scalar {
    /// Functions of several numbers that are no formula.
    fn each<const K: usize, const M: usize>(
        x: [Self; K],
        function: impl FnMut([f64; K]) -> [f64; M],
    ) -> [Self; M];

    /// The same, of a function that is also written for several numbers at a time.
    fn each_or_together<const K: usize, const M: usize>(
        x: [Self; K],
        one: impl FnOnce([f64; K]) -> [f64; M],
        together: impl FnOnce([Lanes; K]) -> [Lanes; M],
    ) -> [Self; M];

    /// Numbers that are computed with together.
    const COUNT: usize;

    /// One of them; a number that is alone stands in all places. By reference: a lane picked from a copy would need the whole
    /// copy in memory.
    fn lane(&self, lane: usize) -> f64;

    /// Does a condition hold for every number?
    fn all(self, condition: impl Fn(f64) -> bool) -> bool;

    /// The larger of two numbers; the other one where this is no number.
    fn at_least(self, other: Self) -> Self;

    /// The smaller of two numbers; the other one where this is no number.
    fn at_most(self, other: Self) -> Self;

    /// The size of a number.
    fn abs(self) -> Self;

    /// The size of this number with the sign of another.
    fn with_sign_of(self, other: Self) -> Self;

    /// 2 to the power of this whole number from -1022 to 1023.
    fn power_of_two(self) -> Self;

    /// A number above 0 that is not subnormal, as a mantissa from 1/sqrt(2) to sqrt(2) and an exponent of 2.
    fn mantissa_and_exponent(self) -> (Self, Self);
}

/// [-] 2^52: where a whole number is added to it, the last bits are that number.
const WHOLE: f64 = 4_503_599_627_370_496.0;
/// Exponent of 1 in bits.
const BIAS: f64 = 1023.0;
/// Bits of a number that its exponent stands above.
const MANTISSA: u32 = f64::MANTISSA_DIGITS - 1;
/// Bits of the least mantissa, 1/sqrt(2) but for its last digits.
const LEAST_MANTISSA: u64 = 0x3fe6_a09e_0000_0000;

impl Values for f64 {
    #[inline(always)]
    fn each<const K: usize, const M: usize>(
        x: [Self; K],
        mut function: impl FnMut([f64; K]) -> [f64; M],
    ) -> [Self; M] {
        function(x)
    }
    #[inline(always)]
    fn each_or_together<const K: usize, const M: usize>(
        x: [Self; K],
        one: impl FnOnce([f64; K]) -> [f64; M],
        _: impl FnOnce([Lanes; K]) -> [Lanes; M],
    ) -> [Self; M] {
        one(x)
    }
    const COUNT: usize = 1;
    #[inline(always)]
    fn lane(&self, _: usize) -> f64 {
        *self
    }
    #[inline(always)]
    fn all(self, condition: impl Fn(f64) -> bool) -> bool {
        condition(self)
    }
    #[inline(always)]
    fn at_least(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn with_sign_of(self, other: Self) -> Self {
        self.copysign(other)
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        Self::from_bits((self + (WHOLE + BIAS)).to_bits() << MANTISSA)
    }
    #[inline(always)]
    fn mantissa_and_exponent(self) -> (Self, Self) {
        // The exponent counts up where the mantissa is its least.
        let bits = self.to_bits().wrapping_add(1f64.to_bits() - LEAST_MANTISSA);
        let exponent = Self::from_bits((bits >> MANTISSA) | WHOLE.to_bits()) - (WHOLE + BIAS);
        let mantissa = (bits & ((1 << MANTISSA) - 1)) + LEAST_MANTISSA;
        (Self::from_bits(mantissa), exponent)
    }
}

/// A number that stands for one quantity, so that a program can go by its value.
pub trait Single: Scalar {
    /// The value without derivatives.
    fn value(self) -> f64;
}

impl Single for f64 {
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
}

/// A force over its limit, brought back to the limit with its direction kept where it exceeds it.
#[inline(always)]
pub fn within_limit<S: Scalar>(x: S, y: S) -> [S; 2] {
    let square = x.square() + y.square();
    // Seldom beyond, and root and quotient take long.
    if !square.any_beyond(1.0, S::one()) {
        return [x, y];
    }
    let inside = square - S::one();
    // One unit of rounding inside.
    let factor = S::constant(1.0 - f64::EPSILON) / square.where_positive(inside, S::one()).sqrt();
    let factor = factor.where_positive(inside, S::one());
    [x * factor, y * factor]
}

impl Scalar for f64 {
    type Apart = Self;
    #[inline(always)]
    fn apart(self) -> Self {
        self
    }
    #[inline(always)]
    fn back(apart: Self) -> Self {
        apart
    }
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn by_lane(mut of: impl FnMut(usize) -> f64) -> Self {
        of(0)
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self * factor
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn map_smooth(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        function(self).0
    }
    #[inline(always)]
    fn map_smooth_many<const K: usize, const M: usize>(
        x: [Self; K],
        mut function: impl FnMut([f64; K]) -> ([f64; M], [[f64; K]; M]),
    ) -> [Self; M] {
        function(x).0
    }
    #[inline(always)]
    fn apply<const K: usize, const M: usize>(map: &impl SmoothMap<K, M>, x: [Self; K]) -> [Self; M] {
        map.values(x)
    }
    #[inline(always)]
    fn polynomial<const K: usize>(self, coefficients: &[f64; K]) -> Self {
        coefficients.iter().rev().fold(0.0, |value, coefficient| value * self + coefficient)
    }
    #[inline(always)]
    fn where_positive(self, condition: Self, other: Self) -> Self {
        if condition > 0.0 { self } else { other }
    }
    #[inline(always)]
    fn any_beyond(self, fraction: f64, limit: Self) -> bool {
        f64::abs(self) > fraction * limit
    }
    #[inline(always)]
    fn clamp_to(self, low: f64, high: f64) -> Self {
        self.at_least(low).at_most(high)
    }
}

/// Directions of derivatives by two bodies: translation of the first, rotation of both. Equilibria have one less and take the same
/// number, as every number of directions compiles its own copy of the contact (0.1 MB).
pub const WIDTH: usize = 9;

/// A number and its derivatives in `N` directions (forward-mode differentiation).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// Value.
    pub value: f64,
    /// Derivatives.
    pub derivatives: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// An independent variable: derivative `rate` in direction `direction`, 0 in all others.
    pub fn variable(value: f64, direction: usize, rate: f64) -> Self {
        let mut derivatives = [0.0; N];
        derivatives[direction] = rate;
        Self { value, derivatives }
    }

    /// Number with derivatives in other directions: the first of them are kept, and there is none in more.
    pub fn resized<const M: usize>(self) -> Dual<M> {
        let derivatives = std::array::from_fn(|k| self.derivatives.get(k).copied().unwrap_or(0.0));
        Dual { value: self.value, derivatives }
    }

    /// Chain rule: a function's value and its slope at this number.
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        let mut derivatives = self.derivatives;
        for d in &mut derivatives {
            *d *= slope;
        }
        Self { value, derivatives }
    }

    /// `p self' + q other'` with a given value.
    #[inline(always)]
    fn combine(self, p: f64, other: Self, q: f64, value: f64) -> Self {
        let mut derivatives = self.derivatives;
        for (d, o) in derivatives.iter_mut().zip(other.derivatives) {
            *d = *d * p + o * q;
        }
        Self { value, derivatives }
    }
}

impl<const N: usize> Single for Dual<N> {
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
}

impl<const N: usize> Scalar for Dual<N> {
    type Apart = Called<N>;
    #[inline(always)]
    fn apart(self) -> Called<N> {
        Called(self)
    }
    #[inline(always)]
    fn back(apart: Called<N>) -> Self {
        apart.0
    }
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value, derivatives: [0.0; N] }
    }
    #[inline(always)]
    fn by_lane(mut of: impl FnMut(usize) -> f64) -> Self {
        Self::constant(of(0))
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self.chain(self.value * factor, factor)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, if root > 0.0 { 0.5 / root } else { 0.0 })
    }
    #[inline(always)]
    fn map_smooth(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        let (value, slope) = function(self.value);
        self.chain(value, slope)
    }
    #[inline(always)]
    fn map_smooth_many<const K: usize, const M: usize>(
        x: [Self; K],
        mut function: impl FnMut([f64; K]) -> ([f64; M], [[f64; K]; M]),
    ) -> [Self; M] {
        let (values, gradient) = function(x.map(|component| component.value));
        std::array::from_fn(|m| {
            let mut derivatives = [0.0; N];
            for (slope, component) in gradient[m].iter().zip(&x) {
                for (derivative, by) in derivatives.iter_mut().zip(component.derivatives) {
                    *derivative += slope * by;
                }
            }
            Self { value: values[m], derivatives }
        })
    }
    #[inline(always)]
    fn apply<const K: usize, const M: usize>(map: &impl SmoothMap<K, M>, x: [Self; K]) -> [Self; M] {
        Self::map_smooth_many(x, |x| map.with_gradient(x))
    }
    #[inline(always)]
    fn polynomial<const K: usize>(self, coefficients: &[f64; K]) -> Self {
        let (mut value, mut slope) = (0.0, 0.0);
        for coefficient in coefficients.iter().rev() {
            slope = slope * self.value + value;
            value = value * self.value + coefficient;
        }
        self.chain(value, slope)
    }
    #[inline(always)]
    fn where_positive(self, condition: Self, other: Self) -> Self {
        if condition.value > 0.0 { self } else { other }
    }
    #[inline(always)]
    fn any_beyond(self, fraction: f64, limit: Self) -> bool {
        self.value.any_beyond(fraction, limit.value)
    }
}

impl<const N: usize> num_traits::Zero for Dual<N> {
    fn zero() -> Self {
        Self::constant(0.0)
    }
    fn is_zero(&self) -> bool {
        *self == Self::constant(0.0)
    }
}

impl<const N: usize> num_traits::One for Dual<N> {
    fn one() -> Self {
        Self::constant(1.0)
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self.value += other.value;
        for (d, o) in self.derivatives.iter_mut().zip(other.derivatives) {
            *d += o;
        }
        self
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self.value -= other.value;
        for (d, o) in self.derivatives.iter_mut().zip(other.derivatives) {
            *d -= o;
        }
        self
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.combine(other.value, other, self.value, self.value * other.value)
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        let quotient = self.value / other.value;
        self.combine(inverse, other, -quotient * inverse, quotient)
    }
}

macro_rules! assign {
    ($($trait:ident $method:ident $operator:tt),*) => {$(
        impl<const N: usize> $trait for Dual<N> {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )*};
}
assign!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign /);

/// Scalar product. nalgebra's own is not inlined for derivatives, which costs a copy of each factor.
#[inline(always)]
pub fn dot<S: Scalar>(a: &Vector3<S>, b: &Vector3<S>) -> S {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// Vector product, inlined like [`dot`].
#[inline(always)]
pub fn cross<S: Scalar>(a: &Vector3<S>, b: &Vector3<S>) -> Vector3<S> {
    Vector3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

/// Lifts a vector of constants.
#[inline(always)]
pub fn constant_vector<S: Scalar>(v: &Vector3<f64>) -> Vector3<S> {
    v.map(S::constant)
}

/// Values of a vector, without derivatives.
#[inline(always)]
pub fn values<S: Single>(v: &Vector3<S>) -> Vector3<f64> {
    v.map(S::value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function that uses every operation, smooth at the point tested.
    fn sample<S: Scalar>(x: S, y: S) -> S {
        let one = S::one();
        let mut r = (x * y - x / y + y.sqrt()).scale(3.0) + (-x).square() - one;
        r += x.positive_part() * y;
        r -= x.clamp_to(-0.5, 0.25) * y;
        r *= y;
        r /= x + y;
        r
    }

    #[test]
    fn dual_derivatives_agree_with_differences() {
        let (x, y, h) = (0.7, 1.9, 1e-6);
        let dual = sample(Dual::<2>::variable(x, 0, 1.0), Dual::<2>::variable(y, 1, 1.0));
        let dx = (sample(x + h, y) - sample(x - h, y)) / (2.0 * h);
        let dy = (sample(x, y + h) - sample(x, y - h)) / (2.0 * h);
        assert_eq!(dual.value, sample(x, y));
        assert!((dual.derivatives[0] - dx).abs() < 1e-8 && (dual.derivatives[1] - dy).abs() < 1e-8);
    }

    #[test]
    fn a_root_switched_on_at_zero_has_finite_derivatives() {
        let x = Dual::<1>::variable(-1.0, 0, 1.0).positive_part();
        assert_eq!((x * x.sqrt()).derivatives, [0.0]);
    }
}
