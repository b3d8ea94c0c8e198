//! Poses that contradict their twists: a race whose pose goes elsewhere than its velocity is moved to and fro within every
//! communication step, and the friction of that is in all results.

use std::fmt;

use nalgebra::{UnitQuaternion, Vector3};

use crate::simulation::inputs::RaceInput;
use crate::simulation::system::Motion;

/// [-] difference of both rates, over the one that was given, that is taken for a contradiction. A missing rate, a wrong
/// sign or a wrong unit is beyond; what coarse steps of a vibration leave is below in most steps.
const DIFFERENCE: f64 = 0.5;
/// [m/s] difference of velocities that does not matter.
const SLOW: f64 = 0.05;
/// [rad/s] difference of angular velocities that does not matter.
const SLOW_TURN: f64 = 2.0;

/// Rates of a race over a communication step: by its poses, and as given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradiction {
    /// Does the race turn otherwise than given? Else it moves otherwise.
    turns: bool,
    by_pose: f64,
    given: f64,
}

impl Contradiction {
    /// The contradiction between two inputs of a race that are valid `step` \[s] after one another, if there is one.
    pub fn between(before: &RaceInput, now: &RaceInput, step: f64) -> Option<Self> {
        let moved = (now.pose.position - before.pose.position) / step;
        let given = 0.5 * (now.twist.velocity + before.twist.velocity);
        let (turned, turning) = match (&before.axis, &now.axis) {
            (Some(before), Some(now)) => {
                let across = |rate: Vector3<f64>| Vector3::new(0.0, rate.y, rate.z);
                ((now.tilt - before.tilt) / step, across(0.5 * (now.rate + before.rate)))
            }
            _ => {
                let given = 0.5 * (now.twist.angular_velocity + before.twist.angular_velocity);
                // Of turns by more than half a revolution, poses tell only where they end.
                let led = UnitQuaternion::new(given * step) * before.pose.orientation;
                let beyond = (now.pose.orientation * led.inverse()).scaled_axis() / step;
                (given + beyond, given)
            }
        };
        Self::of(true, &turned, &turning).or_else(|| Self::of(false, &moved, &given))
    }

    /// The contradiction between two inputs of a component of a motion, a rotation or a displacement.
    pub fn of_motion(turns: bool, before: &Motion, now: &Motion, step: f64) -> Option<Self> {
        let along = |rate: f64| Vector3::x() * rate;
        Self::of(turns, &along((now.value - before.value) / step), &along(0.5 * (now.rate + before.rate)))
    }

    /// The contradiction between two rates, by poses and as given.
    fn of(turns: bool, by_pose: &Vector3<f64>, given: &Vector3<f64>) -> Option<Self> {
        let slow = if turns { SLOW_TURN } else { SLOW };
        let difference = (by_pose - given).norm();
        let contradicts = difference > slow && difference > DIFFERENCE * given.norm();
        contradicts.then(|| Self { turns, by_pose: by_pose.norm(), given: given.norm() })
    }
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (what, unit) = if self.turns { ("turns", "rad/s") } else { ("moves", "m/s") };
        let Self { by_pose, given, .. } = self;
        write!(f, "by its poses it {what} at {by_pose:.6} {unit}, by its velocities at {given:.6} {unit}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::motion::{Pose, Twist};

    fn input(x: f64, velocity: f64, turn: f64, speed: f64) -> RaceInput {
        let pose = Pose {
            position: Vector3::x() * x,
            orientation: UnitQuaternion::new(Vector3::new(turn, 0.0, 0.0)),
        };
        let twist = Twist { velocity: Vector3::x() * velocity, angular_velocity: Vector3::x() * speed };
        RaceInput { pose, twist, ..RaceInput::default() }
    }

    #[test]
    fn closed_form_rates_by_pose_and_as_given() {
        let (h, speed) = (1e-4, 628.0);
        let between = |now| Contradiction::between(&input(0.0, 0.02, 0.1, speed), &now, h);
        assert_eq!(between(input(2e-6, 0.02, 0.1 + speed * h, speed)), None);
        // A vibration that turns back within the step.
        assert_eq!(between(input(0.0, -0.02, 0.1 + speed * h, speed)), None);
        let held = between(input(2e-6, 0.02, 0.1, speed)).map(|found| found.to_string());
        let text = "by its poses it turns at 0.000000 rad/s, by its velocities at 628.000000 rad/s";
        assert_eq!(held.as_deref(), Some(text));
        let moved = between(input(8e-5, 0.02, 0.1 + speed * h, speed)).map(|found| found.to_string());
        let text = "by its poses it moves at 0.800000 m/s, by its velocities at 0.020000 m/s";
        assert_eq!(moved.as_deref(), Some(text));
    }

    #[test]
    fn many_revolutions_within_a_step_are_no_contradiction() {
        let (h, speed) = (0.1, 628.0);
        let (before, now) = (input(0.0, 0.0, 0.0, speed), input(0.0, 0.0, speed * h, speed));
        assert_eq!(Contradiction::between(&before, &now, h), None);
    }
}
