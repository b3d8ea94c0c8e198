//! Poses of races and what an equilibrium makes of them: tilt, and turn about the own axis.

use nalgebra::{UnitQuaternion, Vector3};

use super::inputs::RaceInput;
use crate::equilibrium;
use crate::numerics::motion::Pose;

/// Pose of the race that moved into balance.
pub fn pose_of(solution: &equilibrium::Equilibrium) -> Pose {
    let [x, y, z, ry, rz] = solution.displacement;
    Pose { position: Vector3::new(x, y, z), orientation: UnitQuaternion::new(Vector3::new(0.0, ry, rz)) }
}

/// [rad/s] spin about its own axis.
pub fn own_spin(input: &RaceInput) -> f64 {
    input.twist.angular_velocity.dot(&(input.pose.orientation * Vector3::x()))
}

/// Orientation of a race without its turn about its own axis; that of the outer race is the equilibrium's frame.
pub fn spin_free(race: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::rotation_between(&Vector3::x(), &(race * Vector3::x())).unwrap_or_default()
}

/// \[rad] turn of a race about its own axis beyond its tilt.
pub fn turn_of(race: &UnitQuaternion<f64>) -> f64 {
    let across = spin_free(race).inverse() * (race * Vector3::y());
    across.z.atan2(across.y)
}

/// Rotation vector [0, ry, rz] that carries the x axis to a pose's axis.
pub fn tilt_of(pose: &Pose) -> Vector3<f64> {
    spin_free(&pose.orientation).scaled_axis()
}
