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
//!
//! An eliminated block turns about the x axis with its ball: in a frame that turns along it hardly changes, and serves many
//! matrices. Border rows have three forces in world axes and three moments in the axes of their member.
//!
//! Four blocks at a time are worked with, in the lanes of vectors.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, SMatrix, Vector6};
use serde::{Deserialize, Serialize};

use super::lanes::{Lanes, WIDTH};
use super::orbit_turn::OrbitTurn;
use super::scalar::Scalar;

/// Rows and columns of a block.
pub const BLOCK: usize = 6;

/// Rows of a block.
pub type Six<S> = [S; BLOCK];

/// A matrix of a block's size, column by column.
pub type Square<S> = [Six<S>; BLOCK];

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
    /// Additions of the block to rows and columns of a member of the border.
    pub own: [Matrix6<f64>; SLOTS],
}

impl Default for Block {
    fn default() -> Self {
        let zero = Matrix6::zeros();
        Self { diagonal: zero, right: [zero; SLOTS], left: [zero; SLOTS], own: [zero; SLOTS] }
    }
}

/// A member of the border.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    /// Its slot.
    pub slot: usize,
    /// Its first border row.
    pub from: usize,
    /// Turns world axes into its own.
    pub axes: Matrix3<f64>,
}

impl Member {
    /// Vectors with moments in its own axes, from those in world axes, column by column.
    fn own<const C: usize>(&self, world: &SMatrix<f64, BLOCK, C>) -> SMatrix<f64, BLOCK, C> {
        let mut own = *world;
        for k in 0..C {
            for i in 0..3 {
                let row = |j: usize| self.axes[(i, j)] * world[(3 + j, k)];
                own[(3 + i, k)] = row(0) + row(1) + row(2);
            }
        }
        own
    }

    /// The same row by row.
    fn own_rows(&self, world: &Matrix6<f64>) -> Matrix6<f64> {
        let mut own = *world;
        for i in 0..3 {
            for k in 0..BLOCK {
                let column = |j: usize| self.axes[(i, j)] * world[(k, 3 + j)];
                own[(k, 3 + i)] = column(0) + column(1) + column(2);
            }
        }
        own
    }

    /// The other way round, column by column.
    #[inline(always)]
    fn world<const C: usize>(&self, own: &SMatrix<f64, BLOCK, C>) -> SMatrix<f64, BLOCK, C> {
        let mut world = *own;
        for k in 0..C {
            for i in 0..3 {
                let row = |j: usize| self.axes[(j, i)] * own[(3 + j, k)];
                world[(3 + i, k)] = row(0) + row(1) + row(2);
            }
        }
        world
    }

    /// The same row by row.
    #[inline(always)]
    fn world_rows(&self, own: &Matrix6<f64>) -> Matrix6<f64> {
        let mut world = *own;
        for i in 0..3 {
            for k in 0..BLOCK {
                let column = |j: usize| self.axes[(j, i)] * own[(k, 3 + j)];
                world[(k, 3 + i)] = column(0) + column(1) + column(2);
            }
        }
        world
    }
}

/// Up to [`WIDTH`] blocks that are eliminated, each in its lane; rows and columns of the border in world axes at that time. Lanes without
/// a block are zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Eliminated {
    /// `A^-1`: a product costs a quarter of two triangular solves.
    inverse: Square<Lanes>,
    /// Their couplings to each member of the border.
    couplings: Vec<Coupling>,
}

/// Eliminated blocks and a member of the border.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Coupling {
    /// `A^-1 R`.
    right: Square<Lanes>,
    /// `L`.
    left: Square<Lanes>,
    /// Remainder in rows of this member, columns of each: `-L A^-1 R`, with what the block adds to the member's own.
    rest: Vec<Square<Lanes>>,
}

/// Nothing in any lane.
const NO_BLOCKS: Square<Lanes> = [[Lanes([0.0; WIDTH]); BLOCK]; BLOCK];

impl Eliminated {
    /// No blocks yet, for so many members of the border.
    pub fn none(members: usize) -> Self {
        let none = Coupling { right: NO_BLOCKS, left: NO_BLOCKS, rest: vec![NO_BLOCKS; members] };
        Self { inverse: NO_BLOCKS, couplings: vec![none; members] }
    }

    /// Eliminates a block and puts it into a lane; false if it is singular.
    #[must_use]
    pub fn put(&mut self, lane: usize, block: &Block, members: &[Member]) -> bool {
        let inverse = block.diagonal.lu().try_inverse();
        let Some(inverse) = inverse.filter(|inverse| inverse.iter().all(|v| v.is_finite())) else {
            return false;
        };
        put(&mut self.inverse, lane, &inverse);
        put_couplings(&mut self.couplings, lane, (block, &inverse), members);
        true
    }

    /// Solves in place for right-hand sides of the blocks alone; `turn` is that of each since it was eliminated.
    pub fn solve(&self, turn: &OrbitTurn<Lanes>, x: &mut Six<Lanes>) {
        solve_alone(self, turn, x);
    }

    /// Are its blocks coupled to so many members? A check for blocks that come from outside.
    pub fn fits(&self, members: usize) -> bool {
        let fits = |coupling: &Coupling| coupling.rest.len() == members;
        self.couplings.len() == members && self.couplings.iter().all(fits)
    }
}

/// Puts the couplings of an eliminated block into a lane. Compiled twice, as contacts are ([`crate::contact::many`]), like others below.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn put_couplings(
    couplings: &mut [Coupling],
    lane: usize,
    (block, inverse): (&Block, &Matrix6<f64>),
    members: &[Member],
) {
    let mut right = [Matrix6::zeros(); SLOTS];
    for member in members {
        right[member.slot] = times(inverse, &member.world_rows(&block.right[member.slot]));
    }
    for (member, coupling) in members.iter().zip(couplings) {
        let left = member.world(&block.left[member.slot]);
        put(&mut coupling.right, lane, &right[member.slot]);
        put(&mut coupling.left, lane, &left);
        for (other, lanes) in members.iter().zip(&mut coupling.rest) {
            let mut rest = -times(&left, &right[other.slot]);
            if other.slot == member.slot {
                rest += member.world_rows(&member.world(&block.own[member.slot]));
            }
            put(lanes, lane, &rest);
        }
    }
}

/// Puts a matrix into a lane.
#[inline(always)]
fn put(lanes: &mut Square<Lanes>, lane: usize, matrix: &Matrix6<f64>) {
    for (lanes, number) in lanes.as_flattened_mut().iter_mut().zip(matrix) {
        lanes.0[lane] = *number;
    }
}

/// A matrix whose blocks are eliminated.
#[derive(Clone, Debug, Default)]
pub struct Arrowhead {
    members: Vec<Member>,
    /// Turns of the blocks since they were eliminated.
    turns: Vec<OrbitTurn<Lanes>>,
    /// Remainders of all blocks in rows and columns of each two members, in world axes, by lane.
    sums: Vec<Square<Lanes>>,
    /// Loads on the members, by lane, and what they do, in world axes.
    worlds: Vec<Six<Lanes>>,
}

impl Arrowhead {
    /// Adds what the blocks leave to the border's own matrix: what remains when they are eliminated.
    pub fn reduce<'a>(
        &mut self,
        blocks: impl Iterator<Item = (&'a Eliminated, OrbitTurn<Lanes>)>,
        members: &[Member],
        border: &mut DMatrix<f64>,
    ) {
        self.members.clear();
        self.members.extend(members);
        self.turns.clear();
        let count = members.len();
        let sums = &mut self.sums;
        sums.clear();
        sums.resize(count * count, NO_BLOCKS);
        for (blocks, turn) in blocks {
            self.turns.push(turn);
            add_rest(blocks, &turn, sums);
        }
        for (row, a) in members.iter().enumerate() {
            for (column, b) in members.iter().enumerate() {
                let sum = &sums[count * row + column];
                let sum = Matrix6::from_fn(|i, k| sum_of_lanes(&sum[k][i]));
                let rest = a.own(&b.own_rows(&sum));
                let mut view = border.fixed_view_mut::<BLOCK, BLOCK>(a.from, b.from);
                view += rest;
            }
        }
    }

    /// Takes the right-hand sides of the blocks out of that of the border.
    pub fn eliminate<'a>(
        &mut self,
        blocks: impl Iterator<Item = &'a Eliminated>,
        x: &mut [Six<Lanes>],
        border: &mut DVector<f64>,
    ) {
        self.worlds.clear();
        self.worlds.resize(self.members.len(), NO_BLOCKS[0]);
        for ((blocks, turn), x) in blocks.zip(&self.turns).zip(&mut *x) {
            eliminate(blocks, turn, x, &mut self.worlds);
        }
        for (member, load) in self.members.iter().zip(&self.worlds) {
            let mut rows = border.fixed_rows_mut::<BLOCK>(member.from);
            rows += member.own(&Vector6::from_fn(|i, _| sum_of_lanes(&load[i])));
        }
    }

    /// The blocks' solution from that of the border, after [`Arrowhead::eliminate`]; false if one is not finite.
    pub fn substitute<'a>(
        &mut self,
        blocks: impl Iterator<Item = &'a Eliminated>,
        x: &mut [Six<Lanes>],
        border: &DVector<f64>,
    ) -> bool {
        for (member, world) in self.members.iter().zip(&mut self.worlds) {
            let moved = member.world(&border.fixed_rows::<BLOCK>(member.from).into_owned());
            for i in 0..BLOCK {
                world[i] = Lanes::constant(moved[i]);
            }
        }
        for ((blocks, turn), x) in blocks.zip(&self.turns).zip(&mut *x) {
            substitute(blocks, turn, x, &self.worlds);
        }
        let finite = |lanes: &Lanes| lanes.0.iter().all(|v| v.is_finite());
        x.as_flattened().iter().all(finite) && border.iter().all(|v| v.is_finite())
    }
}

/// Sum over lanes, from the first to the last.
#[inline(always)]
fn sum_of_lanes(lanes: &Lanes) -> f64 {
    let Lanes([a, b, c, d]) = lanes;
    a + b + c + d
}

/// Product of two matrices, in the order of the library's.
#[inline(always)]
fn times(a: &Matrix6<f64>, b: &Matrix6<f64>) -> Matrix6<f64> {
    let mut result = Matrix6::zeros();
    for j in 0..BLOCK {
        for k in 0..BLOCK {
            for i in 0..BLOCK {
                result[(i, j)] += a[(i, k)] * b[(k, j)];
            }
        }
    }
    result
}

/// Products of matrices and vectors, column by column.
#[inline(always)]
fn product(matrix: &Square<Lanes>, x: &Six<Lanes>) -> Six<Lanes> {
    let mut sum = NO_BLOCKS[0];
    for k in 0..BLOCK {
        for i in 0..BLOCK {
            sum[i] += matrix[k][i] * x[k];
        }
    }
    sum
}

/// Solves for right-hand sides of blocks alone.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn solve_alone(blocks: &Eliminated, turn: &OrbitTurn<Lanes>, x: &mut Six<Lanes>) {
    *x = turn.stacked(&product(&blocks.inverse, &turn.back().stacked(x)));
}

/// Takes the right-hand sides of blocks out of loads on the members.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn eliminate(blocks: &Eliminated, turn: &OrbitTurn<Lanes>, x: &mut Six<Lanes>, loads: &mut [Six<Lanes>]) {
    *x = product(&blocks.inverse, &turn.back().stacked(x));
    for (coupling, load) in blocks.couplings.iter().zip(loads) {
        let taken = turn.stacked(&product(&coupling.left, x));
        for i in 0..BLOCK {
            load[i] -= taken[i];
        }
    }
}

/// The solutions of blocks, from that of the members.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn substitute(blocks: &Eliminated, turn: &OrbitTurn<Lanes>, x: &mut Six<Lanes>, members: &[Six<Lanes>]) {
    let mut own = *x;
    for (coupling, moved) in blocks.couplings.iter().zip(members) {
        let follows = product(&coupling.right, &turn.back().stacked(moved));
        for i in 0..BLOCK {
            own[i] -= follows[i];
        }
    }
    *x = turn.stacked(&own);
}

/// Adds what blocks leave in rows and columns of each two members.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn add_rest(blocks: &Eliminated, turn: &OrbitTurn<Lanes>, sums: &mut [Square<Lanes>]) {
    let of_blocks = blocks.couplings.iter().flat_map(|coupling| &coupling.rest);
    for (sum, rest) in sums.iter_mut().zip(of_blocks) {
        turn.add_matrix(rest, sum);
    }
}
