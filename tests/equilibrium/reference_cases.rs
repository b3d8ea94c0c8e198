//! Quasi-static equilibrium against independent data (tests/data/bearing/README.md) and invariants.

use nalgebra::{Rotation2, UnitQuaternion, Vector2};
use roulement::equilibrium::{self, Equilibrium, EquilibriumInput, Gyroscopic, Prescribed};
use roulement::model::Model;
use roulement::scene::Scene;
use serde_json::Value;

use crate::equilibria::{difference, solve, whole};
use crate::mechanics::{Body, Dimensions, V, grooves};
use crate::reference::cases;

#[test]
fn independent_data_twenty_cases_under_both_hypotheses() {
    for case in &cases() {
        for (key, gyroscopic) in
            [("outer_race_control", Gyroscopic::OuterRaceControl), ("no_gyro", Gyroscopic::None)]
        {
            let ours = solve(&whole(case), gyroscopic);
            let d = difference(&ours, &case[key]);
            let name = format!("{} {key}", case["id"]);
            // Both solve the same equations; what differs is the last digits of the reference's Hertz table and its
            // stiffness by differences. Asked for: loads 1e-5 at rest, 0.5 % and 0.1 deg at speed.
            assert!(d.load < 1e-5, "{name}: load {:e}", d.load);
            assert!(d.angle < 1e-6, "{name}: angle {:e} rad", d.angle);
            assert!(d.displacement < 2e-5, "{name}: displacement {:e} of 10 um", d.displacement);
            assert!(d.cage_speed < 1e-7, "{name}: cage speed {:e}", d.cage_speed);
            assert!(d.stiffness < 2e-5, "{name}: stiffness {:e}", d.stiffness);
            assert!(ours.residual < 1e-9 && ours.iterations < 20, "{name}: {} iterations", ours.iterations);
        }
    }
}

fn bearing_text(geometry: &str, load: &str) -> String {
    format!("[bearing]\n{geometry}\n[load]\n{load}\n")
}

const ANGULAR_218: &str = r#"
balls = 16
ball_diameter = "22.23 mm"
pitch_diameter = "125.26 mm"
contact_angle = "40 deg"
inner_conformity = 0.5232
outer_conformity = 0.5232
[ball]
density = 7870"#;

#[test]
#[rustfmt::skip]
fn independent_data_218_angular_contact_table() {
    // Fa [N], speed [rpm], angles [deg], loads [N], axial shift [um], as printed in the data's README.
    let table = [
        [17800.0, 0.0, 41.502, 41.502, 1678.9, 1678.9, 36.096],
        [17800.0, 6000.0, 44.750, 38.005, 1580.2, 1738.9, 33.01],
        [17800.0, 10000.0, 50.030, 31.224, 1451.6, 1925.5, 14.46],
        [17800.0, 15000.0, 56.868, 19.037, 1328.5, 2736.0, -49.16],
        [22250.0, 10000.0, 48.773, 33.531, 1849.0, 2307.9, 27.24],
        [44500.0, 6000.0, 44.025, 41.208, 4002.0, 4157.6, 63.98],
        [44500.0, 15000.0, 50.847, 32.929, 3586.6, 4629.6, 45.00],
    ];
    for [force, rpm, inner_angle, outer_angle, inner_load, outer_load, shift] in table {
        let load = format!(
            "inner_speed = \"{rpm} rpm\"\nx = {{ force = {force} }}\ny = {{ displacement = 0.0 }}\n\
             z = {{ displacement = 0.0 }}\nry = {{ rotation = 0.0 }}\nrz = {{ rotation = 0.0 }}"
        );
        let solution = solve(&bearing_text(ANGULAR_218, &load), Gyroscopic::OuterRaceControl);
        let ball = &solution.balls[0].report;
        // Half of the last printed digit, and what rounding a table's speed and density may add.
        for (ours, theirs, digit) in [
            (ball.inner_contact_angle.to_degrees(), inner_angle, 6e-4),
            (ball.outer_contact_angle.to_degrees(), outer_angle, 6e-4),
            (ball.inner_load, inner_load, 0.06),
            (ball.outer_load, outer_load, 0.06),
            (solution.displacement[0] * 1e6, shift, 6e-3),
        ] {
            assert!((ours - theirs).abs() < digit, "{force} N, {rpm} rpm: {ours} against {theirs}");
        }
    }
}

#[test]
fn independent_data_209_deep_groove_radial() {
    let geometry = r#"
balls = 9
ball_diameter = "12.7 mm"
pitch_diameter = "65 mm"
inner_conformity = 0.52
outer_conformity = 0.52"#;
    let load = "x = { displacement = 0.0 }\ny = { force = \"8900 N\" }\nz = { displacement = 0.0 }\n\
                ry = { rotation = 0.0 }\nrz = { rotation = 0.0 }";
    for (clearance, expected) in
        [("15 um", [4530.6, 2841.2, 60.4, 0.0, 0.0]), ("0 um", [4340.6, 2908.4, 312.0, 0.0, 0.0])]
    {
        let geometry = format!("{geometry}\ndiametral_clearance = \"{clearance}\"");
        let solution = solve(&bearing_text(&geometry, load), Gyroscopic::None);
        for (ball, expected) in solution.balls.iter().zip(expected) {
            assert!((ball.report.inner_load - expected).abs() < 0.06, "{clearance}: {:?}", ball.report);
        }
        if clearance == "15 um" {
            assert!((solution.displacement[1] - 60.76e-6).abs() < 6e-9);
        }
    }
}

#[test]
fn independent_data_static_iso_16281_type_references() {
    // Exact-geometry values of the data's README.
    let geometry = |clearance: &str| {
        format!(
            "balls = 7\nball_diameter = \"11.5 mm\"\npitch_diameter = \"43.5 mm\"\ninner_conformity = 0.52\n\
             outer_conformity = 0.53\ndiametral_clearance = \"{clearance}\"\n\
             [ball]\nyoungs_modulus = \"210 GPa\"\n[race]\nyoungs_modulus = \"210 GPa\""
        )
    };
    let fixed = "ry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\nz = { displacement = 0.0 }";
    for (clearance, direction, expected) in
        [("0 um", 1, 15.115), ("0 um", 0, 133.53), ("10 um", 1, 21.230), ("10 um", 0, 149.16)]
    {
        let load = if direction == 0 {
            format!("x = {{ force = 1000.0 }}\ny = {{ displacement = 0.0 }}\n{fixed}")
        } else {
            format!("y = {{ force = 1000.0 }}\nx = {{ displacement = 0.0 }}\n{fixed}")
        };
        let solution = solve(&bearing_text(&geometry(clearance), &load), Gyroscopic::None);
        let ours = solution.displacement[direction] * 1e6;
        let digit = if expected > 100.0 { 6e-3 } else { 6e-4 };
        assert!((ours - expected).abs() < digit, "{clearance}: {ours} against {expected} um");
    }
}

#[test]
fn invariant_under_rotation_by_one_ball_pitch() {
    let data: Value = serde_json::from_str(include_str!("../data/bearing/equilibrium.json")).unwrap();
    let case = &data["cases"].as_array().unwrap()[10];
    let scene = Scene::parse(&whole(case)).unwrap();
    let model = Model::new(&scene).unwrap();
    let input = EquilibriumInput::from_scene(&scene, Gyroscopic::OuterRaceControl);
    let one = equilibrium::solve(&model, &input).unwrap();
    let Prescribed::Load(fy) = input.conditions[1] else { panic!("y is a force in this case") };
    let Prescribed::Load(fz) = input.conditions[2] else { panic!("z is a force in this case") };
    let turn = Rotation2::new(std::f64::consts::TAU / model.bearing.n_balls as f64);
    let force = turn * Vector2::new(fy, fz);
    let mut turned = input.clone();
    turned.conditions[1] = Prescribed::Load(force.x);
    turned.conditions[2] = Prescribed::Load(force.y);
    let other = equilibrium::solve(&model, &turned).unwrap();
    let expected = turn * Vector2::new(one.displacement[1], one.displacement[2]);
    assert!((expected - Vector2::new(other.displacement[1], other.displacement[2])).norm() < 1e-14);
    for (j, ball) in one.balls.iter().enumerate() {
        let next = &other.balls[(j + 1) % one.balls.len()];
        assert!((ball.report.inner_load - next.report.inner_load).abs() < 1e-6);
    }
}

#[test]
fn invariant_stiffness_is_the_derivative_of_the_load() {
    let data: Value = serde_json::from_str(include_str!("../data/bearing/equilibrium.json")).unwrap();
    let case = &data["cases"].as_array().unwrap()[18];
    let scene = Scene::parse(&whole(case)).unwrap();
    let model = Model::new(&scene).unwrap();
    let mut input = EquilibriumInput::from_scene(&scene, Gyroscopic::OuterRaceControl);
    let here = equilibrium::solve(&model, &input).unwrap();
    let steps = [1e-8, 1e-8, 1e-8, 1e-6, 1e-6];
    for k in 0..5 {
        let mut at = |sign: f64| {
            for i in 0..5 {
                let shift = if i == k { sign * steps[k] } else { 0.0 };
                input.conditions[i] = Prescribed::Motion(here.displacement[i] + shift);
            }
            equilibrium::solve(&model, &input).unwrap().load
        };
        let (plus, minus) = (at(1.0), at(-1.0));
        for i in 0..5 {
            let difference = (plus[i] - minus[i]) / (2.0 * steps[k]);
            let scale = (here.stiffness[(i, i)] * here.stiffness[(k, k)]).abs().sqrt();
            assert!((difference - here.stiffness[(i, k)]).abs() < 1e-6 * scale, "{i} by {k}");
        }
    }
}

#[test]
fn closed_form_axial_play_between_the_flanks() {
    let solve_at = |force: f64| {
        let load = format!(
            "x = {{ force = {force} }}\ny = {{ displacement = 0.0 }}\nz = {{ displacement = 0.0 }}\n\
             ry = {{ rotation = 0.0 }}\nrz = {{ rotation = 0.0 }}\n\
             [inner]\nshoulder_angle = [1.5, 1.5]\n[outer]\nshoulder_angle = [1.5, 1.5]"
        );
        solve(&bearing_text(ANGULAR_218, &load), Gyroscopic::None).displacement[0]
    };
    // Grooves that reach to both sides: the other flanks take a thrust the other way after 2 A sin(alpha0).
    let play = 2.0 * (2.0 * 0.5232 - 1.0) * 22.23e-3 * 40f64.to_radians().sin();
    let (forward, backward) = (solve_at(1000.0), solve_at(-1000.0));
    assert!((forward + backward + play).abs() < 1e-12, "{forward} {backward} {play}");
}

#[test]
fn a_load_that_no_bearing_takes_is_refused_with_its_reason() {
    let load = "y = { force = 1e9 }";
    let scene = Scene::parse(&bearing_text(ANGULAR_218, load)).unwrap();
    let input = EquilibriumInput::from_scene(&scene, Gyroscopic::None);
    let refusal = equilibrium::solve(&Model::new(&scene).unwrap(), &input);
    let message = refusal.map(|solution| solution.displacement).unwrap_err().to_string();
    // The first ball is the one under the load.
    assert!(message.starts_with("ball 1 would be pressed in"), "{message}");
    assert!(message.contains("beyond elastic Hertzian contact"), "{message}");
}

#[test]
fn closed_form_balance_of_a_ball_that_both_races_keep_from_turning() {
    // Newton and Euler for one ball: rolling without slip turns it about an axis, which its orbit carries round; the moment
    // for that is friction at both races in proportion to their loads, if that is enough (1.5), and slides otherwise (0.002).
    let (diameter, pitch, angle, conformity): (f64, f64, f64, f64) =
        (22.23e-3, 125.26e-3, 40f64.to_radians(), 0.5232);
    let steel = (206e9, 0.3);
    let dimensions = Dimensions {
        ball_radius: 0.5 * diameter,
        grooves: grooves(diameter, pitch, angle, [conformity; 2]),
        materials: [steel; 2],
        friction: 0.0,
        damping: 0.0,
    };
    let mass = 7870.0 * std::f64::consts::PI / 6.0 * diameter.powi(3);
    let inertia = 0.1 * mass * diameter * diameter;
    for (friction, slides) in [(1.5, false), (0.002, true)] {
        let load = "inner_speed = 1500.0\nx = { force = 22250.0 }\ny = { displacement = 0.0 }\n\
                    z = { displacement = 0.0 }\nry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n[friction]\nball_race = ";
        let text = bearing_text(ANGULAR_218, &format!("{load}{friction}"));
        let solution = solve(&text, Gyroscopic::Friction);
        let still = |position: V| Body {
            position,
            orientation: UnitQuaternion::identity(),
            velocity: V::zeros(),
            omega: V::zeros(),
        };
        let ball = &solution.balls[2];
        let races = [still(V::x() * solution.displacement[0]), still(V::zeros())];
        let contacts =
            [0, 1].map(|race| dimensions.ball_race(race, &still(ball.position), &races[race]).unwrap());
        let radial = ball.position - V::x() * ball.position.x;
        let (radius, radial) = (radial.norm(), radial.normalize());
        let tangent = V::x().cross(&radial);
        let normals = contacts.map(|contact| contact.normal);
        // Rolling: no slip at either contact, no spin at the outer one, whose race rests.
        let orbit = solution.cage_speed;
        let rolling =
            tangent.cross(&normals[1]) * (-orbit * (radius + normals[1].dot(&radial) * 0.5 * diameter));
        // About the line through the outer contact, across its normal; at that point the ball rests.
        let spin = tangent.cross(&normals[1]) * (rolling.norm() / (0.5 * diameter)) * -1.0;
        let at_outer = tangent * (orbit * radius) + spin.cross(&(normals[1] * (0.5 * diameter)));
        let spin = spin * (orbit * radius / (orbit * radius - at_outer.dot(&tangent)));
        let at = |race: usize| tangent * (orbit * radius) + spin.cross(&(normals[race] * (0.5 * diameter)));
        assert!(at(1).norm() < 1e-9 && spin.dot(&normals[1]).abs() < 1e-9 * spin.norm());
        assert!(
            (spin - ball.angular_velocity).norm() < 1e-9 * spin.norm(),
            "{spin} {}",
            ball.angular_velocity
        );
        let inner_point = contacts[0].point - V::x() * contacts[0].point.x;
        assert!((at(0).dot(&tangent) / (1500.0 * inner_point.norm()) - 1.0).abs() < 1e-9);
        // Euler: the moment that turns the spin with the orbit, by forces F across the contacts.
        let needed = (V::x() * orbit).cross(&spin) * inertia;
        let loads = contacts.map(|contact| contact.load);
        let limit = friction * (loads[0] + loads[1]);
        let all = needed.norm() / (0.5 * diameter);
        assert!(if slides { all > 5.0 * limit } else { all < 0.1 * limit }, "{all} {limit}");
        let carried = all.min(limit);
        let mut sum = radial * (mass * radius * orbit * orbit);
        for race in 0..2 {
            // A force along n x e_t gives a moment along -e_t.
            let direction = normals[race].cross(&tangent) * -needed.dot(&tangent).signum();
            sum += direction * (carried * loads[race] / (loads[0] + loads[1])) - normals[race] * loads[race];
        }
        let imbalance = (loads[1] - loads[0]) / (loads[0] + loads[1]);
        assert!(imbalance > 0.05 && carried * imbalance > 1e-3 * loads[0], "{imbalance} {carried} {loads:?}");
        assert!(sum.norm() < 1e-3 * carried, "{friction}: {sum}, {carried} N of friction");
    }
}

/// A radial bearing with 12 um of play under a load \[N] at an azimuth \[rad]; ball 1 is at azimuth 0.
fn under_light_load(load: f64, azimuth: f64) -> Equilibrium {
    let geometry = "balls = 9\nball_diameter = \"7.94 mm\"\npitch_diameter = \"39.04 mm\"\ndiametral_clearance = \"12 um\"";
    let (y, z) = (load * azimuth.cos(), load * azimuth.sin());
    let load = format!(
        "x = {{ displacement = 0.0 }}\ny = {{ force = {y:e} }}\nz = {{ force = {z:e} }}\nry = {{ rotation = 0.0 }}\n\
         rz = {{ rotation = 0.0 }}"
    );
    solve(&bearing_text(geometry, &load), Gyroscopic::None)
}

#[test]
fn closed_form_a_race_with_play_does_not_balance_on_one_ball() {
    // On top of one ball it would roll off to either side; the next ball stops it where the play of both is used up.
    let (play, half) = (6e-6, std::f64::consts::PI / 9.0);
    for azimuth in [0.0, half, 2.0 * half] {
        let solution = under_light_load(1e-3, azimuth);
        assert_eq!((solution.unstable, solution.warning()), (None, None), "{azimuth}");
        let stiffness = solution.stiffness.fixed_view::<2, 2>(1, 1).into_owned();
        let least = (0.5 * (stiffness + stiffness.transpose())).symmetric_eigenvalues().min();
        assert!(least > 0.0, "{azimuth}: {stiffness}");
        // Of so light a load rounding of the balls' places leaves more than the tolerance of 1e-11; more than a hundred times of it is
        // no answer.
        assert!(solution.residual < 1e-9, "{azimuth}: {}", solution.residual);
        assert_eq!(solution.balls.iter().filter(|ball| ball.report.inner_load > 0.0).count(), 2, "{azimuth}");
        let [_, y, z, ..] = solution.displacement;
        // A load of 1 mN presses a ball in by some nanometres.
        assert!((y.hypot(z) / (play / half.cos()) - 1.0).abs() < 2e-3, "{azimuth}: {y} {z}");
        let beside = (z.atan2(y) - azimuth).abs();
        let expected = if azimuth == half { 0.0 } else { half };
        assert!((beside - expected).abs() < 2e-3, "{azimuth}: {y} {z}");
    }
    // Between two balls both carry the same.
    for ball in &under_light_load(1e-3, half).balls[..2] {
        assert!(
            (ball.report.inner_load / (0.5e-3 / half.cos()) - 1.0).abs() < 1e-3,
            "{}",
            ball.report.inner_load
        );
    }
    // 1 kN on a ball presses it in until its neighbours help.
    let heavy = under_light_load(1e3, 0.0);
    assert!(heavy.unstable.is_none() && heavy.displacement[2].abs() < 1e-15, "{:?}", heavy.displacement);
}

#[test]
fn an_unstable_balance_is_said_to_be_one() {
    let mut solution = under_light_load(1e3, 0.0);
    assert!(solution.to_json()["unstable"].is_null() && !solution.to_string().contains("unstable"));
    solution.unstable = Some(-0.05);
    assert_eq!(solution.to_json()["unstable"], -0.05);
    for text in [solution.to_string(), solution.warning().unwrap()] {
        assert!(text.contains("this equilibrium is unstable") && text.contains("-5.00e-2 N/m"), "{text}");
    }
}
