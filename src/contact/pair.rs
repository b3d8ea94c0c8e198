//! Forces and moments between two bodies that touch.

use nalgebra::Vector3;

use crate::numerics::motion::Wrench;
use crate::numerics::scalar::{Scalar, constant_vector};

/// Forces between a first and a second body, world axes. The force on the second is the opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairForces<S: Scalar = f64> {
    /// \[m] approach; negative is a gap.
    pub approach: S,
    /// \[N] normal load.
    pub load: S,
    /// [N/m^1.5] Hertz stiffness; of a line contact [N/m^(10/9)].
    pub stiffness: S,
    /// \[N] force on the first body.
    pub force: Vector3<S>,
    /// [N m] moment on the first body about its origin.
    pub moment: Vector3<S>,
    /// [N m] moment on the second body about its origin.
    pub other_moment: Vector3<S>,
    /// \[W] power lost to friction.
    pub friction_power: S,
    /// \[W] power lost to contact damping.
    pub damping_power: S,
}

impl<S: Scalar> PairForces<S> {
    /// No forces: the bodies do not touch.
    pub fn none() -> Self {
        let (zero, vector) = (S::zero(), constant_vector(&Vector3::zeros()));
        Self {
            approach: zero,
            load: zero,
            stiffness: zero,
            force: vector,
            moment: vector,
            other_moment: vector,
            friction_power: zero,
            damping_power: zero,
        }
    }

    /// Forces in other numbers.
    #[inline(always)]
    pub fn map<T: Scalar>(&self, number: impl Fn(S) -> T) -> PairForces<T> {
        PairForces {
            approach: number(self.approach),
            load: number(self.load),
            stiffness: number(self.stiffness),
            force: self.force.map(&number),
            moment: self.moment.map(&number),
            other_moment: self.other_moment.map(&number),
            friction_power: number(self.friction_power),
            damping_power: number(self.damping_power),
        }
    }
}

impl PairForces {
    /// \[J] elastic energy of a Hertz contact.
    #[inline(always)]
    pub fn elastic_energy(&self) -> f64 {
        let depth = self.approach.max(0.0);
        0.4 * self.stiffness * (depth * depth * depth.sqrt())
    }

    /// Force and moment on the first body.
    #[inline(always)]
    pub fn on_first(&self) -> Wrench {
        Wrench { force: self.force, moment: self.moment }
    }
}
