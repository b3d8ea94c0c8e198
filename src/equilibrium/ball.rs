//! Quasi-static balance of one ball in its azimuthal plane.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::{EquilibriumInput, Gyroscopic};
use crate::contact::geometry::GrooveContact;
use crate::contact::{ContactModel, RaceMotion};
use crate::effects::moving_frame::MovingFrame;
use crate::model::Model;
use crate::model::bearing::azimuth_directions;
use crate::model::bodies::{PerRace, Race};
use crate::numerics::scalar::{Dual, Scalar, Single, WIDTH, constant_vector, cross, dot, values};

/// First direction of the shared unknowns: those of all balls together.
pub const SHARED: usize = 2;
/// Number of shared unknowns.
pub const N_SHARED: usize = 6;
/// A number with its derivatives by ball axial and radial, x, y, z, ry, rz of the race that moves, cage speed; the rest is zero.
pub type D = Dual<WIDTH>;
/// A number with its derivatives by the ball's own coordinates.
type Own = Dual<SHARED>;

/// [N/m] hold of a ball that nothing else holds, towards the middle of its gap; bearing at rest only. Its force,
/// below 1e-6 N in any gap, is far below what loads are resolved to.
pub const IDLE_HOLD: f64 = 1e-3;
/// [-] units in the last place of the ball's coordinates that count as balanced.
const ROUND_OFF_UNITS: f64 = 4.0;
/// Iterations of one ball.
const MAX_ITERATIONS: u32 = 100;

/// The inner race as the balls see it: relative to the outer race, with derivatives by the shared unknowns.
#[derive(Clone, Copy, Debug)]
pub struct Shared<S: Scalar = D> {
    /// \[m] origin of the inner race.
    pub position: Vector3<S>,
    /// [-] axis of the inner race.
    pub axis: Vector3<S>,
    /// [-] y axis of each race, which azimuths on it are counted from.
    pub across: PerRace<Vector3<f64>>,
    /// [rad/s] cage speed.
    pub cage_speed: S,
    /// [m/s2] gravity on the balls; what it does along the orbit is left to friction.
    pub gravity: Vector3<S>,
    /// The frame that the bearing is seen from, where it moves; places count from the outer race.
    pub frame: Option<MovingFrame<S>>,
}

impl Shared {
    /// Place as numbers that it does not depend on.
    pub fn fixed<S: Scalar>(&self) -> Shared<S> {
        let fixed = |v: &Vector3<D>| v.map(|c| S::constant(c.value));
        Shared {
            position: fixed(&self.position),
            axis: fixed(&self.axis),
            across: self.across,
            cage_speed: S::constant(self.cage_speed.value),
            gravity: fixed(&self.gravity),
            frame: self.frame.as_ref().map(|frame| MovingFrame {
                arm: fixed(&frame.arm),
                acceleration: fixed(&frame.acceleration),
                turn: fixed(&frame.turn),
                change: fixed(&frame.change),
            }),
        }
    }
}

/// Forces on one ball, all relative to the outer race's frame.
#[derive(Clone, Copy, Debug)]
pub struct BallBalance<S: Scalar = D> {
    /// \[N] unbalanced force along the two coordinates of [`Place`].
    pub residual: [S; 2],
    /// \[N] force on the ball of the race that moves.
    pub force: Vector3<S>,
    /// [N m] moment, about that race's origin, of the external load that holds it against this ball.
    pub moment: Vector3<S>,
    /// \[N] load on the inner race.
    pub inner_load: S,
    /// \[N] load on the outer race.
    pub outer_load: S,
    /// [rad/s] orbital speed that this ball alone would take.
    pub own_orbital_speed: S,
    /// Inner contact.
    pub inner: GrooveContact<S>,
    /// Outer contact.
    pub outer: GrooveContact<S>,
    /// [N/m^1.5] Hertz stiffness of inner and outer contact.
    pub stiffness: PerRace<S>,
    /// \[N] centrifugal force.
    pub centrifugal_force: S,
    /// [N m] gyroscopic moment; negative for a positive contact angle, as in Harris.
    pub gyroscopic_moment: S,
    /// [rad/s] angular velocity of the ball, axial and radial component.
    pub angular_velocity: [S; 2],
    /// \[m] centre of the ball, axial and radial.
    pub centre: [S; 2],
}

/// Where a ball is in its azimuthal plane, polar about the outer groove centre: arc and distance \[m]. A ball that
/// slides along the outer groove moves along one coordinate, which Newton's method needs to follow a curved groove.
pub type Place = Vector2<f64>;

/// \[m] distance of the ball centre from the groove centre where a ball touches a race without load. That of the outer race turns
/// the arc of a [`Place`] into an angle.
pub fn arc_radius(contact: &ContactModel<'_>) -> f64 {
    contact.surface.raceway.groove_radius - contact.surface.ball_radius
}

/// Balance of a ball (0 is the first) between the races of its contacts.
pub fn balance(
    model: &Model,
    contacts: &PerRace<ContactModel<'_>>,
    input: &EquilibriumInput,
    shared: &Shared,
    index: usize,
    place: &Place,
) -> BallBalance {
    let place = [D::variable(place.x, 0, 1.0), D::variable(place.y, 1, 1.0)];
    balance_at(model, contacts, input, shared, index, place)
}

/// Balance of a ball as far as settling it needs: derivatives by the ball's own coordinates alone.
#[derive(Clone, Copy)]
struct OwnBalance {
    /// \[N] unbalanced force along the two coordinates of [`Place`].
    residual: [Own; 2],
    /// Does a race press on it?
    touches: bool,
    /// [N/m^1.5] Hertz stiffness of the outer contact.
    outer_stiffness: f64,
}

/// Balance of a ball by itself: what settling it needs.
fn balance_alone(
    model: &Model,
    contacts: &PerRace<ContactModel<'_>>,
    input: &EquilibriumInput,
    shared: &Shared<Own>,
    index: usize,
    place: &Place,
) -> OwnBalance {
    let place = [Own::variable(place.x, 0, 1.0), Own::variable(place.y, 1, 1.0)];
    let whole = balance_at(model, contacts, input, shared, index, place);
    OwnBalance {
        residual: whole.residual,
        touches: whole.inner_load.value != 0.0 || whole.outer_load.value != 0.0,
        outer_stiffness: whole.stiffness.outer.value,
    }
}

/// Balance of a ball, without derivatives.
pub fn balance_value(
    model: &Model,
    contacts: &PerRace<ContactModel<'_>>,
    input: &EquilibriumInput,
    shared: &Shared<f64>,
    index: usize,
    place: &Place,
) -> BallBalance<f64> {
    balance_at(model, contacts, input, shared, index, [place.x, place.y])
}

#[inline(always)]
fn balance_at<S: Single>(
    model: &Model,
    contacts: &PerRace<ContactModel<'_>>,
    input: &EquilibriumInput,
    shared: &Shared<S>,
    index: usize,
    place: [S; 2],
) -> BallBalance<S> {
    let ball = &model.bearing.ball;
    let azimuth = model.bearing.ball_azimuth(index);
    let (radial, tangential) = azimuth_directions(azimuth);
    let (outer_groove, ball_radius) = (&contacts.outer.surface.raceway, contacts.outer.surface.ball_radius);
    let angle = place[0].scale(1.0 / arc_radius(&contacts.outer));
    let distance = place[1];
    let (sin, cos) = angle.value().sin_cos();
    let sine = angle.map_smooth(|_| (sin, cos));
    let cosine = angle.map_smooth(|_| (cos, -sin));
    let axial_place = distance * sine + S::constant(outer_groove.groove_offset);
    let radius = distance * cosine + S::constant(outer_groove.groove_circle_radius);
    let position =
        radial.map(|c| radius.scale(c)) + Vector3::new(axial_place, S::constant(0.0), S::constant(0.0));
    let [inner_race, outer_race] = [
        RaceMotion::resting(shared.position, shared.axis, shared.across.inner),
        RaceMotion::resting(
            constant_vector(&Vector3::zeros()),
            constant_vector(&Vector3::x()),
            shared.across.outer,
        ),
    ];
    let offset = position - shared.position;
    let here = PerRace::new(|race| contacts[race].of_ball(index, None));
    let (inner, inner_lean) = GrooveContact::apart(&here.inner.surface, &offset, &inner_race);
    let (outer, outer_lean) = GrooveContact::apart(&here.outer.surface, &position, &outer_race);
    let stiffness_of = |model: &ContactModel<'_>, contact: &GrooveContact<S>| {
        model.stiffness_of(model.shape.stiffness(contact.circumferential_curvature))
    };
    let stiffness =
        PerRace { inner: stiffness_of(&here.inner, &inner), outer: stiffness_of(&here.outer, &outer) };
    let load = |contact: &GrooveContact<S>, gain: S, stiffness: S| {
        let depth = contact.approach.positive_part();
        stiffness * depth * depth.sqrt() * gain
    };
    let inner_load = load(&inner, inner_lean.gain, stiffness.inner);
    let outer_load = load(&outer, outer_lean.gain, stiffness.outer);

    // rolling without slip at both contacts and without spin at the one that controls the ball (Jones)
    let (inner_cos, inner_sin) = (-dot(&inner.normal, &inner.radial), -dot(&inner.normal, &shared.axis));
    let (outer_cos, outer_sin) = (dot(&outer.normal, &outer.radial), outer.normal.x);
    let g = S::constant(ball_radius) / radius;
    let control = input.control(index);
    let apart = inner_cos * outer_cos + inner_sin * outer_sin;
    let ratio = match control {
        Race::Outer => S::one_minus(g * inner_cos),
        Race::Inner => apart - g * outer_cos,
    } / (S::constant(1.0) + apart);
    let own_orbital_speed =
        ratio.scale(input.inner_speed - input.outer_speed) + S::constant(input.outer_speed);
    let spin = match control {
        Race::Outer => {
            let roll = (shared.cage_speed - S::constant(input.outer_speed)) / g;
            [S::constant(input.outer_speed) - roll * outer_cos, roll * outer_sin]
        }
        Race::Inner => {
            let roll = (shared.cage_speed - S::constant(input.inner_speed)) / g;
            [S::constant(input.inner_speed) + roll * inner_cos, -(roll * inner_sin)]
        }
    };

    // inertia
    let centrifugal_force = (radius * shared.cage_speed.square()).scale(ball.mass);
    let mut gyroscopic_moment = -(shared.cage_speed * spin[1]).scale(ball.inertia);
    let mut outside = shared.gravity.map(|c| c.scale(ball.mass));
    if let Some(frame) = &shared.frame {
        let tangent = constant_vector::<S>(&tangential);
        let field = frame.field(&position, &tangent.map(|c| c * shared.cage_speed * radius));
        outside += field.map(|c| c.scale(ball.mass));
        // The moment along the orbit that the ball's spin asks for, turning with the frame; the others are left to friction.
        let turned = frame.turn.x * spin[1] - frame.turn.dot(&constant_vector(&radial)) * spin[0];
        gyroscopic_moment -= (turned + frame.change.dot(&tangent)).scale(ball.inertia);
    }
    // friction forces along n x e_t whose moments about the centre give the gyroscopic moment
    let needed = gyroscopic_moment.scale(1.0 / ball_radius);
    let [inner_friction, outer_friction] = match input.gyroscopic {
        Gyroscopic::None => [S::constant(0.0); 2],
        Gyroscopic::OuterRaceControl | Gyroscopic::InnerRaceControl | Gyroscopic::LeastHeat => {
            match control {
                Race::Outer => [S::constant(0.0), needed],
                Race::Inner => [needed, S::constant(0.0)],
            }
        }
        Gyroscopic::Friction => {
            let total = inner_load + outer_load + S::constant(f64::MIN_POSITIVE);
            // Shared in proportion to the loads; beyond the friction limit the ball pivots and the force stays there.
            let limit = total.scale(input.friction) + S::constant(1e-12);
            let x = needed / limit;
            let carried = needed / (S::constant(1.0) + x.square().square()).sqrt().sqrt();
            [carried * inner_load / total, carried * outer_load / total]
        }
    };
    let tangent = constant_vector(&tangential);
    let inner_force = -inner.normal * inner_load + cross(&inner.normal, &tangent) * inner_friction;
    let outer_force = -outer.normal * outer_load + cross(&outer.normal, &tangent) * outer_friction;
    let total = inner_force + outer_force + outside;
    let (axial, radial_force) = (total.x, dot(&total, &constant_vector(&radial)) + centrifugal_force);
    let mut residual = [axial * cosine - radial_force * sine, axial * sine + radial_force * cosine];
    if shared.cage_speed.value() == 0.0 {
        let middle = middle_of_gap(contacts, shared, azimuth);
        residual[0] -= (angle.scale(arc_radius(&contacts.outer)) - S::constant(middle.x)).scale(IDLE_HOLD);
        residual[1] -= (distance - S::constant(middle.y)).scale(IDLE_HOLD);
    }
    let (force, from, contact, edge) = match input.race {
        Race::Inner => (inner_force, offset, &inner, inner_lean.moment(inner_load)),
        Race::Outer => (outer_force, position, &outer, outer_lean.moment(outer_load)),
    };
    let arm = from + contact.normal.map(|c| c.scale(ball_radius));
    let moment = cross(&arm, &force);
    BallBalance {
        residual,
        force,
        moment: edge.map_or(moment, |edge| moment + edge),
        inner_load,
        outer_load,
        own_orbital_speed,
        inner,
        outer,
        stiffness,
        centrifugal_force,
        gyroscopic_moment,
        angular_velocity: spin,
        centre: [axial_place, radius],
    }
}

/// Ball place with the same approach or gap at both races, on the line of the groove centres.
pub fn middle_of_gap<S: Single>(
    contacts: &PerRace<ContactModel<'_>>,
    shared: &Shared<S>,
    azimuth: f64,
) -> Place {
    let (radial, _) = azimuth_directions(azimuth);
    let (inner, outer) = (&contacts.inner.surface.raceway, &contacts.outer.surface.raceway);
    let position = values(&shared.position);
    let axis = values(&shared.axis);
    // Groove centre of the inner race in the ball's plane, to first order in the tilt.
    let across = (radial - axis * radial.dot(&axis)).normalize();
    let centre = position + axis * inner.groove_offset + across * inner.groove_circle_radius;
    let inner_centre = Vector2::new(centre.x, centre.dot(&radial));
    let outer_centre = Vector2::new(outer.groove_offset, outer.groove_circle_radius);
    let line = inner_centre - outer_centre;
    let length = line.norm();
    let (l_i, l_o) = (arc_radius(&contacts.inner), arc_radius(&contacts.outer));
    // Groove centres that coincide leave the direction open: any does.
    let angle = if length > 0.0 { line.x.atan2(line.y) } else { 0.0 };
    Vector2::new(angle * l_o, l_o + 0.5 * (length - l_i - l_o))
}

/// Place of a ball that the centrifugal force alone holds on the outer race: no gyroscopic moment acts there, so that it is
/// in balance at any speeds, where another place may be out of reach of Newton's method or be none.
pub fn bottom_of_outer_groove(
    model: &Model,
    contacts: &PerRace<ContactModel<'_>>,
    input: &EquilibriumInput,
    shared: &Shared,
    index: usize,
) -> Place {
    let touching = Vector2::new(0.0, arc_radius(&contacts.outer));
    let there = balance(model, contacts, input, shared, index, &touching);
    let depth = (there.centrifugal_force.value / there.stiffness.outer.value).powf(2.0 / 3.0);
    touching + Vector2::new(0.0, depth)
}

/// Finds the place where a ball (0 is the first) is in balance, starting from `place`.
///
/// Newton's method with a Levenberg shift: the forces derive (nearly) from a potential that is convex but flat where
/// contacts are open. It needs derivatives by the ball's coordinates alone. False if the residual does not come below `tolerance` \[N].
pub fn settle(
    model: &Model,
    contacts: &PerRace<ContactModel<'_>>,
    input: &EquilibriumInput,
    shared: &Shared,
    index: usize,
    place: &mut Place,
    tolerance: f64,
) -> bool {
    let diameter = 2.0 * model.bearing.ball.radius;
    let longest = 0.02 * diameter;
    let balance_radius = 0.5 * model.bearing.pitch_diameter;
    let norm = |b: &OwnBalance| b.residual[0].value.hypot(b.residual[1].value);
    let fixed = shared.fixed();
    let mut here = balance_alone(model, contacts, input, &fixed, index, place);
    let mut shift = 0.0;
    for _ in 0..MAX_ITERATIONS {
        let r = Vector2::new(here.residual[0].value, here.residual[1].value);
        let stiffness = Matrix2::from_fn(|i, k| -here.residual[i].derivatives[k]);
        // A coordinate cannot be set finer than its last digit.
        let round_off = ROUND_OFF_UNITS * f64::EPSILON * stiffness.amax() * balance_radius;
        if r.norm() <= tolerance.max(round_off) {
            return true;
        }
        let shifted = stiffness + Matrix2::identity() * shift;
        let mut step = shifted.lu().solve(&r).filter(|s| s.iter().all(|c| c.is_finite()));
        if let Some(step) = &mut step {
            let length = step.norm();
            if length > longest {
                *step *= longest / length;
            }
        }
        let trial_place = step.map(|step| *place + step);
        let trial = trial_place.map(|p| balance_alone(model, contacts, input, &fixed, index, &p));
        match (trial, trial_place) {
            (Some(trial), Some(p)) if norm(&trial) < norm(&here) || opens(&here, &trial) => {
                *place = p;
                here = trial;
                shift = if shift < 1e-3 { 0.0 } else { shift * 0.1 };
            }
            _ => {
                // from a thousandth of the stiffness at a micrometre upwards
                let scale = 1.5 * here.outer_stiffness * 1e-3;
                shift = if shift == 0.0 { 1e-3 * scale } else { shift * 8.0 };
                if shift > 1e9 * scale {
                    return false;
                }
            }
        }
    }
    false
}

/// A free ball on its way to a race: the force does not fall until it gets there.
fn opens(here: &OwnBalance, trial: &OwnBalance) -> bool {
    !here.touches && !trial.touches
}
