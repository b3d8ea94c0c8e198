//! What holds shafts in equilibria.

use nalgebra::Vector3;

use super::{System, SystemOutputs};
use crate::model::bodies::Race;

/// Outputs of a system that was just started, with the torques that shafts of given speed are held by where friction is that of its losses: balls are not
/// yet in balance along their orbits ([`crate::simulation::outputs::Outputs::torque_of_losses`]).
pub fn outputs(system: &System) -> SystemOutputs {
    let scene = system.scene();
    let mut outputs = system.outputs().clone();
    for (mounted, (_, bearing)) in scene.bearings.iter().zip(system.bearings()) {
        let (of, along) = (bearing.outputs(), mounted.mounting.direction.sign());
        let steady = of.relative_speed().signum() * of.torque_of_losses();
        let rings = [(Race::Inner, Some(mounted.shaft), -steady), (Race::Outer, mounted.outer_shaft, steady)];
        for (race, shaft, steady) in rings {
            let now = of[race].wrench.moment.dot(&(of[race].pose.orientation * Vector3::x()));
            if let Some(shaft) = shaft.filter(|shaft| scene.shafts[*shaft].speed.is_some()) {
                outputs.shafts[shaft].torque += along * (now - steady);
            }
        }
    }
    outputs
}
