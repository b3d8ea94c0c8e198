//! The border of a system's matrix: rows of the structures, with what bearings leave in them of the races that they carry.
//!
//! Balls and bodies that nothing carries are eliminated bearing by bearing: an arrowhead of arrowheads, whose cost grows with the
//! number of bearings.

use nalgebra::{DMatrix, DVector, Dyn, OMatrix, U6};
use serde::{Deserialize, Serialize};

use super::step::Joint;
use super::structure::StructureTrial;
use crate::dynamics::carried::SeatMotion;
use crate::dynamics::equations::BearingStep;
use crate::model::bodies::Body;
use crate::numerics::arrowhead::BLOCK;
use crate::numerics::kept_lu::KeptLu;

/// Matrix and right-hand side of the border, kept between steps.
#[derive(Clone, Debug, Default)]
pub struct Border {
    matrix: DMatrix<f64>,
    lu: KeptLu,
    /// [s2, s] gains of the steps that the factors are of ([`HhtStep::force_gains`]), which serve for others with these; none before the first.
    gains: Option<[f64; 2]>,
    /// Rows of bearings with states that they are of.
    of_bearings: Vec<f64>,
    /// Right-hand side, then solution.
    pub(super) right: DVector<f64>,
}

/// A matrix of the border that serves for several steps, and the gains of these.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeptBorder {
    gains: [f64; 2],
    of_bearings: Vec<f64>,
    /// Column by column.
    matrix: Vec<f64>,
}

impl Border {
    /// The matrix, to be assembled: zeros in so many rows.
    pub(super) fn cleared(&mut self, rows: usize) -> DMatrix<f64> {
        let mut matrix = std::mem::take(&mut self.matrix);
        if matrix.nrows() == rows {
            matrix.fill(0.0);
        } else {
            matrix = DMatrix::zeros(rows, rows);
        }
        matrix
    }

    /// Factorises the matrix that was assembled, with these rows of bearings, and keeps it for steps with these gains.
    pub(super) fn factorise<'a>(
        &mut self,
        matrix: DMatrix<f64>,
        of_bearings: impl Iterator<Item = &'a [f64]>,
        gains: [f64; 2],
    ) {
        self.lu.factorise(&matrix);
        self.matrix = matrix;
        self.gains = Some(gains);
        self.of_bearings.clear();
        of_bearings.for_each(|rows| self.of_bearings.extend_from_slice(rows));
    }

    /// Does the matrix serve for steps with these gains, of bearings with these rows? Sizes of steps that share an interval differ by the rounding of
    /// times.
    pub(super) fn serves<'a>(&self, gains: [f64; 2], of_bearings: impl Iterator<Item = &'a [f64]>) -> bool {
        const ROUNDING: f64 = 1e-9;
        let near = |(own, gain): (f64, f64)| (own - gain).abs() <= ROUNDING * gain;
        self.gains.is_some_and(|own| own.into_iter().zip(gains).all(near))
            && self.of_bearings.iter().eq(of_bearings.flatten())
    }

    /// The matrix that serves for several steps, if there is one.
    pub fn kept(&self) -> Option<KeptBorder> {
        let kept = |gains| KeptBorder {
            gains,
            of_bearings: self.of_bearings.clone(),
            matrix: self.matrix.as_slice().to_vec(),
        };
        self.gains.map(kept)
    }

    /// Goes on with a matrix that was kept, or with none; false, with nothing changed, if it is none of so many rows.
    pub fn restore(&mut self, kept: Option<&KeptBorder>, rows: usize) -> bool {
        let fits = kept.is_none_or(|kept| kept.matrix.len() == rows * rows);
        match kept {
            Some(KeptBorder { gains, of_bearings, matrix }) if fits => {
                let matrix = DMatrix::from_column_slice(rows, rows, matrix);
                self.factorise(matrix, std::iter::once(&of_bearings[..]), *gains);
            }
            None => self.gains = None,
            Some(_) => {}
        }
        fits
    }

    /// Solves in place for the right-hand side; false if the matrix is singular or the solution is not finite.
    pub(super) fn solve(&mut self) -> bool {
        self.lu.solve(self.right.as_mut_slice()) && self.right.iter().all(|v| v.is_finite())
    }
}

/// A race of a bearing that a structure carries: its rows among those of the bearing's bodies, and in the border.
#[derive(Debug)]
pub(super) struct CarriedRace<'a> {
    pub(super) joint: &'a Joint,
    /// First row among those of the bearing's bodies.
    from: usize,
    /// Rows of the border.
    to: Vec<usize>,
    /// Unknowns of the race by those of the structure.
    by: OMatrix<f64, U6, Dyn>,
}

impl<'a> CarriedRace<'a> {
    /// The carried races of a bearing; with the first border row of each structure.
    pub(super) fn of_bearing(
        bearing: usize,
        step: &BearingStep<'_>,
        joints: &'a [Joint],
        first: &[usize],
    ) -> Vec<Self> {
        let offsets = step.model.border_offsets();
        let of = |joint: &'a Joint| {
            let from = offsets[Body::from(joint.race).index()]?;
            let to: Vec<_> = joint.seat.coordinates().iter().map(|k| first[joint.structure] + k).collect();
            let by = OMatrix::<f64, U6, Dyn>::zeros(to.len());
            Some(Self { joint, from, to, by })
        };
        let carried = |joint: &&Joint| joint.bearing == bearing && step.model.is_carried(joint.race);
        joints.iter().filter(carried).filter_map(of).collect()
    }

    /// Puts the race where its structure is, in a trial step.
    pub(super) fn follow(&mut self, motion: &SeatMotion, step: &mut BearingStep<'_>) {
        let Joint { race, seat, .. } = self.joint;
        self.by = StructureTrial::unknowns_of(seat, motion, step.model.race_length());
        if let Some(Some(trial)) = step.workspace.bodies.get_mut(*race) {
            trial.carry(motion);
            step.workspace.races[*race] = trial.motion_value();
        }
    }

    /// Adds the bearing's right-hand sides to those of the border.
    pub(super) fn project(&self, own: &DVector<f64>, border: &mut DVector<f64>) {
        let own = own.fixed_rows::<BLOCK>(self.from);
        self.to.iter().zip(self.by.tr_mul(&own).iter()).for_each(|(k, value)| border[*k] += value);
    }

    /// Unknowns of the race from those of the border.
    pub(super) fn lift(&self, border: &DVector<f64>, own: &mut DVector<f64>) {
        let given = DVector::from_iterator(self.to.len(), self.to.iter().map(|k| border[*k]));
        own.fixed_rows_mut::<BLOCK>(self.from).copy_from(&(&self.by * given));
    }

    /// Adds what the bearing leaves in these rows and the columns of another carried race to the border.
    pub(super) fn add_block(&self, columns: &Self, reduced: &DMatrix<f64>, border: &mut DMatrix<f64>) {
        let block = reduced.fixed_view::<BLOCK, BLOCK>(self.from, columns.from);
        for (one, to) in columns.by.column_iter().zip(&columns.to) {
            let column = self.by.tr_mul(&(block * one));
            self.to.iter().zip(column.iter()).for_each(|(row, value)| border[(*row, *to)] += value);
        }
    }
}
