//! What holds shafts in equilibria.

use nalgebra::Vector3;

use super::Structures;
use crate::model::bodies::Race;
use crate::scene::system::mesh::{InTrain, trains};
use crate::simulation::Simulation;

/// Gives outputs of structures that were just started the torques that shafts of given speed are held by where friction is that of its losses: balls are not
/// yet in balance along their orbits ([`crate::simulation::outputs::Outputs::torque_of_losses`]). Shafts of a train hand theirs on, by their ratio. (Their moments
/// of that instant speed them up, as they twist those that twist: these are in no torque of a drive.)
pub fn hold(bearings: &[Simulation], structures: &mut Structures) {
    let Structures { scene, states, outputs, .. } = structures;
    let trains = trains(&scene.shafts, &scene.meshes, &scene.springs);
    for (shaft, state) in states.iter().enumerate().take(scene.shafts.len()) {
        if scene.shafts[shaft].speed.is_some() {
            outputs.shafts[shaft].torque = state.torque;
        }
    }
    for (mounted, bearing) in scene.bearings.iter().zip(bearings) {
        let (of, along) = (bearing.outputs(), mounted.mounting.direction.sign());
        let steady = of.relative_speed().signum() * of.torque_of_losses();
        let rings = [(Race::Inner, Some(mounted.shaft), -steady), (Race::Outer, mounted.outer_shaft, steady)];
        for (race, shaft, steady) in
            rings.into_iter().filter_map(|(race, shaft, steady)| Some((race, shaft?, steady)))
        {
            let InTrain { root, ratio } = trains[shaft];
            if scene.shafts[root].speed.is_some() {
                let feels_now = shaft == root && !scene.twists(shaft);
                let axis = of[race].pose.orientation * Vector3::x();
                let now = if feels_now { of[race].wrench.moment.dot(&axis) } else { 0.0 };
                outputs.shafts[root].torque += ratio * along * (now - steady);
            }
        }
    }
}
