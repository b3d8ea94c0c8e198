//! Square matrices of few numbers, as those of a shaft along its stations: what is done with them passes over zeros.

use std::ops::{Deref, Mul};

use nalgebra::{DMatrix, DVector};

/// Rows that are worked with together.
const TOGETHER: usize = 4;

/// A square matrix, and where it is not zero.
#[derive(Clone, Debug)]
pub struct Sparse {
    dense: DMatrix<f64>,
    /// Groups of rows that are not all zero, column by column.
    groups: Vec<Group>,
    /// End of each column among them.
    ends: Vec<usize>,
}

/// Some rows of a column.
#[derive(Clone, Copy, Debug)]
struct Group {
    /// Number of the group: its first row over [`TOGETHER`].
    at: usize,
    /// Entries; zero beyond the last row.
    entries: [f64; TOGETHER],
}

impl From<DMatrix<f64>> for Sparse {
    fn from(dense: DMatrix<f64>) -> Self {
        let (mut groups, mut ends) = (vec![], vec![]);
        for column in dense.column_iter() {
            for at in 0..dense.nrows().div_ceil(TOGETHER) {
                let entries = std::array::from_fn(|i| column.get(TOGETHER * at + i).copied().unwrap_or(0.0));
                if entries != [0.0; TOGETHER] {
                    groups.push(Group { at, entries });
                }
            }
            ends.push(groups.len());
        }
        Self { dense, groups, ends }
    }
}

impl Deref for Sparse {
    type Target = DMatrix<f64>;
    fn deref(&self) -> &DMatrix<f64> {
        &self.dense
    }
}

impl Sparse {
    /// Groups of each column.
    fn columns(&self) -> impl Iterator<Item = &[Group]> {
        let mut from = 0;
        self.ends.iter().map(move |end| &self.groups[std::mem::replace(&mut from, *end)..*end])
    }

    /// Adds a multiple to a part of a larger matrix, on its diagonal from a row on.
    pub fn add_to(&self, factor: f64, matrix: &mut DMatrix<f64>, from: usize) {
        for (k, groups) in self.columns().enumerate() {
            let mut column = matrix.column_mut(from + k);
            let column = &mut column.as_mut_slice()[from..];
            for Group { at, entries } in groups {
                let rows = &mut column[TOGETHER * at..];
                rows.iter_mut().zip(entries).for_each(|(row, entry)| *row += factor * entry);
            }
        }
    }
}

/// The product with a vector, to the bits of the dense one but for signs of zeros.
impl Mul<&DVector<f64>> for &Sparse {
    type Output = DVector<f64>;
    fn mul(self, x: &DVector<f64>) -> DVector<f64> {
        let size = self.dense.nrows();
        assert_eq!(x.len(), size, "rows of a vector");
        let mut product = vec![0.0; size.next_multiple_of(TOGETHER)];
        add_columns(&self.groups, &self.ends, x.as_slice(), product.as_chunks_mut::<TOGETHER>().0);
        product.truncate(size);
        DVector::from_vec(product)
    }
}

/// Adds each column times its factor to rows. Compiled twice, as contacts are ([`crate::contact::many`]).
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn add_columns(groups: &[Group], ends: &[usize], factors: &[f64], rows: &mut [[f64; TOGETHER]]) {
    let mut from = 0;
    for (end, factor) in ends.iter().zip(factors) {
        for Group { at, entries } in &groups[from..*end] {
            let row = &mut rows[*at];
            for k in 0..TOGETHER {
                row[k] += entries[k] * factor;
            }
        }
        from = *end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identity_products_and_sums_are_those_of_the_dense_matrix() {
        for (size, reach) in [(0, 0), (1, 1), (5, 5), (23, 3), (24, 9)] {
            let entry = |i: usize, k: usize| {
                if i.abs_diff(k) < reach { ((3 * i + 1) * (7 * k + 2)) as f64 } else { 0.0 }
            };
            let dense = DMatrix::from_fn(size, size, |i, k| entry(i, k).sin());
            let x = DVector::from_fn(size, |i, _| (i as f64 + 0.5).cos());
            let sparse = Sparse::from(dense.clone());
            assert_eq!((&sparse * &x), &dense * &x, "{size} {reach}");
            let (mut sum, mut exact) =
                (DMatrix::repeat(size + 7, size + 7, 1.5), DMatrix::repeat(size + 7, size + 7, 1.5));
            sparse.add_to(-0.7, &mut sum, 3);
            let mut part = exact.view_mut((3, 3), (size, size));
            part += &dense * -0.7;
            assert_eq!(sum, exact, "{size} {reach}");
        }
    }
}
