//! LU decomposition with partial pivoting of small dense matrices, in storage that is kept from one to the next.
//!
//! Operation by operation that of `nalgebra::LU`, which takes memory for every matrix: results are the same to the bit, but for signs of
//! zeros. What is added of zeros is passed over: where few unknowns are coupled, as along a shaft, cost grows with the couplings.

use nalgebra::DMatrix;

/// Rows that are worked with together: columns have a multiple of them, the last ones zero.
const TOGETHER: usize = 4;

/// A factorised square matrix `P A = L U`; before the first, one of no rows.
#[derive(Clone, Debug, Default)]
pub struct KeptLu {
    size: usize,
    /// `L` below its diagonal, which is 1; column by column.
    lower: Vec<f64>,
    /// `U` above its diagonal.
    upper: Vec<f64>,
    /// Diagonal of `U`.
    diagonal: Vec<f64>,
    /// Row that row i was exchanged with in step i: a later one, or itself.
    exchanged: Vec<usize>,
    /// A right-hand side.
    x: Vec<f64>,
    /// Groups of rows where a column of `L` is not zero.
    coupled: Vec<usize>,
}

impl KeptLu {
    /// Factorises a square matrix.
    pub fn factorise(&mut self, matrix: &DMatrix<f64>) {
        let size = matrix.nrows();
        self.factorise_of(size, |k, own| own.copy_from_slice(&matrix.as_slice()[size * k..size * (k + 1)]));
    }

    /// Factorises the part of a square matrix in these rows and columns.
    pub fn factorise_part(&mut self, matrix: &DMatrix<f64>, rows: &[usize]) {
        let size = matrix.nrows();
        self.factorise_of(rows.len(), |k, own| {
            let column = &matrix.as_slice()[size * rows[k]..size * (rows[k] + 1)];
            own.iter_mut().zip(rows).for_each(|(to, row)| *to = column[*row]);
        });
    }

    /// Factorises a matrix of so many rows, whose columns are written one by one.
    fn factorise_of(&mut self, size: usize, write: impl Fn(usize, &mut [f64])) {
        self.size = size;
        let rows = size.next_multiple_of(TOGETHER);
        for list in [&mut self.lower, &mut self.upper] {
            list.clear();
            list.resize(rows * size, 0.0);
        }
        for k in 0..size {
            write(k, &mut self.upper[rows * k..rows * k + size]);
        }
        self.diagonal.resize(size, 0.0);
        self.exchanged.resize(size, 0);
        let Self { lower, upper, diagonal, exchanged, coupled, .. } = self;
        factorise_columns(rows, (lower, upper), diagonal, exchanged, coupled);
    }

    /// Solves in place for a right-hand side; false if the matrix is singular.
    ///
    /// # Panics
    /// If the right-hand side has not as many rows as the matrix.
    #[must_use]
    pub fn solve(&mut self, right: &mut [f64]) -> bool {
        assert_eq!(right.len(), self.size, "rows of a right-hand side");
        let Self { lower, upper, diagonal, exchanged, x, .. } = self;
        x.clear();
        x.extend_from_slice(right);
        x.resize(right.len().next_multiple_of(TOGETHER), 0.0);
        let regular = solve_columns((lower, upper), diagonal, exchanged, x);
        right.copy_from_slice(&x[..right.len()]);
        regular
    }
}

/// Factorises columns with so many rows, which become those of `U`. Compiled twice, as contacts are ([`crate::contact::many`]), like the
/// next one.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn factorise_columns(
    rows: usize,
    (lower, upper): (&mut [f64], &mut [f64]),
    diagonal: &mut [f64],
    exchanged: &mut [usize],
    coupled: &mut Vec<usize>,
) {
    let size = diagonal.len();
    for i in 0..size {
        let (done, rest) = upper.split_at_mut(rows * (i + 1));
        let own = &mut done[rows * i..];
        let (before, coefficients) = lower.split_at_mut(rows * i);
        let mut pivot = i;
        for row in i + 1..size {
            if own[row].abs() > own[pivot].abs() {
                pivot = row;
            }
        }
        exchanged[i] = pivot;
        own.swap(i, pivot);
        diagonal[i] = own[i];
        own[i] = 0.0;
        // A column of zeros is left: the matrix is singular.
        if diagonal[i] == 0.0 {
            continue;
        }
        let inverse = 1.0 / diagonal[i];
        for row in i + 1..size {
            coefficients[row] = own[row] * inverse;
            own[row] = 0.0;
        }
        let from = first_together(i + 1);
        let coefficients = coefficients[from..rows].as_chunks::<TOGETHER>().0;
        coupled.clear();
        let groups = coefficients.iter().enumerate();
        coupled.extend(groups.filter(|(_, group)| **group != [0.0; TOGETHER]).map(|(k, _)| k));
        for column in rest.chunks_exact_mut(rows) {
            column.swap(i, pivot);
            let factor = -column[i];
            if factor == 0.0 {
                continue;
            }
            let column = column[from..].as_chunks_mut::<TOGETHER>().0;
            for k in &*coupled {
                add_together(&mut column[*k], factor, &coefficients[*k]);
            }
        }
        if pivot != i {
            before.chunks_exact_mut(rows).for_each(|column| column.swap(i, pivot));
        }
    }
}

/// Solves in place for a right-hand side; false if the matrix is singular.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn solve_columns(
    (lower, upper): (&[f64], &[f64]),
    diagonal: &[f64],
    exchanged: &[usize],
    x: &mut [f64],
) -> bool {
    let rows = x.len();
    for (i, other) in exchanged.iter().enumerate() {
        x.swap(i, *other);
    }
    for i in 0..diagonal.len() {
        let (factor, from) = (-x[i], first_together(i + 1));
        add(&mut x[from..], factor, &lower[rows * i + from..rows * (i + 1)]);
    }
    for i in (0..diagonal.len()).rev() {
        if diagonal[i] == 0.0 {
            return false;
        }
        x[i] /= diagonal[i];
        let (factor, to) = (-x[i], i.next_multiple_of(TOGETHER));
        add(&mut x[..to], factor, &upper[rows * i..rows * i + to]);
    }
    true
}

/// First of the rows that a row is worked with together.
fn first_together(row: usize) -> usize {
    row - row % TOGETHER
}

/// Adds a multiple of some numbers to others.
#[inline(always)]
fn add(to: &mut [f64], factor: f64, numbers: &[f64]) {
    let (to, numbers) = (to.as_chunks_mut::<TOGETHER>().0, numbers.as_chunks::<TOGETHER>().0);
    for (to, numbers) in to.iter_mut().zip(numbers) {
        add_together(to, factor, numbers);
    }
}

/// Adds a multiple of a group of numbers to another.
#[inline(always)]
fn add_together(to: &mut [f64; TOGETHER], factor: f64, numbers: &[f64; TOGETHER]) {
    for k in 0..TOGETHER {
        to[k] += factor * numbers[k];
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;

    #[test]
    fn identity_bits_are_those_of_the_library() {
        let mut kept = KeptLu::default();
        // Sizes change from one matrix to the next, and every pivot is somewhere else.
        for size in [1, 2, 6, 7, 13, 18, 12, 3] {
            for seed in 0..5 {
                // No row is near a sum of others, and sizes of rows differ.
                let number = |i: usize, k: usize| {
                    let angle = ((3 * i + 1) * (7 * k + 2) + 5 * seed) as f64;
                    angle.sin() * 10f64.powi(i as i32 % 4)
                };
                let matrix = DMatrix::from_fn(size, size, number);
                let mut x = DVector::from_fn(size, |i, _| number(i, size));
                let mut exact = x.clone();
                kept.factorise(&matrix);
                assert!(kept.solve(x.as_mut_slice()) && matrix.lu().solve_mut(&mut exact));
                assert_eq!(x.map(f64::to_bits), exact.map(f64::to_bits), "{size} {seed}");
            }
        }
    }

    #[test]
    fn identity_zeros_that_are_passed_over_change_nothing() {
        let mut kept = KeptLu::default();
        let mut part = KeptLu::default();
        // A chain, whose last two unknowns are coupled to all; rows are exchanged with the next ones.
        for size in [5, 16, 43] {
            let number = |i: usize, k: usize| {
                let coupled = i.abs_diff(k) < 4 || i + 2 >= size || k + 2 >= size;
                if coupled { (((2 * i + 3) * (5 * k + 1)) as f64).sin() } else { 0.0 }
            };
            let matrix = DMatrix::from_fn(size, size, number);
            let mut x = DVector::from_fn(size, |i, _| number(i, i));
            let mut exact = x.clone();
            kept.factorise(&matrix);
            assert!(kept.solve(x.as_mut_slice()) && matrix.clone().lu().solve_mut(&mut exact));
            assert_eq!(x, exact, "{size}");
            // The same rows and columns among others.
            let rows: Vec<_> = (0..size).map(|k| 2 * k + 1).collect();
            let among = DMatrix::from_fn(2 * size, 2 * size, |i, k| {
                if i % 2 + k % 2 == 2 { matrix[(i / 2, k / 2)] } else { 7.0 }
            });
            let mut x = DVector::from_fn(size, |i, _| number(i, i));
            part.factorise_part(&among, &rows);
            assert!(part.solve(x.as_mut_slice()));
            assert_eq!(x, exact, "{size}");
        }
    }

    #[test]
    fn singular_matrices_are_refused_and_no_rows_are_solved() {
        assert!(KeptLu::default().solve(&mut []));
        let mut kept = KeptLu::default();
        kept.factorise(&DMatrix::from_row_slice(3, 3, &[1.0, 0.0, 2.0, 3.0, 0.0, 4.0, 5.0, 0.0, 7.0]));
        assert!(!kept.solve(&mut [1.0, 2.0, 3.0]));
        kept.factorise(&DMatrix::zeros(0, 0));
        assert!(kept.solve(&mut []));
    }
}
