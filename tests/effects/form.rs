//! Form of races and balls against independent data (tests/data/effects/README.md), closed forms and invariants.

use std::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};
use roulement::contact::BallMotion;
use roulement::contact::many::ContactGroup;
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic, Prescribed};
use roulement::model::bodies::Race;
use roulement::model::state::BallState;
use roulement::model::{Conditions, Model};
use roulement::scene::Scene;
use roulement::simulation::Simulation;

use crate::kernel::assert_derivatives_are_differences;

const CASES: &str = include_str!("../data/effects/waviness.json");

/// A bearing of the reference data: 7206 by its contact angle, 6206 by its clearance.
fn bearing(case: &serde_json::Value) -> String {
    let g = &case["geometry"];
    let number = |key: &str| g[key].as_f64().unwrap();
    let play = match g["Pd"].as_f64() {
        Some(clearance) => format!("diametral_clearance = {clearance:e}"),
        None => format!("contact_angle = {}", number("alpha0")),
    };
    format!(
        "[bearing]\nballs = {}\nball_diameter = {}\npitch_diameter = {}\ninner_conformity = {}\nouter_conformity = {}\n{play}\n\
         [inner]\nshoulder_angle = [1.5, 1.5]\n[outer]\nshoulder_angle = [1.5, 1.5]\n\
         [effects]\ncreep = \"frictionless\"\n[load]\n",
        g["Z"],
        number("D"),
        number("dm"),
        number("fi"),
        number("fo"),
    )
}

fn waves(list: &serde_json::Value) -> String {
    let wave = |wave: &serde_json::Value| {
        format!("{{ order = {}, amplitude = {:e}, phase = {} }}", wave[0], wave[1].as_f64().unwrap(), wave[2])
    };
    format!("[{}]", list.as_array().unwrap().iter().map(wave).collect::<Vec<_>>().join(", "))
}

/// Rows of a table as numbers, with its columns' names.
fn table(text: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',').collect();
    (names, lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect())
}

#[test]
fn independent_data_forces_of_wavy_races_at_360_places_of_a_turn() {
    let cases: serde_json::Value = serde_json::from_str(CASES).unwrap();
    for (name, rows) in [
        ("W1", include_str!("../data/effects/waviness_W1.csv")),
        ("W3", include_str!("../data/effects/waviness_W3.csv")),
    ] {
        let case = &cases[name];
        let balls = case["geometry"]["Z"].as_u64().unwrap() as usize;
        let mut sizes = vec!["0".to_string(); balls];
        sizes[0] = format!("{:e}", case["first_ball_excess_m"].as_f64().unwrap());
        let form = format!(
            "[form]\ninner = {}\nouter = {}\nballs = [{}]\n",
            waves(&case["inner"]),
            waves(&case["outer"]),
            sizes.join(", ")
        );
        let scene = Scene::parse(&format!("{}{form}", bearing(case))).unwrap();
        let mut model = Model::new(&scene).unwrap();
        let place: Vec<f64> =
            case["displacement_m"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        let mut input = EquilibriumInput::from_scene(&scene, Gyroscopic::None);
        input.conditions = [place[0], place[1], place[2], 0.0, 0.0].map(Prescribed::Motion);
        let (names, rows) = table(rows);
        let column = |name: &str| names.iter().position(|n| *n == name).unwrap();
        let loads = ["Fx_N", "Fy_N", "Fz_N"].map(column);
        let moments = ["My_Nm", "Mz_Nm"].map(column);
        let size = rows.iter().map(|row| loads.map(|i| row[i]).iter().map(|f| f * f).sum::<f64>().sqrt());
        let size = size.fold(0.0, f64::max);
        let (mut moment, mut load) = (0.0f64, 0.0f64);
        let mut forces: Vec<[f64; 2]> = vec![];
        let lever = model.bearing.inner.groove_offset;
        for row in &rows {
            model.bearing.first_ball_azimuth = row[column("cage_angle_rad")];
            input.turned.inner = row[column("inner_turn_rad")];
            let ours = equilibrium::solve(&model, &input).unwrap();
            // The data are of the force of the balls on the race, ours of the load that holds it.
            forces.extend(loads.into_iter().enumerate().map(|(i, k)| [ours.load[i], -row[k]]));
            for (i, k) in moments.into_iter().enumerate() {
                // Theirs is about the centre of the inner race's groove circle.
                let own = ours.load[3 + i] + [1.0, -1.0][i] * lever * ours.load[2 - i];
                moment = moment.max((own + row[k]).abs() / (0.023 * size));
            }
            let first = &ours.balls[0].report;
            load = load.max((first.inner_load - row[column("Q_inner_ball1_N")]).abs() / size);
            load = load.max((first.outer_load - row[column("Q_outer_ball1_N")]).abs() / size);
        }
        // The last digits of the data's Hertz table, alike for all contacts of a case: exact elliptic integrals give the first ball
        // of W3 807.7716 N at the first place, as ours, and not 807.7842.
        let products = forces.iter().fold([0.0; 2], |sum, [a, b]| [sum[0] + a * b, sum[1] + b * b]);
        let table = products[0] / products[1];
        let worst =
            |factor: f64| forces.iter().map(|[a, b]| (a - factor * b).abs() / size).fold(0.0, f64::max);
        let [force, rest] = [worst(1.0), worst(table)];
        println!(
            "{name}: force {force:.1e}, {rest:.1e} beside a factor of 1 {:+.1e}; moment {moment:.1e}, ball 1 {load:.1e}",
            table - 1.0
        );
        assert!(rows.len() == 360 && rest < 3e-6 && moment < 1e-5 && load < 1e-5, "{name}");
        assert!((table - 1.0).abs() < 1.5e-5, "{name}: {table}");
    }
}

/// Amplitude of a wave of an order in numbers at equal distances of a turn.
fn amplitude(values: &[f64], order: usize) -> f64 {
    let (mut cos, mut sin) = (0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        let angle = TAU * (order * i) as f64 / values.len() as f64;
        cos += value * angle.cos();
        sin += value * angle.sin();
    }
    2.0 * cos.hypot(sin) / values.len() as f64
}

#[test]
fn independent_data_orders_of_a_slow_run() {
    let cases: serde_json::Value = serde_json::from_str(CASES).unwrap();
    let case = &cases["W1"];
    let balls = 13;
    let linear = &cases["linear"];
    let expected = ["radial_N", "axial_N"].map(|key| 0.1 * linear[key].as_f64().unwrap());
    let run = |race: &str, order: u32| {
        // Speed alone holds the balls on their orbit, and must not bring their own frequencies near; what swings at the start is
        // damped by the scheme before the first wave is looked at.
        let speed = if race == "inner" { 1200 } else { 2400 };
        let text = bearing(case).replace(
            "[load]\n",
            &format!(
                "[solver]\nalpha_f = 0.3\nmax_step = 1e-4\n\
                 [load]\ninner_speed = \"{speed} rpm\"\nx = {{ force = 500 }}\n"
            ),
        );
        let text = format!("{text}[form]\n{race} = [{{ order = {order}, amplitude = 2e-9 }}]\n");
        let scene = Scene::parse(&text).unwrap();
        let mut simulation = Simulation::new(&scene).unwrap();
        // Of the balls along the race.
        let cage = simulation.outputs().cage_speed;
        let along = if race == "inner" { scene.load.inner_speed.at(0.0) - cage } else { cage };
        let count = 16 * balls;
        simulation.advance(TAU / (f64::from(balls) * along)).unwrap();
        let begin = simulation.time();
        let mut forces = [vec![], vec![]];
        for i in 0..count {
            let angle = TAU * f64::from(i) / f64::from(count);
            if i > 0 {
                simulation.advance(begin + angle / along).unwrap();
            }
            let outputs = simulation.outputs();
            let mut force = outputs.inner.wrench.force;
            // In axes that turn with the race whose waves these are.
            if race == "inner" {
                let turn = UnitQuaternion::new(Vector3::x() * -outputs.inner.turned);
                force = turn * force;
            }
            forces[0].push(force.y);
            forces[1].push(force.x);
        }
        forces
    };
    for race in ["outer", "inner"] {
        for order in [11, 12, 13, 14] {
            let [y, x] = run(race, order);
            let radial = amplitude(&y, balls as usize) / expected[0];
            let axial = amplitude(&x, balls as usize) / expected[1];
            println!("{race} {order}: radial {radial:.5}, axial {axial:.5} of the closed form");
            let [wanted_y, wanted_x] = match order {
                13 => [0.0, 1.0],
                12 | 14 => [1.0, 0.0],
                _ => [0.0, 0.0],
            };
            for (ours, wanted) in [(radial, wanted_y), (axial, wanted_x)] {
                assert!((ours - wanted).abs() < if wanted > 0.0 { 0.01 } else { 1e-3 }, "{race} {order}");
            }
        }
    }
}

/// The thrust case with a form.
fn thrust(form: &str, changes: &[(&str, &str)]) -> Scene {
    let scene = Scene::edited(include_str!("../../scenes/thrust.toml"), changes.iter().copied()).unwrap();
    Scene::parse(&format!("{}\n[form]\n{form}\n", scene.source)).unwrap()
}

const WAVES: &str = "outer = [{ order = 9, amplitude = \"0.3 um\" }, { order = 10, amplitude = \"0.3 um\", phase = 1 }, \
                     { order = 11, amplitude = \"0.3 um\", phase = 2, direction = \"axial\" }]";
const SIZES: &str = "balls = [1e-6, 0, -1e-6, 0, 5e-7, 0, 0, 2e-6, 0, 0]";

#[test]
fn invariant_energy_of_a_wavy_race_is_that_of_the_work() {
    for waves in [WAVES.to_string(), WAVES.replace("outer", "inner")] {
        let scene = thrust(&waves, &[("load.duration", "\"20 ms\"")]);
        let mut simulation = Simulation::new(&scene).unwrap();
        let before = simulation.outputs().stored_energy;
        simulation.advance(20e-3).unwrap();
        let after = simulation.outputs();
        let imbalance = (after.stored_energy - before + after.dissipated - after.work) / after.work;
        println!("imbalance {imbalance:.1e} of {:.3} J in {} steps", after.work, after.statistics.steps);
        assert!(imbalance.abs() < 1e-5 && after.work > 0.1);
    }
}

#[test]
fn invariant_a_run_starts_in_balance_on_wavy_races_under_balls_of_all_sizes() {
    // So slow that the gyroscopic moments, which friction carries in the equilibrium its own way, are none.
    let slow = [("load.inner_speed", "\"10 rpm\""), ("effects.creep", "\"frictionless\"")];
    let simulation = Simulation::new(&thrust(&format!("{SIZES}\n{WAVES}"), &slow)).unwrap();
    let outputs = simulation.outputs();
    let force = outputs.inner.wrench.force;
    assert!((force.x + 1500.0).abs() < 1e-3, "{force}");
    // Loads of the balls are far from alike.
    let loads = || outputs.balls.iter().map(|ball| ball.inner.load);
    assert!(loads().fold(0.0, f64::max) > 1.05 * loads().fold(f64::INFINITY, f64::min));
}

#[test]
fn invariant_lanes_are_single_balls_to_the_bit_and_derivatives_are_differences() {
    let scene = thrust(&format!("{SIZES}\n{WAVES}\n{}", WAVES.replace("outer", "inner")), &[]);
    let simulation = Simulation::new(&scene).unwrap();
    for race in Race::BOTH {
        let contact = simulation.model().contact(race, &Conditions::of_friction(0.08));
        let seen = simulation.state().race(race).motion();
        let motions: Vec<_> = simulation.state().balls.iter().map(BallState::motion).collect();
        for first in [0, 4, 8] {
            let some = &motions[first..(first + 4).min(motions.len())];
            let alone: Vec<_> = (0..some.len())
                .map(|lane| contact.of_ball(first + lane, None).evaluated(&some[lane], &seen))
                .collect();
            let mut together = ContactGroup::filled(&alone[0]);
            together.evaluate(&contact.of_ball(first, None), &seen, &BallMotion::of_balls(some));
            for (lane, alone) in alone.iter().enumerate() {
                assert!(alone.load > 10.0);
                assert_eq!(together.contact(lane), *alone);
            }
        }
        assert_derivatives_are_differences(&contact.of_ball(7, None), &motions[7], &seen, 1e-9, [1e-5, 1e-4]);
    }
}

#[test]
fn invariant_waves_turn_with_their_race() {
    // A race that is turned by one of its waves is as it was; turned by half a wave it has troughs where its crests were.
    let scene = thrust("outer = [{ order = 10, amplitude = 1e-6 }]\n", &[]);
    let model = Model::new(&scene).unwrap();
    let at = |turn: f64| {
        let mut input = EquilibriumInput::from_scene(&scene, Gyroscopic::None);
        input.turned.outer = turn;
        equilibrium::solve(&model, &input).unwrap().displacement[0]
    };
    let [here, wave, half] = [0.0, TAU / 10.0, TAU / 20.0].map(at);
    assert!((here - wave).abs() < 1e-12, "{here} {wave}");
    // All ten balls stand on crests of the outer race, which are away from the axis, or all in troughs.
    assert!(here - half > 2e-6, "{here} {half}");
}

#[test]
fn waves_that_no_contact_can_follow_and_wrong_numbers_are_refused() {
    let thrust = include_str!("../../scenes/thrust.toml");
    let refusal = |form: &str| match Scene::parse(&format!("{thrust}\n[form]\n{form}\n")) {
        Err(why) => why.to_string(),
        Ok(scene) => Simulation::new(&scene).unwrap_err().to_string(),
    };
    for (form, parts) in [
        (
            "outer = [{ order = 500, amplitude = 1e-9 }]",
            &["form.outer", "order 500", "allowed are orders to"][..],
        ),
        ("outer = [{ order = 0, amplitude = 1e-9 }]", &["form.outer[0].order = 0", "[1, 10000]"]),
        ("inner = [{ order = 3, amplitude = 1 }]", &["form.inner[0].amplitude = 1 m", "[-0.001, 0.001] m"]),
        ("inner = [{ order = 3, amplitude = nan }]", &["form.inner[0].amplitude = NaN"]),
        ("inner = [{ order = 3, amplitude = \"1 s\" }]", &["s measures something else", "line"]),
        ("inner = [{ order = 3, amplitude = 1e-6, phase = 9 }]", &["form.inner[0].phase = 9", "[-7, 7] rad"]),
        ("inner = [{ ordre = 3, amplitude = 1e-6 }]", &["form.inner", "order"]),
        ("inner = { profile = [0, 1e-6] }", &["form.inner.profile: number of points = 2", "[8, 20000]"]),
        ("inner = { profile = \"no-such-file.csv\" }", &["no-such-file.csv"]),
        ("inner = 3", &["a shape is a list of waves"]),
        ("balls = [1e-6]", &["form.balls", "1 deviations", "10 balls"]),
        ("balls = [0, 0, 0, 0, 1e-3, 0, 0, 0, 0, 0]", &["form.balls = 0.001", "[-0.00009525"]),
        ("inners = []", &["form.inners is no known key: did you mean inner?"]),
    ] {
        let message = refusal(form);
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
}

#[test]
fn a_measured_profile_is_its_waves_and_its_file_goes_into_the_scene() {
    let points = 360;
    let rows = |columns: usize| {
        let row = |i: i32| {
            let angle = TAU * f64::from(i) / f64::from(points);
            let radial = 2e-6 * (3.0 * angle - 0.5).cos() + 1e-7 * (20.0 * angle).sin();
            let axial =
                if columns == 3 { format!(",{:e}", 4e-7 * (5.0 * angle).cos()) } else { String::new() };
            format!("{angle},{radial:e}{axial}")
        };
        (0..points).map(row).collect::<Vec<_>>().join("\n")
    };
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("form");
    std::fs::create_dir_all(&folder).unwrap();
    let thrust = include_str!("../../scenes/thrust.toml");
    let load = |table: &str| {
        std::fs::write(folder.join("race.csv"), table).unwrap();
        let text = format!("{thrust}\n[form]\nouter = {{ profile = \"race.csv\" }}\n");
        std::fs::write(folder.join("scene.toml"), text).unwrap();
        Scene::load(&folder.join("scene.toml"))
    };
    let scene = load(&format!("azimuth_rad,radial_m,axial_m\n{}\n", rows(3))).unwrap();
    // What a package carries needs no file.
    let again = Scene::parse(&scene.source).unwrap();
    assert!(!scene.source.contains("race.csv"));
    let waves = "[{ order = 3, amplitude = 2e-6, phase = 0.5 }, \
                 { order = 20, amplitude = 1e-7, phase = 1.5707963267948966 }, \
                 { order = 5, amplitude = 4e-7, direction = \"axial\" }]";
    let waves = Scene::parse(&format!("{thrust}\n[form]\nouter = {waves}\n")).unwrap();
    let loads = |scene: &Scene| -> Vec<f64> {
        Simulation::new(scene).unwrap().outputs().balls.iter().map(|ball| ball.outer.load).collect()
    };
    let [profile, copied, waves] = [&scene, &again, &waves].map(loads);
    assert_eq!(profile, copied);
    for (a, b) in profile.iter().zip(&waves) {
        assert!((a - b).abs() < 1e-4 * b, "{a} {b}");
    }
    for (table, why) in [
        ("angle,height\n0,0\n".to_string(), "azimuth_rad,radial_m"),
        (format!("azimuth_rad,radial_m\n{}\n7,0\n", rows(2)), "row 2 is at"),
        (format!("azimuth_rad,radial_m\n{}", rows(3)), "row 1 has 3 numbers, not 2"),
        (format!("azimuth_rad,radial_m\n{},x", rows(2)), "x is no number"),
    ] {
        let message = load(&table).unwrap_err().to_string();
        assert!(message.contains("form.outer.profile") && message.contains(why), "{message}");
    }
}

#[test]
fn closed_form_a_turned_race_has_its_waves_and_spalls_turned() {
    let [waves, spall] = ["waviness", "spall"].map(|name| {
        std::fs::read_to_string(format!("{}/scenes/effects/{name}.toml", roulement_tests::ROOT)).unwrap()
    });
    let forces = |text: &str, changes: &[(&str, &str)]| {
        let scene = Scene::edited(text, changes.iter().copied()).unwrap();
        let mut simulation = Simulation::new(&scene).unwrap();
        let mut seen = vec![simulation.outputs().inner.wrench];
        // Bodies move, and turn, for the first rows.
        for row in 1..=4 {
            simulation.advance_scripted(50e-6 * f64::from(row)).unwrap();
            seen.push(simulation.outputs().inner.wrench);
        }
        seen
    };
    // cos(n (th - t) - p): every wave has its phase later by n t.
    let turned = forces(&waves, &[("inner.turn", "0.3"), ("outer.turn", "-0.2")]);
    let inner = "[{ order = 12, amplitude = \"0.1 um\", phase = 3.6 }, { order = 26, amplitude = \"0.05 um\", direction = \"axial\", phase = 1.5168146928204138 }]";
    let outer = "[{ order = 2, amplitude = \"2 um\", phase = -0.4 }, { order = 13, amplitude = \"0.1 um\", phase = -2.6 }, \
                 { order = 14, amplitude = \"0.1 um\", phase = -1.2292036732051034 }]";
    let phased = forces(&waves, &[("form.inner", inner), ("form.outer", outer)]);
    let plain = forces(&waves, &[]);
    for ((turned, phased), plain) in turned.iter().zip(&phased).zip(&plain) {
        // Splines between 64 points to a wave are right within 3e-7 of it, of forces of up to 20 N.
        assert!((turned.force - phased.force).norm() < 1e-4, "{turned:?} {phased:?}");
        assert!((turned.moment - phased.moment).norm() < 1e-5, "{turned:?} {phased:?}");
        assert!((turned.force - plain.force).norm() > 0.1 || (turned.moment - plain.moment).norm() > 1e-2);
    }
    // A spall is where its azimuth and the turn together put it: the same bits.
    let placed = forces(
        &spall,
        &[("defect", "[{ on = \"outer\", azimuth = 0.5, length = 1e-3, width = 3e-3, depth = 1e-4 }]")],
    );
    let changes = [
        ("defect", "[{ on = \"outer\", azimuth = 0.25, length = 1e-3, width = 3e-3, depth = 1e-4 }]"),
        ("outer.turn", "0.25"),
    ];
    assert_eq!(forces(&spall, &changes), placed);
    // It is a parameter of packages.
    let scene = Scene::edited(&spall, changes).unwrap();
    let rows = roulement::interface::variables::Variables::new(&scene);
    assert!(rows.rows().iter().any(|row| row.name == "outer.turn"));
    // Nothing is turned in silence that is not there, nor too far.
    for (key, value, parts) in [
        ("inner.turn", "0.1", ["inner.turn", "[[defect]]"]),
        ("outer.turn", "8", ["outer.turn = 8", "[-7, 7] rad"]),
        ("outer.turn", "\"1 mm\"", ["outer.turn", "mm"]),
    ] {
        let message = Scene::edited(&spall, [(key, value)]).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{message}\nshould have {part}");
        }
    }
}

#[test]
fn closed_form_a_bearing_of_a_shaft_has_its_spall_turned() {
    let pinion = include_str!("../../scenes/shafts/pinion.toml");
    let forces = |keys: &str| {
        let text =
            pinion.replacen("catalogue = \"7206 B\"\n", &format!("catalogue = \"7206 B\"\n{keys}\n"), 1);
        let system = roulement::simulation::system::System::new(
            &roulement::scene::system::SystemScene::parse(&text, None, std::path::Path::new("")).unwrap(),
        )
        .unwrap();
        system.bearings().map(|(_, bearing)| bearing.outputs().inner.wrench).collect::<Vec<_>>()
    };
    let spall = |azimuth: f64, turn: &str| {
        format!(
            "set = {{ defect = [{{ on = \"inner\", azimuth = {azimuth}, length = 1e-3, width = 3e-3, depth = 1e-4 }}]{turn} }}"
        )
    };
    let placed = forces(&spall(0.5, ""));
    assert_eq!(forces(&spall(0.25, ", inner = { turn = 0.25 }")), placed);
    assert!((forces(&spall(0.25, ""))[0].force - placed[0].force).norm() > 0.1);
}
