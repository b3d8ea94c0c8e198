//! Unknowns of a small dense system that are eliminated before the others, in storage that is kept.
//!
//! ```text
//! | A  R | | x |   | b |      A rows and columns of the own unknowns x, D of the others y
//! | L  D | | y | = | c |      (D - L A^-1 R) y = c - L A^-1 b,   x = A^-1 b - A^-1 R y
//! ```
//! Own rows may lie anywhere among the others, and all stay where they are. `A` is factorised with pivoting.

use nalgebra::{DMatrix, DVector};

use super::kept_lu::KeptLu;

/// A system whose own unknowns are eliminated; before the first, one without any.
#[derive(Clone, Debug, Default)]
pub struct Condensed {
    own: Vec<usize>,
    others: Vec<usize>,
    lu: KeptLu,
    /// `A^-1 R`, column by column.
    right: Vec<f64>,
    /// `L`, row by row.
    left: Vec<f64>,
    /// Right-hand sides of the own rows.
    x: Vec<f64>,
}

impl Condensed {
    /// Factorises the own rows and columns of a square matrix, and leaves those of the others without them. A singular matrix shows
    /// in [`Condensed::eliminate`].
    pub fn factorise(&mut self, matrix: &mut DMatrix<f64>, is_own: impl Fn(usize) -> bool) {
        let Self { own, others, lu, right, left, .. } = self;
        let size = matrix.nrows();
        own.clear();
        own.extend((0..size).filter(|row| is_own(*row)));
        others.clear();
        others.extend((0..size).filter(|row| !is_own(*row)));
        lu.factorise_part(matrix, own);
        left.clear();
        right.clear();
        if own.is_empty() {
            return;
        }
        left.extend(others.iter().flat_map(|i| own.iter().map(|k| matrix[(*i, *k)])));
        right.extend(others.iter().flat_map(|k| own.iter().map(|i| matrix[(*i, *k)])));
        for (follows, k) in right.chunks_exact_mut(own.len()).zip(&*others) {
            // Of a singular matrix nothing is left that is of use.
            if !lu.solve(follows) {
                follows.fill(f64::NAN);
            }
            for (taken, i) in left.chunks_exact(own.len()).zip(&*others) {
                matrix[(*i, *k)] -= product(taken, follows);
            }
        }
    }

    /// Solves the own rows alone, and takes them out of the others' right-hand sides; false if the matrix is singular.
    #[must_use]
    pub fn eliminate(&mut self, x: &mut DVector<f64>) -> bool {
        let Self { own, others, lu, left, x: alone, .. } = self;
        if own.is_empty() {
            return true;
        }
        alone.clear();
        alone.extend(own.iter().map(|row| x[*row]));
        let regular = lu.solve(alone);
        own.iter().zip(&*alone).for_each(|(row, value)| x[*row] = *value);
        for (taken, row) in left.chunks_exact(own.len()).zip(&*others) {
            x[*row] -= product(taken, alone);
        }
        regular
    }

    /// The own unknowns from the others, after [`Condensed::eliminate`].
    pub fn substitute(&self, x: &mut DVector<f64>) {
        let Self { own, others, right, .. } = self;
        for (follows, other) in right.chunks_exact(own.len().max(1)).zip(others) {
            let by = x[*other];
            own.iter().zip(follows).for_each(|(row, follows)| x[*row] -= follows * by);
        }
    }
}

/// Scalar product of two lists, from the first to the last.
#[inline(always)]
fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number between -1 and 1 without a pattern in rows and columns.
    fn number(i: usize, k: usize) -> f64 {
        (((3 * i + 1) * (7 * k + 2)) as f64).sin()
    }

    #[test]
    fn closed_form_solutions_are_those_of_the_dense_matrix() {
        let mut condensed = Condensed::default();
        // None is own, all are, some here and there; more of them, then fewer. Own rows need a pivot off the diagonal.
        for (size, own) in [(12, vec![]), (18, (6..18).collect()), (7, (0..7).collect()), (9, vec![1, 4, 7])]
        {
            let pivotless = own.first().copied();
            let entry = |i, k| if pivotless == Some(i) && i == k { 0.0 } else { number(i, k) };
            let matrix = DMatrix::from_fn(size, size, entry);
            let mut x = DVector::from_fn(size, |i, _| number(i, size));
            let exact = matrix.clone().lu().solve(&x).unwrap_or_else(|| DVector::repeat(size, f64::NAN));
            let mut left = matrix.clone();
            condensed.factorise(&mut left, |row| own.contains(&row));
            assert!(condensed.eliminate(&mut x));
            let others: Vec<_> = (0..size).filter(|row| !own.contains(row)).collect();
            let mut rest = KeptLu::default();
            rest.factorise_part(&left, &others);
            let mut y: Vec<_> = others.iter().map(|row| x[*row]).collect();
            assert!(rest.solve(&mut y));
            others.iter().zip(&y).for_each(|(row, value)| x[*row] = *value);
            condensed.substitute(&mut x);
            // The worst of these matrices has a condition of some hundreds.
            assert!((&x - &exact).norm() < 1e-12 * exact.norm(), "{size} {own:?}: {}", (x - &exact).norm());
        }
    }

    #[test]
    fn singular_own_rows_are_refused() {
        let mut condensed = Condensed::default();
        let mut matrix = DMatrix::from_fn(6, 6, |i, k| if (i, k) == (3, 3) { 0.0 } else { number(i, k) });
        condensed.factorise(&mut matrix, |row| row == 3);
        assert!(!condensed.eliminate(&mut DVector::repeat(6, 1.0)));
        assert!(matrix[(0, 0)].is_nan());
    }
}
