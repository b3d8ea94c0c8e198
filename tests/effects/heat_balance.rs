//! Temperatures from the heat of friction: closed forms of the balance, and runs whose heat, growth and oil follow it.

use roulement::effects::heat::ByContact;
use roulement::effects::heat_balance::{HeatBalance, Heating};
use roulement::effects::reports::Warm;
use roulement::interface::variables::{Causality, Variables};
use roulement::model::Model;
use roulement::scene::Scene;
use roulement::simulation::Simulation;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
/// Heat capacities of all parts \[J/K], and nothing that leaves them.
const CLOSED: &str = "{ inner_capacity = 0.2, outer_capacity = 0.3, balls_capacity = 0.1, shaft_capacity = 0.5, \
                      housing_capacity = 0.8, shaft_surroundings = 0.0, housing_surroundings = 0.0 }";
const CAPACITIES: [f64; 5] = [0.2, 0.3, 0.1, 0.5, 0.8];

fn scene(changes: &[(&str, &str)]) -> Scene {
    Scene::edited(THRUST, changes.iter().copied()).unwrap_or_else(|why| panic!("{why}"))
}

fn balance(section: &str) -> HeatBalance {
    let scene = scene(&[("growth.inner", "0.0"), ("effects.heat_balance", section)]);
    Model::new(&scene).unwrap().heat_balance.unwrap()
}

/// What goes on without friction.
fn quiet(powers: &ByContact, loads: f64, speed: f64) -> Heating<'_> {
    Heating { powers, guide: None, loads: [loads; 2], speed, lubrication: 1.0 }
}

#[test]
fn closed_form_two_parts_come_to_one_temperature() {
    // Ring and shaft alone: balls do not touch, the other ring has no way out.
    let section = CLOSED.replace('}', ", inner_shaft = 2.0, outer_housing = 0.0 }");
    let balance = balance(&section);
    let mut warm = Warm { rises: [30.0, 5.0, 7.0, 10.0, 0.0], out: 0.0 };
    let (powers, h, steps) = (ByContact::default(), 1e-4, 2000);
    for _ in 0..steps {
        balance.advance(&mut warm, &quiet(&powers, 0.0, 600.0), h);
    }
    let rate = 2.0 * (1.0 / 0.2 + 1.0 / 0.5);
    let left = 20.0 * (-rate * h * f64::from(steps)).exp();
    let mean = (0.2 * 30.0 + 0.5 * 10.0) / 0.7;
    assert!((warm.rises[0] - warm.rises[3] - left).abs() < 2e-3 * left.max(1.0), "{warm:?} {left}");
    assert!(((0.2 * warm.rises[0] + 0.5 * warm.rises[3]) / 0.7 - mean).abs() < 1e-9);
    assert_eq!((warm.rises[1], warm.rises[2], warm.rises[4]), (5.0, 7.0, 0.0));
}

#[test]
fn closed_form_heat_goes_half_to_each_surface() {
    let balance = balance(&CLOSED.replace('}', ", inner_shaft = 0.0, outer_housing = 0.0 }"));
    let powers = ByContact { races: [10.0, 4.0], pockets: 3.0, lands: 2.0, balls: 1.0, medium: 0.0 };
    let mut warm = Warm::default();
    balance.advance(&mut warm, &Heating { guide: Some(1), ..quiet(&powers, 0.0, 600.0) }, 1e-3);
    let expected = [5.0 / 0.2, (2.0 + 2.0) / 0.3, (5.0 + 2.0 + 3.0 + 1.0) / 0.1].map(|rate| rate * 1e-3);
    for (ours, expected) in warm.rises.into_iter().zip(expected) {
        assert!((ours - expected).abs() < 1e-15, "{ours} {expected}");
    }
    // Everything warms faster by the factor, and oil takes heat as far as there is some.
    let fast = balance_of_faster();
    let mut quicker = Warm::default();
    let without_oil = Heating { guide: Some(1), lubrication: 0.0, ..quiet(&powers, 0.0, 600.0) };
    fast.advance(&mut quicker, &without_oil, 1e-3);
    assert!((quicker.rises[0] / warm.rises[0] - 50.0).abs() < 1e-12);
    let mut cooled = Warm { rises: [10.0; 5], out: 0.0 };
    let none = ByContact::default();
    let heating = Heating { lubrication: 0.25, ..quiet(&none, 0.0, 600.0) };
    fast.advance(&mut cooled, &heating, 1e-3);
    // An implicit step of each part: as warm as at its end.
    let ends = [0.2, 0.3, 0.1].map(|capacity: f64| 10.0 / (1.0 + 1e-3 * 1.0 * 50.0 / capacity));
    for (ours, end) in cooled.rises.into_iter().zip(ends) {
        assert!((ours - end).abs() < 1e-12, "{cooled:?} {ends:?}");
    }
    assert!((cooled.out - ends.into_iter().sum::<f64>()).abs() < 1e-9, "{cooled:?}");
}

#[test]
fn invariant_small_heat_capacities_do_not_swing() {
    // Balls that take their whole heat up in nanoseconds, with oil and contacts that carry it on.
    let balance = balance(
        &CLOSED.replace("balls_capacity = 0.1", "balls_capacity = 1e-9").replace('}', ", oil = 4.0 }"),
    );
    let powers = ByContact { pockets: 8.0, ..ByContact::default() };
    let mut warm = Warm::default();
    let mut before = 0.0;
    for _ in 0..200_000 {
        balance.advance(&mut warm, &quiet(&powers, 100.0, 600.0), 1e-4);
        assert!(warm.rises[2] >= before - 1e-12, "{warm:?}");
        before = warm.rises[2];
    }
    // What goes in goes out, to oil alone.
    assert!((warm.out - 8.0).abs() < 1e-6, "{warm:?}");
    assert!((warm.rises.iter().take(3).sum::<f64>() * 4.0 - 8.0).abs() < 1e-6, "{warm:?}");
}

fn balance_of_faster() -> HeatBalance {
    balance(&CLOSED.replace('}', ", inner_shaft = 0.0, outer_housing = 0.0, faster = 50.0, oil = 4.0 }"))
}

#[test]
fn closed_form_conductance_of_passing_contacts() {
    // Heat of two half-spaces in contact for the time that each strip takes through the ellipse, summed over the strips.
    let scene = scene(&[("growth.inner", "0.0"), ("effects.heat_balance", CLOSED)]);
    let model = Model::new(&scene).unwrap();
    let balance = model.heat_balance.unwrap();
    let (load, speed): (f64, f64) = (300.0, 628.0);
    let [inner, _] = balance.through_contacts([load.sqrt(); 2], speed);
    let race = roulement::model::bodies::Race::Inner;
    let bearing = &model.bearing;
    let contact = model.contact(race, &roulement::model::Conditions::default());
    let at = contact.shape.at(bearing.circumferential_curvature(race));
    let root = (load / at.stiffness).cbrt();
    let [a, b] = [at.semi_axis_rolling * root, at.semi_axis_transverse * root];
    let (conductivity, density, heat): (f64, f64, f64) = (46.0, scene.race.density.0, 460.0);
    let ratio = 2.0 * bearing.ball.radius / bearing.pitch_diameter;
    let surface = 0.25 * bearing.pitch_diameter * (1.0 - ratio * ratio) * speed;
    let strips = 20_000;
    let expected: f64 = (0..strips)
        .map(|strip| {
            let t = (f64::from(strip) + 0.5) / f64::from(strips) * 2.0 - 1.0;
            let time = 2.0 * a * (1.0 - t * t).sqrt() / surface;
            // Half of the difference at the surface: 2 k (1/2) root(time/(pi kappa)) J/(m2 K).
            let through =
                conductivity * (time * density * heat / (conductivity * std::f64::consts::PI)).sqrt();
            surface * through * 2.0 * b / f64::from(strips)
        })
        .sum();
    assert!((inner / expected - 1.0).abs() < 1e-4, "{inner} {expected}");
}

#[test]
fn invariant_friction_is_what_parts_have_taken_up() {
    let scene =
        scene(&[("growth.inner", "0.0"), ("effects.heat_balance", CLOSED), ("effects.damping", "0.0")]);
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.advance_scripted(0.02).unwrap();
    let outputs = simulation.outputs();
    let taken: f64 = outputs.warm.unwrap().rises.into_iter().zip(CAPACITIES).map(|(rise, c)| rise * c).sum();
    assert!(
        outputs.dissipated > 0.1 && (taken / outputs.dissipated - 1.0).abs() < 1e-3,
        "{taken} {outputs:?}"
    );
    // Growth follows, and nothing is unaccounted for.
    let grown = simulation.state().grown.unwrap().warmth.rises;
    assert!(grown[0] > 0.1 && (grown[0] / outputs.warm.unwrap().rises[0] - 1.0).abs() < 1e-3, "{grown:?}");
}

#[test]
fn temperatures_are_outputs_where_they_are_computed_and_oil_follows_them() {
    let scene = scene(&[
        ("growth.inner", "20.0"),
        ("growth.balls", "10.0"),
        ("effects.heat_balance", CLOSED),
        ("film.iso_vg", "68.0"),
        ("film.cold_temperature", "40.0"),
    ]);
    let variables = Variables::new(&scene);
    let named = |name: &str| variables.rows().iter().find(|row| row.name == name).unwrap().causality;
    assert_eq!(named("temperature_rise.inner"), Causality::Output);
    assert_eq!(named("lubrication"), Causality::Input);
    let simulation = Simulation::new(&scene).unwrap();
    // Mean of ring and balls: 55 and 45 degC.
    let oil = roulement::effects::film::oil::Oil::Graded(68.0, 880.0);
    let [inner, outer] = simulation.outputs().oil.unwrap();
    assert_eq!([inner, outer], [oil.viscosity(55.0), oil.viscosity(45.0)]);
}

#[test]
fn what_does_not_go_together_is_refused() {
    let why =
        |changes: &[(&str, &str)]| Scene::edited(THRUST, changes.iter().copied()).unwrap_err().to_string();
    assert!(why(&[("effects.heat_balance", "{}")]).contains("[growth]"));
    let table = [("growth.inner", "[[0, 0], [1, 20]]"), ("effects.heat_balance", "{}")];
    assert!(why(&table).contains("constants"));
    let range = [("growth.inner", "0.0"), ("effects.heat_balance.faster", "0.5")];
    assert!(why(&range).contains("effects.heat_balance.faster") && why(&range).contains("[1, 10000]"));
}
