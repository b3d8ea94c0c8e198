//! A body whose centre of mass lies beside its origin, as that of a cage with an unbalance.
//!
//! With `u` the mass times the offset of the centre of mass, material, `R` the orientation, `a` the acceleration of the origin, `g` gravity,
//! `J` the inertia about the origin, `w` the material angular velocity:
//!
//! ```text
//! m a   = F - R (w' x u + w x (w x u))        F with the weight
//! J w'  = M - w x J w - u x R^T (a - g)
//! ```

use nalgebra::{Matrix3, Vector3};

use super::step_turn::StepTurn;
use crate::model::bodies::RigidBody;
use crate::model::state::BodyState;
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::{Scalar, constant_vector, cross};

/// Force of an unbalance [kg m] on its body, whose origin has this acceleration less that of gravity [m/s2]: force (spatial) and moment
/// (material).
#[cold]
pub(super) fn of_unbalance<S: Scalar>(
    unbalance: &Vector3<f64>,
    turn: &StepTurn<S>,
    falling: &Vector3<S>,
) -> Wrench<S> {
    let u = constant_vector(unbalance);
    let inertial = cross(&turn.rate_derivative, &u) + cross(&turn.rate, &cross(&turn.rate, &u));
    Wrench { force: -turn.spatial(&inertial), moment: -cross(&u, &turn.material(falling)) }
}

/// \[W] power of the weight of a body on its unbalance [kg m], in gravity [m/s2].
pub(super) fn power_of_weight(unbalance: &Vector3<f64>, state: &BodyState, gravity: &Vector3<f64>) -> f64 {
    let gravity = state.pose.orientation.inverse() * gravity;
    unbalance.cross(&gravity).dot(&state.rate)
}

/// Accelerations of a body with an unbalance [kg m] under this force (spatial, with the weight) and moment (material, with the gyroscopic one) of
/// all that acts on it, in gravity [m/s2]; gives them as the force and moment that a body without one would need.
pub(super) fn balanced(
    body: &RigidBody,
    unbalance: &Vector3<f64>,
    state: &BodyState,
    (force, moment): (&Vector3<f64>, &Vector3<f64>),
    gravity: &Vector3<f64>,
) -> (Vector3<f64>, Vector3<f64>) {
    let (u, rate, orientation) = (unbalance, &state.rate, state.pose.orientation);
    let back = orientation.inverse();
    let force = back * force - rate.cross(&rate.cross(u));
    let moment = moment + u.cross(&(back * gravity));
    // The origin's acceleration b = (force + u x w')/m, put into the moments.
    let across = u.cross_matrix();
    let inertia = Matrix3::from_diagonal(&body.inertia) + across * across / body.mass;
    let angular = inertia.lu().solve(&(moment - u.cross(&force) / body.mass)).unwrap_or_default();
    (orientation * (force + u.cross(&angular)), angular.component_mul(&body.inertia))
}
