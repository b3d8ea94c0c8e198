//! The method of time integration for an error goal.

use roulement::scene::machine::MachineScene;
use roulement::scene::system::MountedScene;
use roulement::scene::{Level, Scene};
use roulement::schema::Method;

/// [-] error goals up to this are cheaper with the method of order 3: in twelve scenes it took 0.3 to 1.3 times the CPU time of HHT at
/// 1e-3 and 1e-4, and met five goals that six rounds of HHT did not (`docs/accuracy-cost.md`).
const ORDER_THREE: f64 = 1e-3;

/// A scene with the method that is cheapest at its error goal, where it has one and names no method.
#[must_use]
pub fn for_goal(scene: &MachineScene) -> MachineScene {
    let solver = scene.solver();
    let fine = solver.goal.is_some_and(|goal| goal.error <= ORDER_THREE);
    // Edges that balls meet cost the method its order.
    let has_spalls = |(_, scene): (_, &Scene)| !scene.effects.defects.sections.is_empty();
    let gains = fine && takes_order_three(scene) && !scene.bearings().into_iter().any(has_spalls);
    if gains && !solver.method_given {
        return scene.with(|scene| scene.solver.method = Method::Esdirk3);
    }
    scene.clone()
}

/// Does the method of order 3 know all of a scene? It knows neither balls at even spacing nor bearings without states.
pub fn takes_order_three(scene: &MachineScene) -> bool {
    let resting = |bearing: &MountedScene| bearing.level == Level::Equilibrium;
    let kept_apart = |(_, scene): (_, &Scene)| scene.effects.cage.is_ideal();
    !scene.shaft().is_some_and(|shaft| shaft.bearings.iter().any(resting))
        && !scene.bearings().into_iter().any(kept_apart)
}
