//! A bearing by its stiffness: springs and dampers between a shaft and what its outer ring sits in, without balls or rollers.

use nalgebra::{Matrix2, Vector2, Vector6};

use super::force::LinkForce;
use super::one_sided::OneSided;

/// Along which directions of its axis a bearing holds the shaft.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxialSupport {
    /// Both.
    Both,
    /// Forces of the shaft along +x.
    Along,
    /// Forces of the shaft along -x.
    Against,
}

/// A bearing by its stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringBearing {
    /// [N/m] across the axis, along it; [N m/rad] of a tilt.
    pub stiffness: [f64; 3],
    /// [N s/m, N s/m, N m s/rad] likewise.
    pub damping: [f64; 3],
    /// \[m] play across the axis: as far as the shaft goes from the middle.
    pub gap: f64,
    /// Which way it holds the shaft.
    pub axial: AxialSupport,
    /// \[m, rad] where the shaft is while it does nothing.
    pub rest: Vector6<f64>,
}

impl SpringBearing {
    /// Force and moment on the shaft.
    pub fn force(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>) -> LinkForce {
        let mut on = LinkForce::none();
        let displacement = &(displacement - self.rest);
        self.add_radial(displacement, rate, &mut on);
        let ways: &[f64] = match self.axial {
            AxialSupport::Both => &[0.0],
            AxialSupport::Along => &[1.0],
            AxialSupport::Against => &[-1.0],
        };
        for way in ways {
            let law = match way {
                0.0 => OneSided::linear(displacement[0]),
                sign => OneSided::at(sign * displacement[0]),
            };
            let sign = if *way == 0.0 { 1.0 } else { *way };
            add_along(0, (sign, law), (self.stiffness[1], self.damping[1]), rate, &mut on);
        }
        for axis in [4, 5] {
            let law = OneSided::linear(displacement[axis]);
            add_along(axis, (1.0, law), (self.stiffness[2], self.damping[2]), rate, &mut on);
        }
        on
    }

    /// Across the axis: away from the middle, once the play is used up.
    fn add_radial(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>, on: &mut LinkForce) {
        let (k, c) = (self.stiffness[0], self.damping[0]);
        let place: Vector2<f64> = displacement.fixed_rows::<2>(1).into_owned();
        let velocity: Vector2<f64> = rate.fixed_rows::<2>(1).into_owned();
        let radius = place.norm();
        let law = if self.gap > 0.0 { OneSided::at(radius - self.gap) } else { OneSided::linear(radius) };
        // In the middle of a bearing without play every direction is the same.
        let out = if radius > 0.0 { place / radius } else { Vector2::zeros() };
        let along = out * out.transpose();
        let round = if radius > 0.0 { law.way / radius } else { law.slope };
        let force = -out * (k * law.way) - velocity * (c * law.slope);
        let by_place = -(along * law.slope + (Matrix2::identity() - along) * round) * k
            - velocity * out.transpose() * (c * law.curvature);
        let mut rows = on.force.fixed_rows_mut::<2>(1);
        rows += force;
        let mut block = on.by_displacement.fixed_view_mut::<2, 2>(1, 1);
        block += by_place;
        let mut block = on.by_rate.fixed_view_mut::<2, 2>(1, 1);
        block -= Matrix2::identity() * (c * law.slope);
        on.stored += k * law.potential;
        on.damped += c * law.slope * velocity.norm_squared();
    }
}

/// Along or about one axis, with the sign of the displacement that it stands against.
fn add_along(
    axis: usize,
    (sign, law): (f64, OneSided),
    (k, c): (f64, f64),
    rate: &Vector6<f64>,
    on: &mut LinkForce,
) {
    let closing = sign * rate[axis];
    on.force[axis] -= sign * (k * law.way + c * law.slope * closing);
    on.by_displacement[(axis, axis)] -= k * law.slope + c * law.curvature * closing;
    on.by_rate[(axis, axis)] -= c * law.slope;
    on.stored += k * law.potential;
    on.damped += c * law.slope * closing * closing;
}
