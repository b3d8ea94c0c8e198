//! Functions of numbers with derivatives that films are powers of.

use crate::numerics::scalar::Scalar;

/// Natural logarithm of a number above 0.
#[inline(always)]
pub fn ln<S: Scalar>(x: S) -> S {
    x.map_smooth(|x| (x.ln(), 1.0 / x))
}

/// Exponential function.
#[inline(always)]
pub fn exp<S: Scalar>(x: S) -> S {
    x.map_smooth(|x| {
        let value = x.exp();
        (value, value)
    })
}
