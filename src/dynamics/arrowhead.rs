//! Block elimination of the Newton matrix: one 6x6 block per ball, bordered by the bodies that all balls touch.
//!
//! ```text
//! | A_1           R_1 | | x_1 |   | b_1 |      A_j 6x6 ball, R_j ball by body, L_j body by ball,
//! |      A_2      R_2 | | x_2 | = | b_2 |      D the bodies' own block with their constraints
//! |          ...  ... | | ... |   | ... |
//! | L_1  L_2 ...  D   | | y   |   | c   |      (D - sum L_j A_j^-1 R_j) y = c - sum L_j A_j^-1 b_j
//! ```
//! The matrix is not symmetric (friction), so every block is inverted by LU with pivoting. Cost grows linearly with the
//! number of balls.

use nalgebra::{DMatrix, DVector, Dyn, LU, Matrix6, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// Rows and columns of one ball or one free body in the matrix.
pub const BLOCK: usize = 6;

/// Bodies in the border: inner race, outer race, cage.
pub const BODIES: usize = 3;

/// One ball's part of the matrix. `right[r]` and `left[r]` couple it to the 6 motion unknowns of body r.
#[derive(Clone, Debug)]
pub struct BallBlock {
    /// Ball rows, ball columns.
    pub diagonal: Matrix6<f64>,
    /// Ball rows, body columns.
    pub right: [Matrix6<f64>; BODIES],
    /// Body rows, ball columns.
    pub left: [Matrix6<f64>; BODIES],
}

impl Default for BallBlock {
    fn default() -> Self {
        let zero = Matrix6::zeros();
        Self { diagonal: zero, right: [zero; BODIES], left: [zero; BODIES] }
    }
}

/// The inverted matrix of balls that nothing couples. It is part of the state, as it serves many steps.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct KeptMatrix {
    /// [s] size of the steps that it serves.
    pub step: f64,
    /// Corrections beyond one a step that it has taken after the step that it was made in.
    pub extra_corrections: u64,
    /// By ball; empty while there is none.
    pub balls: Vec<KeptBlock>,
}

/// The inverted block of one ball.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeptBlock {
    /// `A^-1`.
    pub inverse: Matrix6<f64>,
    /// [m] where the ball was, seen from the outer race: the block goes round with its ball.
    pub offset: Vector3<f64>,
}

/// A ball block, solved.
#[derive(Clone, Debug)]
struct Factor {
    /// `A^-1`: a product costs a quarter of two triangular solves.
    inverse: Matrix6<f64>,
    /// `A^-1 R` per body.
    right: [Matrix6<f64>; BODIES],
    left: [Matrix6<f64>; BODIES],
}

/// The factorised matrix.
#[derive(Clone, Debug, Default)]
pub struct Arrowhead {
    balls: Vec<Factor>,
    border: Option<LU<f64, Dyn, Dyn>>,
}

impl Arrowhead {
    /// Factorises. `offsets[r]` is the first border row of body r, `None` where r has no unknowns.
    pub fn factorise(
        &mut self,
        balls: &[&BallBlock],
        border: &DMatrix<f64>,
        offsets: [Option<usize>; BODIES],
    ) {
        self.balls.clear();
        let mut schur = border.clone();
        for block in balls {
            // A singular block shows in `solve`.
            let inverse = block.diagonal.lu().try_inverse().unwrap_or(Matrix6::repeat(f64::NAN));
            let mut right = block.right;
            for (body, offset) in offsets.into_iter().enumerate() {
                if offset.is_some() {
                    right[body] = inverse * block.right[body];
                }
            }
            for (row_body, row) in offsets.into_iter().enumerate() {
                for (column_body, column) in offsets.into_iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column) {
                        let mut view = schur.fixed_view_mut::<BLOCK, BLOCK>(row, column);
                        view -= block.left[row_body] * right[column_body];
                    }
                }
            }
            self.balls.push(Factor { inverse, right, left: block.left });
        }
        self.border = if border.is_empty() { None } else { Some(schur.lu()) };
    }

    /// Solves in place for the right-hand sides of balls and border; false if the matrix is singular.
    pub fn solve(
        &self,
        balls: &mut [Vector6<f64>],
        border: &mut DVector<f64>,
        offsets: [Option<usize>; BODIES],
    ) -> bool {
        for (factor, x) in self.balls.iter().zip(&mut *balls) {
            *x = factor.inverse * *x;
            for (body, offset) in offsets.into_iter().enumerate() {
                if let Some(offset) = offset {
                    let mut rows = border.fixed_rows_mut::<BLOCK>(offset);
                    rows -= factor.left[body] * *x;
                }
            }
        }
        if let Some(lu) = &self.border {
            if !lu.solve_mut(border) {
                return false;
            }
            for (factor, x) in self.balls.iter().zip(&mut *balls) {
                for (body, offset) in offsets.into_iter().enumerate() {
                    if let Some(offset) = offset {
                        *x -= factor.right[body] * border.fixed_rows::<BLOCK>(offset);
                    }
                }
            }
        }
        balls.iter().all(|x| x.iter().all(|v| v.is_finite())) && border.iter().all(|v| v.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reproducible numbers in [-1, 1].
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 1u64;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn closed_form_agrees_with_the_dense_solution() {
        let mut random = numbers();
        let (n_balls, n_border, offsets) = (5, 19, [Some(0), Some(7), Some(13)]);
        let size = BLOCK * n_balls + n_border;
        let mut dense = DMatrix::<f64>::zeros(size, size);
        let mut blocks = vec![BallBlock::default(); n_balls];
        let border_start = BLOCK * n_balls;
        for (j, block) in blocks.iter_mut().enumerate() {
            block.diagonal = Matrix6::from_fn(|i, k| random() + if i == k { 3.0 } else { 0.0 });
            dense.fixed_view_mut::<BLOCK, BLOCK>(BLOCK * j, BLOCK * j).copy_from(&block.diagonal);
            for (body, offset) in [(0, 0), (1, 7), (2, 13)] {
                block.right[body] = Matrix6::from_fn(|_, _| random());
                block.left[body] = Matrix6::from_fn(|_, _| random());
                let at = border_start + offset;
                dense.fixed_view_mut::<BLOCK, BLOCK>(BLOCK * j, at).copy_from(&block.right[body]);
                dense.fixed_view_mut::<BLOCK, BLOCK>(at, BLOCK * j).copy_from(&block.left[body]);
            }
        }
        let border = DMatrix::from_fn(n_border, n_border, |_, _| random());
        dense.view_mut((border_start, border_start), (n_border, n_border)).copy_from(&border);
        let rhs = DVector::from_fn(size, |_, _| random());
        let exact = dense.lu().solve(&rhs).unwrap();

        let mut arrowhead = Arrowhead::default();
        arrowhead.factorise(&blocks.iter().collect::<Vec<_>>(), &border, offsets);
        let mut balls: Vec<_> =
            (0..n_balls).map(|j| rhs.fixed_rows::<BLOCK>(BLOCK * j).into_owned()).collect();
        let mut tail = rhs.rows(border_start, n_border).into_owned();
        assert!(arrowhead.solve(&mut balls, &mut tail, offsets));
        for (j, x) in balls.iter().enumerate() {
            assert!((x - exact.fixed_rows::<BLOCK>(BLOCK * j)).norm() < 1e-12 * exact.norm());
        }
        assert!((tail - exact.rows(border_start, n_border)).norm() < 1e-12 * exact.norm());
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let mut arrowhead = Arrowhead::default();
        arrowhead.factorise(&[&BallBlock::default()], &DMatrix::zeros(0, 0), [None; BODIES]);
        assert!(!arrowhead.solve(&mut [Vector6::repeat(1.0)], &mut DVector::zeros(0), [None; BODIES]));
    }
}
