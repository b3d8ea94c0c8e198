//! Block elimination of arrowhead matrices, and of rings in them, against dense elimination.
#![allow(clippy::unwrap_used)]

#[path = "common/random.rs"]
mod random;

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};
use random::Random;
use roulement::numerics::arrowhead::{Arrowhead, BLOCK, Block, SLOTS};
use roulement::numerics::ring::{Link, Ring};

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

#[test]
fn closed_form_rings_agree_with_the_dense_solution() {
    // Every number of blocks, rings that are closed, open, broken, or of single pairs, with a border and without.
    let mut numbers = Random::new(2);
    let mut random = || numbers.symmetric();
    for (n, broken, with_border) in
        (2..8).flat_map(|n| (0..4).flat_map(move |broken| [(n, broken, true), (n, broken, false)]))
    {
        let offsets = if with_border { [Some(0), Some(7), None] } else { [None; SLOTS] };
        let n_border = if with_border { 13 } else { 0 };
        let size = BLOCK * n + n_border;
        let mut dense = DMatrix::<f64>::zeros(size, size);
        let mut blocks = vec![Block::default(); n];
        for (j, block) in blocks.iter_mut().enumerate() {
            block.diagonal = Matrix6::from_fn(|i, k| random() + if i == k { 4.0 } else { 0.0 });
            dense.fixed_view_mut::<BLOCK, BLOCK>(BLOCK * j, BLOCK * j).copy_from(&block.diagonal);
            for (slot, offset) in offsets.into_iter().enumerate() {
                block.right[slot] = Matrix6::from_fn(|_, _| random());
                block.left[slot] = Matrix6::from_fn(|_, _| random());
                if let Some(offset) = offset {
                    let at = BLOCK * n + offset;
                    dense.fixed_view_mut::<BLOCK, BLOCK>(BLOCK * j, at).copy_from(&block.right[slot]);
                    dense.fixed_view_mut::<BLOCK, BLOCK>(at, BLOCK * j).copy_from(&block.left[slot]);
                }
            }
        }
        let all = if n == 2 { 1 } else { n };
        let links: Vec<Link> = (0..all)
            .filter(|block| match broken {
                0 => true,
                1 => *block + 1 < n,
                2 => *block != 1,
                _ => *block == all - 1,
            })
            .map(|block| Link {
                block,
                forward: Matrix6::from_fn(|_, _| random()),
                backward: Matrix6::from_fn(|_, _| random()),
            })
            .collect();
        for link in &links {
            let (here, next) = (BLOCK * link.block, BLOCK * ((link.block + 1) % n));
            dense.fixed_view_mut::<BLOCK, BLOCK>(here, next).copy_from(&link.forward);
            dense.fixed_view_mut::<BLOCK, BLOCK>(next, here).copy_from(&link.backward);
        }
        let border = DMatrix::from_fn(n_border, n_border, |_, _| random());
        dense.view_mut((BLOCK * n, BLOCK * n), (n_border, n_border)).copy_from(&border);
        let rhs = DVector::from_fn(size, |_, _| random());
        let exact = dense.lu().solve(&rhs).unwrap();

        let mut ring = Ring::default();
        ring.factorise(&blocks.iter().collect::<Vec<_>>(), &links, &border, offsets);
        let mut balls: Vec<_> = (0..n).map(|j| rhs.fixed_rows::<BLOCK>(BLOCK * j).into_owned()).collect();
        let mut tail = rhs.rows(BLOCK * n, n_border).into_owned();
        assert!(ring.solve(&mut balls, &mut tail, offsets));
        let error = balls
            .iter()
            .enumerate()
            .map(|(j, x)| (x - exact.fixed_rows::<BLOCK>(BLOCK * j)).norm())
            .chain([(tail - exact.rows(BLOCK * n, n_border)).norm()])
            .fold(0.0, f64::max);
        // The worst of these random matrices loses four digits.
        assert!(error < 1e-10 * exact.norm(), "{n} {broken} {with_border}: {error}");
    }
    let mut ring = Ring::default();
    ring.factorise(&[&Block::default()], &[], &DMatrix::zeros(0, 0), [None; SLOTS]);
    assert!(!ring.solve(&mut [Vector6::repeat(1.0)], &mut DVector::zeros(0), [None; SLOTS]));
}
