//! Block elimination of an arrowhead matrix: 6x6 blocks on the diagonal, coupled through a border alone.
//!
//! ```text
//! | A_1           R_1 | | x_1 |   | b_1 |      A_j 6x6 block, R_j block by border, L_j border by block,
//! |      A_2      R_2 | | x_2 | = | b_2 |      D the border's own matrix
//! |          ...  ... | | ... |   | ... |
//! | L_1  L_2 ...  D   | | y   |   | c   |      (D - sum L_j A_j^-1 R_j) y = c - sum L_j A_j^-1 b_j
//! ```
//! A block is coupled to six border rows of each of up to [`SLOTS`] members of the border; a bearing has a block per ball
//! and its bodies in the border. The matrix is not symmetric (friction), so every block is inverted by LU with pivoting.
//! Cost grows linearly with the number of blocks.

use nalgebra::{DMatrix, DVector, Dyn, LU, Matrix6, Vector6};

/// Rows and columns of a block.
pub const BLOCK: usize = 6;

/// Members of the border that a block can be coupled to.
pub const SLOTS: usize = 3;

/// First border row of every member that blocks can be coupled to; `None` where it has no unknowns.
pub type Offsets = [Option<usize>; SLOTS];

/// One block with its couplings. `right[k]` and `left[k]` are those to the first six rows of member k of the border.
#[derive(Clone, Debug)]
pub struct Block {
    /// Own rows, own columns.
    pub diagonal: Matrix6<f64>,
    /// Own rows, border columns.
    pub right: [Matrix6<f64>; SLOTS],
    /// Border rows, own columns.
    pub left: [Matrix6<f64>; SLOTS],
}

impl Default for Block {
    fn default() -> Self {
        let zero = Matrix6::zeros();
        Self { diagonal: zero, right: [zero; SLOTS], left: [zero; SLOTS] }
    }
}

/// A block, solved.
#[derive(Clone, Debug)]
struct Factor {
    /// `A^-1`: a product costs a quarter of two triangular solves.
    inverse: Matrix6<f64>,
    /// `A^-1 R` per member of the border.
    right: [Matrix6<f64>; SLOTS],
    left: [Matrix6<f64>; SLOTS],
}

/// The factorised matrix.
#[derive(Clone, Debug, Default)]
pub struct Arrowhead {
    blocks: Vec<Factor>,
    border: Option<LU<f64, Dyn, Dyn>>,
}

impl Arrowhead {
    /// Factorises blocks and border.
    pub fn factorise(&mut self, blocks: &[&Block], border: &DMatrix<f64>, offsets: Offsets) {
        self.blocks.clear();
        let mut schur = border.clone();
        for block in blocks {
            // A singular block shows in `solve`.
            let inverse = block.diagonal.lu().try_inverse().unwrap_or(Matrix6::repeat(f64::NAN));
            let mut right = block.right;
            for (slot, offset) in offsets.into_iter().enumerate() {
                if offset.is_some() {
                    right[slot] = inverse * block.right[slot];
                }
            }
            for (row_slot, row) in offsets.into_iter().enumerate() {
                for (column_slot, column) in offsets.into_iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column) {
                        let mut view = schur.fixed_view_mut::<BLOCK, BLOCK>(row, column);
                        view -= block.left[row_slot] * right[column_slot];
                    }
                }
            }
            self.blocks.push(Factor { inverse, right, left: block.left });
        }
        self.border = if border.is_empty() { None } else { Some(schur.lu()) };
    }

    /// Solves in place for the right-hand sides of blocks and border; false if the matrix is singular.
    pub fn solve(&self, blocks: &mut [Vector6<f64>], border: &mut DVector<f64>, offsets: Offsets) -> bool {
        for (factor, x) in self.blocks.iter().zip(&mut *blocks) {
            *x = factor.inverse * *x;
            for (slot, offset) in offsets.into_iter().enumerate() {
                if let Some(offset) = offset {
                    let mut rows = border.fixed_rows_mut::<BLOCK>(offset);
                    rows -= factor.left[slot] * *x;
                }
            }
        }
        if let Some(lu) = &self.border {
            if !lu.solve_mut(border) {
                return false;
            }
            for (factor, x) in self.blocks.iter().zip(&mut *blocks) {
                for (slot, offset) in offsets.into_iter().enumerate() {
                    if let Some(offset) = offset {
                        *x -= factor.right[slot] * border.fixed_rows::<BLOCK>(offset);
                    }
                }
            }
        }
        blocks.iter().all(|x| x.iter().all(|v| v.is_finite())) && border.iter().all(|v| v.is_finite())
    }
}
