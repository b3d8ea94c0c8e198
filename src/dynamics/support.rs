//! A race on a flexible support in one trial step: what the support does to it, with derivatives.

use nalgebra::Vector3;

use super::Boundary;
use super::body::BodyTrial;
use super::directions::D;
use crate::effects::support::{Held, Relative, Support, SupportState};
use crate::model::Model;
use crate::model::bodies::{Body, Race};
use crate::model::state::{Powers, State};
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::{Pose, Twist, Wrench};
use crate::numerics::rotation::{conformal_product, rotate, turn};
use crate::numerics::scalar::{constant_vector, cross};

/// The flange of a race on a support.
#[derive(Clone, Copy, Debug)]
pub struct Flange<'a> {
    /// The support.
    pub support: &'a Support,
    /// Pose of the flange.
    pub pose: &'a Pose,
    /// Its twist.
    pub twist: &'a Twist,
}

impl Boundary {
    /// The flange of a race on a support; none of other bodies.
    pub fn flange<'a>(&'a self, model: &'a Model, body: Body) -> Option<Flange<'a>> {
        let Body::Race(race) = body else {
            return None;
        };
        let (pose, twist) = &self.motion[race];
        model.supports[race].as_ref().map(|support| Flange { support, pose, twist })
    }
}

impl BodyTrial {
    /// Force (spatial) and moment (material) of a support.
    #[cold]
    pub(super) fn held_by(&self, flange: &Flange<'_>, step: &HhtStep) -> Wrench<D> {
        let Flange { support, pose, twist } = flange;
        let [place, velocity, turning] =
            [pose.position, twist.velocity, twist.angular_velocity].map(|v| constant_vector::<D>(&v));
        let displacement = self.position(step) - place;
        let Held { force, elastic_moment, damping_moment } = support.holds(
            pose,
            &Relative {
                displacement,
                rotation: conformal_product(
                    &(pose.orientation.inverse() * self.start_orientation),
                    &self.rotation,
                ),
                velocity: self.velocity(step) - velocity - cross(&turning, &displacement),
                angular_velocity: self.motion.angular_velocity - turning,
            },
        );
        let damping = turn(&self.start_orientation.inverse(), &damping_moment);
        Wrench { force, moment: elastic_moment + rotate(&-self.rotation, &damping) }
    }
}

/// Supports of a state whose bodies are where they are; adds their powers.
pub(super) fn renew_supports(model: &Model, state: &mut State, boundary: &Boundary, powers: &mut Powers) {
    for race in Race::BOTH {
        let Some(support) = &model.supports[race] else {
            continue;
        };
        let (pose, twist) = &boundary.motion[race];
        let body = state.race(race);
        let now: SupportState = support.state((pose, twist), (&body.pose, &body.twist()));
        powers.input += now.power_into();
        powers.around += now.lost;
        state.supports[race] = Some(now);
    }
}

/// Force (spatial) and moment (material) of a support on a race at a pose with a twist.
pub(super) fn on_race(flange: &Flange<'_>, race: &Pose, twist: &Twist) -> Wrench {
    let Flange { support, pose, twist: flange_twist } = flange;
    let held = support.holds(pose, &Relative::between((pose, flange_twist), (race, twist)));
    let to_material = race.orientation.inverse();
    let moment: Vector3<f64> = held.elastic_moment + to_material * held.damping_moment;
    Wrench { force: held.force, moment }
}
