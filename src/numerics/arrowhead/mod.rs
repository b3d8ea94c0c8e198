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

pub(super) mod block;
mod eliminated;

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

pub use block::{BLOCK, Block, Member, Offsets, SLOTS, Shared, Six, Square};
pub use eliminated::Eliminated;
use eliminated::{NO_BLOCKS, add_rest, add_shared_rest, eliminate, substitute};

use super::lanes::Lanes;
use super::orbit_turn::OrbitTurn;
use super::scalar::Scalar;

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
    /// Sums that all blocks leave in its row and the columns of each member, and in the rows of that and its column, in world axes, by lane.
    shared_sums: Vec<[Six<Lanes>; 2]>,
}

impl Arrowhead {
    /// Puts members and blocks where they are now, with turns of the blocks since they were eliminated. `shared` is the border row of the
    /// unknown that they share.
    pub fn place(
        &mut self,
        turns: impl Iterator<Item = OrbitTurn<Lanes>>,
        (members, shared): (&[Member], Option<usize>),
    ) {
        self.shared = shared;
        self.members.clear();
        self.members.extend(members);
        self.turns.clear();
        self.turns.extend(turns);
    }

    /// Adds what the blocks leave to the border's own matrix: what remains when they are eliminated; after [`Arrowhead::place`].
    pub fn reduce<'a>(&mut self, blocks: impl Iterator<Item = &'a Eliminated>, border: &mut DMatrix<f64>) {
        let Self { members, turns, sums, shared_sums, shared, .. } = self;
        shared_sums.clear();
        shared_sums.resize(shared.map_or(0, |_| members.len()), [NO_BLOCKS[0]; 2]);
        let mut rest = NO_BLOCKS[0][0];
        let count = members.len();
        sums.clear();
        sums.resize(count * count, NO_BLOCKS);
        for (blocks, turn) in blocks.zip(&*turns) {
            add_rest(blocks, turn, sums);
            if let Some(shared) = &blocks.shared {
                rest += shared.rest;
                add_shared_rest(shared, turn, shared_sums);
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
        if let Some(place) = *shared {
            border[(place, place)] += sum_of_lanes(&rest);
            for (member, sums) in members.iter().zip(&*shared_sums) {
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
            eliminate(blocks, turn, x, (&mut self.worlds, &mut taken));
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
            substitute(blocks, turn, x, (&self.worlds, common.as_ref()));
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
