//! Eigenvalues of a matrix that need not be symmetric, with their vectors.
//!
//! The matrix is balanced by powers of two, so that units and stiff parts do not spoil the small eigenvalues: by Euclid's norms of
//! whole rows and columns, as sums without the diagonal blow up couplings that are rounding alone (James, Langou and Lowery 2014).
//! It is brought to Schur's form `Q T Q^T`, T upper triangular but for 2 x 2 blocks. From there each vector takes one substitution.

use nalgebra::{Complex, DMatrix, DVector, Schur};

/// Iterations of Schur's form for each row, at most.
const ITERATIONS: usize = 100;
/// Rounds of balancing, at most: two or three do.
const ROUNDS: usize = 20;
/// [-] sizes over that of the matrix below which entries beside the diagonal count as 0, tried one after the other where the iteration does not
/// end with the usual one.
const SMALL: [f64; 4] = [1e-14, 1e-13, 1e-12, 1e-11];
/// [-] how much smaller the sum of a row's and a column's size has to become for a round to go on.
const PROGRESS: f64 = 0.95;

/// An eigenvalue and its vector.
#[derive(Clone, Debug)]
pub struct Eigenpair {
    /// The eigenvalue.
    pub value: Complex<f64>,
    /// Its vector, of no particular size.
    pub vector: DVector<Complex<f64>>,
}

/// The real eigenvalues that are `wanted`, and of each such conjugate pair that with the positive imaginary part, with their vectors. None where a
/// number is not finite, or where the iteration does not end.
pub fn eigenpairs(matrix: &DMatrix<f64>, wanted: impl Fn(Complex<f64>) -> bool) -> Option<Vec<Eigenpair>> {
    if matrix.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let size = matrix.nrows();
    let (balanced, scales) = balance(matrix.clone());
    let (q, t) = schur(&balanced)?;
    // Substitutions go along rows of T.
    let rows = t.transpose();
    let mut found = vec![];
    let mut row = 0;
    // What a difference of eigenvalues is at least: eigenvalues that are the same have vectors that are nearly so.
    let least = f64::EPSILON * t.amax().max(f64::MIN_POSITIVE);
    while row < size {
        let pair = row + 1 < size && t[(row + 1, row)] != 0.0;
        let values = if pair { block_eigenvalues(&t, row) } else { vec![Complex::from(t[(row, row)])] };
        for value in values.into_iter().filter(|value| wanted(*value)) {
            let of_t = triangular_vector((&t, &rows, least), (row, pair), value);
            let part = |of: fn(&Complex<f64>) -> f64| q.columns(0, of_t.len()) * of_t.map(|value| of(&value));
            let (re, im) = (part(|value| value.re), part(|value| value.im));
            let vector = DVector::from_fn(size, |i, _| Complex::new(re[i], im[i]) * scales[i]);
            found.push(Eigenpair { value, vector });
        }
        row += if pair { 2 } else { 1 };
    }
    Some(found)
}

/// Schur's form: Q and T. nalgebra takes an entry for 0 that is small beside its neighbours on the diagonal. Where these are nearly 0 themselves,
/// as of balls along their orbits, rounding alone is larger: with a shift of the size of the matrix entries are compared with that.
fn schur(matrix: &DMatrix<f64>) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
    let most = ITERATIONS * matrix.nrows().max(1);
    let shift = matrix.norm();
    let moved = |by: f64, mut matrix: DMatrix<f64>| {
        (0..matrix.nrows()).for_each(|i| matrix[(i, i)] += by);
        matrix
    };
    let shifted = |small| {
        let (q, t) = Schur::try_new(moved(shift, matrix.clone()), small, most)?.unpack();
        Some((q, moved(-shift, t)))
    };
    let usual = Schur::try_new(matrix.clone(), f64::EPSILON, most).map(Schur::unpack);
    usual.or_else(|| SMALL.into_iter().find_map(shifted))
}

/// `D^-1 A D` whose rows and columns are of a size, and the diagonal of D.
fn balance(mut matrix: DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let size = matrix.nrows();
    let mut scales = DVector::repeat(size, 1.0);
    for _ in 0..ROUNDS {
        let mut done = true;
        for i in 0..size {
            let (column, row) = (matrix.column(i).norm(), matrix.row(i).norm());
            if column == 0.0 || row == 0.0 {
                continue;
            }
            let factor = (0.5 * (row / column).log2()).round().exp2();
            if (column * factor).hypot(row / factor) < PROGRESS * column.hypot(row) {
                done = false;
                scales[i] *= factor;
                matrix.column_mut(i).scale_mut(factor);
                matrix.row_mut(i).scale_mut(1.0 / factor);
            }
        }
        if done {
            break;
        }
    }
    (matrix, scales)
}

/// Eigenvalues of the 2 x 2 block at a row: both where they are real, that with the positive imaginary part where they are not.
fn block_eigenvalues(t: &DMatrix<f64>, row: usize) -> Vec<Complex<f64>> {
    let (a, b, c, d) = (t[(row, row)], t[(row, row + 1)], t[(row + 1, row)], t[(row + 1, row + 1)]);
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let square = half * half + b * c;
    if square < 0.0 {
        return vec![Complex::new(mean, (-square).sqrt())];
    }
    let root = square.sqrt();
    vec![Complex::from(mean + root), Complex::from(mean - root)]
}

/// The vector of an eigenvalue of a matrix in Schur's form whose block begins at a row, and has two rows if it is a `pair`: what there is of it
/// up to that block, below which it is 0. With the transposed matrix, and what differences of eigenvalues are at least.
fn triangular_vector(
    (t, rows, least): (&DMatrix<f64>, &DMatrix<f64>, f64),
    (row, pair): (usize, bool),
    value: Complex<f64>,
) -> DVector<Complex<f64>> {
    let apart = |difference: Complex<f64>| {
        if difference.norm() < least { Complex::from(least) } else { difference }
    };
    let last = if pair { row + 1 } else { row };
    let mut vector = DVector::from_element(last + 1, Complex::from(0.0));
    vector[row] = Complex::from(1.0);
    if pair {
        // The row of the block below: its first entry is not 0.
        vector[row] = (value - t[(row + 1, row + 1)]) / t[(row + 1, row)];
        vector[row + 1] = Complex::from(1.0);
    }
    let right_side = |vector: &DVector<Complex<f64>>, i: usize, from: usize| {
        let entries = rows.view((from, i), (last + 1 - from, 1));
        let products = vector.rows_range(from..).into_iter().zip(entries.iter());
        products.fold(Complex::from(0.0), |sum, (entry, of_row)| sum - entry * *of_row)
    };
    let mut i = row;
    while i > 0 {
        i -= 1;
        if i > 0 && t[(i, i - 1)] != 0.0 {
            let (above, below) = (right_side(&vector, i - 1, i + 1), right_side(&vector, i, i + 1));
            let (a, b) = (value - t[(i - 1, i - 1)], t[(i - 1, i)]);
            let (c, d) = (t[(i, i - 1)], value - t[(i, i)]);
            let determinant = apart(a * d - Complex::from(b * c));
            vector[i - 1] = -(above * d + below * b) / determinant;
            vector[i] = -(above * c + below * a) / determinant;
            i -= 1;
        } else {
            vector[i] = -right_side(&vector, i, i + 1) / apart(value - t[(i, i)]);
        }
    }
    vector
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [-] what is left of `A x - lambda x` over the size of both.
    fn left(matrix: &DMatrix<f64>, pair: &Eigenpair) -> f64 {
        let complex = matrix.map(Complex::from);
        let residual = &complex * &pair.vector - &pair.vector * pair.value;
        residual.norm() / (matrix.norm() * pair.vector.norm())
    }

    #[test]
    fn closed_form_eigenvalues_of_blocks_with_known_ones() {
        // Pairs -1 +- 2 i and 3 +- 0.5 i, and the real values 7, -4 and 0, mixed by a similarity.
        let blocks = [(-1.0, 2.0), (3.0, 0.5)];
        let mut known = DMatrix::zeros(7, 7);
        for (k, (re, im)) in blocks.into_iter().enumerate() {
            let at = 2 * k;
            (known[(at, at)], known[(at + 1, at + 1)]) = (re, re);
            (known[(at, at + 1)], known[(at + 1, at)]) = (im, -im);
        }
        (known[(4, 4)], known[(5, 5)]) = (7.0, -4.0);
        let mix =
            DMatrix::from_fn(7, 7, |i, k| 1.0 / (1.0 + (i * i + 3 * k) as f64) + f64::from(u8::from(i == k)));
        let matrix = &mix * known * mix.clone().try_inverse().unwrap();
        let found = eigenpairs(&matrix, |_| true).unwrap();
        assert_eq!(found.len(), 5);
        let expected = [(-1.0, 2.0), (3.0, 0.5), (7.0, 0.0), (-4.0, 0.0), (0.0, 0.0)];
        for (re, im) in expected {
            let wanted = Complex::new(re, im);
            let nearest = found.iter().map(|pair| (pair.value - wanted).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-12, "{wanted} {nearest:e}");
        }
        let growing = eigenpairs(&matrix, |value| value.re > 1e-6).unwrap();
        assert_eq!(growing.iter().map(|pair| pair.value.re.round()).sum::<f64>(), 10.0);
        for pair in found.iter().chain(&growing) {
            assert!(left(&matrix, pair) < 1e-14, "{} {:e}", pair.value, left(&matrix, pair));
        }
    }

    #[test]
    fn invariant_eigenvalues_do_not_change_with_units() {
        // A chain of masses with dampers, its coordinates in units that differ by up to 1e12.
        let size = 40;
        let chain = DMatrix::from_fn(size, size, |i, k| match i.abs_diff(k) {
            0 => -0.3 * i as f64,
            1 => {
                if i < k {
                    2.0 + i as f64
                } else {
                    -3.0
                }
            }
            _ => 0.0,
        });
        let units = DVector::from_fn(size, |i, _| 10f64.powi((i % 7) as i32 * 2 - 6));
        let other = DMatrix::from_fn(size, size, |i, k| chain[(i, k)] * units[i] / units[k]);
        let sorted = |matrix: &DMatrix<f64>| {
            let mut values: Vec<_> =
                eigenpairs(matrix, |_| true).unwrap().into_iter().map(|pair| pair.value).collect();
            values.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
            values
        };
        let (own, others) = (sorted(&chain), sorted(&other));
        assert_eq!(own.len(), others.len());
        let largest = chain.norm();
        for (a, b) in own.iter().zip(&others) {
            assert!((a - b).norm() < 1e-12 * largest, "{a} {b}");
        }
        assert!(eigenpairs(&DMatrix::repeat(2, 2, f64::NAN), |_| true).is_none());
    }
}
