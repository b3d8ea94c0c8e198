//! Four-point contact ball bearings of a machine: two sets of balls at one place, against balls with four contacts.

use std::f64::consts::TAU;

use nalgebra::{Matrix2, Vector2, Vector3};
use roulement::catalogue::rows_of;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::{MachineEquilibrium, System};

use crate::common::{forces, held, run, system};

/// A rigid shaft in a four-point bearing alone, held against what that does not hold.
fn alone(thrust: f64, radial: f64, tilt: f64, more: &str) -> String {
    format!(
        r#"
[shaft]
speed = "10 rpm"
mass = "2 kg"
polar_inertia = "1e-3 kg m^2"
transverse_inertia = "3e-3 kg m^2"

[[shaft.load]]
name = "load"
position = 0
force = [{thrust}, {radial}, 0]
rotation = {{ ry = 0, rz = {tilt} }}

[[bearing]]
name = "both"
catalogue = "QJ 208"
mounting = {{ position = 0 }}
{more}

[load]
duration = "1 ms"
output_interval = "100 us"
"#
    )
}

/// A contact of a ball in its plane: centre of its arc, axial and radial \[m], the distance from there at which it begins, its stiffness [N/m^1.5].
type Contact = (Vector2<f64>, f64, f64);

/// Force and moment on the inner ring of a bearing each of whose balls has four contacts, displaced along x and y \[m] and tilted about z \[rad]; and how
/// many of the balls touch more than two of their arcs. With a centrifugal force \[N].
fn four_contacts(system: &System, [x, y, tilt]: [f64; 3], centrifugal: f64) -> ([f64; 3], usize) {
    let scene = &system.scene().bearings[0].scene;
    let play = rows_of("QJ 208").unwrap().unwrap().axial_play;
    let [inner, outer] = scene.bearing.raceways();
    let radius = 0.5 * scene.bearing.ball_diameter.0;
    let (_, bearing) = system.bearings().next().unwrap();
    let (cosine, orbit) =
        (scene.bearing.contact_angle.unwrap().0.cos(), 0.5 * scene.bearing.pitch_diameter.0);
    let stiffness = |race: Race, side: f64| {
        let contact = bearing.model().contact(race, &bearing.conditions());
        contact.stiffness_of(contact.shape.stiffness(-side * cosine / (orbit + side * radius * cosine)))
    };
    let stiffnesses = [stiffness(Race::Inner, -1.0), stiffness(Race::Outer, 1.0)];
    let count = bearing.model().bearing.n_balls;
    let (mut sum, mut many) = ([0.0; 3], 0);
    for ball in 0..count {
        let azimuth: f64 = TAU * ball as f64 / count as f64;
        let (sin, cos) = azimuth.sin_cos();
        // The inner ring's arcs where the ring is; about z a point at +y goes to -x.
        let moved = |side: f64| {
            let (along, across) = (side * (inner.groove_offset - 0.25 * play), inner.groove_circle_radius);
            let (turned, back) = tilt.sin_cos();
            let outwards = (y + along * turned) * cos + across * (cos * cos * back + sin * sin);
            Vector2::new(along * back + x - turned * across * cos, outwards)
        };
        let arcs: Vec<Contact> = [-1.0, 1.0]
            .into_iter()
            .flat_map(|side: f64| {
                let of_outer =
                    Vector2::new(side * (outer.groove_offset + 0.25 * play), outer.groove_circle_radius);
                [
                    (moved(side), inner.groove_radius - radius, stiffnesses[0]),
                    (of_outer, outer.groove_radius - radius, stiffnesses[1]),
                ]
            })
            .collect();
        let place = minimum(&arcs, centrifugal, Vector2::new(0.0, orbit));
        let loads: Vec<Vector2<f64>> = arcs.iter().map(|arc| push(arc, &place).0).collect();
        many += usize::from(loads.iter().filter(|load| load.norm() > 1e-3).count() > 2);
        for k in [0, 2] {
            // What the arc does to the ball, the ball does to the ring, at the arc's centre.
            let on = -loads[k];
            let arm = arcs[k].0;
            sum[0] += on.x;
            sum[1] += on.y * cos;
            sum[2] += arm.x * on.y * cos - arm.y * cos * on.x;
        }
    }
    (sum, many)
}

/// Force \[N] of an arc on a ball at a place, its derivative, and the energy.
fn push((centre, reach, stiffness): &Contact, place: &Vector2<f64>) -> (Vector2<f64>, Matrix2<f64>, f64) {
    let arm = place - centre;
    let distance = arm.norm();
    let approach = (distance - reach).max(0.0);
    let (normal, load) = (arm / distance, stiffness * approach.powf(1.5));
    let along = normal * normal.transpose();
    let slope =
        along * (1.5 * stiffness * approach.sqrt()) + (Matrix2::identity() - along) * (load / distance);
    (-normal * load, slope, 0.4 * load * approach)
}

/// Where a ball between arcs has the least energy, by Newton's method with halved steps.
fn minimum(arcs: &[Contact], centrifugal: f64, from: Vector2<f64>) -> Vector2<f64> {
    let energy =
        |place: &Vector2<f64>| arcs.iter().map(|arc| push(arc, place).2).sum::<f64>() - centrifugal * place.y;
    let mut place = from;
    for _ in 0..200 {
        let zero = (Vector2::new(0.0, centrifugal), Matrix2::identity() * 1e3);
        let (force, slope) = arcs.iter().fold(zero, |(force, slope), arc| {
            let (own, by_place, _) = push(arc, &place);
            (force + own, slope + by_place)
        });
        let step = slope.try_inverse().unwrap() * force;
        let mut part = 1.0;
        while energy(&(place + step * part)) > energy(&place) && part > 1e-12 {
            part *= 0.5;
        }
        place += step * part;
    }
    place
}

/// Displacement of the shaft at the bearing: along x and y.
fn moved(system: &System) -> [f64; 2] {
    let at = system.outputs().loads[0].displacement;
    [at.x, at.y]
}

#[test]
fn independent_two_sets_load_the_rings_as_balls_with_four_contacts() {
    let mut most = [0usize; 2];
    for (thrust, radial, tilt) in [
        (2000.0, 0.0, 0.0),
        (-2000.0, 0.0, 0.0),
        (2000.0, 1000.0, 0.0),
        (3000.0, 6000.0, 0.0),
        (500.0, 8000.0, 0.0),
        (-1.0, 8000.0, 0.0),
        (4000.0, 2000.0, 2e-3),
        (1000.0, 6000.0, -2e-3),
    ] {
        let system = system(&alone(
            thrust,
            radial,
            tilt,
            "set = { friction = { ball_race = 0 }, effects = { creep = \"frictionless\" } }",
        ));
        let [x, y] = moved(&system);
        let ([along, across, about], many) = four_contacts(&system, [x, y, tilt], 0.0);
        let total = held(&system).iter().fold([Vector3::zeros(); 2], |[force, moment], [own, turn]| {
            [force + own, moment + turn + Vector3::new(x, y, 0.0).cross(own)]
        });
        let size = thrust.hypot(radial);
        assert!((total[0].x + thrust).hypot(total[0].y + radial) < 1e-6 * size, "{total:?}");
        // A tilted ball's plane is not its azimuth's, which is the rest.
        let allowed = if tilt == 0.0 { 2e-3 } else { 1e-2 };
        let off = (along + thrust).hypot(across + radial);
        assert!(off < allowed * size, "{thrust} {radial} {tilt}: {along} {across}");
        let of_moment = (about - total[1].z).abs();
        assert!(of_moment < allowed * 0.03 * size, "{thrust} {radial} {tilt}: {about} {}", total[1].z);
        most[usize::from(radial.abs() > thrust.abs())] += many;
    }
    // Balls that a thrust presses touch two arcs, but where a tilt lifts them; some of those under a radial load touch four.
    assert!(most[0] <= 3 && most[1] > 10, "{most:?}");
}

#[test]
fn closed_form_the_shaft_goes_by_the_axial_play() {
    let place = |thrust: f64| moved(&system(&alone(thrust, 0.0, 0.0, "")))[0];
    let play = rows_of("QJ 208").unwrap().unwrap().axial_play;
    assert!((play - 87.5e-6).abs() < 1e-12, "{play}");
    // By Hertz: approaches of both directions go with the power 2/3 of the load.
    let [light, heavy] = [1.0, 8.0].map(|thrust| place(thrust) - place(-thrust));
    let without = light - (heavy - light) / 3.0;
    assert!((without - play).abs() < 0.01e-6, "{without} {play}");
    let wider = alone(1.0, 0.0, 0.0, "").replace("QJ 208", "QJ208-MA/C3");
    assert!((moved(&system(&wider))[0] - place(1.0) - 0.5 * (125e-6 - play)).abs() < 0.01e-6);
}

#[test]
fn published_life_under_a_thrust_is_that_of_the_makers_factors() {
    // SKF: P = 1.07 Fa with C of the bearing where the thrust is large, which are ISO 281's factors of two rows at 35 degrees. These count a thrust more by
    // the inverse of 1 - sin(a)/3, which ISO/TS 16281 does not know: 0.81^-3 = 1.9 times the life; contact angles that grow take some of it back in both.
    let rows = rows_of("QJ 208").unwrap().unwrap();
    let thrust = 0.1 * rows.dynamic_load_rating;
    let found = MachineEquilibrium::of(system(&alone(thrust, 0.0, 0.0, "")).scene(), 0.0, 1.0).unwrap();
    let lives: Vec<f64> = found.bearings.iter().filter_map(|row| Some(row.outputs.life?.reference)).collect();
    let loaded = lives.iter().copied().fold(f64::INFINITY, f64::min);
    let by_rating = (rows.dynamic_load_rating / (1.07 * thrust)).powi(3);
    assert!((1.5..1.95).contains(&(loaded / by_rating)), "{lives:?} {by_rating}");
}

#[test]
fn consistency_balls_of_every_size_fit_and_give_the_ratings_of_the_table() {
    let table = include_str!("../../src/catalogue/four_point.csv");
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |place: usize| cells[place].parse::<f64>().unwrap();
        for name in
            [format!("QJ {}", cells[0]), format!("SKF QJ{} MA", cells[0]), format!("QJ{}-XL-MPA", cells[0])]
        {
            let rows = rows_of(&name)
                .unwrap_or_else(|| panic!("{name}"))
                .unwrap_or_else(|why| panic!("{name}: {why}"));
            let scene = Scene::parse(&rows.scene).unwrap();
            let ball = 1e3 * scene.bearing.ball_diameter.0;
            let height = 0.5 * (number(2) - number(1));
            assert!(ball < 0.76 * height && ball < 0.9 * number(3), "{name}: {ball} mm of {height} mm");
            assert!(rows.distance == 0.0 && rows.axial_play > 40e-6, "{name}");
            let own = scene.effects.rating.section.as_ref().unwrap().dynamic_load_rating.unwrap().0;
            assert!((own * 2f64.powf(0.7) / (1e3 * number(4)) - 1.0).abs() < 1e-3, "{name}: {own}");
        }
    }
    assert!(rows_of("QJF 208").is_none() && rows_of("NJ 208").is_none());
    let why = |name: &str| rows_of(name).unwrap().unwrap_err().to_string();
    assert!(why("QJ 208 C5").contains("C2, CN, C3, C4"), "{}", why("QJ 208 C5"));
    assert!(why("QJ 1036").contains("that the table lacks"), "{}", why("QJ 1036"));
}

#[test]
fn independent_a_set_under_a_thrust_is_exact_with_centrifugal_force() {
    // A ball that a thrust presses is exact until it falls onto the second arc of its outer race.
    for speed in [3000.0, 6000.0, 12000.0] {
        let text = alone(
            3000.0,
            0.0,
            0.0,
            "level = \"equilibrium\"\nset = { friction = { ball_race = 0 }, effects = { creep = \"frictionless\" } }",
        )
        .replace("10 rpm", &format!("{speed} rpm"));
        let system = system(&text);
        let scene = &system.scene().bearings[0].scene;
        let (_, bearing) = system.bearings().next().unwrap();
        let cage = bearing.outputs().rolling_speed;
        let mass = bearing.model().bearing.ball.mass;
        let force = mass * cage * cage * 0.5 * scene.bearing.pitch_diameter.0;
        let [x, y] = moved(&system);
        let ([along, ..], many) = four_contacts(&system, [x, y, 0.0], force);
        assert!(many == 0 && (along + 3000.0).abs() < 1e-3 * 3000.0, "{speed}: {along} {many}");
    }
}

#[test]
fn invariant_it_runs_with_its_balls_at_both_levels() {
    let text = alone(2000.0, 300.0, 0.0, "").replace("10 rpm", "1500 rpm");
    let still = held(&system(&text));
    for level in ["dynamic", "equilibrium"] {
        let system = run(&text.replace("catalogue = ", &format!("level = \"{level}\"\ncatalogue = ")), 1e-3);
        for (own, [force, _]) in forces(&system).iter().zip(&still) {
            assert!((own - force).norm() < 0.05 * 2000.0, "{level}: {own} {force}");
        }
        let names: Vec<&str> = system.scene().bearings.iter().map(|row| row.name.as_str()).collect();
        assert_eq!(names, ["both-1", "both-2"]);
    }
    // A preload takes the place of the play.
    let pressed = SystemScene::edited(
        &text.replace("position = 0 }", "position = 0, preload = { displacement = \"2 um\" } }"),
    )
    .unwrap();
    assert!(
        pressed.bearings.iter().all(|row| row.mounting.preload.displacement.is_some_and(|way| way.0 == 2e-6))
    );
}
