//! Teeth of two gears in mesh: normal forces along the lines of action in their planes of action.
//!
//! ```text
//! x_f = -n_f . (v_1 - v_2) - j/2              overlap on flank f, v displacements at the pitch point, j the normal backlash
//! F_f = k s(x_f) + c s'(x_f) x_f'             s one_sided
//! ```
//! `n_f` is the normal of the flank at the pitch point of the middle of the common face width: the force on the first gear is `F_f n_f`. It acts on
//! both gears at one place, so that torques are as the base radii, which are as the numbers of teeth (ISO 21771: 2007).

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::force::LinkForce;
use super::one_sided::OneSided;

/// A mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToothMesh {
    /// Normals of both flanks, on the first gear: of the one that presses where that gear drives while it turns about +x, and of the other.
    pub normals: [Vector3<f64>; 2],
    /// [N/m] stiffness along the normal.
    pub stiffness: f64,
    /// [N s/m] damping along it.
    pub damping: f64,
    /// \[m] play along it between both flanks.
    pub backlash: f64,
}

impl ToothMesh {
    /// \[m] overlap of a flank \[m] by the displacement of the first gear against the second.
    pub fn overlap(&self, flank: usize, displacement: &Vector6<f64>) -> f64 {
        -self.normals[flank].dot(&displacement.fixed_rows::<3>(0)) - 0.5 * self.backlash
    }

    /// \[N] normal force on each flank.
    pub fn flank_forces(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>) -> [f64; 2] {
        [0, 1].map(|flank| {
            let (law, closing) = self.flank(flank, displacement, rate, None);
            self.stiffness * law.way + self.damping * law.slope * closing
        })
    }

    fn flank(
        &self,
        flank: usize,
        displacement: &Vector6<f64>,
        rate: &Vector6<f64>,
        held: Option<usize>,
    ) -> (OneSided, f64) {
        let x = self.overlap(flank, displacement);
        let law = match held {
            None => OneSided::at(x),
            Some(other) if other == flank => OneSided::held(x),
            Some(_) => OneSided::at(f64::NEG_INFINITY),
        };
        (law, -self.normals[flank].dot(&rate.fixed_rows::<3>(0)))
    }

    /// Force on the first gear at the pitch point; of teeth that stay in contact on a flank, if one is named.
    pub fn force(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>, held: Option<usize>) -> LinkForce {
        let mut force = Vector3::zeros();
        let (mut by_place, mut by_velocity) = (Matrix3::zeros(), Matrix3::zeros());
        let (mut stored, mut damped) = (0.0, 0.0);
        for (flank, normal) in self.normals.iter().enumerate() {
            let (law, closing) = self.flank(flank, displacement, rate, held);
            let (k, c) = (self.stiffness, self.damping);
            force += normal * (k * law.way + c * law.slope * closing);
            let dyad = normal * normal.transpose();
            by_place -= dyad * (k * law.slope + c * law.curvature * closing);
            by_velocity -= dyad * (c * law.slope);
            stored += k * law.potential;
            damped += c * law.slope * closing * closing;
        }
        let mut on_first = Vector6::zeros();
        on_first.fixed_rows_mut::<3>(0).copy_from(&force);
        let whole = |part: Matrix3<f64>| {
            let mut whole = Matrix6::zeros();
            whole.fixed_view_mut::<3, 3>(0, 0).copy_from(&part);
            whole
        };
        LinkForce {
            force: on_first,
            by_displacement: whole(by_place),
            by_rate: whole(by_velocity),
            stored,
            damped,
        }
    }
}
