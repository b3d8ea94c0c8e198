//! Loads on balls and bodies from outside of the bearing: weight, the forces of inertia of a moving frame, and the drag of
//! the medium around the balls. [`Ambient`] is the one place of all of them.

use crate::numerics::elementary::pow;
use std::f64::consts::PI;

use nalgebra::Vector3;
use serde::Deserialize;

use super::effect::{Effect, Getter, Info, Row};
use super::estimate::{Estimate, digits};
use super::keys::keys;
use super::losses::Part;
use super::moving_frame::MovingFrame;
use super::twin::Twin;
use crate::contact::BallMotion;
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::{Scalar, constant_vector, cross};
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::units::{Density, Viscosity};
use crate::schema::variable_units::WATT;

/// The section `[effects.ambient]`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AmbientSection {
    /// [kg/m3] density of what the balls move through: 1.2 of air, 10 to 100 of a mist of oil, 850 of oil.
    pub density: Density,
    /// [Pa s] its dynamic viscosity: 18e-6 of air.
    pub viscosity: Viscosity,
}

keys! {
    /// The medium around the balls; there with the effect only.
    "ambient" => section: Option<AmbientSection> = None,
}

/// A mist of oil, which the estimate is for where the scene gives no medium: its viscosity is that of the air.
const MIST: AmbientSection = AmbientSection { density: Density(50.0), viscosity: Viscosity(18e-6) };

/// Ranges of a medium.
pub const DENSITY: Range = Range::closed(0.0, 2e4, "kg/m3");
/// See [`DENSITY`].
pub const VISCOSITY: Range = Range::above(0.0, 1e4, "Pa.s");
/// [-] drag coefficient of a sphere at large Reynolds numbers (Newton's range).
const NEWTON_RANGE: f64 = 0.44;

/// The medium around the balls, which rests in the bearing's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// [kg/m3] density.
    density: f64,
    /// [Pa s] dynamic viscosity.
    viscosity: f64,
}

impl Medium {
    /// \[N] drag on a sphere of a radius \[m] that moves with a velocity [m/s] (Schiller and Naumann 1935).
    pub fn drag<S: Scalar>(&self, radius: f64, velocity: &Vector3<S>) -> Vector3<S> {
        let over_viscosity = 2.0 * radius * self.density / self.viscosity;
        let square = velocity.x.square() + velocity.y.square() + velocity.z.square();
        // Drag over that of Stokes's law, by the square of the speed: the drag coefficient times Re/24.
        let factor = square.map_smooth(|square| {
            let reynolds = over_viscosity * square.sqrt();
            let (slow, fast) = (0.15 * pow(reynolds, 0.687), NEWTON_RANGE / 24.0 * reynolds);
            let (excess, exponent) = if 1.0 + slow >= fast { (slow, 0.687) } else { (fast, 1.0) };
            let slope = if square > 0.0 { 0.5 * exponent * excess / square } else { 0.0 };
            (if 1.0 + slow >= fast { 1.0 + slow } else { fast }, slope)
        });
        let stokes = -6.0 * PI * self.viscosity * radius;
        velocity.map(|component| (component * factor).scale(stokes))
    }

    /// [N m] moment on a sphere of a radius \[m] that turns with an angular velocity [rad/s]: Kirchhoff's at small Reynolds
    /// numbers, that of Dennis, Singh and Ingham (1980) where it is larger, from 8 on.
    pub fn churning<S: Scalar>(&self, radius: f64, angular_velocity: &Vector3<S>) -> Vector3<S> {
        let over_viscosity = radius * radius * self.density / self.viscosity;
        let w = angular_velocity;
        let square = w.x.square() + w.y.square() + w.z.square();
        let factor = square.map_smooth(|square| {
            let root = (over_viscosity * square.sqrt()).sqrt();
            let (slow, fast) = (8.0 * PI, 16.05 + 3.225 * root);
            if slow >= fast { (slow, 0.0) } else { (fast, 0.25 * 3.225 * root / square) }
        });
        let size = -self.viscosity * radius.powi(3);
        w.map(|component| (component * factor).scale(size))
    }
}

impl AmbientSection {
    /// The medium as forces need it.
    pub fn medium(&self) -> Medium {
        Medium { density: self.density.0, viscosity: self.viscosity.0 }
    }
}

/// All that acts on balls and bodies from outside, at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ambient {
    /// [m/s2] gravity.
    pub gravity: Vector3<f64>,
    /// The bearing's frame, where it moves.
    pub frame: Option<MovingFrame>,
    /// The medium around the balls, where it is felt.
    pub medium: Option<Medium>,
    /// \[kg] mass of a ball.
    pub mass: f64,
    /// [kg m2] its moment of inertia.
    pub inertia: f64,
    /// \[m] its radius.
    pub radius: f64,
}

impl Ambient {
    /// Force and moment about the centre on a ball.
    #[inline(always)]
    pub fn on_ball<S: Scalar>(&self, ball: &BallMotion<S>) -> Wrench<S> {
        let weight = Wrench {
            force: constant_vector(&(self.gravity * self.mass)),
            moment: constant_vector(&Vector3::zeros()),
        };
        if self.depends_on_motion() { self.in_motion(ball, weight) } else { weight }
    }

    /// Is there anything that depends on the motion of a ball?
    #[inline(always)]
    pub fn depends_on_motion(&self) -> bool {
        self.frame.is_some() || self.medium.is_some()
    }

    #[cold]
    #[inline(never)]
    fn in_motion<S: Scalar>(&self, ball: &BallMotion<S>, mut sum: Wrench<S>) -> Wrench<S> {
        if let Some(frame) = &self.frame {
            let field = frame.seen(constant_vector).field(&ball.position, &ball.velocity);
            sum.force += field.map(|component| component.scale(self.mass));
        }
        let steady = self.against_rolling(ball);
        Wrench { force: sum.force + steady.force, moment: sum.moment + steady.moment }
    }

    /// Loads on the rolling of a ball in a steady orbit: drag, churning, and the moment of a frame that turns.
    pub fn against_rolling<S: Scalar>(&self, ball: &BallMotion<S>) -> Wrench<S> {
        let mut sum = Wrench::default();
        if let Some(frame) = &self.frame {
            let turned = cross(&constant_vector(&frame.turn), &ball.angular_velocity);
            let change = constant_vector::<S>(&frame.change) + turned;
            sum.moment -= change.map(|component| component.scale(self.inertia));
        }
        if let Some(medium) = &self.medium {
            sum.force += medium.drag(self.radius, &ball.velocity);
            sum.moment += medium.churning(self.radius, &ball.angular_velocity);
        }
        sum
    }

    /// \[W] power put into a ball: of its weight and of the frame's motion. What the medium takes is no part of it.
    pub fn power_into(&self, ball: &BallMotion<f64>) -> f64 {
        let weight = self.mass * self.gravity.dot(&ball.velocity);
        match &self.frame {
            Some(frame) => {
                let field = frame.field(&ball.position, &ball.velocity);
                let moment = frame.change * self.inertia;
                weight + self.mass * field.dot(&ball.velocity) - moment.dot(&ball.angular_velocity)
            }
            None => weight,
        }
    }

    /// \[W] power that a ball loses to the medium.
    pub fn power_lost(&self, ball: &BallMotion<f64>) -> f64 {
        let of = |medium: &Medium| {
            -medium.drag(self.radius, &ball.velocity).dot(&ball.velocity)
                - medium.churning(self.radius, &ball.angular_velocity).dot(&ball.angular_velocity)
        };
        self.medium.as_ref().map_or(0.0, of)
    }
}

/// Its part of the losses.
pub const LOSS: Part = Part {
    name: "loss.drag",
    description: "power that the balls lose to the medium around them",
    words: "drag of the medium",
    is_of: |effects| effects.ambient.section.is_some(),
    get: |losses| losses.drag,
};

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.ambient",
        adds: "drag and churning moment of the medium around the balls, which rests in the bearing's frame",
        states: "none",
        price: "8 % of a step (thrust case)",
        source: "Schiller and Naumann 1935; Kirchhoff 1876; Dennis, Singh and Ingham 1980",
        example: "[effects]\nambient = { density = 1.2, viscosity = 18e-6 }\n",
    };
    const ESTIMATE: &'static str =
        "settled states with and without it; a mist of oil of 50 kg/m3 where it is off";

    const NUMBERS: &'static [Number<Self>] = &[
        Number::fixed("effects.ambient.density", DENSITY, "density of the medium around the balls", |s| {
            Place::Value(s.section.as_mut().map(|section| &mut section.density.0))
        }),
        Number::fixed(
            "effects.ambient.viscosity",
            VISCOSITY,
            "dynamic viscosity of the medium around the balls",
            |s| Place::Value(s.section.as_mut().map(|section| &mut section.viscosity.0)),
        ),
    ];

    fn setting(&self) -> Option<String> {
        self.section.map(|AmbientSection { density, viscosity }| {
            format!("{:?} kg/m3, {:?} Pa s", density.0, viscosity.0)
        })
    }

    fn twins(&self, _: &Estimate) -> Vec<Twin> {
        let on = self.section.is_some();
        let medium = if on { None } else { Some(MIST) };
        let section = self.section.unwrap_or(MIST);
        let twin = Twin::new("effects.ambient", "drag", on, move |effects| effects.ambient.section = medium);
        vec![
            twin.taken_as(format!("a medium of {} kg/m3", digits(section.density.0))).written(
                "[effects] ambient = { density = ..., viscosity = ... }; the medium is not known here",
            ),
        ]
    }

    fn headlines(&self) -> &'static [&'static str] {
        &["ambient.drag_power"]
    }

    fn rows(&self) -> Vec<Row> {
        let power = Row {
            name: "ambient.drag_power".into(),
            unit: WATT,
            nominal: 1.0,
            description: "power that the balls lose to the medium around them".into(),
            get: Getter::new(|reports| reports.drag_power),
        };
        self.section.map(|_| power).into_iter().collect()
    }
}
