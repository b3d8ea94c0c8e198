//! Direct solution of arrowhead matrices whose neighbouring blocks are coupled too, around a ring.
//!
//! ```text
//! | A_1  F_1           B_n  R_1 |     F_k couples block k to the next one, B_k the next one to block k;
//! | B_1  A_2  F_2           R_2 |     the next block of the last one is the first.
//! |      B_2  ...  ...      ... |
//! | F_n       ...  A_n      R_n |
//! | L_1  L_2  ...  L_n      D   |     border as in [`arrowhead`](super::arrowhead)
//! ```
//! Blocks are eliminated one after the other. That fills in couplings of the next block and, where the ring is closed, of
//! the last one alone, so that the cost grows linearly with the number of blocks.

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

use super::arrowhead::{BLOCK, Block, Offsets, SLOTS};

/// Coupling of a block and the next one.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// The block; the next one of the last is the first. Two blocks have one link, from the first.
    pub block: usize,
    /// Rows of the block, columns of the next.
    pub forward: Matrix6<f64>,
    /// Rows of the next, columns of the block.
    pub backward: Matrix6<f64>,
}

/// Coupling of a block and a later one: own rows, and own columns.
type Coupling = Option<[Matrix6<f64>; 2]>;

/// A block, solved. Couplings have `A^-1` times the own rows, and the own columns.
#[derive(Clone, Debug)]
struct Factor {
    inverse: Matrix6<f64>,
    next: Coupling,
    /// To the last block, where that is not the next.
    last: Coupling,
    right: [Matrix6<f64>; SLOTS],
    left: [Matrix6<f64>; SLOTS],
}

/// The matrix with blocks eliminated.
#[derive(Clone, Debug, Default)]
pub struct Ring {
    blocks: Vec<Factor>,
}

impl Ring {
    /// Factorises blocks and links; gives what they leave of the border.
    pub fn reduce(
        &mut self,
        blocks: &[&Block],
        links: &[Link],
        border: &DMatrix<f64>,
        offsets: Offsets,
    ) -> DMatrix<f64> {
        let mut schur = border.clone();
        let n = blocks.len();
        // `inverse` is the block itself until it is its turn.
        let open = |block: &&Block| Factor {
            inverse: block.diagonal,
            next: None,
            last: None,
            right: block.right,
            left: block.left,
        };
        self.blocks = blocks.iter().map(open).collect();
        for (slot, from) in present(offsets) {
            let mut own = schur.fixed_view_mut::<BLOCK, BLOCK>(from, from);
            blocks.iter().for_each(|block| own += block.own[slot]);
        }
        for link in links {
            if link.block + 1 < n {
                self.blocks[link.block].next = Some([link.forward, link.backward]);
            } else {
                self.blocks[0].last = Some([link.backward, link.forward]);
            }
        }
        for k in 0..n {
            let (here, later) = self.blocks[k..].split_at_mut(1);
            eliminate_block(&mut here[0], later, &mut schur, offsets);
        }
        schur
    }

    /// Takes the right-hand sides of the blocks out of that of the border.
    pub fn eliminate(&self, blocks: &mut [Vector6<f64>], border: &mut DVector<f64>, offsets: Offsets) {
        for (k, factor) in self.blocks.iter().enumerate() {
            let (here, later) = blocks[k..].split_at_mut(1);
            let x = &mut here[0];
            *x = factor.inverse * *x;
            if let (Some([_, own]), Some(next)) = (&factor.next, later.first_mut()) {
                *next -= own * *x;
            }
            if let (Some([_, own]), Some(last)) = (&factor.last, later.last_mut()) {
                *last -= own * *x;
            }
            for (slot, offset) in present(offsets) {
                let mut rows = border.fixed_rows_mut::<BLOCK>(offset);
                rows -= factor.left[slot] * *x;
            }
        }
    }

    /// The blocks' solution from that of the border, after [`Ring::eliminate`]; false if one is not finite.
    pub fn substitute(&self, blocks: &mut [Vector6<f64>], border: &DVector<f64>, offsets: Offsets) -> bool {
        for (k, factor) in self.blocks.iter().enumerate().rev() {
            let (here, later) = blocks[k..].split_at_mut(1);
            let x = &mut here[0];
            for (slot, offset) in present(offsets) {
                *x -= factor.right[slot] * border.fixed_rows::<BLOCK>(offset);
            }
            if let (Some([own, _]), Some(next)) = (&factor.next, later.first()) {
                *x -= own * next;
            }
            if let (Some([own, _]), Some(last)) = (&factor.last, later.last()) {
                *x -= own * last;
            }
        }
        blocks.iter().all(|x| x.iter().all(|v| v.is_finite())) && border.iter().all(|v| v.is_finite())
    }
}

/// Slots of the border that have rows, with the first of them.
fn present(offsets: Offsets) -> impl Iterator<Item = (usize, usize)> {
    offsets.into_iter().enumerate().filter_map(|(slot, offset)| Some((slot, offset?)))
}

/// Eliminates a block from the later ones and the border.
fn eliminate_block(here: &mut Factor, later: &mut [Factor], schur: &mut DMatrix<f64>, offsets: Offsets) {
    // A singular block shows in the solution.
    here.inverse = here.inverse.lu().try_inverse().unwrap_or(Matrix6::repeat(f64::NAN));
    for [own_rows, _] in [&mut here.next, &mut here.last].into_iter().flatten() {
        *own_rows = here.inverse * *own_rows;
    }
    for (slot, _) in present(offsets) {
        here.right[slot] = here.inverse * here.right[slot];
    }
    for (row_slot, row) in present(offsets) {
        for (column_slot, column) in present(offsets) {
            let mut view = schur.fixed_view_mut::<BLOCK, BLOCK>(row, column);
            view -= here.left[row_slot] * here.right[column_slot];
        }
    }
    let index_of_last = later.len().wrapping_sub(1);
    for (at, coupling) in [(0, here.next), (index_of_last, here.last)] {
        if let (Some([rows, columns]), Some(other)) = (coupling, later.get_mut(at)) {
            other.inverse -= columns * rows;
            for (slot, _) in present(offsets) {
                other.right[slot] -= columns * here.right[slot];
                other.left[slot] -= here.left[slot] * rows;
            }
        }
    }
    if let (Some([next_rows, next_columns]), Some([last_rows, last_columns])) = (here.next, here.last) {
        // The next block meets the last one, which may be the next but one.
        let fill = [-(next_columns * last_rows), -(last_columns * next_rows)];
        let only_two_left = later.len() == 2;
        if let Some(next) = later.first_mut() {
            let place = if only_two_left { &mut next.next } else { &mut next.last };
            *place = Some(place.map_or(fill, |[rows, columns]| [rows + fill[0], columns + fill[1]]));
        }
    }
}
