//! Block elimination of arrowhead matrices, and of rings in them, against dense elimination.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Rotation3, Vector3, Vector6};
use roulement::numerics::arrowhead::{Arrowhead, BLOCK, Block, Eliminated, Member, SLOTS, Six};
use roulement::numerics::kept_lu::KeptLu;
use roulement::numerics::lanes::{Lanes, WIDTH};
use roulement::numerics::orbit_turn::OrbitTurn;
use roulement::numerics::ring::{Link, Ring};
use roulement::numerics::scalar::Scalar;

use crate::random::Random;

/// Turns the last three of six rows.
fn turned(axes: &Matrix3<f64>) -> Matrix6<f64> {
    let mut all = Matrix6::identity();
    all.fixed_view_mut::<3, 3>(3, 3).copy_from(axes);
    all
}

/// A turn about x of both vectors of six rows.
fn about_x(angle: f64) -> Matrix6<f64> {
    let turn = *Rotation3::from_axis_angle(&Vector3::x_axis(), angle).matrix();
    let mut all = turned(&turn);
    all.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
    all
}

/// Solves in place for a right-hand side; false if the matrix is singular.
fn solve(matrix: &DMatrix<f64>, right: &mut DVector<f64>) -> bool {
    let mut lu = KeptLu::default();
    lu.factorise(matrix);
    lu.solve(right.as_mut_slice())
}

#[test]
fn closed_form_agrees_with_the_dense_solution() {
    let mut numbers = Random::new(1);
    let mut random = || numbers.symmetric();
    // Blocks are eliminated in one place and used in another, by members that have turned since.
    // The last border row may be that of an unknown that all blocks share.
    for (n_balls, offsets, shares) in [
        (5, vec![0, 7, 13], false),
        (3, vec![0], false),
        (4, vec![], false),
        (5, vec![0, 7, 13], true),
        (6, vec![], true),
    ] {
        let n_border = if offsets.is_empty() { usize::from(shares) } else { 20 };
        let shared = shares.then(|| n_border - 1);
        let border_start = BLOCK * n_balls;
        let size = border_start + n_border;
        let mut dense = DMatrix::<f64>::zeros(size, size);
        let members = |random: &mut dyn FnMut() -> f64| -> Vec<Member> {
            let mut member = |(slot, from): (usize, &usize)| {
                let axes = Rotation3::new(Vector3::from_fn(|_, _| 2.0 * random()));
                Member { slot, from: *from, axes: axes.into_inner() }
            };
            offsets.iter().enumerate().map(&mut member).collect()
        };
        let (then, now) = (members(&mut random), members(&mut random));
        let mut border = DMatrix::from_fn(n_border, n_border, |_, _| random());
        dense.view_mut((border_start, border_start), (n_border, n_border)).copy_from(&border);
        let groups = n_balls.div_ceil(WIDTH);
        let mut blocks = vec![Eliminated::none(offsets.len(), shares); groups];
        let mut ends = vec![Vector3::y(); WIDTH * groups];
        for j in 0..n_balls {
            let mut block = Block::default();
            let angle = 3.0 * random();
            let turn = about_x(angle);
            let diagonal = Matrix6::from_fn(|i, k| random() + if i == k { 3.0 } else { 0.0 });
            block.diagonal = diagonal;
            let own = turn * diagonal * turn.transpose();
            dense.fixed_view_mut::<BLOCK, BLOCK>(BLOCK * j, BLOCK * j).copy_from(&own);
            for (then, now) in then.iter().zip(&now) {
                // in world axes
                let [right, left, own] = [(); 3].map(|()| Matrix6::from_fn(|_, _| random()));
                block.right[then.slot] = right * turned(&then.axes).transpose();
                block.left[then.slot] = turned(&then.axes) * left;
                block.own[then.slot] = turned(&then.axes) * own * turned(&then.axes).transpose();
                let axes = turned(&now.axes);
                let at = border_start + now.from;
                let right = turn * right * turn.transpose() * axes.transpose();
                let left = axes * turn * left * turn.transpose();
                let own = axes * turn * own * turn.transpose() * axes.transpose();
                dense.fixed_view_mut::<BLOCK, BLOCK>(BLOCK * j, at).copy_from(&right);
                dense.fixed_view_mut::<BLOCK, BLOCK>(at, BLOCK * j).copy_from(&left);
                let mut rows = dense.fixed_view_mut::<BLOCK, BLOCK>(at, at);
                rows += own;
            }
            if let Some(place) = shared {
                let at = border_start + place;
                let mut vector = || Vector6::from_fn(|_, _| random());
                let (column, row) = (vector(), vector());
                (block.shared.column, block.shared.row, block.shared.own) = (column, row, column[0] * row[1]);
                dense.fixed_view_mut::<BLOCK, 1>(BLOCK * j, at).copy_from(&(turn * column));
                dense.fixed_view_mut::<1, BLOCK>(at, BLOCK * j).copy_from(&(turn * row).transpose());
                dense[(at, at)] += block.shared.own;
                for (then, now) in then.iter().zip(&now) {
                    let (right, left) = (vector(), vector());
                    block.shared.right[then.slot] = turned(&then.axes) * right;
                    block.shared.left[then.slot] = turned(&then.axes) * left;
                    let (axes, from) = (turned(&now.axes), border_start + now.from);
                    let mut columns = dense.fixed_view_mut::<1, BLOCK>(at, from);
                    columns += (axes * turn * right).transpose();
                    let mut rows = dense.fixed_view_mut::<BLOCK, 1>(from, at);
                    rows += axes * turn * left;
                }
            }
            ends[j] = Vector3::new(0.0, angle.cos(), angle.sin());
            assert!(blocks[j / WIDTH].put(j % WIDTH, &block, &then));
        }
        assert!(blocks.iter().all(|group| group.fits(offsets.len(), shares)));
        assert!(!blocks[0].fits(offsets.len() + 1, shares) && !blocks[0].fits(offsets.len(), !shares));
        let turn = |group: usize| {
            OrbitTurn::between(
                &Vector3::y().map(Lanes::constant),
                &Lanes::vector(|lane| ends[WIDTH * group + lane]),
            )
        };
        let rhs = DVector::from_fn(size, |_, _| random());
        let exact = dense.lu().solve(&rhs).unwrap();

        let mut arrowhead = Arrowhead::default();
        arrowhead.place((0..groups).map(turn), (&now, shared));
        arrowhead.reduce(blocks.iter(), &mut border);
        // lanes without a block have no right-hand side
        let lane = |j: usize, k: usize| if j < n_balls { rhs[BLOCK * j + k] } else { 0.0 };
        let mut balls: Vec<Six<Lanes>> = (0..groups)
            .map(|group| std::array::from_fn(|k| Lanes::from_fn(|l| lane(WIDTH * group + l, k))))
            .collect();
        let alone = balls.clone();
        let mut tail = rhs.rows(border_start, n_border).into_owned();
        arrowhead.eliminate(blocks.iter(), &mut balls, &mut tail);
        assert!(solve(&border, &mut tail) && arrowhead.substitute(blocks.iter(), &mut balls, &tail));
        for j in 0..n_balls {
            let x = Vector6::from(balls[j / WIDTH].map(|lanes| lanes.0[j % WIDTH]));
            assert!((x - exact.fixed_rows::<BLOCK>(BLOCK * j)).norm() < 1e-11 * exact.norm());
        }
        // Without a border a block is solved alone.
        for (group, mut x) in alone.into_iter().enumerate().filter(|_| n_border == 0) {
            blocks[group].solve(&turn(group), &mut x);
            assert_eq!(x, balls[group]);
        }
        assert!((tail - exact.rows(border_start, n_border)).norm() < 1e-11 * exact.norm());
    }
}

#[test]
fn a_singular_block_is_refused() {
    assert!(!Eliminated::none(0, false).put(0, &Block::default(), &[]));
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
        let left = ring.reduce(&blocks.iter().collect::<Vec<_>>(), &links, &border, offsets);
        let mut balls: Vec<_> = (0..n).map(|j| rhs.fixed_rows::<BLOCK>(BLOCK * j).into_owned()).collect();
        let mut tail = rhs.rows(BLOCK * n, n_border).into_owned();
        ring.eliminate(&mut balls, &mut tail, offsets);
        assert!(solve(&left, &mut tail) && ring.substitute(&mut balls, &tail, offsets));
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
    ring.reduce(&[&Block::default()], &[], &DMatrix::zeros(0, 0), [None; SLOTS]);
    let mut ball = [Vector6::repeat(1.0)];
    ring.eliminate(&mut ball, &mut DVector::zeros(0), [None; SLOTS]);
    assert!(!ring.substitute(&mut ball, &DVector::zeros(0), [None; SLOTS]));
}
