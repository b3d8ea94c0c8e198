//! Scenes that a method of time integration takes.

use roulement::scene::machine::MachineScene;
use roulement::scene::system::MountedScene;
use roulement::scene::{Level, Scene};

/// Does the method of order 3 know all of a scene? It knows neither balls at even spacing nor bearings without states.
pub fn takes_order_three(scene: &MachineScene) -> bool {
    let resting = |bearing: &MountedScene| bearing.level == Level::Equilibrium;
    let kept_apart = |(_, scene): (_, &Scene)| scene.effects.cage.is_ideal();
    !scene.shaft().is_some_and(|shaft| shaft.bearings.iter().any(resting))
        && !scene.bearings().into_iter().any(kept_apart)
}
