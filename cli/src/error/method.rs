//! The method of time integration for an error goal.

use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::schema::Method;

/// [-] error goals up to this are cheaper with the method of order 3: in twelve scenes it took 0.3 to 1.3 times the CPU time of HHT at
/// 1e-3 and 1e-4, and met five goals that six rounds of HHT did not (`docs/accuracy-cost.md`).
const ORDER_THREE: f64 = 1e-3;

/// A scene with the method that is cheapest at its error goal, where it has one and names no method.
#[must_use]
pub fn for_goal(scene: &MachineScene) -> MachineScene {
    let solver = scene.solver();
    let fine = solver.goal.is_some_and(|goal| goal.error <= ORDER_THREE);
    if !fine || solver.method_given || scene.bearings().into_iter().any(|(_, scene)| loses_order(scene)) {
        return scene.clone();
    }
    scene.with(|scene| scene.solver.method = Method::Esdirk3)
}

/// Does the method of order 3 gain nothing? Balls that meet a spall's edge cost it its order, and it knows no balls at even spacing.
fn loses_order(scene: &Scene) -> bool {
    let effects = &scene.effects;
    !effects.defects.sections.is_empty() || effects.cage.is_ideal()
}
