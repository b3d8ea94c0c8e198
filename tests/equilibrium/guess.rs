//! The equilibrium from a guess against that from the plain start.

use nalgebra::{UnitQuaternion, Vector3};
use roulement::equilibrium::{
    Equilibrium, EquilibriumInput, Gyroscopic, Prescribed, solve, solve_without_guess,
};
use roulement::model::Model;
use roulement::model::bodies::Race;
use roulement::scene::Scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const RADIAL: &str = include_str!("../../scenes/radial.toml");
const CAGE: &str = include_str!("../../scenes/cage.toml");
const MISALIGNMENT: &str = include_str!("../../scenes/misalignment.toml");

/// A ball of 1 mm, at 300 000 rpm.
const MINIATURE: &str = r#"
[bearing]
balls = 7
ball_diameter = "1 mm"
pitch_diameter = "4.5 mm"
contact_angle = "15 deg"
inner_conformity = 0.53
outer_conformity = 0.53
[load]
inner_speed = "300000 rpm"
x = { force = "8 N" }
y = { force = "-3 N" }
rz = { moment = "0.002 N m" }
"#;

/// A slewing ring of 2 m.
const SLEWING: &str = r#"
[bearing]
balls = 120
ball_diameter = "40 mm"
pitch_diameter = "2 m"
contact_angle = "45 deg"
inner_conformity = 0.53
outer_conformity = 0.53
[load]
inner_speed = "5 rpm"
x = { force = "400 kN" }
z = { force = "-90 kN" }
ry = { moment = "60 kN m" }
"#;

/// A deep groove bearing under thrust, radial load and a tilt.
const DEEP_GROOVE: &str = r#"
[bearing]
balls = 9
ball_diameter = "12.7 mm"
pitch_diameter = "65 mm"
diametral_clearance = "15 um"
inner_conformity = 0.52
outer_conformity = 0.52
[load]
inner_speed = "9000 rpm"
x = { force = "900 N" }
y = { force = "2500 N" }
ry = { rotation = "0.05 deg" }
"#;

fn case(text: &str) -> (Model, EquilibriumInput) {
    let scene = Scene::parse(text).unwrap();
    let input = EquilibriumInput::from_scene(&scene, Gyroscopic::Friction);
    (Model::new(&scene).unwrap(), input)
}

/// [-] largest difference: of loads over the largest one, of displacements over the ball diameter, of the cage speed over itself.
fn difference(model: &Model, a: &Equilibrium, b: &Equilibrium) -> f64 {
    let loads = |e: &Equilibrium| -> Vec<f64> {
        e.balls.iter().flat_map(|ball| [ball.report.inner_load, ball.report.outer_load]).collect()
    };
    let (a_loads, b_loads) = (loads(a), loads(b));
    let largest = b_loads.iter().copied().fold(0.0, f64::max);
    let of_loads = a_loads.iter().zip(&b_loads).map(|(a, b)| (a - b).abs() / largest);
    let of_race = (0..5).map(|i| {
        let size = if i < 3 { 1.0 } else { model.race_length() };
        (a.displacement[i] - b.displacement[i]).abs() * size / (2.0 * model.bearing.ball.radius)
    });
    let of_cage = (a.cage_speed - b.cage_speed).abs() / b.cage_speed.abs().max(f64::MIN_POSITIVE);
    of_loads.chain(of_race).chain([of_cage]).fold(0.0, f64::max)
}

#[test]
fn invariant_a_guess_ends_in_the_state_of_the_plain_start_and_leaves_no_iterations() {
    let scenes = [
        ("thrust", THRUST),
        ("radial", RADIAL),
        ("cage", CAGE),
        ("misalignment", MISALIGNMENT),
        ("miniature", MINIATURE),
        ("slewing ring", SLEWING),
        ("deep groove", DEEP_GROOVE),
    ];
    for (name, text) in scenes {
        let (model, mut input) = case(text);
        for outer_moves in [false, true] {
            if outer_moves {
                // The same loads on the other race, which then moves; the one that rests is tilted.
                input.race = Race::Outer;
                for condition in &mut input.conditions {
                    if let Prescribed::Load(load) = condition {
                        *load = -*load;
                    }
                }
                input.resting.orientation = UnitQuaternion::new(Vector3::new(0.0, 2e-4, -3e-4));
            }
            let guessed = solve(&model, &input).unwrap();
            let plain = solve_without_guess(&model, &input).unwrap();
            let (few, many) = (guessed.iterations, plain.iterations);
            assert!(few <= 1 && many >= 4, "{name}, outer {outer_moves}: {few} and {many} iterations");
            assert!(guessed.residual <= 1e-11, "{name}, outer {outer_moves}: {}", guessed.residual);
            // The residual of 1e-11 over the softest direction.
            let difference = difference(&model, &guessed, &plain);
            assert!(difference < 1e-8, "{name}, outer {outer_moves}: {difference:e}");
        }
    }
}

#[test]
fn limit_a_race_free_to_tilt_without_thrust_begins_at_the_plain_start() {
    let (model, mut input) = case(RADIAL);
    input.conditions[0] = Prescribed::Load(1.0);
    input.conditions[3] = Prescribed::Load(0.0);
    let guessed = solve(&model, &input).unwrap();
    let plain = solve_without_guess(&model, &input).unwrap();
    assert_eq!((guessed.iterations, guessed.displacement), (plain.iterations, plain.displacement));
}

#[test]
fn limit_a_guess_that_leads_nowhere_changes_no_error() {
    // More than the bearing carries, and a race that nothing holds.
    let (model, mut input) = case(THRUST);
    input.conditions[0] = Prescribed::Load(1e7);
    let (guessed, plain) =
        (solve(&model, &input).unwrap_err(), solve_without_guess(&model, &input).unwrap_err());
    assert_eq!(guessed.to_string(), plain.to_string());
    input.conditions[0] = Prescribed::Load(-1500.0);
    let (guessed, plain) =
        (solve(&model, &input).unwrap_err(), solve_without_guess(&model, &input).unwrap_err());
    assert_eq!(guessed.to_string(), plain.to_string());
}
