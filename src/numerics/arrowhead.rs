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
//! Blocks may share one more unknown, a number without direction ([`Shared`]): its row and column are the border's, too.
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
    /// Couplings to the unknown that all blocks share; not used where there is none.
    pub shared: Shared,
}

impl Default for Block {
    fn default() -> Self {
        let zero = Matrix6::zeros();
        let shared = Shared::default();
        Self { diagonal: zero, right: [zero; SLOTS], left: [zero; SLOTS], own: [zero; SLOTS], shared }
    }
}

/// Couplings of a block to the unknown that all blocks share.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shared {
    /// Own rows, its column.
    pub column: Vector6<f64>,
    /// Its row, own columns.
    pub row: Vector6<f64>,
    /// What the block adds to its row and column.
    pub own: f64,
    /// What the block adds to its row, columns of each member of the border.
    pub right: [Vector6<f64>; SLOTS],
    /// What the block adds to rows of each member, its column.
    pub left: [Vector6<f64>; SLOTS],
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
    /// Their couplings to the unknown that they share, where there is one.
    shared: Option<SharedCoupling>,
}

/// Eliminated blocks and the unknown that they share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SharedCoupling {
    /// `A^-1` times its column.
    column: Six<Lanes>,
    /// Its row.
    row: Six<Lanes>,
    /// What is left in its row and column.
    rest: Lanes,
    /// What is left in its row and the columns of each member, and in the rows of that and its column.
    members: Vec<[Six<Lanes>; 2]>,
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
    /// No blocks yet, for so many members of the border; is there an unknown that they share?
    pub fn none(members: usize, shared: bool) -> Self {
        let none = Coupling { right: NO_BLOCKS, left: NO_BLOCKS, rest: vec![NO_BLOCKS; members] };
        let zero = NO_BLOCKS[0];
        let shared = shared.then(|| SharedCoupling {
            column: zero,
            row: zero,
            rest: zero[0],
            members: vec![[zero; 2]; members],
        });
        Self { inverse: NO_BLOCKS, couplings: vec![none; members], shared }
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
        if let Some(shared) = &mut self.shared {
            shared.put(lane, (block, &inverse), members);
        }
        true
    }

    /// Solves in place for right-hand sides of the blocks alone; `turn` is that of each since it was eliminated.
    pub fn solve(&self, turn: &OrbitTurn<Lanes>, x: &mut Six<Lanes>) {
        solve_alone(self, turn, x);
    }

    /// Are its blocks coupled to so many members, and to an unknown that they share or to none? A check for blocks that come from outside.
    pub fn fits(&self, members: usize, shared: bool) -> bool {
        let fits = |coupling: &Coupling| coupling.rest.len() == members;
        let shares = self.shared.as_ref().is_none_or(|shared| shared.members.len() == members);
        self.couplings.len() == members
            && self.couplings.iter().all(fits)
            && shares
            && self.shared.is_some() == shared
    }
}

impl SharedCoupling {
    /// Puts the couplings of an eliminated block into a lane.
    fn put(&mut self, lane: usize, (block, inverse): (&Block, &Matrix6<f64>), members: &[Member]) {
        let Shared { column, row, own, right, left } = &block.shared;
        let follows = inverse * column;
        put_six(&mut self.column, lane, &follows);
        put_six(&mut self.row, lane, row);
        self.rest.0[lane] = own - row.dot(&follows);
        // `row A^-1` takes the place of the row in what it leaves in columns of the members.
        let taken = inverse.tr_mul(row);
        for (member, [in_row, in_column]) in members.iter().zip(&mut self.members) {
            let slot = member.slot;
            put_six(in_row, lane, &member.world(&(right[slot] - block.right[slot].tr_mul(&taken))));
            put_six(in_column, lane, &member.world(&(left[slot] - block.left[slot] * follows)));
        }
    }
}

/// Puts a vector into a lane.
fn put_six(lanes: &mut Six<Lanes>, lane: usize, vector: &Vector6<f64>) {
    for (lanes, number) in lanes.iter_mut().zip(vector) {
        lanes.0[lane] = *number;
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
    /// Border row of the unknown that the blocks share, where there is one.
    shared: Option<usize>,
    /// What all blocks leave in its row and the columns of each member, and in the rows of that and its column, in world axes, by lane.
    shared_sums: Vec<[Six<Lanes>; 2]>,
}

impl Arrowhead {
    /// Adds what the blocks leave to the border's own matrix: what remains when they are eliminated. `shared` is the border row of the
    /// unknown that they share.
    pub fn reduce<'a>(
        &mut self,
        blocks: impl Iterator<Item = (&'a Eliminated, OrbitTurn<Lanes>)>,
        (members, shared): (&[Member], Option<usize>),
        border: &mut DMatrix<f64>,
    ) {
        self.shared = shared;
        self.shared_sums.clear();
        self.shared_sums.resize(shared.map_or(0, |_| members.len()), [NO_BLOCKS[0]; 2]);
        let mut rest = NO_BLOCKS[0][0];
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
            if let Some(shared) = &blocks.shared {
                rest += shared.rest;
                add_shared_rest(shared, &turn, &mut self.shared_sums);
            }
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
        if let Some(place) = shared {
            border[(place, place)] += sum_of_lanes(&rest);
            for (member, sums) in members.iter().zip(&self.shared_sums) {
                let [in_row, in_column] =
                    sums.map(|six| member.own(&Vector6::from_fn(|i, _| sum_of_lanes(&six[i]))));
                let mut row = border.fixed_view_mut::<1, BLOCK>(place, member.from);
                row += in_row.transpose();
                let mut column = border.fixed_view_mut::<BLOCK, 1>(member.from, place);
                column += in_column;
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
        let mut taken = NO_BLOCKS[0][0];
        for ((blocks, turn), x) in blocks.zip(&self.turns).zip(&mut *x) {
            eliminate(blocks, turn, x, &mut self.worlds);
            if let Some(shared) = &blocks.shared {
                shared.row.iter().zip(&*x).for_each(|(row, x)| taken += *row * *x);
            }
        }
        if let Some(place) = self.shared {
            border[place] -= sum_of_lanes(&taken);
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
        let common = self.shared.map(|place| Lanes::constant(border[place]));
        for ((blocks, turn), x) in blocks.zip(&self.turns).zip(&mut *x) {
            if let (Some(common), Some(shared)) = (common, &blocks.shared) {
                x.iter_mut().zip(&shared.column).for_each(|(x, column)| *x -= *column * common);
            }
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

/// Adds what blocks leave in the row of the unknown that they share and the columns of each member, and in the rows of that and its column.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn add_shared_rest(shared: &SharedCoupling, turn: &OrbitTurn<Lanes>, sums: &mut [[Six<Lanes>; 2]]) {
    for (sums, rests) in sums.iter_mut().zip(&shared.members) {
        for (sum, rest) in sums.iter_mut().zip(rests) {
            let turned = turn.stacked(rest);
            for i in 0..BLOCK {
                sum[i] += turned[i];
            }
        }
    }
}
