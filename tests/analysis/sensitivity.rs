//! What slightly different inputs would have led to, by the exact tangents of the steps, against runs with these inputs: bodies in a
//! moving frame and on flexible supports.

use nalgebra::Vector3;
use roulement::model::bodies::Race;
use roulement::scene::{Groups, Scene};
use roulement::simulation::Simulation;
use roulement::simulation::inputs::Inputs;

const SOFT_HOUSING: &str = include_str!("../../scenes/effects/soft_housing.toml");
const SHAFT_SUPPORT: &str = include_str!("../../scenes/effects/shaft_support.toml");
const PLANET_CARRIER: &str = include_str!("../../scenes/effects/planet_carrier.toml");

/// [s] until inputs change, and for how long they then differ.
const TIMES: [f64; 2] = [2e-4, 3e-4];

/// Changes of the places of both races \[m] by `change` \[N] more on a race, or \[m] of its pose, half the difference of both signs.
fn changes(name: &str, text: &str, of: impl Fn(&mut Inputs, f64), change: f64) -> [[Vector3<f64>; 2]; 2] {
    // Steps of one length: the runs then differ by their inputs alone.
    let same = [("solver", "{ initial_step = 1e-6, max_step = 1e-6, tolerance = 0.01 }")];
    let scene = Scene::edited(text, same).unwrap();
    let start = || {
        let mut simulation = Simulation::new(&scene).unwrap();
        simulation.advance(TIMES[0]).unwrap();
        simulation
    };
    let end = TIMES[0] + TIMES[1];
    let inputs = |by: f64| {
        let mut inputs = *start().inputs();
        of(&mut inputs, by);
        inputs
    };
    let given = [change, -change].map(inputs);
    let predicted = start().advance_perturbed(end, &given, Groups::default()).unwrap();
    let place = |outputs: &roulement::simulation::outputs::Outputs| {
        [outputs.inner.pose.position, outputs.outer.pose.position]
    };
    let predicted = [place(predicted[0].outputs()), place(predicted[1].outputs())];
    let run = given.map(|inputs| {
        let mut simulation = start();
        simulation.set_inputs(inputs);
        simulation.advance(end).unwrap();
        place(simulation.outputs())
    });
    let half = |places: [[Vector3<f64>; 2]; 2]| [0, 1].map(|race| (places[0][race] - places[1][race]) / 2.0);
    let sizes = [half(predicted), half(run)];
    println!("{name}: {sizes:?}");
    sizes
}

/// By the tangents and by runs the changes are the same within a part of the largest.
fn assert_same([ours, runs]: [[Vector3<f64>; 2]; 2], part: f64) {
    let largest = runs.iter().map(Vector3::norm).fold(0.0, f64::max);
    assert!(largest > 1e-10, "{runs:?}");
    for race in 0..2 {
        assert!((ours[race] - runs[race]).norm() < part * largest, "{ours:?} {runs:?}");
    }
}

#[test]
fn invariant_tangents_of_a_race_on_a_support_are_differences_of_runs() {
    let push = |inputs: &mut Inputs, by: f64| inputs.inner.applied.force.y += by;
    assert_same(changes("housing", SOFT_HOUSING, push, 1.0), 1e-6);
}

#[test]
fn invariant_tangents_of_a_flange_that_moves_are_differences_of_runs() {
    let scene = Scene::parse(SHAFT_SUPPORT).unwrap();
    let race =
        Race::BOTH.into_iter().find(|race| scene.effects.support.sections[*race as usize].is_some()).unwrap();
    let shift = |inputs: &mut Inputs, by: f64| inputs[race].pose.position.y += by;
    assert_same(changes("flange", SHAFT_SUPPORT, shift, 1e-8), 1e-5);
}

#[test]
fn invariant_tangents_of_a_race_in_a_carrier_are_differences_of_runs() {
    let push = |inputs: &mut Inputs, by: f64| inputs.outer.applied.force.z += by;
    assert_same(changes("carrier", PLANET_CARRIER, push, 1.0), 1e-6);
}

#[test]
fn invariant_tangents_of_balls_kept_apart_are_differences_of_runs() {
    let push = |inputs: &mut Inputs, by: f64| inputs.inner.applied.force.y += by;
    let scene = SHAFT_SUPPORT.replace("[effects]\n", "[effects]\ncage = \"ideal\"\n");
    assert_same(changes("ideal cage", &scene, push, 1.0), 1e-5);
}
