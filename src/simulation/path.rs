//! How prescribed quantities move between two communication points: continuous, never a jump inside a step.

use nalgebra::{SVector, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::numerics::motion::{Pose, Twist};
use crate::numerics::rotation::{from_quaternion, rotate, tangent, tangent_inverse, to_quaternion};
use crate::numerics::tilt;
use crate::simulation::inputs::AxisInput;

/// A cubic in time with given values and rates at both ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Cubic<const N: usize>([SVector<f64, N>; 4]);

impl<const N: usize> Cubic<N> {
    /// Cubic from `x0`, rate `v0` to `x1`, rate `v1` within `duration` \[s].
    fn hermite(
        x0: SVector<f64, N>,
        v0: SVector<f64, N>,
        x1: SVector<f64, N>,
        v1: SVector<f64, N>,
        duration: f64,
    ) -> Self {
        let mean = (x1 - x0) / duration;
        Self([
            x0,
            v0,
            (mean * 3.0 - v0 * 2.0 - v1) / duration,
            (v0 + v1 - mean * 2.0) / (duration * duration),
        ])
    }

    /// Is it 0 at all times?
    fn is_zero(&self) -> bool {
        self.0 == [SVector::<f64, N>::zeros(); 4]
    }

    /// Value and rate after `t` \[s].
    fn at(&self, t: f64) -> (SVector<f64, N>, SVector<f64, N>) {
        let [x0, v0, c2, c3] = self.0;
        (x0 + (v0 + (c2 + c3 * t) * t) * t, v0 + (c2 * 2.0 + c3 * (3.0 * t)) * t)
    }

    /// Rate of the rate after `t` \[s].
    fn acceleration(&self, t: f64) -> SVector<f64, N> {
        let [_, _, c2, c3] = self.0;
        c2 * 2.0 + c3 * (6.0 * t)
    }
}

/// Component of a motion that is given from outside: value [m, rad], its rate, and the rate of that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// [m, rad] where it is.
    pub value: f64,
    /// [m/s, rad/s] its rate.
    pub rate: f64,
    /// [m/s2, rad/s2] rate of that.
    pub acceleration: f64,
}

/// Path of such a component over one communication step: a cubic from where the last path ended to where inputs lead, as the position
/// of a race has.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionPath {
    start_time: f64,
    path: Cubic<1>,
}

impl MotionPath {
    /// Path with a steady acceleration.
    pub fn steady(start_time: f64, motion: &Motion) -> Self {
        let Motion { value, rate, acceleration } = *motion;
        let path = Cubic([value, rate, 0.5 * acceleration, 0.0].map(|factor| SVector::from([factor])));
        Self { start_time, path }
    }

    /// Path from where this one is at `time` \[s] to where inputs that are valid then lead within `duration` \[s].
    pub fn towards(&self, time: f64, input: &Motion, duration: f64) -> Self {
        let (now, rate) = self.path.at(time - self.start_time);
        let gain = input.acceleration * duration;
        let end = SVector::from([input.value + (input.rate + gain * 0.5) * duration]);
        let path = Cubic::hermite(now, rate, end, SVector::from([input.rate + gain]), duration);
        Self { start_time: time, path }
    }

    /// Motion at a time \[s].
    pub fn at(&self, time: f64) -> Motion {
        let t = time - self.start_time;
        let (value, rate) = self.path.at(t);
        Motion { value: value[0], rate: rate[0], acceleration: self.path.acceleration(t)[0] }
    }
}

/// Path of a race whose motion is given from outside, over one communication step.
///
/// It begins with the pose and twist where the last path ended and ends with those that the inputs announce. The
/// position is a cubic, and the orientation as it was given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RacePath {
    start_time: f64,
    position: Cubic<3>,
    orientation: OrientationPath,
}

/// Path of an orientation; a steady turn of any number of revolutions per step is exact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum OrientationPath {
    /// A turn at the announced angular velocity `w` times a small correction, whose conformal rotation vector `e(t)` is a
    /// cubic: `R(t) = exp(w t) R(e(t)) R(0)`.
    Turn { start: UnitQuaternion<f64>, turn: Vector3<f64>, correction: Cubic<3> },
    /// Turn and tilts of [`tilt`]: both tilts are cubics, the spin speed is linear.
    Axis(Cubic<3>),
}

impl RacePath {
    /// Steady motion from a pose with a twist.
    pub fn steady(start_time: f64, pose: &Pose, twist: &Twist) -> Self {
        let zero = Vector3::zeros();
        Self {
            start_time,
            position: Cubic([pose.position, twist.velocity, zero, zero]),
            orientation: OrientationPath::Turn {
                start: pose.orientation,
                turn: twist.angular_velocity,
                correction: Cubic([zero; 4]),
            },
        }
    }

    /// Path from `start` to where the inputs `pose`, `twist` and `twist_rate` [m/s2, rad/s2], valid at `start_time` \[s],
    /// lead within `duration` \[s].
    pub fn towards(
        start_time: f64,
        start: (&Pose, &Twist),
        pose: &Pose,
        twist: &Twist,
        twist_rate: &Twist,
        duration: f64,
    ) -> Self {
        let (start_pose, start_twist) = start;
        let gain = twist_rate.velocity * duration;
        let position = Cubic::hermite(
            start_pose.position,
            start_twist.velocity,
            pose.position + (twist.velocity + gain * 0.5) * duration,
            twist.velocity + gain,
            duration,
        );
        let turn = twist.angular_velocity;
        let turned = UnitQuaternion::new(turn * duration);
        let gain = twist_rate.angular_velocity * duration;
        let ahead = UnitQuaternion::new((turn + gain * 0.5) * duration);
        let end = turned.inverse() * ahead * pose.orientation * start_pose.orientation.inverse();
        let end = from_quaternion(&end);
        // Spatial rate of R(e) is R T e', hence e' = T^-1 R^T of what the end still lacks in angular velocity.
        let end_rate = tangent_inverse(&end, &rotate(&-end, &(turned.inverse() * gain)));
        let start_rate = start_twist.angular_velocity - turn;
        Self {
            start_time,
            position,
            orientation: OrientationPath::Turn {
                start: start_pose.orientation,
                turn,
                correction: Cubic::hermite(Vector3::zeros(), start_rate, end, end_rate, duration),
            },
        }
    }

    /// Path with the orientation led by the motion of the race's axis: the tilts go to where the announced ones
    /// lead, the spin speed changes linearly to the announced one.
    #[must_use]
    pub fn with_axis(self, start: (&Pose, &Twist), axis: &AxisInput, duration: f64) -> Self {
        let (pose, twist) = start;
        let now = tilt::coordinates(&pose.orientation);
        let rate = tilt::rates(&now, &twist.angular_velocity);
        let gain = axis.acceleration * duration;
        let mut end = axis.tilt + (axis.rate + gain * 0.5) * duration;
        let end_rate = axis.rate + gain;
        end.x = now.x + 0.5 * (rate.x + end_rate.x) * duration;
        let path = Cubic::hermite(now, rate, end, end_rate, duration);
        Self { orientation: OrientationPath::Axis(path), ..self }
    }

    /// Pose and twist at a time \[s].
    pub fn at(&self, time: f64) -> (Pose, Twist) {
        let t = time - self.start_time;
        let (position, velocity) = self.position.at(t);
        let zero = Vector3::zeros();
        let (orientation, angular_velocity) = match &self.orientation {
            // A race at rest: the formula below, without its sines.
            OrientationPath::Turn { start, turn, correction } if *turn == zero && correction.is_zero() => {
                (*start, zero)
            }
            OrientationPath::Turn { start, turn, correction } => {
                let (e, e_rate) = correction.at(t);
                let turned = UnitQuaternion::new(turn * t);
                let orientation = turned * to_quaternion(&e) * start;
                (orientation, turn + turned * rotate(&e, &tangent(&e, &e_rate)))
            }
            OrientationPath::Axis(path) => {
                let (coordinates, rates) = path.at(t);
                (tilt::orientation(&coordinates), tilt::angular_velocity(&coordinates, &rates))
            }
        };
        let orientation = UnitQuaternion::new_normalize(orientation.into_inner());
        (Pose { position, orientation }, Twist { velocity, angular_velocity })
    }
}

/// A vector of `N` numbers that moves linearly from one value to another within a communication step, and is held
/// afterwards.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ramp<const N: usize> {
    start_time: f64,
    duration: f64,
    from: SVector<f64, N>,
    to: SVector<f64, N>,
}

impl<const N: usize> Ramp<N> {
    /// A constant.
    pub fn constant(value: SVector<f64, N>) -> Self {
        Self { start_time: 0.0, duration: 1.0, from: value, to: value }
    }

    /// Ramp from the value of `self` at `start_time` \[s] to `value` after `duration` \[s].
    pub fn towards(&self, start_time: f64, value: SVector<f64, N>, duration: f64) -> Self {
        Self { start_time, duration, from: self.at(start_time), to: value }
    }

    /// As [`Ramp::towards`], of a ramp that is read by [`Ramp::smooth_at`].
    pub fn smooth_towards(&self, start_time: f64, value: SVector<f64, N>, duration: f64) -> Self {
        Self { start_time, duration, from: self.smooth_at(start_time), to: value }
    }

    /// Value at a time \[s] where the way from one value to the other begins and ends at rest.
    pub fn smooth_at(&self, time: f64) -> SVector<f64, N> {
        let t = ((time - self.start_time) / self.duration).clamp(0.0, 1.0);
        self.from + (self.to - self.from) * (t * t * (3.0 - 2.0 * t))
    }

    /// \[1/s] rate of change on the way.
    pub fn slope(&self) -> SVector<f64, N> {
        (self.to - self.from) / self.duration
    }

    /// Value at a time \[s].
    pub fn at(&self, time: f64) -> SVector<f64, N> {
        let t = ((time - self.start_time) / self.duration).clamp(0.0, 1.0);
        self.from + (self.to - self.from) * t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: &(Pose, Twist), b: &(Pose, Twist)) -> f64 {
        (a.0.position - b.0.position).norm()
            + a.0.orientation.angle_to(&b.0.orientation)
            + (a.1.velocity - b.1.velocity).norm()
            + (a.1.angular_velocity - b.1.angular_velocity).norm()
    }

    #[test]
    fn closed_form_steady_turn_is_exact_over_many_revolutions() {
        let twist =
            Twist { velocity: Vector3::new(0.1, 0.0, 0.2), angular_velocity: Vector3::new(628.0, 3.0, -2.0) };
        let (pose, h) = (Pose::default(), 0.1);
        let path = RacePath::towards(2.0, (&pose, &twist), &pose, &twist, &Twist::default(), h);
        let exact = RacePath::steady(2.0, &pose, &twist);
        for i in 0..=10 {
            let time = 2.0 + h * f64::from(i) / 10.0;
            assert!(close(&path.at(time), &exact.at(time)) < 1e-9);
        }
    }

    #[test]
    fn invariant_a_race_at_rest_has_the_bits_of_one_that_hardly_turns() {
        let orientation = UnitQuaternion::new(Vector3::new(0.3, 0.01, -0.02));
        let pose = Pose { position: Vector3::new(1e-5, 0.0, -2e-6), orientation };
        // A turn that is lost in rounding, and takes the way of all turns.
        let hardly = Twist { angular_velocity: Vector3::repeat(1e-200), ..Twist::default() };
        let at = |twist: &Twist| {
            let path = RacePath::towards(0.0, (&pose, twist), &pose, twist, &Twist::default(), 1e-3);
            path.at(7e-4)
        };
        let ((resting, still), (turned, _)) = (at(&Twist::default()), at(&hardly));
        assert_eq!(still, Twist::default());
        assert_eq!(
            (resting.position, resting.orientation.coords),
            (turned.position, turned.orientation.coords)
        );
    }

    #[test]
    fn invariant_paths_join_in_pose_and_twist_and_twist_is_the_rate_of_pose() {
        let start = (
            Pose {
                position: Vector3::new(1e-5, 0.0, 0.0),
                orientation: UnitQuaternion::new(Vector3::new(1.0, 0.01, 0.02)),
            },
            Twist {
                velocity: Vector3::new(0.01, 0.02, 0.0),
                angular_velocity: Vector3::new(600.0, 1.0, 2.0),
            },
        );
        let pose = Pose {
            position: Vector3::new(2e-5, 1e-5, 0.0),
            orientation: UnitQuaternion::new(Vector3::new(1.002, 0.012, 0.018)),
        };
        let twist = Twist {
            velocity: Vector3::new(0.0, 0.03, 0.0),
            angular_velocity: Vector3::new(628.0, -1.0, 2.0),
        };
        let rate =
            Twist { velocity: Vector3::new(5.0, 0.0, 1.0), angular_velocity: Vector3::new(1e3, 20.0, 5.0) };
        let h = 1e-3;
        let path = RacePath::towards(0.5, (&start.0, &start.1), &pose, &twist, &rate, h);
        assert!(close(&path.at(0.5), &start) < 1e-12);
        let (end, end_twist) = path.at(0.5 + h);
        assert!(
            (end_twist.angular_velocity - twist.angular_velocity - rate.angular_velocity * h).norm() < 1e-9
        );
        assert!((end_twist.velocity - twist.velocity - rate.velocity * h).norm() < 1e-12);
        let expected = pose.position + twist.velocity * h + rate.velocity * (0.5 * h * h);
        assert!((end.position - expected).norm() < 1e-15);
        for i in 1..10 {
            let (time, d) = (0.5 + h * f64::from(i) / 10.0, 1e-7);
            let ((before, _), (_, at), (after, _)) = (path.at(time - d), path.at(time), path.at(time + d));
            let turn = (after.orientation * before.orientation.inverse()).scaled_axis() / (2.0 * d);
            assert!((turn - at.angular_velocity).norm() < 1e-5, "{turn} {}", at.angular_velocity);
        }
    }

    #[test]
    fn closed_form_a_tilting_axis_is_where_its_rotation_vector_says_however_fast_it_spins() {
        // Tilts that are cubics in time, a spin speed that is linear: announced exactly, step after step.
        let tilt_at = |t: f64| Vector3::new(0.0, 1e-3 + 0.2 * t - 3.0 * t * t, 2e-3 - 0.5 * t + 4.0 * t * t);
        let rate_at = |t: f64| Vector3::new(628.0 + 500.0 * t, 0.2 - 6.0 * t, -0.5 + 8.0 * t);
        let axis_at = |t: f64| AxisInput {
            tilt: tilt_at(t),
            rate: rate_at(t),
            acceleration: Vector3::new(500.0, -6.0, 8.0),
        };
        let first = axis_at(0.0);
        let pose = Pose { orientation: tilt::orientation(&first.tilt), ..Pose::default() };
        let angular_velocity = tilt::angular_velocity(&first.tilt, &first.rate);
        let mut path = RacePath::steady(0.0, &pose, &Twist { angular_velocity, ..Twist::default() });
        // Steps of half a revolution to twenty.
        for (from, to) in [(0.0, 0.005), (0.005, 0.0051), (0.0051, 0.2)] {
            let (pose, twist) = path.at(from);
            let none = Twist::default();
            let plain = RacePath::towards(from, (&pose, &twist), &pose, &none, &none, to - from);
            path = plain.with_axis((&pose, &twist), &axis_at(from), to - from);
            assert!(close(&path.at(from), &(pose, twist)) < 1e-12);
            for i in 1..=10 {
                let time = from + (to - from) * f64::from(i) / 10.0;
                let (pose, twist) = path.at(time);
                let now = tilt::coordinates(&pose.orientation);
                assert!((now.yz() - tilt_at(time).yz()).norm() < 1e-12, "{time}");
                let rate = tilt::rates(&now, &twist.angular_velocity);
                assert!((rate - rate_at(time)).norm() < 1e-9, "{time} {rate}");
                let turned = 628.0 * time + 250.0 * time * time;
                let behind = (turned - now.x) / std::f64::consts::TAU;
                assert!((behind - behind.round()).abs() < 1e-11, "{time} {behind}");
            }
        }
    }

    #[test]
    fn a_ramp_is_linear_and_held_afterwards() {
        let ramp = Ramp::<5>::constant(SVector::repeat(1.0)).towards(2.0, SVector::repeat(3.0), 0.5);
        assert_eq!([2.0, 2.25, 2.5, 3.0].map(|time| ramp.smooth_at(time)[4]), [1.0, 2.0, 3.0, 3.0]);
        assert_eq!([1.0, 2.0, 2.25, 3.0].map(|time| ramp.at(time)[4]), [1.0, 1.0, 2.0, 3.0]);
    }
}
