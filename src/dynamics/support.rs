//! A race on a flexible support in one trial step: what the support does to it, with derivatives or without.

use nalgebra::Vector3;

use super::Boundary;
use super::step_turn::StepTurn;
use crate::effects::reports::SupportState;
use crate::effects::support::{Held, Relative, Support};
use crate::model::Model;
use crate::model::bodies::{Body, PerRace, Race};
use crate::model::energies::Powers;
use crate::model::state::BodyState;
use crate::numerics::motion::{Pose, Twist, Wrench};
use crate::numerics::scalar::{Scalar, constant_vector, cross};

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

impl Flange<'_> {
    /// Force (spatial) and moment (material) of the support on a race at a position \[m] with a velocity [m/s].
    #[cold]
    pub(super) fn holds<S: Scalar>(
        &self,
        turn: &StepTurn<S>,
        (position, velocity): (&Vector3<S>, &Vector3<S>),
    ) -> Wrench<S> {
        let Flange { support, pose, twist } = self;
        let [place, moving, turning] =
            [pose.position, twist.velocity, twist.angular_velocity].map(|v| constant_vector::<S>(&v));
        let displacement = position - place;
        let Held { force, elastic_moment, damping_moment } = support.holds(
            pose,
            &Relative {
                displacement,
                rotation: turn.relative_to(&pose.orientation),
                velocity: velocity - moving - cross(&turning, &displacement),
                angular_velocity: turn.angular_velocity - turning,
            },
        );
        Wrench { force, moment: elastic_moment + turn.material(&damping_moment) }
    }
}

/// Supports of races that are where `bodies` are; adds their powers.
pub(super) fn supports_of<'a>(
    model: &Model,
    bodies: impl Fn(Race) -> Option<&'a BodyState>,
    boundary: &Boundary,
    powers: &mut Powers,
) -> PerRace<Option<SupportState>> {
    PerRace::new(|race| {
        let (support, body) = (model.supports[race].as_ref()?, bodies(race)?);
        let (pose, twist) = &boundary.motion[race];
        let now = support.state((pose, twist), (&body.pose, &body.twist()));
        powers.input += now.power_into();
        powers.around += now.lost;
        Some(now)
    })
}

/// Force (spatial) and moment (material) of a support on a race at a pose with a twist.
pub(super) fn on_race(flange: &Flange<'_>, race: &Pose, twist: &Twist) -> Wrench {
    let Flange { support, pose, twist: flange_twist } = flange;
    let held = support.holds(pose, &Relative::between((pose, flange_twist), (race, twist)));
    let to_material = race.orientation.inverse();
    let moment: Vector3<f64> = held.elastic_moment + to_material * held.damping_moment;
    Wrench { force: held.force, moment }
}
