//! Block elimination of arrowhead matrices against dense elimination.
#![allow(clippy::unwrap_used)]

#[path = "common/random.rs"]
mod random;

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};
use random::Random;
use roulement::numerics::arrowhead::{Arrowhead, BLOCK, Block, SLOTS};

#[test]
fn closed_form_agrees_with_the_dense_solution() {
    let mut numbers = Random::new(1);
    let mut random = || numbers.symmetric();
    let (n_balls, n_border, offsets) = (5, 19, [Some(0), Some(7), Some(13)]);
    let size = BLOCK * n_balls + n_border;
    let mut dense = DMatrix::<f64>::zeros(size, size);
    let mut blocks = vec![Block::default(); n_balls];
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
    let mut balls: Vec<_> = (0..n_balls).map(|j| rhs.fixed_rows::<BLOCK>(BLOCK * j).into_owned()).collect();
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
    arrowhead.factorise(&[&Block::default()], &DMatrix::zeros(0, 0), [None; SLOTS]);
    assert!(!arrowhead.solve(&mut [Vector6::repeat(1.0)], &mut DVector::zeros(0), [None; SLOTS]));
}
