//! Blocks that are eliminated, and what they do to right-hand sides and to the border.

use nalgebra::{Matrix6, Vector6};
use serde::{Deserialize, Serialize};

use super::block::{BLOCK, Block, Member, SLOTS, Shared, Six, Square};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::orbit_turn::OrbitTurn;

/// Up to [`WIDTH`] blocks that are eliminated, each in its lane; rows and columns of the border in world axes at that time. Lanes without
/// a block are zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Eliminated {
    /// `A^-1`: a product costs a quarter of two triangular solves.
    inverse: Square<Lanes>,
    /// Their couplings to each member of the border.
    couplings: Vec<Coupling>,
    /// Their couplings to the unknown that they share, where there is one.
    pub(super) shared: Option<SharedCoupling>,
}

/// Eliminated blocks and the unknown that they share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SharedCoupling {
    /// `A^-1` times its column.
    pub(super) column: Six<Lanes>,
    /// Its row.
    pub(super) row: Six<Lanes>,
    /// Diagonal entry that is left.
    pub(super) rest: Lanes,
    /// Entries that are left in its row and the columns of each member, and in the rows of that and its column.
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
pub(super) const NO_BLOCKS: Square<Lanes> = [[Lanes([0.0; WIDTH]); BLOCK]; BLOCK];

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

    /// Becomes a copy of another without taking memory, where both are coupled to as many members.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { inverse, couplings, shared } = self;
        *inverse = other.inverse;
        couplings.truncate(other.couplings.len());
        for (own, Coupling { right, left, rest }) in couplings.iter_mut().zip(&other.couplings) {
            (own.right, own.left) = (*right, *left);
            own.rest.clone_from(rest);
        }
        couplings.extend_from_slice(&other.couplings[couplings.len()..]);
        shared.clone_from(&other.shared);
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

/// Takes the right-hand sides of blocks out of loads on the members, and adds up what is to be taken out of that of an unknown that they share.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
pub(super) fn eliminate(
    blocks: &Eliminated,
    turn: &OrbitTurn<Lanes>,
    x: &mut Six<Lanes>,
    (loads, of_shared): (&mut [Six<Lanes>], &mut Lanes),
) {
    *x = product(&blocks.inverse, &turn.back().stacked(x));
    if let Some(shared) = &blocks.shared {
        for i in 0..BLOCK {
            *of_shared += shared.row[i] * x[i];
        }
    }
    for (coupling, load) in blocks.couplings.iter().zip(loads) {
        let taken = turn.stacked(&product(&coupling.left, x));
        for i in 0..BLOCK {
            load[i] -= taken[i];
        }
    }
}

/// The solutions of blocks, from that of the members and of an unknown that they share.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
pub(super) fn substitute(
    blocks: &Eliminated,
    turn: &OrbitTurn<Lanes>,
    x: &mut Six<Lanes>,
    (members, common): (&[Six<Lanes>], Option<&Lanes>),
) {
    let mut own = *x;
    if let (Some(common), Some(shared)) = (common, &blocks.shared) {
        for i in 0..BLOCK {
            own[i] -= shared.column[i] * *common;
        }
    }
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
pub(super) fn add_rest(blocks: &Eliminated, turn: &OrbitTurn<Lanes>, sums: &mut [Square<Lanes>]) {
    let of_blocks = blocks.couplings.iter().flat_map(|coupling| &coupling.rest);
    for (sum, rest) in sums.iter_mut().zip(of_blocks) {
        turn.add_matrix(rest, sum);
    }
}

/// Adds what blocks leave in the row of the unknown that they share and the columns of each member, and in the rows of that and its column.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
pub(super) fn add_shared_rest(
    shared: &SharedCoupling,
    turn: &OrbitTurn<Lanes>,
    sums: &mut [[Six<Lanes>; 2]],
) {
    for (sums, rests) in sums.iter_mut().zip(&shared.members) {
        for (sum, rest) in sums.iter_mut().zip(rests) {
            let turned = turn.stacked(rest);
            for i in 0..BLOCK {
                sum[i] += turned[i];
            }
        }
    }
}
