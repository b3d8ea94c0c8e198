//! Rigid parts that have the mass of a structure, as what acts on it in a frame that turns depends on where its mass is.

use nalgebra::{DMatrix, DVector, Dyn, Matrix, Storage, U6, Vector3};

use super::{Map, Spin, Structure, Turning};
use crate::effects::moving_frame::MovingFrame;
use crate::model::state::stack;

/// A rigid part of a structure.
#[derive(Clone, Debug)]
pub struct Lump {
    /// \[m] place of its centre of mass while the coordinates are zero, in the axes of the machine.
    pub place: Vector3<f64>,
    /// \[kg] mass.
    pub mass: f64,
    /// [kg m2] principal moments of inertia along the axes of the machine. Those of a piece of a beam, whose mass is at its ends, are less
    /// by the inertia that this has too much: they may be below 0.
    pub inertia: Vector3<f64>,
    /// Displacement and rotation by the coordinates.
    pub map: Map,
}

impl Lump {
    /// Lump by more coordinates, the new ones without effect.
    #[must_use]
    pub fn widened(self, size: usize) -> Self {
        Self { map: self.map.resize_horizontally(size, 0.0), ..self }
    }
}

/// Force on a structure because its frame turns.
#[derive(Clone, Debug)]
pub struct FrameForce {
    /// Generalised force.
    pub force: DVector<f64>,
    /// [N m] moment about the axis of a structure.
    pub axial: f64,
}

/// Motion of a place by coordinates or rates: displacement and rotation.
fn moved<S: Storage<f64, U6, Dyn>>(map: &Matrix<f64, U6, Dyn, S>, by: &DVector<f64>) -> [Vector3<f64>; 2] {
    let moved = map * by;
    [moved.fixed_rows::<3>(0).into_owned(), moved.fixed_rows::<3>(3).into_owned()]
}

/// Steps \[m or rad, and a second of these] of differences of a force that is a polynomial of third degree in coordinates, with small terms
/// beyond the first, and linear in rates.
const STEPS: [f64; 2] = [1e-5, 1.0];

/// Forces of inertia on rigid parts in a frame that turns about the origin of the machine's axes, at a state of coordinates and rates; `turn` is
/// the turn of a shaft whose speed is given. They are those of where the parts are and how they move in the frame, to the first order of
/// their tilts.
fn frame_force(
    lumps: &[Lump],
    frame: &MovingFrame,
    [q, rates]: [&DVector<f64>; 2],
    (turning, turn): (Turning, &Spin),
) -> FrameForce {
    let mut sum = FrameForce { force: DVector::zeros(q.len()), axial: 0.0 };
    for lump in lumps {
        let [[displacement, mut tilt], [velocity, mut spin]] = [q, rates].map(|of| moved(&lump.map, of));
        match turning {
            Turning::Still => {}
            // A shaft is alike around its axis; what it has turned by is no small angle.
            Turning::Free => tilt.x = 0.0,
            Turning::Given => {
                tilt.x = 0.0;
                spin.x += turn.speed;
            }
        }
        let force = frame.field(&(lump.place + displacement), &velocity) * lump.mass;
        let own = frame.moment(&lump.inertia, &spin, |vector| vector - tilt.cross(vector));
        let moment = own + tilt.cross(&own);
        sum.force += lump.map.tr_mul(&stack(&force, &moment));
        sum.axial += moment.x;
    }
    sum
}

/// Stiffness and damping that forces of inertia of a frame which turns add to rigid parts at a state of coordinates and rates, the
/// Coriolis forces among it.
pub fn frame_matrices(
    lumps: &[Lump],
    frame: &MovingFrame,
    at: [&DVector<f64>; 2],
    turn: (Turning, &Spin),
) -> [DMatrix<f64>; 2] {
    let size = at[0].len();
    [0, 1].map(|which| {
        let column = |k: usize| {
            let moved = |way: f64| {
                let mut moved = at.map(DVector::clone);
                moved[which][k] += way * STEPS[which];
                frame_force(lumps, frame, [&moved[0], &moved[1]], turn).force
            };
            (moved(-1.0) - moved(1.0)) / (2.0 * STEPS[which])
        };
        let columns: Vec<_> = (0..size).map(column).collect();
        DMatrix::from_fn(size, size, |i, k| columns[k][i])
    })
}

impl Structure {
    /// Forces of inertia of a frame that turns about the origin of the machine's axes, at a state of coordinates and rates; `turn` is the
    /// turn of a shaft whose speed is given.
    pub fn frame_force(&self, frame: &MovingFrame, at: [&DVector<f64>; 2], turn: &Spin) -> FrameForce {
        frame_force(&self.lumps, frame, at, (self.turning, turn))
    }

    /// Stiffness and damping that such a frame adds.
    pub fn frame_matrices(
        &self,
        frame: &MovingFrame,
        at: [&DVector<f64>; 2],
        turn: &Spin,
    ) -> [DMatrix<f64>; 2] {
        frame_matrices(&self.lumps, frame, at, (self.turning, turn))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::numerics::modes::modes;

    /// Seen from axes that turn, what swings in a circle with `w0` does so with `w0 - W` and `w0 + W`.
    #[test]
    fn closed_form_a_point_mass_on_equal_springs_in_a_frame_that_turns() {
        let (mass, stiffness, turn) = (0.7, 2.8e5, 140.0);
        let mut map = Map::zeros(2);
        (map[(1, 0)], map[(2, 1)]) = (1.0, 1.0);
        let place = Vector3::new(0.1, 0.02, -0.03);
        let lumps = [Lump { place, mass, inertia: Vector3::zeros(), map }];
        let zero = Vector3::zeros();
        let frame = MovingFrame { arm: zero, acceleration: zero, turn: Vector3::x() * turn, change: zero };
        let still = DVector::zeros(2);
        let [more, coriolis] =
            frame_matrices(&lumps, &frame, [&still, &still], (Turning::Still, &Spin::default()));
        let one = DMatrix::identity(2, 2);
        let found = modes(&(&one * mass), &coriolis, &(&one * stiffness + more)).unwrap();
        let own = (stiffness / mass).sqrt();
        for (mode, expected) in found.iter().zip([own - turn, own + turn]) {
            assert!(
                (mode.frequency() * TAU / expected - 1.0).abs() < 1e-9,
                "{} {expected}",
                mode.frequency()
            );
        }
        assert_eq!(found.len(), 2);
    }
}
