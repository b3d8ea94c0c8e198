//! Rigid parts that have the mass of a structure, as what acts on it in a frame that turns depends on where its mass is.

use nalgebra::{DVector, Dyn, Matrix, Storage, U6, Vector3};

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
    /// The same by more coordinates, the new ones without effect.
    #[must_use]
    pub fn widened(self, size: usize) -> Self {
        Self { map: self.map.resize_horizontally(size, 0.0), ..self }
    }
}

/// What acts on a structure because its frame turns.
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

impl Structure {
    /// Forces of inertia of a frame that turns about the origin of the machine's axes, at a state of coordinates and rates; `turn` is the
    /// turn of a shaft whose speed is given. They are those of where the structure is and how it moves in the frame, to the first order of
    /// its tilts.
    pub fn frame_force(
        &self,
        frame: &MovingFrame,
        [q, rates]: [&DVector<f64>; 2],
        turn: &Spin,
    ) -> FrameForce {
        let mut sum = FrameForce { force: DVector::zeros(self.size()), axial: 0.0 };
        for lump in &self.lumps {
            let [[displacement, mut tilt], [velocity, mut spin]] = [q, rates].map(|of| moved(&lump.map, of));
            match self.turning {
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
}
