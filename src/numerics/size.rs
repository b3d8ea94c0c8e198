//! Sizes that do not lose a NaN: what is not a number must not look like a small one; and orders by size.

/// The larger of two numbers; NaN if one of them is (`f64::max` gives the other one).
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Largest absolute value; NaN if a number is (nalgebra's `amax` drops it), 0 of none.
#[inline(always)]
pub fn largest<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> f64 {
    numbers.into_iter().fold(0.0, |largest, number| larger(largest, number.abs()))
}

/// Indices of numbers from the smallest to the largest, equal ones in the order that they have. One function for all who sort by a number: each sort of
/// its own takes 8 kB in a package.
pub fn ascending(numbers: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    order.sort_by(|a, b| numbers[*a].total_cmp(&numbers[*b]));
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nan_is_the_largest_wherever_it_stands() {
        assert_eq!((largest(&[1.0, -3.0, 2.0]), largest(&[])), (3.0, 0.0));
        for numbers in [[f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::NAN], [f64::NAN; 3]] {
            assert!(largest(&numbers).is_nan(), "{numbers:?}");
        }
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan());
        assert_eq!(largest(&[1.0, f64::NEG_INFINITY]), f64::INFINITY);
    }

    #[test]
    fn equal_numbers_keep_their_order() {
        assert_eq!(ascending(&[2.0, -1.0, 2.0, f64::INFINITY, -1.0]), [1, 4, 0, 2, 3]);
    }
}
