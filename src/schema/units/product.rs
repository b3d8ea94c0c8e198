//! Products of units, exact until the end.

use super::known::Known;

/// Two, and pi, as an `f64` and what is left.
const TWO: [f64; 2] = [2.0, 0.0];
const PI: [f64; 2] = [std::f64::consts::PI, 1.224_646_799_147_353_2e-16];

/// A product of units: its exponents, and its size in SI as a fraction of whole numbers and powers of pi and of turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Product {
    /// Exponents of m, kg, s, K and of angles.
    pub exponents: [i32; 5],
    /// How many of the angles are turns.
    pub turns: i32,
    /// Numerator of the size, without common divisor.
    pub numerator: u128,
    /// Divisor of the size.
    pub divisor: u128,
    pi: i32,
}

impl Product {
    /// No unit.
    pub const ONE: Self = Self { exponents: [0; 5], turns: 0, numerator: 1, divisor: 1, pi: 0 };

    /// A unit times a power of ten.
    pub fn of(known: &Known, ten: i32) -> Option<Self> {
        let [numerator, divisor] = known.factor.map(u128::from);
        let unit = Self {
            exponents: known.exponents.map(i32::from),
            turns: i32::from(known.turns),
            numerator,
            divisor,
            pi: i32::from(known.pi),
        };
        let power = 10u128.checked_pow(ten.unsigned_abs())?;
        unit.times(if ten < 0 {
            Self { divisor: power, ..Self::ONE }
        } else {
            Self { numerator: power, ..Self::ONE }
        })
    }

    /// The product with another; none where a number of it has more than 38 digits.
    pub fn times(self, other: Self) -> Option<Self> {
        // Crosswise without common divisors, so is the product.
        let (a, d) = reduced(self.numerator, other.divisor);
        let (c, b) = reduced(other.numerator, self.divisor);
        let mut exponents = self.exponents;
        exponents.iter_mut().zip(other.exponents).for_each(|(sum, exponent)| *sum += exponent);
        Some(Self {
            exponents,
            turns: self.turns + other.turns,
            numerator: a.checked_mul(c)?,
            divisor: b.checked_mul(d)?,
            pi: self.pi + other.pi,
        })
    }

    /// One over it.
    pub fn reciprocal(self) -> Self {
        Self {
            exponents: self.exponents.map(|exponent| -exponent),
            turns: -self.turns,
            numerator: self.divisor,
            divisor: self.numerator,
            pi: -self.pi,
        }
    }

    /// A power of it, which may be negative.
    pub fn power(self, exponent: i32) -> Option<Self> {
        let base = if exponent < 0 { self.reciprocal() } else { self };
        (0..exponent.abs()).try_fold(Self::ONE, |product, _| product.times(base))
    }

    /// The size as the nearest `f64`; a turn is 2 pi rad.
    pub fn factor(&self) -> f64 {
        let (mut over, mut under) = (double(self.numerator), double(self.divisor));
        for (power, factor) in [(self.turns, TWO), (self.turns + self.pi, PI)] {
            let side = if power < 0 { &mut under } else { &mut over };
            (0..power.abs()).for_each(|_| *side = times(*side, factor));
        }
        let quotient = over[0] / under[0];
        let rest = (-quotient).mul_add(under[0], over[0]) + over[1] - quotient * under[1];
        quotient + rest / under[0]
    }
}

/// Two numbers over their greatest common divisor.
fn reduced(a: u128, b: u128) -> (u128, u128) {
    let (mut divisor, mut rest) = (a, b);
    while rest != 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    (a / divisor, b / divisor)
}

/// A whole number as an `f64` and what is left.
fn double(whole: u128) -> [f64; 2] {
    let high = whole as f64;
    let back = high as u128;
    [high, if back > whole { -((back - whole) as f64) } else { (whole - back) as f64 }]
}

/// The product of two such sums.
fn times([a, a_rest]: [f64; 2], [b, b_rest]: [f64; 2]) -> [f64; 2] {
    let product = a * b;
    [product, a.mul_add(b, -product) + a * b_rest + a_rest * b]
}
