//! Where the groove circle of a race is at the azimuth of a ball, where it is not that of a torus.

use nalgebra::Vector3;

use crate::contact::motion::RaceMotion;
use crate::numerics::scalar::{Scalar, cross, dot};

/// The groove circle at an azimuth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shift<S> {
    /// \[m] more radius.
    pub radial: S,
    /// \[m/rad] its slope.
    pub radial_slope: S,
    /// \[m] further along the axis.
    pub axial: S,
    /// \[m/rad] its slope.
    pub axial_slope: S,
}

impl<S: Scalar> Shift<S> {
    /// No shift.
    pub(super) fn none() -> Self {
        Self { radial: S::zero(), radial_slope: S::zero(), axial: S::zero(), axial_slope: S::zero() }
    }

    /// The same in other numbers.
    pub(super) fn map<T: Scalar>(&self, number: impl Fn(S) -> T) -> Shift<T> {
        Shift {
            radial: number(self.radial),
            radial_slope: number(self.radial_slope),
            axial: number(self.axial),
            axial_slope: number(self.axial_slope),
        }
    }

    /// Change of the angle of the contact, in radians times its distance from the groove's centre, along the circumference.
    #[inline(always)]
    pub(super) fn turn(&self, cos: S, sin: S) -> S {
        sin * self.radial_slope - cos * self.axial_slope
    }
}

/// \[rad] azimuth at `offset` \[m] from the origin of a race, from its own y axis.
#[inline(always)]
pub(super) fn azimuth<S: Scalar>(offset: &Vector3<S>, race: &RaceMotion<S>) -> S {
    let y = race.across.map(S::constant);
    let z = cross(&race.axis, &y);
    let [azimuth] = S::map_smooth_many([dot(offset, &y), dot(offset, &z)], |[y, z]| {
        let square = y * y + z * z;
        ([z.atan2(y)], [[-z / square, y / square]])
    });
    azimuth
}
