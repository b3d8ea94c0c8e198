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

use nalgebra::{DMatrix, DVector, Dyn, LU, Matrix3, Matrix6, SMatrix, Vector6};
use serde::{Deserialize, Serialize};

use super::orbit_turn::OrbitTurn;

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
    /// What the block adds to rows and columns of a member of the border.
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
        own.fixed_rows_mut::<3>(3).copy_from(&(self.axes * world.fixed_rows::<3>(3)));
        own
    }

    /// The same the other way round.
    fn world<const C: usize>(&self, own: &SMatrix<f64, BLOCK, C>) -> SMatrix<f64, BLOCK, C> {
        let mut world = *own;
        world.fixed_rows_mut::<3>(3).copy_from(&self.axes.tr_mul(&own.fixed_rows::<3>(3)));
        world
    }
}

/// A block that is eliminated, rows and columns of its border in world axes at that time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Eliminated {
    /// `A^-1`: a product costs a quarter of two triangular solves.
    inverse: Matrix6<f64>,
    /// Its coupling to each member of the border.
    couplings: Vec<Coupling>,
}

/// An eliminated block and a member of the border.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Coupling {
    /// `A^-1 R`.
    right: Matrix6<f64>,
    /// `L`.
    left: Matrix6<f64>,
    /// What is left in rows of this member, columns of each: `-L A^-1 R`, with what the block adds to the member's own.
    rest: Vec<Matrix6<f64>>,
}

impl Eliminated {
    /// Eliminates a block; none if it is singular.
    pub fn new(block: &Block, members: &[Member]) -> Option<Self> {
        let inverse = block.diagonal.lu().try_inverse()?;
        if !inverse.iter().all(|v| v.is_finite()) {
            return None;
        }
        let right =
            |member: &Member| inverse * member.world(&block.right[member.slot].transpose()).transpose();
        let coupling = |member: &Member| {
            let left = member.world(&block.left[member.slot]);
            let rest = |other: &Member| {
                let mut rest = -(left * right(other));
                if other.slot == member.slot {
                    rest += member.world(&member.world(&block.own[member.slot]).transpose()).transpose();
                }
                rest
            };
            Coupling { right: right(member), left, rest: members.iter().map(rest).collect() }
        };
        Some(Self { inverse, couplings: members.iter().map(coupling).collect() })
    }

    /// Solves for a right-hand side of the block alone; `turn` is that since it was eliminated.
    pub fn solve(&self, turn: &OrbitTurn, right: &Vector6<f64>) -> Vector6<f64> {
        let mut x = *right;
        solve_one(self, turn, &mut x);
        x
    }

    /// Is it coupled to so many members? A check for blocks that come from outside.
    pub fn fits(&self, members: usize) -> bool {
        let fits = |coupling: &Coupling| coupling.rest.len() == members;
        self.couplings.len() == members && self.couplings.iter().all(fits)
    }
}

/// The factorised border of a matrix whose blocks are eliminated.
#[derive(Clone, Debug, Default)]
pub struct Arrowhead {
    members: Vec<Member>,
    /// Turns of the blocks since they were eliminated.
    turns: Vec<OrbitTurn>,
    border: Option<LU<f64, Dyn, Dyn>>,
    /// What all blocks leave in rows and columns of each two members, in world axes.
    sums: Vec<Matrix6<f64>>,
    /// Loads on the members, and what they do, in world axes.
    worlds: Vec<Vector6<f64>>,
}

impl Arrowhead {
    /// Adds what the blocks leave to the border's own matrix, and factorises it.
    pub fn factorise<'a>(
        &mut self,
        blocks: impl Iterator<Item = (&'a Eliminated, OrbitTurn)>,
        members: &[Member],
        border: DMatrix<f64>,
    ) {
        let border = self.reduce(blocks, members, border);
        self.border = if border.is_empty() { None } else { Some(border.lu()) };
    }

    /// Adds what the blocks leave to the border's own matrix: what remains when they are eliminated.
    pub fn reduce<'a>(
        &mut self,
        blocks: impl Iterator<Item = (&'a Eliminated, OrbitTurn)>,
        members: &[Member],
        mut border: DMatrix<f64>,
    ) -> DMatrix<f64> {
        self.members.clear();
        self.members.extend(members);
        self.turns.clear();
        let count = members.len();
        let sums = &mut self.sums;
        sums.clear();
        sums.resize(count * count, Matrix6::zeros());
        for (block, turn) in blocks {
            self.turns.push(turn);
            add_one(block, &turn, sums);
        }
        for (row, a) in members.iter().enumerate() {
            for (column, b) in members.iter().enumerate() {
                let rest = a.own(&b.own(&sums[count * row + column].transpose()).transpose());
                let mut view = border.fixed_view_mut::<BLOCK, BLOCK>(a.from, b.from);
                view += rest;
            }
        }
        border
    }

    /// Solves in place for the right-hand side of the border that the blocks were taken out of; false if its matrix is singular.
    pub fn solve_border(&self, border: &mut DVector<f64>) -> bool {
        self.border.as_ref().is_none_or(|lu| lu.solve_mut(border))
    }

    /// Takes the right-hand sides of the blocks out of that of the border.
    pub fn eliminate<'a>(
        &mut self,
        blocks: impl Iterator<Item = &'a Eliminated>,
        x: &mut [Vector6<f64>],
        border: &mut DVector<f64>,
    ) {
        self.worlds.clear();
        self.worlds.resize(self.members.len(), Vector6::zeros());
        for ((block, turn), x) in blocks.zip(&self.turns).zip(&mut *x) {
            eliminate_one(block, turn, x, &mut self.worlds);
        }
        for (member, load) in self.members.iter().zip(&self.worlds) {
            let mut rows = border.fixed_rows_mut::<BLOCK>(member.from);
            rows += member.own(load);
        }
    }

    /// The blocks' solution from that of the border, after [`Arrowhead::eliminate`]; false if one is not finite.
    pub fn substitute<'a>(
        &mut self,
        blocks: impl Iterator<Item = &'a Eliminated>,
        x: &mut [Vector6<f64>],
        border: &DVector<f64>,
    ) -> bool {
        for (member, world) in self.members.iter().zip(&mut self.worlds) {
            *world = member.world(&border.fixed_rows::<BLOCK>(member.from).into_owned());
        }
        for ((block, turn), x) in blocks.zip(&self.turns).zip(&mut *x) {
            substitute_one(block, turn, x, &self.worlds);
        }
        x.iter().all(|x| x.iter().all(|v| v.is_finite())) && border.iter().all(|v| v.is_finite())
    }
}

/// A matrix times a vector, column by column; inlined, so that it becomes vector instructions where there are some.
#[inline(always)]
fn product(matrix: &Matrix6<f64>, x: &Vector6<f64>) -> Vector6<f64> {
    let mut sum = Vector6::zeros();
    for k in 0..BLOCK {
        for i in 0..BLOCK {
            sum[i] += matrix[(i, k)] * x[k];
        }
    }
    sum
}

/// Solves for a right-hand side of a block alone. Compiled twice, as contacts are ([`crate::contact::many`]), like the next ones.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn solve_one(block: &Eliminated, turn: &OrbitTurn, x: &mut Vector6<f64>) {
    *x = turn.stacked(&product(&block.inverse, &turn.back().stacked(x)));
}

/// Takes the right-hand side of a block out of loads on the members.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn eliminate_one(block: &Eliminated, turn: &OrbitTurn, x: &mut Vector6<f64>, loads: &mut [Vector6<f64>]) {
    *x = product(&block.inverse, &turn.back().stacked(x));
    for (coupling, load) in block.couplings.iter().zip(loads) {
        *load -= turn.stacked(&product(&coupling.left, x));
    }
}

/// The solution of a block, from that of the members.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn substitute_one(block: &Eliminated, turn: &OrbitTurn, x: &mut Vector6<f64>, members: &[Vector6<f64>]) {
    for (coupling, moved) in block.couplings.iter().zip(members) {
        *x -= product(&coupling.right, &turn.back().stacked(moved));
    }
    *x = turn.stacked(x);
}

/// Adds what a block leaves in rows and columns of each two members.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn add_one(block: &Eliminated, turn: &OrbitTurn, sums: &mut [Matrix6<f64>]) {
    let of_blocks = block.couplings.iter().flat_map(|coupling| &coupling.rest);
    for (sum, rest) in sums.iter_mut().zip(of_blocks) {
        *sum += turn.matrix(rest);
    }
}
