//! A bearing by its stiffness, and a coupling: springs and dampers between a shaft and what its outer ring sits in, or another shaft, without balls or rollers.

use nalgebra::{Matrix2, Vector2, Vector6};

use super::force::LinkForce;
use super::force_table::{ForceTable, TableForce};
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

/// A stiffness.
#[derive(Clone, Debug, PartialEq)]
pub enum Spring {
    /// [N/m or N m/rad] One at all displacements.
    Linear(f64),
    /// By a table.
    Table(ForceTable),
}

impl Spring {
    /// [N/m or N m/rad] what it is as a whole.
    pub fn mean(&self) -> f64 {
        match self {
            Self::Linear(stiffness) => *stiffness,
            Self::Table(table) => table.mean_stiffness(),
        }
    }

    /// At a displacement, which a number takes through a law of contact.
    fn at(&self, x: f64, contact: impl Fn(f64) -> OneSided) -> Acting {
        match self {
            Self::Linear(k) => {
                let law = contact(x);
                Acting { k: *k, law, engaged: [law.slope, law.curvature] }
            }
            Self::Table(table) => {
                let TableForce { force, stiffness, stored } = table.at(x);
                let law = OneSided { way: force, slope: stiffness, curvature: 0.0, potential: stored };
                Acting { k: 1.0, law, engaged: [1.0, 0.0] }
            }
        }
    }
}

/// A spring at a displacement.
struct Acting {
    /// Force, stiffness and energy are those of the law times this.
    k: f64,
    law: OneSided,
    /// [-, 1/m] part of the damper that acts, and its derivative.
    engaged: [f64; 2],
}

/// A bearing by its stiffness, or a coupling.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringBearing {
    /// [N/m] across the axis, along it; [N m/rad] of a tilt.
    pub stiffness: [Spring; 3],
    /// [N s/m, N s/m, N m s/rad] likewise.
    pub damping: [f64; 3],
    /// [N m/rad, N m s/rad] about the axis; none of a bearing.
    pub torsion: Option<(Spring, f64)>,
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
        let [_, axial, tilt] = &self.stiffness;
        for way in ways {
            let (sign, acting) = match way {
                0.0 => (1.0, axial.at(displacement[0], OneSided::linear)),
                sign => (*sign, axial.at(sign * displacement[0], OneSided::at)),
            };
            add_along(0, (sign, acting), self.damping[1], rate, &mut on);
        }
        for axis in [4, 5] {
            let acting = tilt.at(displacement[axis], OneSided::linear);
            add_along(axis, (1.0, acting), self.damping[2], rate, &mut on);
        }
        if let Some((torsion, damping)) = &self.torsion {
            let acting = torsion.at(displacement[3], OneSided::linear);
            add_along(3, (1.0, acting), *damping, rate, &mut on);
        }
        on
    }

    /// Across the axis: away from the middle, once the play is used up.
    fn add_radial(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>, on: &mut LinkForce) {
        let c = self.damping[0];
        let place: Vector2<f64> = displacement.fixed_rows::<2>(1).into_owned();
        let velocity: Vector2<f64> = rate.fixed_rows::<2>(1).into_owned();
        let radius = place.norm();
        let contact = |radius: f64| match self.gap {
            gap if gap > 0.0 => OneSided::at(radius - gap),
            _ => OneSided::linear(radius),
        };
        let Acting { k, law, engaged: [engaged, engaging] } = self.stiffness[0].at(radius, contact);
        // In the middle of a bearing without play every direction is the same.
        let out = if radius > 0.0 { place / radius } else { Vector2::zeros() };
        let along = out * out.transpose();
        let round = if radius > 0.0 { law.way / radius } else { law.slope };
        let force = -out * (k * law.way) - velocity * (c * engaged);
        let by_place = -(along * law.slope + (Matrix2::identity() - along) * round) * k
            - velocity * out.transpose() * (c * engaging);
        let mut rows = on.force.fixed_rows_mut::<2>(1);
        rows += force;
        let mut block = on.by_displacement.fixed_view_mut::<2, 2>(1, 1);
        block += by_place;
        let mut block = on.by_rate.fixed_view_mut::<2, 2>(1, 1);
        block -= Matrix2::identity() * (c * engaged);
        on.stored += k * law.potential;
        on.damped += c * engaged * velocity.norm_squared();
    }
}

/// Along or about one axis, with the sign of the displacement that it stands against.
fn add_along(axis: usize, (sign, acting): (f64, Acting), c: f64, rate: &Vector6<f64>, on: &mut LinkForce) {
    let Acting { k, law, engaged: [engaged, engaging] } = acting;
    let closing = sign * rate[axis];
    on.force[axis] -= sign * (k * law.way + c * engaged * closing);
    on.by_displacement[(axis, axis)] -= k * law.slope + c * engaging * closing;
    on.by_rate[(axis, axis)] -= c * engaged;
    on.stored += k * law.potential;
    on.damped += c * engaged * closing * closing;
}
