//! Teeth of two gears in mesh: normal forces along the lines of action in their planes of action.
//!
//! ```text
//! p   = p_0 + z_2/(z_1 + z_2) r_x                   turn of the first gear against the line of centres, r the relative rotation
//! x_f = -n_f . (u_1 - u_2) - j/2 +- e(p)            overlap on flank f, u displacements at the pitch point, j the normal backlash
//! V   = sum_f k (1 + v(p)) S(x_f)                   S the integral of s, one_sided
//! F_f = k (1 + v(p)) s(x_f) + c s'(x_f) x_f'
//! ```
//! `n_f` is the normal of the flank at the pitch point of the middle of the common face width: the force on the first gear is `F_f n_f`. It acts on
//! both gears at one place, so that torques are as the base radii, which are as the numbers of teeth (ISO 21771: 2007).
//!
//! What varies as teeth come and go, stiffness `v` and transmission error `e`, depends on the relative rotation alone. So the force is that of a
//! potential of the displacement: beside `F_f n_f` a couple about the axes, `-F_f e'(p) dp/dr_x` of the error and the small `-k v' S dp/dr_x`. That
//! is what the pitch point does as it moves with the error: torques are as the speeds at every moment, and no energy is made.

use nalgebra::{Vector3, Vector6};

use super::force::LinkForce;
use super::one_sided::OneSided;
use super::variation::Variation;

/// What varies with the turn of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Varying {
    /// \[rad] turn of the first gear against the line of centres at the start.
    pub turned: f64,
    /// [-] of the stiffness: v.
    pub stiffness: Variation,
    /// \[m] transmission error along the normal, e: how far the second gear is pushed on, where the first drives as it turns about +x.
    pub error: Variation,
}

/// Friction between teeth, in the mean over a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToothFriction {
    /// \[m] moment against the relative rotation over the normal force.
    pub arm: f64,
    /// [rad/s] relative rotation over which it takes its sign.
    pub slow: f64,
}

/// A mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct ToothMesh {
    /// Normals of both flanks, on the first gear: of the one that presses where that gear drives while it turns about +x, and of the other.
    pub normals: [Vector3<f64>; 2],
    /// \[m] from the axis of each gear to the pitch point.
    pub arms: [Vector3<f64>; 2],
    /// [N/m] mean stiffness along the normal.
    pub stiffness: f64,
    /// [N s/m] damping along it.
    pub damping: f64,
    /// \[m] play along it between both flanks.
    pub backlash: f64,
    /// [-] turn of the first gear against the line of centres, over the relative rotation of both.
    pub turn: f64,
    /// What varies as they turn; nothing if not given.
    pub varying: Option<Varying>,
    /// Friction of the teeth; none if not given.
    pub friction: Option<ToothFriction>,
}

/// A flank in contact.
struct Flank {
    law: OneSided,
    /// [m/s] rate of the overlap.
    closing: f64,
    /// Derivative of the overlap by the displacement.
    gradient: Vector6<f64>,
    /// Its derivative by the relative rotation: of the last component by that alone.
    bend: f64,
}

/// Index of the relative rotation about the axes.
const TURN: usize = 3;

impl ToothMesh {
    /// Value, slope and second derivative by the relative rotation, of the stiffness over its mean and of the error \[m].
    fn varied(&self, varying: Option<&Varying>, rotation: f64) -> [[f64; 3]; 2] {
        let Some(varying) = varying else { return [[1.0, 0.0, 0.0], [0.0; 3]] };
        let by_turn = [1.0, self.turn, self.turn * self.turn];
        let at = |of: &Variation| {
            let own = of.at(varying.turned + self.turn * rotation);
            [0, 1, 2].map(|k| own[k] * by_turn[k])
        };
        let [value, slope, bend] = at(&varying.stiffness);
        [[1.0 + value, slope, bend], at(&varying.error)]
    }

    /// \[m] overlap of a flank by the displacement of the first gear against the second.
    pub fn overlap(&self, flank: usize, displacement: &Vector6<f64>) -> f64 {
        let [_, error] = self.varied(self.varying.as_ref(), displacement[TURN]);
        self.overlap_by(flank, displacement, error[0])
    }

    fn overlap_by(&self, flank: usize, displacement: &Vector6<f64>, error: f64) -> f64 {
        sign(flank) * error - self.normals[flank].dot(&displacement.fixed_rows::<3>(0)) - 0.5 * self.backlash
    }

    /// \[N] normal force on each flank.
    pub fn flank_forces(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>) -> [f64; 2] {
        let [stiffness, error] = self.varied(self.varying.as_ref(), displacement[TURN]);
        [0, 1].map(|flank| {
            let Flank { law, closing, .. } = self.flank(flank, (displacement, rate), &error, None);
            self.stiffness * stiffness[0] * law.way + self.damping * law.slope * closing
        })
    }

    fn flank(
        &self,
        flank: usize,
        (displacement, rate): (&Vector6<f64>, &Vector6<f64>),
        error: &[f64; 3],
        held: Option<usize>,
    ) -> Flank {
        let x = self.overlap_by(flank, displacement, error[0]);
        let law = match held {
            None => OneSided::at(x),
            Some(other) if other == flank => OneSided::held(x),
            Some(_) => OneSided::at(f64::NEG_INFINITY),
        };
        let normal = &self.normals[flank];
        let mut gradient = Vector6::new(-normal.x, -normal.y, -normal.z, 0.0, 0.0, 0.0);
        gradient[TURN] = sign(flank) * error[1];
        Flank { law, closing: gradient.dot(rate), gradient, bend: sign(flank) * error[2] }
    }

    /// Force on the first gear at the pitch point; of teeth that stay in contact on a flank, if one is named.
    pub fn force(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>, held: Option<usize>) -> LinkForce {
        self.force_with(self.varying.as_ref(), (displacement, rate), held)
    }

    /// Force without what varies: as statics and natural frequencies take it.
    pub fn mean_force(
        &self,
        displacement: &Vector6<f64>,
        rate: &Vector6<f64>,
        held: Option<usize>,
    ) -> LinkForce {
        self.force_with(None, (displacement, rate), held)
    }

    fn force_with(
        &self,
        varying: Option<&Varying>,
        (displacement, rate): (&Vector6<f64>, &Vector6<f64>),
        held: Option<usize>,
    ) -> LinkForce {
        let [stiffness, error] = self.varied(varying, displacement[TURN]);
        let [k, slope, bend] = stiffness.map(|over_mean| self.stiffness * over_mean);
        let c = self.damping;
        let mut on = LinkForce::none();
        for flank in 0..2 {
            let Flank { law, closing, gradient, bend: error_bend } =
                self.flank(flank, (displacement, rate), &error, held);
            let normal = k * law.way + c * law.slope * closing;
            let dyad = gradient * gradient.transpose();
            let mut by_displacement = -dyad * (k * law.slope + c * law.curvature * closing);
            let by_rate = -dyad * (c * law.slope);
            let mut force = -gradient * normal;
            force[TURN] -= slope * law.potential;
            // What varies: the gradient turns with the error, the stiffness with the teeth.
            let mut column = by_displacement.column_mut(TURN);
            column -= gradient * (slope * law.way + c * law.slope * error_bend * rate[TURN]);
            let mut row = by_displacement.row_mut(TURN);
            row -= gradient.transpose() * (slope * law.way);
            by_displacement[(TURN, TURN)] -= normal * error_bend + bend * law.potential;
            on.force += force;
            on.by_displacement += by_displacement;
            on.by_rate += by_rate;
            on.stored += k * law.potential;
            on.damped += c * law.slope * closing * closing;
            if let Some(friction) = &self.friction {
                let mut by_place = gradient * (k * law.slope + c * law.curvature * closing);
                by_place[TURN] += slope * law.way + c * law.slope * error_bend * rate[TURN];
                friction.add(normal, [by_place, gradient * (c * law.slope)], rate[TURN], &mut on);
            }
        }
        on
    }

    /// \[rad] misalignment of the teeth in their plane of action, from a displacement: by how much the flank of the first gear that presses is
    /// turned into the other one towards +x.
    pub fn misalignment(&self, displacement: &Vector6<f64>) -> f64 {
        let pressing = usize::from(self.overlap(1, displacement) > self.overlap(0, displacement));
        let mut normal = self.normals[pressing];
        normal.x = 0.0;
        // Of a point `b` further along x the first flank moves by `r x b` against the second.
        -normal.normalize().dot(&displacement.fixed_rows::<3>(3).cross(&Vector3::x()))
    }

    /// [N m] moment of the axial force on each gear, about the axis of that.
    pub fn tilting_moments(&self, on_first: &Vector6<f64>) -> [Vector3<f64>; 2] {
        let axial = Vector3::new(on_first[0], 0.0, 0.0);
        [self.arms[0].cross(&axial), self.arms[1].cross(&-axial)]
    }

    /// \[W] power that friction of the teeth takes.
    pub fn friction_power(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>) -> f64 {
        let Some(friction) = &self.friction else { return 0.0 };
        let normal: f64 = self.flank_forces(displacement, rate).iter().map(|force| force.max(0.0)).sum();
        friction.moment(normal, rate[TURN]) * rate[TURN]
    }
}

impl ToothFriction {
    fn moment(&self, normal: f64, rate: f64) -> f64 {
        self.arm * normal * (rate / self.slow).tanh()
    }

    /// Adds the moment of a normal force \[N], with the derivatives of that by displacement and rate. A damper that pulls has no friction.
    fn add(&self, normal: f64, [by_displacement, by_rate]: [Vector6<f64>; 2], rate: f64, on: &mut LinkForce) {
        if normal <= 0.0 {
            return;
        }
        let towards = (rate / self.slow).tanh();
        on.force[TURN] -= self.arm * normal * towards;
        let mut row = on.by_displacement.row_mut(TURN);
        row -= by_displacement.transpose() * (self.arm * towards);
        let mut row = on.by_rate.row_mut(TURN);
        row -= by_rate.transpose() * (self.arm * towards);
        on.by_rate[(TURN, TURN)] -= self.arm * normal * (1.0 - towards * towards) / self.slow;
        on.damped += self.moment(normal, rate) * rate;
    }
}

/// The sign with which the error acts on a flank.
fn sign(flank: usize) -> f64 {
    if flank == 0 { 1.0 } else { -1.0 }
}
