//! Poses of races and what an equilibrium makes of them: tilt, and turn about the own axis.

use nalgebra::{UnitQuaternion, Vector3};

use super::inputs::RaceInput;
use crate::equilibrium;
use crate::numerics::motion::Pose;
use crate::numerics::tilt;

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
    UnitQuaternion::new(tilt::of_axis(race))
}

/// \[rad] turn of a race about its own axis beyond its tilt.
pub fn turn_of(race: &UnitQuaternion<f64>) -> f64 {
    let across = spin_free(race).inverse() * (race * Vector3::y());
    across.z.atan2(across.y)
}

/// Rotation vector [0, ry, rz] that carries the x axis to a pose's axis.
pub fn tilt_of(pose: &Pose) -> Vector3<f64> {
    tilt::of_axis(&pose.orientation)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stiff bearings tell tilts of far less than a nanoradian.
    #[test]
    fn identity_tilts_are_read_to_their_last_digits() {
        for tilt in [1e-12, 3e-9, 1.2e-7, 1e-4, 0.05] {
            let tilt = Vector3::new(0.0, 0.6 * tilt, -0.8 * tilt);
            let turned = UnitQuaternion::new(tilt) * UnitQuaternion::new(Vector3::x() * 2.0);
            let pose = Pose { position: Vector3::zeros(), orientation: turned };
            assert!(
                (tilt_of(&pose) - tilt).norm() < 1e-15 * (1.0 + tilt.norm()),
                "{tilt} {}",
                tilt_of(&pose)
            );
            assert!((turn_of(&turned) - 2.0).abs() < 1e-14);
        }
    }
}
