//! Force of a link.

use nalgebra::{Matrix6, Vector6};

/// Force of a link, with its tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkForce {
    /// \[N, N m] force and moment on the first end.
    pub force: Vector6<f64>,
    /// Its derivative by the displacement.
    pub by_displacement: Matrix6<f64>,
    /// Its derivative by the rate.
    pub by_rate: Matrix6<f64>,
    /// \[J] energy that is stored.
    pub stored: f64,
    /// \[W] power that is lost.
    pub damped: f64,
    /// [-] force that is left on a body inside of the link, one without states, over what may be left: 1 at most in balance, 0 without such bodies.
    pub unbalanced: f64,
    /// [N m] part of the moment about the axis that is friction of rollers.
    pub friction: f64,
}

impl LinkForce {
    /// No force.
    pub fn none() -> Self {
        Self {
            force: Vector6::zeros(),
            by_displacement: Matrix6::zeros(),
            by_rate: Matrix6::zeros(),
            stored: 0.0,
            damped: 0.0,
            unbalanced: 0.0,
            friction: 0.0,
        }
    }

    /// Is all inside of the link in balance? What is not a number is no balance.
    pub fn is_balanced(&self) -> bool {
        self.unbalanced <= 1.0
    }

    /// The same without the moment about the axis, which is none in the mean over a turn, and without what the turn does.
    pub fn without_turning(mut self) -> Self {
        self.force[3] = 0.0;
        for matrix in [&mut self.by_displacement, &mut self.by_rate] {
            matrix.row_mut(3).fill(0.0);
            matrix.column_mut(3).fill(0.0);
        }
        self
    }
}
