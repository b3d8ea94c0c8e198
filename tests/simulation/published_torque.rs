//! Dry friction torque of whole bearings against SKF's published model of sliding friction (SKF, Rolling bearings, 2018,
//! section "Friction": `M_sl = G_sl mu`): nothing of it was used in the model. It holds for given loads without regard to
//! clearance or conformity, so it is a measure of size and of exponents, not of digits.

use roulement::scene::Scene;
use roulement::simulation::Simulation;

use crate::evidence;

/// \[mm] mean diameter and \[N] static rating of a 6206.
const MEAN_DIAMETER: f64 = 46.0;
const STATIC_RATING: f64 = 11.2e3;
/// [-] friction coefficient of both.
const FRICTION: f64 = 0.05;

/// A 6206 with the default law: its balls, clearance CN, loads \[N] on the inner race along x and y.
const DEEP_GROOVE: &str = r#"
[bearing]
balls = 9
ball_diameter = "9.525 mm"
pitch_diameter = "46 mm"
diametral_clearance = "10 um"
inner_conformity = 0.515
outer_conformity = 0.525
[friction]
ball_race = 0.05
[effects]
damping = "0.02 s/m"
[inner]
drive = "wrench"
mass = "0.2 kg"
inertia = ["6e-5 kg m^2", "4e-5 kg m^2", "4e-5 kg m^2"]
shoulder_angle = [1.0, 1.0]
[outer]
shoulder_angle = [1.0, 1.0]
[load]
duration = "30 ms"
output_interval = "100 us"
inner_speed = "1500 rpm"
x = { force = 0.0 }
y = { force = 0.0 }
ry = { rotation = 0.0 }
rz = { rotation = 0.0 }
"#;

/// [N m] mean friction torque over two passages of a ball, after as many.
fn torque(changes: &[(&str, String)]) -> f64 {
    let scene =
        Scene::edited(DEEP_GROOVE, changes.iter().map(|(key, value)| (*key, value.as_str()))).unwrap();
    let mut simulation = Simulation::new(&scene).unwrap();
    let passage = std::f64::consts::TAU / (simulation.outputs().cage_speed * scene.bearing.balls as f64);
    let (mut sum, points) = (0.0, 100);
    for point in 1..=2 * points {
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        simulation.advance(2.0 * passage * f64::from(point) / f64::from(points)).unwrap();
        sum += if point > points { simulation.outputs().friction_torque.abs() } else { 0.0 };
    }
    sum / f64::from(points)
}

fn under(axial: f64, radial: f64) -> f64 {
    torque(&[("load.x.force", axial.to_string()), ("load.y.force", radial.to_string())])
}

/// [N m] SKF's sliding friction of a deep-groove bearing of series 62 under a radial load \[N].
fn radial_model(force: f64) -> f64 {
    3.23e-3 * MEAN_DIAMETER.powf(-0.26) * force.powf(5.0 / 3.0) * FRICTION * 1e-3
}

/// [N m] the same under an axial load \[N].
fn axial_model(force: f64) -> f64 {
    axial_model_at((24.6 * (force / STATIC_RATING).powf(0.24)).to_radians(), force)
}

/// [N m] the same where the contact angle \[rad] is known.
fn axial_model_at(angle: f64, force: f64) -> f64 {
    let load = (36.5 * MEAN_DIAMETER.powf(1.5) / angle.sin() * force.powi(4)).cbrt();
    3.23e-3 * MEAN_DIAMETER.powf(-0.145) * load * FRICTION * 1e-3
}

/// Ratios of a row of docs/evidence.md, whose figures are compared.
fn ratios(row: &str, loads: &[f64], model: impl Fn(f64) -> f64, run: impl Fn(f64) -> f64) -> Vec<f64> {
    let both: Vec<[f64; 2]> = loads.iter().map(|load| [run(*load), model(*load)]).collect();
    let ratio = |(load, [torque, published]): (&f64, &[f64; 2])| {
        println!(
            "{load} N: {:.4} N mm, published {:.4}, ratio {:.3}",
            torque * 1e3,
            published * 1e3,
            torque / published
        );
        torque / published
    };
    let ratios: Vec<f64> = loads.iter().zip(&both).map(ratio).collect();
    let of = |which: usize| both.iter().map(move |torques| torques[which] * 1e3);
    let figures: Vec<f64> = of(0).chain(of(1)).chain(ratios.iter().copied()).collect();
    evidence::compare(row, &figures);
    ratios
}

/// Are ratios about a value, and as equal over these loads as exponents that agree make them?
fn agree(ratios: &[f64], about: f64) {
    for ratio in ratios {
        assert!((ratio / about - 1.0).abs() < 0.05, "{ratios:?}");
    }
}

#[test]
fn published_number_torque_under_radial_load() {
    // The exponent of the load is 5/3: over a factor of 46 in torque the ratio stays.
    let row = "radial 300 / 1000 / 3000 N";
    agree(&ratios(row, &[300.0, 1000.0, 3000.0], radial_model, |load| under(0.0, load)), 0.89);
}

#[test]
fn published_number_torque_under_axial_load() {
    // 4/3, and what the contact angle that grows with the load adds.
    let row = "axial 150 / 500 / 2000 N";
    agree(&ratios(row, &[150.0, 500.0, 2000.0], axial_model, |load| under(load, 0.0)), 0.70);
}

/// [N m] SKF's sliding friction of a single-row angular-contact bearing under an axial load \[N]; those of the catalogue have 40
/// degrees, and the formula has no other angle. Its constants are recalled and not seen, the formula is page 106 of the catalogue
/// of 2016.
fn angular_contact_model(force: f64) -> f64 {
    1.30e-2 * MEAN_DIAMETER.powf(0.26) * 0.68 * force.powf(4.0 / 3.0) * FRICTION * 1e-3
}

/// [N m] torque of the same bearing with grooves of a contact angle \[deg] under an axial load \[N].
fn under_thrust_at(angle: &str, force: f64) -> f64 {
    torque(&[
        ("bearing.diametral_clearance", String::new()),
        ("bearing.contact_angle", format!("\"{angle} deg\"")),
        ("load.x.force", force.to_string()),
    ])
}

#[test]
fn published_number_torque_of_angular_contact_at_25_degrees() {
    // The model of deep grooves with this angle in the place of theirs, which the load opens.
    let model = |force| axial_model_at(25f64.to_radians(), force);
    let row = "axial 150 / 500 / 1500 N, 25 degrees (the angle put into the formula of deep grooves)";
    agree(&ratios(row, &[150.0, 500.0, 1500.0], model, |load| under_thrust_at("25", load)), 0.626);
}

#[test]
fn published_number_torque_of_angular_contact_at_40_degrees() {
    let row = "axial 150 / 500 / 1500 N, 40 degrees (formula of angular contact)";
    agree(
        &ratios(row, &[150.0, 500.0, 1500.0], angular_contact_model, |load| under_thrust_at("40", load)),
        1.217,
    );
}

#[test]
fn regression_conformity_decides_the_torque() {
    // The published model knows no conformity: between close and wide grooves lie 35 % of the torque.
    let with = |[inner, outer]: [&str; 2]| {
        torque(&[
            ("bearing.inner_conformity", inner.into()),
            ("bearing.outer_conformity", outer.into()),
            ("load.y.force", "1000.0".into()),
        ])
    };
    let [close, wide] = [with(["0.515", "0.525"]), with(["0.53", "0.53"])];
    println!("0.515 and 0.525: {:.4} N mm, 0.53 and 0.53: {:.4} N mm", close * 1e3, wide * 1e3);
    assert!((wide / close - 0.653).abs() < 0.02, "{close} {wide}");
}
