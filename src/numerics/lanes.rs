//! Vectors of several numbers, for the contact kernel of four balls at a time.
//!
//! Every operation is that of `f64`, lane by lane, so that results are those of one ball at a time to the bit, with or
//! without vector instructions.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::numerics::scalar::{Scalar, SmoothMap, Values};
use crate::numerics::size::larger;

/// Numbers per vector: as many as a register of 256 bits holds.
pub const WIDTH: usize = 4;

/// Numbers that are computed with together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[repr(align(32))]
pub struct Lanes(pub [f64; WIDTH]);

impl Lanes {
    /// Number of every lane.
    #[inline(always)]
    pub fn from_fn(number: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(number))
    }

    /// With another number in one lane.
    #[inline(always)]
    pub fn with(mut self, lane: usize, number: f64) -> Self {
        self.0[lane] = number;
        self
    }

    /// Vectors of several lanes as one; `number` gives that of a lane.
    #[inline(always)]
    pub fn vector(number: impl Fn(usize) -> Vector3<f64>) -> Vector3<Self> {
        let vectors = [number(0), number(1), number(2), number(3)];
        let component = |k: usize| Self([vectors[0][k], vectors[1][k], vectors[2][k], vectors[3][k]]);
        Vector3::new(component(0), component(1), component(2))
    }

    /// The larger of each number and the size of another; NaN where one of them is ([`crate::numerics::size::larger`]).
    #[inline(always)]
    pub fn larger_size(self, other: Self) -> Self {
        self.zip(other, |a, b| larger(a, b.abs()))
    }

    /// A function of every number.
    #[inline(always)]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let [a, b, c, d] = self.0;
        Self([f(a), f(b), f(c), f(d)])
    }

    /// A function of every number and that of another.
    #[inline(always)]
    pub fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let ([a, b, c, d], [p, q, r, s]) = (self.0, other.0);
        Self([f(a, p), f(b, q), f(c, r), f(d, s)])
    }
}

impl Scalar for Lanes {
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
        Self([value; WIDTH])
    }
    #[inline(always)]
    fn by_lane(of: impl FnMut(usize) -> f64) -> Self {
        Self::from_fn(of)
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self.map(|x| x * factor)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn map_smooth(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        self.map(|x| function(x).0)
    }
    #[inline(always)]
    fn map_smooth_many<const K: usize, const M: usize>(
        x: [Self; K],
        mut function: impl FnMut([f64; K]) -> ([f64; M], [[f64; K]; M]),
    ) -> [Self; M] {
        Self::each(x, |x| function(x).0)
    }
    #[inline(always)]
    fn apply<const K: usize, const M: usize>(map: &impl SmoothMap<K, M>, x: [Self; K]) -> [Self; M] {
        map.values(x)
    }
    #[inline(always)]
    fn polynomial<const K: usize>(self, coefficients: &[f64; K]) -> Self {
        let mut value = Self([0.0; WIDTH]);
        for coefficient in coefficients.iter().rev() {
            value = value.zip(self, |value, x| value * x + coefficient);
        }
        value
    }
    #[inline(always)]
    fn where_positive(self, condition: Self, other: Self) -> Self {
        let ([a, b, c, d], [p, q, r, s], [i, j, k, l]) = (self.0, other.0, condition.0);
        let select = |condition: f64, this: f64, other: f64| if condition > 0.0 { this } else { other };
        Self([select(i, a, p), select(j, b, q), select(k, c, r), select(l, d, s)])
    }
    #[inline(always)]
    fn any_beyond(self, fraction: f64, limit: Self) -> bool {
        let ([a, b, c, d], [p, q, r, s]) = (self.0, limit.0);
        let beyond = |lane: f64, limit: f64| lane.any_beyond(fraction, limit);
        beyond(a, p) | beyond(b, q) | beyond(c, r) | beyond(d, s)
    }
    #[inline(always)]
    fn clamp_to(self, low: f64, high: f64) -> Self {
        self.map(|x| x.clamp_to(low, high))
    }
}

impl Values for Lanes {
    #[inline(always)]
    fn each<const K: usize, const M: usize>(
        x: [Self; K],
        mut function: impl FnMut([f64; K]) -> [f64; M],
    ) -> [Self; M] {
        let mut results = [Lanes([0.0; WIDTH]); M];
        let (mut last, mut values) = ([f64::NAN; K], [0.0; M]);
        for lane in 0..WIDTH {
            let arguments = x.map(|component| component.0[lane]);
            // Lanes without a ball of their own repeat another.
            if arguments != last {
                values = function(arguments);
                last = arguments;
            }
            for (result, value) in results.iter_mut().zip(values) {
                result.0[lane] = value;
            }
        }
        results
    }
    #[inline(always)]
    fn each_or_together<const K: usize, const M: usize>(
        x: [Self; K],
        _: impl FnOnce([f64; K]) -> [f64; M],
        together: impl FnOnce([Lanes; K]) -> [Lanes; M],
    ) -> [Self; M] {
        together(x)
    }
    const COUNT: usize = WIDTH;
    #[inline(always)]
    fn lane(&self, lane: usize) -> f64 {
        self.0[lane]
    }
    #[inline(always)]
    fn all(self, condition: impl Fn(f64) -> bool) -> bool {
        self.0.into_iter().all(condition)
    }
    #[inline(always)]
    fn at_least(self, other: Self) -> Self {
        self.zip(other, f64::at_least)
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self {
        self.zip(other, f64::at_most)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn with_sign_of(self, other: Self) -> Self {
        self.zip(other, f64::copysign)
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        self.map(f64::power_of_two)
    }
    #[inline(always)]
    fn mantissa_and_exponent(self) -> (Self, Self) {
        (self.map(|x| x.mantissa_and_exponent().0), self.map(|x| x.mantissa_and_exponent().1))
    }
}

impl num_traits::Zero for Lanes {
    #[inline(always)]
    fn zero() -> Self {
        Self([0.0; WIDTH])
    }
    fn is_zero(&self) -> bool {
        self.0 == [0.0; WIDTH]
    }
}

impl num_traits::One for Lanes {
    #[inline(always)]
    fn one() -> Self {
        Self([1.0; WIDTH])
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $assign:ident $assign_method:ident $operator:tt),*) => {$(
        impl $trait for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $operator b)
            }
        }
        impl $assign for Lanes {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )*};
}
operators!(
    Add add AddAssign add_assign +, Sub sub SubAssign sub_assign -,
    Mul mul MulAssign mul_assign *, Div div DivAssign div_assign /
);
