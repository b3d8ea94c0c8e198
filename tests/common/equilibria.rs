//! Our equilibria of the reference cases beside the independent ones (tests/data/bearing/README.md).

use roulement::equilibrium::{self, Equilibrium, EquilibriumInput, Gyroscopic};
use roulement::model::Model;
use roulement::scene::Scene;
use serde_json::Value;

use crate::reference::{number, scene_text};

/// Scene text of a reference case. The data know no shoulders: grooves reach to both sides.
pub fn whole(case: &Value) -> String {
    let shoulders = "shoulder_angle = [1.5, 1.5]\n";
    format!("[inner]\n{shoulders}[outer]\n{shoulders}{}", scene_text(case))
}

/// Solves a scene.
pub fn solve(text: &str, gyroscopic: Gyroscopic) -> Equilibrium {
    let scene = Scene::parse(text).unwrap();
    let input = EquilibriumInput::from_scene(&scene, gyroscopic);
    equilibrium::solve(&Model::new(&scene).unwrap(), &input).unwrap()
}

/// Largest differences of a solution from a reference solution: relative load and angle [rad] over loaded balls,
/// relative displacement, cage speed and stiffness.
pub struct Difference {
    pub load: f64,
    pub angle: f64,
    pub displacement: f64,
    pub cage_speed: f64,
    pub stiffness: f64,
}

/// Those of a solution from a reference solution.
pub fn difference(ours: &Equilibrium, reference: &Value) -> Difference {
    let list =
        |key: &str| -> Vec<f64> { reference["balls"][key].as_array().unwrap().iter().map(number).collect() };
    let largest = list("inner_load").into_iter().fold(0.0, f64::max);
    let mut d = Difference { load: 0.0, angle: 0.0, displacement: 0.0, cage_speed: 0.0, stiffness: 0.0 };
    for (j, ball) in ours.balls.iter().enumerate() {
        let b = &ball.report;
        d.load = d.load.max((b.inner_load - list("inner_load")[j]).abs() / largest);
        d.load = d.load.max((b.outer_load - list("outer_load")[j]).abs() / largest);
        if list("inner_load")[j] > 0.0 {
            d.angle = d.angle.max((b.inner_contact_angle - list("inner_contact_angle")[j]).abs());
            d.angle = d.angle.max((b.outer_contact_angle - list("outer_contact_angle")[j]).abs());
        }
    }
    for (i, key) in ["x", "y", "z"].into_iter().enumerate() {
        let theirs = number(&reference["displacement"][key]);
        d.displacement = d.displacement.max((ours.displacement[i] - theirs).abs() / 1e-5);
    }
    let cage = number(&reference["cage_speed"]);
    d.cage_speed = (ours.cage_speed - cage).abs() / cage.abs().max(1.0);
    for i in 0..5 {
        for k in 0..5 {
            let at = |i: usize, k: usize| number(&reference["stiffness"][i][k]);
            let scale = (at(i, i) * at(k, k)).abs().sqrt();
            d.stiffness = d.stiffness.max((ours.stiffness[(i, k)] - at(i, k)).abs() / scale);
        }
    }
    d
}
