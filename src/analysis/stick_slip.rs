//! Where a contact of a running bearing sticks and where it slips: pressure, tractions and slip over its ellipse, as in figure 1b
//! of the paper.
//!
//! The half-space solver computes them from load, ellipse and creepages that the contact has in the simulation, whatever law its
//! forces there are of.

use serde::{Deserialize, Serialize};

use crate::contact::BallRaceContact;
use crate::contact::film::Film;
use crate::kalker::half_space::{CellState, HalfSpace, HalfSpaceError, cells};
use crate::kalker::{Patch, ScaledCreepage, ScaledForces};
use crate::model::bodies::Race;
use crate::model::state::State;
use crate::model::{Conditions, Model};

/// The field of one contact, in frame C (x along rolling, y transverse), or in the axes of its ellipse where it rolls obliquely to them.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// \[m] semi-axes of the ellipse along x and y.
    pub semi_axes: [f64; 2],
    /// [-] forces of the ball on the race over mu Q, spin moment over mu Q c, by these tractions.
    pub forces: ScaledForces,
    /// [-] adhesion area over contact area.
    pub stick: f64,
    /// Cells of the grid.
    pub points: Vec<FieldPoint>,
}

/// A cell of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldPoint {
    /// \[m] place from the middle of the ellipse.
    pub place: [f64; 2],
    /// \[m2] area.
    pub area: f64,
    /// \[Pa] pressure.
    pub pressure: f64,
    /// \[Pa] traction of the ball on the race.
    pub traction: [f64; 2],
    /// [m/s] slip of the ball over the race; that of cells that stick is what the solver leaves.
    pub slip: [f64; 2],
    /// Does it stick?
    pub sticks: bool,
}

/// Quantities that the field of a contact that carries load with friction follows from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FieldCause {
    /// \[m] semi-axes of the ellipse along x and y.
    pub semi_axes: [f64; 2],
    /// \[Pa] largest pressure.
    pub pressure: f64,
    /// [-] friction coefficient.
    pub friction: f64,
    /// [-] creepage along x and y, of spin, and by the curvature of the groove, scaled as in [`crate::kalker`].
    pub creepage: [f64; 4],
    /// [-] Poisson's ratio.
    pub poisson_ratio: f64,
    /// \[Pa] shear modulus.
    pub shear_modulus: f64,
    /// [m/s] speed of rolling.
    pub rolling_speed: f64,
    /// \[rad] direction of rolling from the first semi-axis; 0 in frame C.
    #[serde(default)]
    pub rolling_angle: f64,
}

impl FieldCause {
    /// That of the contact of a ball (0 is the first) with a race in a state; none of a contact that carries no load, or has no friction.
    pub fn of(
        model: &Model,
        state: &State,
        conditions: &Conditions,
        (ball, race): (usize, Race),
    ) -> Option<Self> {
        let (motion, race_motion) = (state.balls[ball].motion(), state.race(race).motion());
        let contacts = model.contact(race, conditions).oriented(state.orientations.as_ref());
        let contacts = contacts.of_ball(ball, state.difference(ball, race));
        let contact = contacts.completed(&contacts.evaluate(&motion, &race_motion), &motion, &race_motion);
        // Of a film its friction coefficient; that it yields before it slides is no part of the half-space.
        let in_oil = |film: &Film<'_>| film.forces(&contacts.film_loading(&contact)).friction;
        let friction = contacts.film.as_ref().map_or(conditions.friction, in_oil);
        let rolling = friction > 0.0 && contact.load > 0.0;
        rolling.then(|| Self::of_contact(model, friction, &contact))
    }

    fn of_contact(model: &Model, friction: f64, contact: &BallRaceContact<f64>) -> Self {
        let materials = &model.bearing.materials;
        let root = contact.geometry.approach.sqrt();
        let semi_axes @ [a, b] = contact.semi_axes.map(|axis| axis * root);
        let mean = (a * b).sqrt();
        let pressure = 1.5 * contact.load / (std::f64::consts::PI * a * b);
        // Frame C has x along the rolling direction; the kernel's x is along the circumference.
        let along = if contact.rolling_cosine < 0.0 { -1.0 } else { 1.0 };
        let (poisson_ratio, shear_modulus) = (materials.poisson_ratio, materials.shear_modulus);
        let scale = shear_modulus / (friction * pressure);
        let creepage = [
            along * contact.creepage.longitudinal * scale,
            along * contact.creepage.lateral * scale,
            contact.creepage.spin * mean * scale,
            along * contact.creepage.curvature.unwrap_or(0.0) * mean * mean * scale,
        ];
        let rolling_speed = contact.rolling_speed;
        let rolling_angle = 0.0;
        Self {
            semi_axes,
            pressure,
            friction,
            creepage,
            poisson_ratio,
            shear_modulus,
            rolling_speed,
            rolling_angle,
        }
    }

    /// The field on about `n` times `n` cells.
    ///
    /// # Errors
    /// See [`HalfSpaceError`].
    pub fn field(&self, n: usize) -> Result<Field, HalfSpaceError> {
        let Self { semi_axes, pressure, friction, poisson_ratio, rolling_angle, .. } = *self;
        let ([a, b], [x, y, spin, curvature]) = (semi_axes, self.creepage);
        let mean = (a * b).sqrt();
        let scale = self.shear_modulus / (friction * pressure);
        let creepage = ScaledCreepage { x, y, spin, curvature };
        let patch = Patch { axis_ratio: a / b, poisson_ratio, rolling_angle };
        let grid = HalfSpace::with_cells(&patch, cells(&patch, n))?;
        let solution = grid.solve(&creepage, None)?;
        let point = |cell: CellState| FieldPoint {
            place: cell.place.map(|place| place * mean),
            area: cell.area * mean * mean,
            pressure: pressure * cell.bound,
            traction: cell.traction.map(|traction| traction * friction * pressure),
            slip: cell.slip.map(|slip| slip / scale * self.rolling_speed),
            sticks: cell.sticks,
        };
        Ok(Field {
            semi_axes,
            forces: solution.forces,
            stick: solution.stick,
            points: grid.states(&creepage, &solution).into_iter().map(point).collect(),
        })
    }
}

/// The field of the contact of a ball (0 is the first) with a race in a state, on about `n` times `n` cells; none of a contact
/// that carries no load, or has no friction.
///
/// # Errors
/// See [`HalfSpaceError`].
pub fn field(
    model: &Model,
    state: &State,
    conditions: &Conditions,
    contact: (usize, Race),
    n: usize,
) -> Result<Option<Field>, HalfSpaceError> {
    FieldCause::of(model, state, conditions, contact).map(|cause| cause.field(n)).transpose()
}
