//! Friction torque of whole bearings in oil against SKF's model (SKF, Rolling bearings, 2018, section "Friction"), of which nothing was
//! used in the model but its factor of starvation. Writes and checks the table of docs/oil.md (`scripts/tables`).

use roulement::scene::Scene;
use roulement::simulation::Simulation;

use crate::tables::{compare, count, row};

const POINTS: &str = include_str!("../data/effects/skf_6206.csv");
/// [-] friction coefficient of boundary layers in SKF's model, ours of dry surfaces.
const BOUNDARY: f64 = 0.15;
/// [kg/m3] density of oil.
const DENSITY: f64 = 880.0;

/// A bearing: what SKF's model asks for [mm, N], and the internal geometry that we give it.
#[derive(Clone, Copy)]
struct Bearing {
    name: &'static str,
    angular: bool,
    mean_diameter: f64,
    bore: f64,
    outside: f64,
    static_rating: f64,
    balls: usize,
    ball_diameter: f64,
    /// Key and value.
    free: [&'static str; 2],
}

const B6206: Bearing = Bearing {
    name: "6206",
    angular: false,
    mean_diameter: 46.0,
    bore: 30.0,
    outside: 62.0,
    static_rating: 11.2e3,
    balls: 9,
    ball_diameter: 9.525,
    free: ["bearing.diametral_clearance", "\"10 um\""],
};
const B6210: Bearing = Bearing {
    name: "6210",
    mean_diameter: 70.0,
    bore: 50.0,
    outside: 90.0,
    static_rating: 23.2e3,
    balls: 10,
    ball_diameter: 12.7,
    free: ["bearing.diametral_clearance", "\"12 um\""],
    ..B6206
};
const B7206: Bearing = Bearing {
    name: "7206 B",
    angular: true,
    static_rating: 14e3,
    balls: 13,
    free: ["bearing.contact_angle", "\"40 deg\""],
    ..B6206
};

/// A point of operation: loads \[N], speed [rpm], kinematic viscosity [mm2/s].
type Point = (Bearing, f64, f64, f64, f64);

/// [mm2/s] ISO VG 68 at 70 degC.
const VG68: f64 = 19.9;

/// Further points than those of the data.
const FURTHER: [Point; 20] = [
    (B6206, 1500.0, 0.0, 100.0, VG68),
    (B6206, 1500.0, 0.0, 300.0, VG68),
    (B6206, 1500.0, 0.0, 1000.0, VG68),
    (B6206, 1500.0, 0.0, 3000.0, VG68),
    (B6206, 1500.0, 0.0, 6000.0, VG68),
    (B6206, 1500.0, 0.0, 12000.0, VG68),
    (B6206, 500.0, 0.0, 3000.0, 32.0),
    (B6206, 500.0, 0.0, 12000.0, 15.0),
    (B6206, 3000.0, 0.0, 1500.0, 32.0),
    (B6206, 0.0, 1000.0, 3000.0, 32.0),
    (B6206, 1000.0, 1000.0, 6000.0, 32.0),
    (B6210, 2000.0, 0.0, 500.0, 68.0),
    (B6210, 2000.0, 0.0, 3000.0, 32.0),
    (B6210, 4000.0, 0.0, 1500.0, 32.0),
    (B6210, 1000.0, 0.0, 8000.0, 15.0),
    (B7206, 0.0, 1000.0, 3000.0, 32.0),
    (B7206, 0.0, 2000.0, 6000.0, 20.0),
    (B7206, 1000.0, 2000.0, 6000.0, 32.0),
    (B7206, 0.0, 2000.0, 500.0, 68.0),
    (B7206, 0.0, 500.0, 10000.0, 15.0),
];

/// [N mm] rolling and sliding moment of SKF's model, an oil bath.
fn published(&(bearing, radial, axial, speed, viscosity): &Point) -> [f64; 2] {
    let Bearing { angular, mean_diameter: mean, bore, outside, static_rating, .. } = bearing;
    let (rolling, sliding) = if angular {
        let centrifugal = |factor: f64| factor * mean.powi(4) * speed * speed;
        (
            5.03e-7 * mean.powf(1.97) * (radial + centrifugal(1.9e-12) + 1.97 * axial).powf(0.54),
            1.3e-2
                * mean.powf(0.26)
                * ((radial + centrifugal(1.91e-12)).powf(4.0 / 3.0) + 0.68 * axial.powf(4.0 / 3.0)),
        )
    } else if axial == 0.0 {
        (3.9e-7 * mean.powf(1.96) * radial.powf(0.54), 3.23e-3 * mean.powf(-0.26) * radial.powf(5.0 / 3.0))
    } else {
        let sine = (24.6 * (axial / static_rating).powf(0.24)).to_radians().sin();
        (
            3.9e-7 * mean.powf(1.96) * (radial + 1.7 / sine * axial).powf(0.54),
            3.23e-3
                * mean.powf(-0.145)
                * (radial.powi(5) + 36.5 * mean.powf(1.5) / sine * axial.powi(4)).cbrt(),
        )
    };
    let heating = 1.0 / (1.0 + 1.84e-9 * (speed * mean).powf(1.28) * viscosity.powf(0.64));
    let geometry: f64 = if angular { 4.4 } else { 3.1 };
    let starving = 3e-8 * viscosity * speed * (bore + outside) * (geometry / (2.0 * (outside - bore))).sqrt();
    let boundary = (-2.6e-8 * (speed * viscosity).powf(1.4) * mean).exp();
    let friction = boundary * BOUNDARY + (1.0 - boundary) * 0.05;
    [heating * (-starving).exp() * rolling * (viscosity * speed).powf(0.6), friction * sliding]
}

/// [N mm] moment of Palmgren's model (1959) in an oil bath: that of the speed, and that of the load. Factors as recalled from catalogues of
/// his time; f_1 of deep groove bearings is the upper one of the range that they give, 0.0006 to 0.0009.
fn palmgren(&(bearing, radial, axial, speed, viscosity): &Point) -> f64 {
    let Bearing { angular, mean_diameter: mean, static_rating, .. } = bearing;
    let (of_speed, of_load, power) = if angular { (3.3, 1e-3, 0.33) } else { (2.0, 9e-4, 0.55) };
    let (share, load) = if angular {
        (0.5 * radial + 0.26 * axial, axial - 0.1 * radial)
    } else {
        (0.6 * radial + 0.5 * axial, 3.0 * axial - 0.1 * radial)
    };
    let (share, load) = (share.max(radial), load.max(radial));
    // Below 2000 mm2/s rpm it does not depend on the speed.
    let speed = 1e-7 * of_speed * (viscosity * speed).max(2000.0).powf(2.0 / 3.0) * mean.powi(3);
    speed + of_load * (share / static_rating).powf(power) * load * mean
}

#[test]
fn published_number_torque_by_palmgren() {
    // By hand: 2e-7 119400^(2/3) 46^3 = 47.2, and 9e-4 (1500/11200)^0.55 1500 46 = 20.6.
    assert!((palmgren(&(B6206, 1500.0, 0.0, 6000.0, VG68)) - 67.75).abs() < 0.1);
    // 3.3e-7 96000^(2/3) 46^3 = 67.3, and 1e-3 (260/14000)^0.33 1000 46 = 12.3.
    assert!((palmgren(&(B7206, 0.0, 1000.0, 3000.0, 32.0)) - 79.7).abs() < 0.1);
}

/// Our friction torque and the part of it by rolling resistance [N mm]: means over a passage of a ball, after as long.
fn ours(&(bearing, radial, axial, speed, viscosity): &Point) -> [f64; 2] {
    let text = format!(
        "[bearing]\nballs = {}\nball_diameter = \"{} mm\"\npitch_diameter = \"{} mm\"\ninner_conformity = 0.52\n\
         outer_conformity = 0.53\n{} = {}\n[friction]\nball_race = {BOUNDARY}\n[effects]\nhysteresis = true\n\
         [film]\nviscosity = {}\ntemperature_viscosity = 0.045\nbore = \"{} mm\"\noutside = \"{} mm\"\n\
         [inner]\ndrive = \"wrench\"\nmass = 1.0\ninertia = [6e-4, 5e-4, 5e-4]\n[load]\ninner_speed = \"{speed} rpm\"\n\
         x = {{ force = {axial} }}\ny = {{ force = {radial} }}\nz = {{ displacement = 0.0 }}\n\
         ry = {{ rotation = 0.0 }}\nrz = {{ rotation = 0.0 }}\n[solver]\naccuracy = \"balanced\"\n",
        bearing.balls,
        bearing.ball_diameter,
        bearing.mean_diameter,
        bearing.free[0].trim_start_matches("bearing."),
        bearing.free[1],
        viscosity * 1e-6 * DENSITY,
        bearing.bore,
        bearing.outside,
    );
    let scene = Scene::parse(&text).unwrap_or_else(|why| panic!("{why}\n{text}"));
    let mut simulation = Simulation::new(&scene).unwrap();
    let passage = std::f64::consts::TAU / (simulation.outputs().cage_speed * bearing.balls as f64);
    // Where balls pass often, several of them.
    let duration = passage * (0.01 / passage).ceil();
    let (mut torque, mut rolling, points) = (0.0, 0.0, 60);
    for point in 1..=2 * points {
        simulation.advance_scripted(duration * f64::from(point) / f64::from(points)).unwrap();
        if point > points {
            let outputs = simulation.outputs();
            let of_balls: f64 =
                outputs.contact_power(|ball| ball.inner.film.rolling_power + ball.outer.film.rolling_power);
            torque += outputs.friction_torque.abs();
            rolling += of_balls / scene.load.inner_speed.at(0.0);
        }
    }
    [torque, rolling].map(|sum| sum * 1e3 / f64::from(points))
}

/// The points of the data, with what they say of SKF's model.
fn given() -> Vec<(Point, [f64; 2])> {
    POINTS
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            ((B6206, cells[0], cells[1], cells[2], cells[3]), [cells[10], cells[11]])
        })
        .collect()
}

#[test]
fn published_model_is_the_one_of_the_data() {
    for (point, expected) in given() {
        for (ours, theirs) in published(&point).into_iter().zip(expected) {
            assert!((ours / theirs - 1.0).abs() < 1e-9, "{ours} {theirs}");
        }
    }
}

#[test]
fn published_model_of_friction_torque_in_oil() {
    let given: Vec<Point> = given().into_iter().map(|(point, _)| point).collect();
    let points: Vec<Point> = given.iter().copied().chain(FURTHER).collect();
    let rows: Vec<_> = points
        .iter()
        .enumerate()
        .map(|(index, point)| {
            let ([rolling, sliding], [torque, film]) = (published(point), ours(point));
            let ratio = torque / (rolling + sliding);
            let (bearing, radial, axial, speed, viscosity) = point;
            // At 12000 rpm the balls' centrifugal forces, which no torque model of deep groove bearings has, roll all outer contacts.
            let usual = bearing.name == "6206" && (*radial, *axial) == (1500.0, 0.0) && *speed <= 6000.0;
            if index < given.len() || usual {
                assert!((ratio - 1.0).abs() < 0.25, "{radial} N, {axial} N, {speed} rpm: {ratio}");
            }
            let words = format!(
                "{} | {radial} | {axial} | {speed} | {viscosity} | {rolling:.1} + {sliding:.1} | {:.1}",
                bearing.name,
                palmgren(point)
            );
            row(words, vec![count(film, 1), count(torque, 1), count(ratio, 2)], "")
        })
        .collect();
    let header = "bearing | radial \\[N] | axial \\[N] | \\[rpm] | \\[mm2/s] | SKF, rolling + sliding \\[N mm] | Palmgren \\[N mm] | ours: film's rolling / all \\[N mm] / ratio";
    compare("docs/oil.md", "torque", header, &rows);
}

#[test]
fn published_exponent_of_torque_with_speed() {
    // 0.6 in SKF's model and before it in Palmgren's (2/3), where rolling resistance is most of the torque: a light load.
    let torque = |speed: f64, viscosity: f64| ours(&(B6206, 500.0, 0.0, speed, viscosity))[0];
    for viscosity in [32.0, 68.0] {
        let exponent = (torque(8000.0, viscosity) / torque(1000.0, viscosity)).ln() / 8f64.ln();
        assert!((exponent - 0.6).abs() < 0.1, "{viscosity} mm2/s: {exponent}");
    }
}
