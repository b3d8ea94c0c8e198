//! Exponential function, logarithm and what is made of them, to the same bits on every platform, with and without vector instructions, of one
//! number or of several in lanes.
//!
//! The mathematical library of a platform takes one number at a time, and its last digits are its own. Here all is sums, products and
//! quotients in a given order, none of them fused, and selections in place of branches. Reductions and coefficients are those of fdlibm
//! (Sun Microsystems 1993), whose errors are below one unit in the last place.

use super::scalar::{Scalar, SmoothMap, Values};

/// [-] 3/2 of 2^52: a number that this is added to is rounded to a whole one.
const SHIFT: f64 = 6_755_399_441_055_744.0;
/// [-] 2^54, and its exponent.
const ENLARGED: (f64, f64) = (18_014_398_509_481_984.0, 54.0);
/// [-] ln 2 in two parts: products of the first with exponents are exact.
const LN_2: [f64; 2] = [f64::from_bits(0x3fe6_2e42_fee0_0000), f64::from_bits(0x3dea_39ef_3579_3c76)];
/// [-] where the exponential function is infinite and where it is 0, or beyond.
const EXP_RANGE: [f64; 2] = [-746.0, 710.0];
/// [-] polynomial of the exponential function's quotient, by the square of the reduced argument.
const EXP: [f64; 6] = [
    0.0,
    f64::from_bits(0x3fc5_5555_5555_553e),
    f64::from_bits(0xbf66_c16c_16be_bd93),
    f64::from_bits(0x3f11_566a_af25_de2c),
    f64::from_bits(0xbebb_bd41_c5d2_6bf1),
    f64::from_bits(0x3e66_3769_72be_a4d0),
];
/// [-] polynomial of the logarithm, by the square of `(m - 1)/(m + 1)` of its mantissa m.
const LN: [f64; 8] = [
    0.0,
    f64::from_bits(0x3fe5_5555_5555_5593),
    f64::from_bits(0x3fd9_9999_9997_fa04),
    f64::from_bits(0x3fd2_4924_9422_9359),
    f64::from_bits(0x3fcc_71c5_1d8e_78af),
    f64::from_bits(0x3fc7_4664_96cb_03de),
    f64::from_bits(0x3fc3_9a09_d078_c69f),
    f64::from_bits(0x3fc2_f112_df3e_5244),
];
/// [-] the least number above 0.
const LEAST: f64 = f64::from_bits(1);
/// [-] size from which on `1 + x^2` is `x^2`; that of no number above it is needed.
const LARGE: f64 = 1e150;

/// Exponential function.
#[inline(always)]
pub fn exp<S: Scalar>(x: S) -> S {
    let [value] = S::apply(&Exp, [x]);
    value
}

/// Natural logarithm.
#[inline(always)]
pub fn ln<S: Scalar>(x: S) -> S {
    let [value] = S::apply(&Ln, [x]);
    value
}

/// Inverse hyperbolic sine; of sizes up to 8e307.
#[inline(always)]
pub fn asinh<S: Scalar>(x: S) -> S {
    let [value] = S::apply(&Asinh, [x]);
    value
}

/// A power of a number that is not negative: within 1 + |y ln x| units in the last place. No number where both are 0.
#[inline(always)]
pub fn pow(x: f64, y: f64) -> f64 {
    exp(y * ln(x))
}

/// Binary logarithm.
#[inline(always)]
pub fn log2(x: f64) -> f64 {
    ln(x) * std::f64::consts::LOG2_E
}

/// Cube root of a number that is not negative.
#[inline(always)]
pub fn cbrt(x: f64) -> f64 {
    pow(x, 1.0 / 3.0)
}

/// [`exp`], value and slope.
#[derive(Clone, Copy, Debug)]
struct Exp;

impl SmoothMap<1, 1> for Exp {
    #[inline(always)]
    fn values<V: Values>(&self, x: [V; 1]) -> [V; 1] {
        V::each_or_together(x, |[x]| [exp_of_one(x)], |[x]| [Self::of(x)])
    }

    #[inline(always)]
    fn with_gradient(&self, x: [f64; 1]) -> ([f64; 1], [[f64; 1]; 1]) {
        let value = self.values(x);
        (value, [value])
    }
}

/// That of one number is a function of its own: where it is asked for there are derivatives, and it would be compiled for each of many.
#[inline(never)]
fn exp_of_one(x: f64) -> f64 {
    Exp::of(x)
}

impl Exp {
    #[inline(always)]
    fn of<V: Values>(x: V) -> V {
        let [least, most] = EXP_RANGE.map(V::constant);
        // What is no number stays so.
        let x = most.where_positive(x - most, x);
        let x = least.where_positive(least - x, x);
        // To the nearest whole number.
        let shift = V::constant(SHIFT);
        let exponent = x.scale(std::f64::consts::LOG2_E) + shift - shift;
        let (high, low) = (x - exponent.scale(LN_2[0]), exponent.scale(LN_2[1]));
        let rest = high - low;
        let c = rest - rest.square().polynomial(&EXP);
        let value = V::one() - ((low - rest * c / (V::constant(2.0) - c)) - high);
        // In two parts: neither the largest nor the least of results has a factor that is a number.
        let half = exponent.scale(0.5) + shift - shift;
        value * half.power_of_two() * (exponent - half).power_of_two()
    }
}

/// [`ln`], value and slope.
#[derive(Clone, Copy, Debug)]
struct Ln;

impl SmoothMap<1, 1> for Ln {
    #[inline(always)]
    fn values<V: Values>(&self, x: [V; 1]) -> [V; 1] {
        V::each_or_together(x, |[x]| [ln_of_one(x)], |[x]| [Self::of(x)])
    }

    #[inline(always)]
    fn with_gradient(&self, x: [f64; 1]) -> ([f64; 1], [[f64; 1]; 1]) {
        (self.values(x), [[1.0 / x[0]]])
    }
}

/// That of one number, as [`exp_of_one`].
#[inline(never)]
fn ln_of_one(x: f64) -> f64 {
    Ln::of(x)
}

impl Ln {
    #[inline(always)]
    fn of<V: Values>(x: V) -> V {
        // Numbers that are too small for a mantissa of their own are made larger.
        let small = V::constant(f64::MIN_POSITIVE) - x;
        let (mantissa, exponent) = x.scale(ENLARGED.0).where_positive(small, x).mantissa_and_exponent();
        let exponent = (exponent - V::constant(ENLARGED.1)).where_positive(small, exponent);
        let f = mantissa - V::one();
        let s = f / (f + V::constant(2.0));
        let half_square = f.square().scale(0.5);
        let series = s * (half_square + s.square().polynomial(&LN)) + exponent.scale(LN_2[1]);
        let value = exponent.scale(LN_2[0]) - ((half_square - series) - f);
        let value = value.where_positive(V::constant(f64::INFINITY) - x, x);
        // Of 0, and of numbers below it.
        let pole = V::constant(f64::NEG_INFINITY);
        let none = pole.where_positive(x + V::constant(LEAST), V::constant(f64::NAN));
        value.where_positive(x, none)
    }
}

/// [`asinh`], value and slope.
#[derive(Clone, Copy, Debug)]
struct Asinh;

impl SmoothMap<1, 1> for Asinh {
    #[inline(always)]
    fn values<V: Values>(&self, [x]: [V; 1]) -> [V; 1] {
        let size = x.abs();
        let root = (V::one() + size.square()).sqrt();
        let share = V::one().where_positive(size - V::constant(LARGE), size / (V::one() + root));
        let excess = size + size * share;
        // ln(1 + excess), with what rounding takes of the sum.
        let sum = V::one() + excess;
        let lost = (excess - (sum - V::one())) / sum;
        let lost = V::zero().where_positive(sum - V::constant(LARGE), lost);
        [(ln(sum) + lost).with_sign_of(x)]
    }

    #[inline(always)]
    fn with_gradient(&self, x: [f64; 1]) -> ([f64; 1], [[f64; 1]; 1]) {
        let [size] = x.map(f64::abs);
        let root = if size > LARGE { size } else { (1.0 + size * size).sqrt() };
        (self.values(x), [[1.0 / root]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::lanes::Lanes;
    use crate::numerics::scalar::Dual;

    /// Units in the last place between a number and a more exact one, which is given in two parts.
    fn units([high, low]: [f64; 2], number: f64) -> f64 {
        let unit = f64::from_bits(high.abs().to_bits() + 1) - high.abs();
        (((number - high) - low) / unit).abs()
    }

    /// Sum of two numbers, and what rounding takes of it (Knuth).
    fn sum(a: f64, b: f64) -> [f64; 2] {
        let s = a + b;
        let other = s - a;
        [s, (a - (s - other)) + (b - other)]
    }

    /// A product of numbers in two parts (Dekker, with the fused product in place of his splitting).
    fn product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
        let high = a[0] * b[0];
        sum(high, a[0].mul_add(b[0], -high) + (a[0] * b[1] + a[1] * b[0]))
    }

    /// `ln 2` in three parts.
    const LN_2_EXACT: [f64; 2] = [std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17];

    /// The exponential function to some 100 bits: Taylor's series of a 2^-10th part, squared ten times; of arguments from -700 to 700.
    fn exp_in_two(x: f64) -> [f64; 2] {
        let exponent = (x / LN_2_EXACT[0]).round();
        let taken = product([-exponent, 0.0], LN_2_EXACT);
        let [high, low] = sum(x, taken[0]);
        let [high, low] = sum(high, low + taken[1]);
        let part = [high / 1024.0, low / 1024.0];
        let mut power = [1.0, 0.0];
        for n in (1..12).rev() {
            let next = product(power, part);
            let high = next[0] / f64::from(n);
            let low = ((-high).mul_add(f64::from(n), next[0]) + next[1]) / f64::from(n);
            let [s, rest] = sum(1.0, high);
            power = sum(s, rest + low);
        }
        for _ in 0..10 {
            power = product(power, power);
        }
        power.map(|part| part * 2f64.powi(exponent as i32))
    }

    /// The logarithm to some 100 bits, from that of the library and one correction of Newton's method.
    fn ln_in_two(x: f64) -> [f64; 2] {
        let y = x.ln();
        let [high, low] = exp_in_two(-y);
        let [high, low] = product([x, 0.0], [high, low]);
        let excess = (high - 1.0) + low;
        sum(y, excess - 0.5 * excess * excess)
    }

    /// Numbers without a pattern from one to another.
    fn between(from: f64, to: f64, count: u32) -> impl Iterator<Item = f64> {
        let mut seed = 0x9e37_79b9_7f4a_7c15u64;
        (0..count).map(move |_| {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            from + (to - from) * (seed >> 11) as f64 / (1u64 << 53) as f64
        })
    }

    #[test]
    fn independent_values_agree_within_a_unit_in_the_last_place() {
        let mut worst = [0.0f64; 4];
        for (from, to) in [(-0.4, 0.4), (-3.0, 3.0), (-700.0, 700.0)] {
            for x in between(from, to, 100_000) {
                worst[0] = worst[0].max(units(exp_in_two(x), exp(x)));
            }
        }
        for (from, to) in [(0.7, 1.42), (0.9, 1.1), (1e-3, 1e3)] {
            for x in between(from, to, 100_000) {
                worst[1] = worst[1].max(units(ln_in_two(x), ln(x)));
            }
        }
        for power in between(-690.0, 690.0, 100_000) {
            let x = power.exp();
            worst[2] = worst[2].max(units(ln_in_two(x), ln(x)));
        }
        for power in between(-40.0, 300.0, 100_000) {
            let x = power.exp();
            worst[3] = worst[3].max(units([x.asinh(), 0.0], asinh(x)));
        }
        // The library's inverse hyperbolic sine has errors of its own.
        assert!(worst[..3].iter().all(|units| *units < 1.0) && worst[3] < 4.0, "{worst:?}");
    }

    #[test]
    fn closed_form_special_values() {
        let (inf, nan) = (f64::INFINITY, f64::NAN);
        for (x, value) in [(0.0, 1.0), (-0.0, 1.0), (inf, inf), (-inf, 0.0), (710.0, inf), (-746.0, 0.0)] {
            assert_eq!(exp(x), value, "exp {x}");
        }
        for (x, value) in [(1.0, 0.0), (0.0, -inf), (-0.0, -inf), (inf, inf)] {
            assert_eq!(ln(x), value, "ln {x}");
        }
        for (x, value) in [(0.0, 0.0), (inf, inf), (-inf, -inf)] {
            assert_eq!(asinh(x), value, "asinh {x}");
        }
        assert!(exp(nan).is_nan() && [nan, -1.0, -inf, -5e-324].map(ln).iter().all(|y| y.is_nan()));
        assert!(asinh(nan).is_nan());
        // The ends of what is finite, and numbers without a mantissa of their own.
        for x in [709.782_712_893_384, -708.4, -720.5, -744.4] {
            let (own, library) = (exp(x), x.exp());
            assert!(
                (own - library).abs() <= f64::max(2.0 * f64::EPSILON * library, 5e-324),
                "{x}: {own:e} {library:e}"
            );
        }
        for x in [f64::MAX, f64::MIN_POSITIVE, 1e-310, 5e-324] {
            assert!((ln(x) - x.ln()).abs() < f64::EPSILON * x.ln().abs(), "{x}");
        }
        assert_eq!([pow(0.0, 2.5), pow(8.0, 0.0), log2(1.0)], [0.0, 1.0, 0.0]);
        assert!((cbrt(27.0) - 3.0).abs() < 4.0 * f64::EPSILON && (log2(1024.0) - 10.0).abs() < 1e-14);
    }

    /// Bits are the same whatever is computed with what: known ones, one at a time, in lanes, with derivatives.
    #[test]
    fn identity_bits_in_lanes_with_derivatives_and_on_every_platform() {
        let specials = [0.0, -0.0, f64::INFINITY, -745.1, 1e-310, f64::MAX, 1.0, 709.9];
        let numbers: Vec<f64> = specials.into_iter().chain(between(-50.0, 50.0, 10_000)).collect();
        let mut digest = 0u64;
        for x in numbers.as_chunks::<4>().0 {
            let lanes = Lanes(*x);
            let [e, l, a] = [exp(lanes), ln(lanes), asinh(lanes)];
            for (lane, x) in x.iter().enumerate() {
                for (own, lanes) in [exp(*x), ln(*x), asinh(*x)].iter().zip([e, l, a]) {
                    assert!(
                        own.to_bits() == lanes.0[lane].to_bits() || own.is_nan() && lanes.0[lane].is_nan(),
                        "{x}"
                    );
                    if !own.is_nan() {
                        digest = (digest ^ own.to_bits()).wrapping_mul(0x0100_0000_01b3);
                    }
                }
                let dual = Dual::<1>::variable(*x, 0, 1.0);
                assert_eq!(exp(dual).value.to_bits(), exp(*x).to_bits());
                if *x > 1e-300 && x.abs() < 700.0 {
                    let slope = (exp(x + 1e-5 * x) - exp(x - 1e-5 * x)) / (2e-5 * x);
                    assert!((exp(dual).derivatives[0] / slope - 1.0).abs() < 1e-6, "{x}");
                    let slope = (ln(x + 1e-5 * x) - ln(x - 1e-5 * x)) / (2e-5 * x);
                    assert!((ln(dual).derivatives[0] / slope - 1.0).abs() < 1e-9, "{x}");
                    let slope = (asinh(x + 1e-5 * x) - asinh(x - 1e-5 * x)) / (2e-5 * x);
                    assert!((asinh(dual).derivatives[0] / slope - 1.0).abs() < 1e-6, "{x}");
                }
            }
        }
        assert_eq!(digest, 0x750e_5c68_c6b5_605b);
    }
}
