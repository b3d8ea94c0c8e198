//! A number with derivatives whose operations are calls: less than half of the code of [`Dual`], where each is written out, to the same
//! bits. For what few contacts go through ([`Scalar::Apart`]).

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use super::scalar::{Dual, Scalar, Single, SmoothMap};

/// A number and its derivatives in `N` directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Called<const N: usize>(pub Dual<N>);

macro_rules! operations {
    ($($trait:ident $method:ident $assign:ident $assigned:ident $call:ident $operator:tt),*) => {$(
        #[inline(never)]
        fn $call<const N: usize>(a: &Dual<N>, b: &Dual<N>) -> Dual<N> {
            *a $operator *b
        }

        impl<const N: usize> $trait for Called<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self($call(&self.0, &other.0))
            }
        }

        impl<const N: usize> $assign for Called<N> {
            #[inline(always)]
            fn $assigned(&mut self, other: Self) {
                self.0 = $call(&self.0, &other.0);
            }
        }
    )*};
}
operations!(
    Add add AddAssign add_assign sum +,
    Sub sub SubAssign sub_assign difference -,
    Mul mul MulAssign mul_assign product *,
    Div div DivAssign div_assign quotient /
);

#[inline(never)]
fn scaled<const N: usize>(x: &Dual<N>, factor: f64) -> Dual<N> {
    x.scale(factor)
}

#[inline(never)]
fn root<const N: usize>(x: &Dual<N>) -> Dual<N> {
    x.sqrt()
}

#[inline(never)]
fn composed<const N: usize>(x: &Dual<N>, (value, slope): (f64, f64)) -> Dual<N> {
    x.map_smooth(|_| (value, slope))
}

/// A function with its gradient of several numbers.
#[inline(never)]
fn differential<const N: usize, const K: usize>(
    x: &[Called<N>; K],
    value: f64,
    gradient: &[f64; K],
) -> Called<N> {
    let [one] = Dual::map_smooth_many(x.map(|x| x.0), |_| ([value], [*gradient]));
    Called(one)
}

impl<const N: usize> Neg for Called<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.scale(-1.0)
    }
}

impl<const N: usize> num_traits::Zero for Called<N> {
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }
    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
}

impl<const N: usize> num_traits::One for Called<N> {
    #[inline(always)]
    fn one() -> Self {
        Self::constant(1.0)
    }
}

impl<const N: usize> Single for Called<N> {
    #[inline(always)]
    fn value(self) -> f64 {
        self.0.value
    }
}

impl<const N: usize> Scalar for Called<N> {
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
        Self(Dual::constant(value))
    }
    #[inline(always)]
    fn by_lane(of: impl FnMut(usize) -> f64) -> Self {
        Self(Dual::by_lane(of))
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        Self(scaled(&self.0, factor))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(root(&self.0))
    }
    #[inline(always)]
    fn map_smooth(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        Self(composed(&self.0, function(self.0.value)))
    }
    #[inline(always)]
    fn map_smooth_many<const K: usize, const M: usize>(
        x: [Self; K],
        mut function: impl FnMut([f64; K]) -> ([f64; M], [[f64; K]; M]),
    ) -> [Self; M] {
        let (values, gradient) = function(x.map(Self::value));
        std::array::from_fn(|m| differential(&x, values[m], &gradient[m]))
    }
    #[inline(always)]
    fn apply<const K: usize, const M: usize>(map: &impl SmoothMap<K, M>, x: [Self; K]) -> [Self; M] {
        Self::map_smooth_many(x, |x| map.with_gradient(x))
    }
    #[inline(always)]
    fn polynomial<const K: usize>(self, coefficients: &[f64; K]) -> Self {
        self.map_smooth(|x| {
            let by_itself = Dual { value: x, derivatives: [1.0] }.polynomial(coefficients);
            (by_itself.value, by_itself.derivatives[0])
        })
    }
    #[inline(always)]
    fn where_positive(self, condition: Self, other: Self) -> Self {
        if condition.0.value > 0.0 { self } else { other }
    }
    #[inline(always)]
    fn any_beyond(self, fraction: f64, limit: Self) -> bool {
        self.0.any_beyond(fraction, limit.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_operations_by_calls_have_the_bits_of_those_written_out() {
        fn all<S: Scalar>(x: S, y: S) -> Vec<S> {
            let mut sum = x;
            sum += y;
            sum -= x * y;
            sum *= y - x;
            sum /= x.scale(0.3) + S::one();
            let smooth = S::map_smooth_many([x, y, sum], |[x, y, z]| {
                ([x * y * z, x - z], [[y * z, x * z, x * y], [1.0, 0.0, -1.0]])
            });
            let [product, difference] = smooth;
            vec![
                sum,
                -x / y,
                x.sqrt(),
                y.map_smooth(|y| (y.exp(), y.exp())),
                product,
                difference,
                y.polynomial(&[0.1, -0.2, 0.3, 0.7]),
                (x - y).positive_part() + x.clamp_to(0.0, 0.5),
                S::one_minus(x.square()),
            ]
        }
        let of =
            |k: usize| Dual::<3> { value: 0.7 + 0.6 * k as f64, derivatives: [1.0 - k as f64, 0.3, -2.0] };
        let (x, y) = (of(0), of(1));
        let called = all(x.apart(), y.apart()).into_iter().map(Dual::back).collect::<Vec<_>>();
        let written_out = all(x, y);
        let bits =
            |x: &Dual<3>| [x.value, x.derivatives[0], x.derivatives[1], x.derivatives[2]].map(f64::to_bits);
        assert!(written_out.iter().zip(&called).all(|(one, other)| bits(one) == bits(other)), "{called:?}");
        assert!(x.apart().any_beyond(0.5, y.apart()) && !x.apart().any_beyond(0.6, y.apart()));
    }
}
