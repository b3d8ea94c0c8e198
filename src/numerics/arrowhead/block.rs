//! Blocks of the matrix, and the members of the border that they are coupled to.

use nalgebra::{Matrix3, Matrix6, SMatrix, Vector6};

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
    /// Diagonal entry that the block adds.
    pub own: f64,
    /// Entries that the block adds to its row, columns of each member of the border.
    pub right: [Vector6<f64>; SLOTS],
    /// Entries that the block adds to rows of each member, its column.
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
    pub(super) fn own<const C: usize>(&self, world: &SMatrix<f64, BLOCK, C>) -> SMatrix<f64, BLOCK, C> {
        let mut own = *world;
        for k in 0..C {
            for i in 0..3 {
                let row = |j: usize| self.axes[(i, j)] * world[(3 + j, k)];
                own[(3 + i, k)] = row(0) + row(1) + row(2);
            }
        }
        own
    }

    /// Rows with moments in its own axes, from those in world axes.
    pub(super) fn own_rows(&self, world: &Matrix6<f64>) -> Matrix6<f64> {
        let mut own = *world;
        for i in 0..3 {
            for k in 0..BLOCK {
                let column = |j: usize| self.axes[(i, j)] * world[(k, 3 + j)];
                own[(k, 3 + i)] = column(0) + column(1) + column(2);
            }
        }
        own
    }

    /// Vectors with moments in world axes, from those in its own, column by column.
    #[inline(always)]
    pub(super) fn world<const C: usize>(&self, own: &SMatrix<f64, BLOCK, C>) -> SMatrix<f64, BLOCK, C> {
        let mut world = *own;
        for k in 0..C {
            for i in 0..3 {
                let row = |j: usize| self.axes[(j, i)] * own[(3 + j, k)];
                world[(3 + i, k)] = row(0) + row(1) + row(2);
            }
        }
        world
    }

    /// Rows with moments in world axes, from those in its own.
    #[inline(always)]
    pub(super) fn world_rows(&self, own: &Matrix6<f64>) -> Matrix6<f64> {
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
