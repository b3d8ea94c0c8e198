//! What a structure does by itself: forces, torque and energy of its mass, damping, stiffness and spin.

use nalgebra::DVector;

use super::{Spin, Structure, Turning};

/// Forces of a structure itself at a place and rates, and the products that torque, losses and energy are made of.
#[derive(Clone, Debug, Default)]
pub struct OwnForces {
    /// Damping, gyroscopic, elastic, and those of a spin that changes.
    pub total: DVector<f64>,
    /// `C q'`.
    damping: DVector<f64>,
    /// `K q`.
    elastic: DVector<f64>,
    /// `G q`.
    turned: DVector<f64>,
}

impl OwnForces {
    /// \[W] lost to damping at these rates.
    pub fn damped(&self, rates: &DVector<f64>) -> f64 {
        rates.dot(&self.damping)
    }
}

impl Structure {
    /// Forces of the structure itself.
    pub fn own_forces(&self, q: &DVector<f64>, rates: &DVector<f64>, spin: &Spin) -> OwnForces {
        let (damping, elastic, turned) = (&self.damping * rates, &self.stiffness * q, &self.gyroscopic * q);
        let gyroscopic = rates * spin.speed + q * (0.5 * spin.acceleration);
        let mut total = -&damping - &elastic - &self.gyroscopic * &gyroscopic;
        match self.turning {
            Turning::Free => {}
            Turning::Still | Turning::Given => total -= &self.by_spin * spin.acceleration,
        }
        OwnForces { total, damping, elastic, turned }
    }

    /// [N m] inertial torque of the coordinates, whose own forces are given, and the spin about the x axis.
    pub fn spin_torque(&self, own: &OwnForces, accelerations: &DVector<f64>, spin: &Spin) -> f64 {
        self.polar_inertia * spin.acceleration
            + self.by_spin.dot(accelerations)
            + 0.5 * accelerations.dot(&own.turned)
    }

    /// \[J] kinetic and elastic energy where its own forces are these.
    pub fn stored(&self, own: &OwnForces, q: &DVector<f64>, rates: &DVector<f64>, spin: &Spin) -> f64 {
        let own_spin = match self.turning {
            // Its inertia is in the mass matrix.
            Turning::Free => 0.0,
            Turning::Still | Turning::Given => {
                spin.speed * (0.5 * self.polar_inertia * spin.speed + self.by_spin.dot(rates))
            }
        };
        0.5 * rates.dot(&(&self.mass * rates))
            + 0.5 * q.dot(&own.elastic)
            + 0.5 * spin.speed * rates.dot(&own.turned)
            + own_spin
    }
}
