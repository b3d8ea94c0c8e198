//! Loads over time as data: building blocks in scenes, measured files, unbalance and gears, and what is refused.

use std::f64::consts::{PI, TAU};
use std::path::PathBuf;

use nalgebra::Vector3;
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::loads::{Mesh, Ripple, unbalance};
use roulement::scene::{Condition, Scene, Schedule, Sine};
use roulement::{Model, Simulation};

use crate::scenes::{self, HELD, scene};

type V = Vector3<f64>;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const SPEED: f64 = 200.0 * PI;

fn force_y(value: &str) -> Schedule {
    match &scene(THRUST, &[("load.y.force", value)]).load.conditions()[1] {
        Condition::Load(schedule) => schedule.clone(),
        Condition::Motion(_) => panic!("a load was written"),
    }
}

#[test]
fn closed_form_building_blocks_are_what_they_say() {
    assert_eq!(
        force_y("{ ramp = [\"0 N\", \"2 kN\"], from = \"1 ms\", to = \"5 ms\" }"),
        Schedule::Table(vec![(1e-3, 0.0), (5e-3, 2000.0)])
    );
    assert_eq!(force_y("{ ramp = [1, 2], to = 1 }"), Schedule::Table(vec![(0.0, 1.0), (1.0, 2.0)]));
    assert_eq!(
        force_y("{ step = [0, \"2 kN\"], at = 0.25, rise = 0.5 }"),
        Schedule::Table(vec![(0.25, 0.0), (0.75, 2000.0)])
    );
    // Without a rise, 10 us.
    assert_eq!(force_y("{ step = [0, 1], at = 0 }"), Schedule::Table(vec![(0.0, 0.0), (1e-5, 1.0)]));
    let sine = "{ mean = \"1 kN\", amplitude = \"100 N\", frequency = \"2.3 kHz\", phase = \"90 deg\", begin = \"1 ms\" }";
    assert_eq!(
        force_y(sine),
        Schedule::Sine(Sine {
            mean: 1000.0,
            amplitude: 100.0,
            frequency: 2300.0,
            phase: 0.5 * PI,
            begin: Some(1e-3)
        })
    );
    let plain = Sine { mean: 0.0, amplitude: 5.0, frequency: 100.0, phase: 0.0, begin: None };
    let Schedule::Sine(of_rpm) = force_y("{ amplitude = 5, frequency = \"6000 rpm\" }") else { panic!() };
    assert_eq!(Sine { frequency: 100.0, ..of_rpm }, plain);
    assert!((of_rpm.frequency / 100.0 - 1.0).abs() < 1e-15);
    assert_eq!(
        force_y("{ table = [[0, 0.5], [\"1 ms\", 0.75]], unit = \"kN\", scale = 2, offset = \"10 N\" }"),
        Schedule::Table(vec![(0.0, 1010.0), (1e-3, 1510.0)])
    );
    // Sums: constants come together, sums in sums are one.
    assert_eq!(
        force_y("{ sum = [1, { sum = [\"2 N\", { amplitude = 5, frequency = 100 }] }, [[0, 0], [1, 1]]] }"),
        Schedule::Sum(vec![
            Schedule::Constant(1.0),
            Schedule::Constant(2.0),
            Schedule::Sine(plain),
            Schedule::Table(vec![(0.0, 0.0), (1.0, 1.0)])
        ])
    );
    assert_eq!(force_y("{ sum = [1, \"2 N\"] }"), Schedule::Constant(3.0));
}

/// Blocks of every kind of schedule: friction, lubrication, temperatures, tilts, speeds, gravity, the frame.
#[test]
fn invariant_blocks_stand_wherever_a_value_over_time_stands() {
    let sine = |amplitude: &str| {
        format!(
            "{{ amplitude = {amplitude}, frequency = \"50 Hz\", phase = \"-90 deg\", mean = {amplitude} }}"
        )
    };
    let settings = [
        ("friction.ball_race", sine("0.02")),
        ("film", format!("{{ iso_vg = 68, temperature = 70, lubrication = {} }}", sine("0.4"))),
        ("growth", format!("{{ inner = {}, outer = 5 }}", sine("\"2 K\""))),
        ("outer.misalignment.ry", sine("\"1 mrad\"")),
        ("load.inner_speed", sine("\"3000 rpm\"")),
        ("effects.gravity", format!("[0, 0, {}]", sine("-5.0"))),
        ("effects.frame", format!("{{ angular_velocity = [{}, 0, 0] }}", sine("\"100 rpm\""))),
    ];
    let changes: Vec<(&str, &str)> = settings.iter().map(|(key, value)| (*key, value.as_str())).collect();
    let scene = scene(THRUST, &changes);
    // Twice the mean after half a period, nothing at the start.
    let half = 0.01;
    assert!(scene.friction.ball_race.at(0.0).abs() < 1e-15);
    assert!((scene.friction.ball_race.at(half) - 0.04).abs() < 1e-15);
    assert!((scene.effects.film.lubrication(half) - 0.8).abs() < 1e-14);
    assert!((scene.outer.misalignment.ry.at(half) - 2e-3).abs() < 1e-16);
    assert!((scene.load.inner_speed.at(half) - SPEED).abs() < 1e-10);
    assert!((scene.frame_at(half).gravity.z + 10.0).abs() < 1e-12);
    assert!((scene.frame_at(half).angular_velocity.x - 200.0 * PI / 30.0).abs() < 1e-12);
    // The rate of the frame's speed, a quarter of a period on, is that of the sine.
    let steepest = 100.0 * PI / 30.0 * 100.0 * PI;
    assert!((scene.frame_at(0.005).angular_acceleration.x / steepest - 1.0).abs() < 1e-12);
}

#[test]
fn errors_name_key_value_and_allowed_range() {
    let cases: &[(&str, &str, &[&str])] = &[
        ("load.y.force", "{ ramp = [0, 1], from = 2, to = 1 }", &["to = 1 s", "(2, 1000000] s"]),
        ("load.y.force", "{ ramp = [0, 1] }", &["a ramp needs to"]),
        ("load.y.force", "{ ramp = [0, 1, 2], to = 1 }", &["ramp is a list of two values"]),
        (
            "load.y.force",
            "{ ramp = [0, \"1 mm\"], to = 1 }",
            &["ramp: ", "1 mm", "mm measures something else"],
        ),
        ("load.y.force", "{ ramp = [0, 1], until = 1 }", &["until is no key of a ramp", "ramp, from, to"]),
        ("load.y.force", "{ ramp = [0, 1], to = nan }", &["to = NaN s", "[-1000000, 1000000] s"]),
        ("load.y.force", "{ step = [0, 1], at = 0, rise = 0 }", &["rise = 0 s", "(0, 1000000] s"]),
        ("load.y.force", "{ step = [0, 1] }", &["a step needs at"]),
        (
            "load.y.force",
            "{ amplitude = 1, frequency = -1 }",
            &["frequency = -1 Hz", "[0.000001, 1000000] Hz"],
        ),
        ("load.y.force", "{ amplitude = 1 }", &["a sine needs frequency"]),
        ("load.y.force", "{ frequency = 1 }", &["a sine needs amplitude"]),
        ("load.y.force", "{ amplitude = 1, frequency = \"50 rad/s\" }", &["50 rad/s", "write Hz or rpm"]),
        ("load.y.force", "{ amplitude = 1, frequency = 1, phase = 8 }", &["phase = 8 rad", "[-7, 7] rad"]),
        (
            "load.y.force",
            "{ amplitude = 2e9, frequency = 1 }",
            &["load.y.force = -2000000000 N", "[-1000000000"],
        ),
        ("load.y.force", "{ amplitude = nan, frequency = 1 }", &["load.y.force = NaN N"]),
        ("load.y.force", "{ sum = [] }", &["the sum is empty"]),
        ("load.y.force", "{ sum = [1, { step = [0, 1] }] }", &["sum[1]: a step needs at"]),
        (
            "load.y.force",
            "{ sum = [1e9, { amplitude = 1, frequency = 1 }] }",
            &["load.y.force = 1000000001 N"],
        ),
        (
            "load.y.force",
            "{ table = [[0, \"1 N\"]], unit = \"kN\" }",
            &["values of a table with a unit are numbers"],
        ),
        (
            "load.y.force",
            "{ table = [[0, 1]], unit = \"mm\" }",
            &["unit = \"mm\"", "a force", "something else"],
        ),
        (
            "load.y.force",
            "{ wobble = 1 }",
            &["a number, a list [[time, value], ...]", "ramp, step, amplitude"],
        ),
        (
            "friction.ball_race",
            "{ mean = 0.1, amplitude = 0.2, frequency = 1 }",
            &["friction.ball_race = -0.1", "[0, 2]"],
        ),
        (
            "load.rotating",
            "[{ unbalance = 1e-5, force = 1 }]",
            &["load.rotating[0]", "exactly one of unbalance and force"],
        ),
        ("load.rotating", "[{ unbalance = -1 }]", &["load.rotating[0].unbalance = -1 kg m", "[0, "]),
        ("load.rotating", "[{ force = \"1 mm\" }]", &["load.rotating", "1 mm"]),
        (
            "load.rotating",
            "[{ force = 1, offset = \"20 m\" }]",
            &["load.rotating[0].offset = 20 m", "[-10, 10] m"],
        ),
        ("load.gear", "[{ torque = 1, pitch_radius = 0.02 }]", &["pressure_angle", "missing"]),
        (
            "load.gear",
            "[{ torque = 1, pitch_radius = 0, pressure_angle = 0.3 }]",
            &["load.gear[0].pitch_radius = 0 m"],
        ),
        (
            "load.gear",
            "[{ torque = 1, pitch_radius = 0.02, pressure_angle = 0.3, helix_angle = \"80 deg\" }]",
            &["load.gear[0].helix_angle = 1.396", "[-1.2, 1.2] rad"],
        ),
        (
            "load.gear",
            "[{ torque = 1, pitch_radius = 0.02, pressure_angle = 0.3, ripple = 0.1 }]",
            &["load.gear[0].ripple", "needs teeth"],
        ),
        (
            "load.gear",
            "[{ torque = 1, pitch_radius = 0.02, pressure_angle = 0.3, ripple = 1.5, teeth = 20 }]",
            &["load.gear[0].ripple = 1.5", "[0, 1]"],
        ),
    ];
    for (key, value, parts) in cases {
        let message = Scene::edited(THRUST, [(*key, *value)]).unwrap_err().to_string();
        for part in parts.iter().chain([key]) {
            assert!(message.contains(part), "{value}: {message}\nshould name {part}");
        }
    }
    // Lines of a text as it is written, in lists of sections too.
    let text = format!("{THRUST}\n[[load.rotating]]\nforce = 1\n[[load.rotating]]\nforce = 2\nphase = 8\n");
    let line = text.lines().position(|line| line == "phase = 8").unwrap() + 1;
    let message = Scene::parse(&text).unwrap_err().to_string();
    assert!(message.contains(&format!("line {line}: load.rotating[1].phase = 8 rad")), "{message}");
    let message = Scene::parse(&text.replace("phase", "phas")).unwrap_err().to_string();
    let parts = [format!("line {line}"), "load.rotating[1].phas is no known key: did you mean phase?".into()];
    assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    // Only a race that a wrench moves takes loads of the machine.
    for (key, entry) in [
        ("load.rotating", "[{ force = 1 }]"),
        ("load.gear", "[{ torque = 1, pitch_radius = 0.02, pressure_angle = 0.3 }]"),
    ] {
        let changes = [("inner.drive", "\"pose\""), ("inner.mass", ""), ("inner.inertia", ""), (key, entry)];
        let message = Scene::edited(THRUST, changes).unwrap_err().to_string();
        assert!(message.contains(key) && message.contains("inner.drive = \"wrench\""), "{message}");
    }
    // A motion has no jump in speed.
    let moved = |phase: &str| {
        let sine = format!("{{ displacement = {{ amplitude = 1e-6, frequency = 50, phase = {phase} }} }}");
        Scene::edited(THRUST, [("load.y", sine)]).map_err(|why| why.to_string())
    };
    let message = moved("0").unwrap_err();
    assert!(message.contains("load.y.displacement") && message.contains("-90 deg"), "{message}");
    assert!(moved("\"90 deg\"").is_ok() && moved("\"-90 deg\"").is_ok());
}

/// A folder of its own for a test, with files in it.
fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let path = std::env::temp_dir().join(format!("roulement-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&path).unwrap();
    for (name, text) in files {
        std::fs::write(path.join(name), text).unwrap();
    }
    path
}

fn with_force(value: &str) -> String {
    Scene::edited_text(THRUST, [("load.y.force", value)]).unwrap()
}

#[test]
fn round_trip_a_measured_file_becomes_a_table_of_the_text() {
    let measured = "# a comment\nt [ms], speed [rpm], Fy [kN]\n0, 10, 0.5\n\n0.1, 11, 0.75\n1.7, 12, -0.1\n";
    let block =
        "{ file = \"measured.csv\", time = \"t [ms]\", value = \"Fy [kN]\", scale = 2, offset = \"10 N\" }";
    let inside = format!("{{ sum = [\"1 N\", {block}] }}");
    let path = folder(
        "measured",
        &[("measured.csv", measured), ("scene.toml", &with_force(block)), ("sum.toml", &with_force(&inside))],
    );
    let expected = Schedule::Table(vec![(0.0, 1010.0), (1e-4, 1510.0), (1.7e-3, -190.0)]);
    let read = Scene::load(&path.join("scene.toml")).unwrap();
    assert_eq!(read.load.conditions()[1], Condition::Load(expected.clone()));
    let sum = Scene::load(&path.join("sum.toml")).unwrap();
    assert_eq!(
        sum.load.conditions()[1],
        Condition::Load(Schedule::Sum(vec![Schedule::Constant(1.0), expected]))
    );
    // The text goes without the file, to the same bits.
    std::fs::remove_dir_all(&path).unwrap();
    for scene in [read, sum] {
        assert!(!scene.source.contains("file =") && scene.source.contains("measured.csv"));
        let again = Scene::parse(&scene.source).unwrap();
        assert_eq!(format!("{again:?}"), format!("{scene:?}"));
    }
}

#[test]
fn errors_of_measured_files_name_key_file_and_line() {
    let block = |time: &str, value: &str| {
        with_force(&format!("{{ file = \"m.csv\", time = \"{time}\", value = \"{value}\" }}"))
    };
    let plain = block("t [ms]", "Fy [N]");
    let cases: [(&str, &str, &[&str]); 12] = [
        (
            "t [ms],Fy [N]\n0,1\n2,1\n2,3\n",
            &plain,
            &["line 4", "t [ms] = 2 comes after 2", "times must grow"],
        ),
        ("t [ms],Fy [N]\n0,1\n2,x\n", &plain, &["line 3", "Fy [N] = \"x\" is no number"]),
        ("t [ms],Fy [N]\n0,inf\n", &plain, &["line 2", "Fy [N] = \"inf\" is no number"]),
        ("t [ms],Fy [N]\n0,1\n2\n", &plain, &["line 3", "1 cells, not 2"]),
        ("t [ms],Fz [N]\n0,1\n", &plain, &["line 1", "no column \"Fy [N]\"", "it has t [ms], Fz [N]"]),
        ("t [ms],Fy [N]\n", &plain, &["line 1", "no row after the header"]),
        ("", &plain, &["line 1", "no header"]),
        ("t,Fy [N]\n0,1\n", &block("t", "Fy [N]"), &["line 1", "column \"t\" has no unit", "t [ms]"]),
        ("t [mm],Fy [N]\n0,1\n", &block("t [mm]", "Fy [N]"), &["line 1", "mm measures something else"]),
        ("t [ms],Fy [mm]\n0,1\n", &block("t [ms]", "Fy [mm]"), &["unit = \"mm\"", "a force", "Fy [mm]"]),
        ("t [ms],Fy\n0,1\n", &block("t [ms]", "Fy"), &["unit = \"1\"", "a force", "Fy"]),
        ("", &with_force("{ file = \"m.csv\", time = \"t [ms]\" }"), &["a file needs value", "Fy [N]"]),
    ];
    for (measured, text, parts) in cases {
        let path = folder("measured-errors", &[("m.csv", measured), ("scene.toml", text)]);
        let message = Scene::load(&path.join("scene.toml")).unwrap_err().to_string();
        for part in parts.iter().chain(&["load.y.force", "scene.toml"]) {
            assert!(message.contains(part), "{measured}: {message}\nshould name {part}");
        }
        assert!(parts[0].starts_with("a file") || message.contains("m.csv"), "{message}");
        std::fs::remove_dir_all(path).unwrap();
    }
    let missing =
        Scene::parse(&with_force("{ file = \"no_such.csv\", time = \"t [s]\", value = \"F [N]\" }"));
    let message = missing.unwrap_err().to_string();
    assert!(message.contains("load.y.force") && message.contains("no_such.csv"), "{message}");
}

/// The mesh of docs/gearbox.md.
const MESH: Mesh = Mesh {
    pitch_radius: 0.0238,
    pressure_angle: 20.0 * PI / 180.0,
    helix_angle: -15.0 * PI / 180.0,
    position: 0.0,
    offset: -0.01,
};

#[test]
fn published_number_components_of_a_mesh_are_those_of_the_gearbox() {
    let [tangential, radial, axial] = MESH.components(30.0);
    // The table of docs/gearbox.md, in whole newtons.
    assert_eq!([tangential, radial, axial].map(f64::round), [1261.0, -475.0, 338.0]);
    // Backwards all but the force that keeps both gears apart turns round; the other hand turns the axial one round.
    assert_eq!(MESH.components(-30.0), [-tangential, radial, -axial]);
    assert_eq!(
        Mesh { helix_angle: -MESH.helix_angle, ..MESH }.components(30.0),
        [tangential, radial, -axial]
    );
}

#[test]
fn closed_form_statics_of_a_mesh_by_hand() {
    let torque = 30.0;
    let tangential = torque / 0.0238;
    let (tan_alpha, cos_beta, tan_beta) =
        (20f64.to_radians().tan(), 15f64.to_radians().cos(), 15f64.to_radians().tan());
    // At y = r the tangent is +z: as examples/gearbox/gearbox.py has it.
    let at_y = MESH.wrench(torque);
    let force = V::new(tan_beta, -tan_alpha / cos_beta, 1.0) * tangential;
    let moment = V::new(-0.01, 0.0238, 0.0).cross(&force);
    assert!((at_y.force - force).norm() < 1e-12 * force.norm());
    assert!((at_y.moment - moment).norm() < 1e-12 * moment.norm());
    // It is the torque about x, wherever the pitch point is.
    for position in [0.0, 0.7, 2.0, -1.5] {
        let wrench = Mesh { position, ..MESH }.wrench(torque);
        assert!((wrench.moment.x - torque).abs() < 1e-13 * torque);
        assert!((wrench.force.norm() - force.norm()).abs() < 1e-12 * force.norm());
        let out = V::new(0.0, position.cos(), position.sin());
        assert!((wrench.force.dot(&out) - force.y).abs() < 1e-12 * force.norm());
    }
    let ripple = Ripple { teeth: 23.0, amplitude: 0.1, phase: 0.3 };
    assert!((ripple.factor(0.2) - (1.0 + 0.1 * (23.0f64 * 0.2 + 0.3).sin())).abs() < 1e-15);
}

#[test]
fn closed_form_an_unbalance_is_a_mass_on_a_turning_arm() {
    // Mass times acceleration of a point at radius e and angle phi(t), by differences, is what the shaft must give it.
    let (product, speed, acceleration) = (2e-5, 500.0, 3e4);
    let angle = |t: f64| 0.8 + speed * t + 0.5 * acceleration * t * t;
    let at = |t: f64| V::new(0.0, angle(t).cos(), angle(t).sin());
    let d = 1e-6;
    let pulled = -(at(d) - at(0.0) * 2.0 + at(-d)) / (d * d) * product;
    let wrench = unbalance(product, 0.8, speed, acceleration, 0.05);
    assert!((wrench.force - pulled).norm() < 1e-4 * pulled.norm(), "{} {pulled}", wrench.force);
    // A moment by the arm to its plane.
    let moment = V::new(0.0, -0.05 * wrench.force.z, 0.05 * wrench.force.y);
    assert!((wrench.moment - moment).norm() < 1e-15);
}

const MACHINE: [(&str, &str); 3] = [
    ("load.y.force", "\"200 N\""),
    (
        "load.gear",
        "[{ torque = \"5 N m\", pitch_radius = \"23.8 mm\", pressure_angle = \"20 deg\", helix_angle = \"-15 deg\", \
         offset = \"-10 mm\", position = \"30 deg\", teeth = 23, ripple = 0.1, phase = 0.5 }]",
    ),
    (
        "load.rotating",
        "[{ unbalance = \"100 g mm\", phase = \"40 deg\", offset = \"5 mm\" }, { force = \"3 N\", speed = -900 }]",
    ),
];

/// Force and moment of `MACHINE` on the race at a time \[s], by hand; 1500 N along x are those of the scene.
fn by_hand(time: f64) -> (V, V) {
    let torque = 5.0 * (1.0 + 0.1 * (23.0 * SPEED * time + 0.5).sin());
    let mesh = Mesh { position: 30f64.to_radians(), ..MESH }.wrench(torque);
    let turned = 40f64.to_radians() + SPEED * time;
    let pull = 1e-4 * SPEED * SPEED;
    let unbalance = V::new(0.0, pull * turned.cos(), pull * turned.sin());
    let other = V::new(0.0, 3.0 * (-900.0 * time).cos(), 3.0 * (-900.0 * time).sin());
    let force = V::new(1500.0, 200.0, 0.0) + mesh.force + unbalance + other;
    let moment = mesh.moment + V::new(5e-3, 0.0, 0.0).cross(&unbalance);
    (force, V::new(0.0, moment.y, moment.z))
}

#[test]
fn closed_form_the_start_and_every_row_carry_gears_and_unbalance() {
    let scene = scene(THRUST, &MACHINE);
    // The equilibrium carries what they do at time 0.
    let input = EquilibriumInput::from_scene(&scene, Gyroscopic::Friction);
    let solution = equilibrium::solve(&Model::new(&scene).unwrap(), &input).unwrap();
    let (force, moment) = by_hand(0.0);
    for (i, expected) in [force.x, force.y, force.z, moment.y, moment.z].into_iter().enumerate() {
        assert!(
            (solution.load[i] - expected).abs() < 1e-7 * force.norm(),
            "{i}: {} {expected}",
            solution.load[i]
        );
    }
    let mut simulation = Simulation::new(&scene).unwrap();
    for row in 0..5 {
        let applied = simulation.inputs().inner.applied;
        let (force, moment) = by_hand(simulation.time());
        assert!((applied.force - force).norm() < 1e-12 * force.norm(), "{row}: {} {force}", applied.force);
        assert!(
            (applied.moment - moment).norm() < 1e-12 * force.norm(),
            "{row}: {} {moment}",
            applied.moment
        );
        simulation.advance_scripted(f64::from(row + 1) * 1e-4).unwrap();
    }
    // In a direction that is held they press on what holds it.
    let held = scenes::scene(THRUST, &[&MACHINE[1..], &HELD].concat());
    let applied = Simulation::new(&held).unwrap().inputs().inner.applied;
    assert!((applied.force - V::x() * by_hand(0.0).0.x).norm() < 1e-9 && applied.moment == V::zeros());
    // A gear without ripple is the same at all times: no script, but a load.
    let steady = "[{ torque = 5, pitch_radius = 0.0238, pressure_angle = 0.3 }]";
    let steady = scenes::scene(THRUST, &[("load.gear", steady)]);
    assert!(!roulement::simulation::follows_time(&steady) && roulement::simulation::follows_time(&held));
    assert!((Simulation::new(&steady).unwrap().inputs().inner.applied.force.z - 5.0 / 0.0238).abs() < 1e-10);
}

#[test]
fn invariant_the_outer_race_under_a_wrench_takes_the_machine() {
    let changes = [
        ("inner.drive", "\"fixed\""),
        ("inner.mass", ""),
        ("inner.inertia", ""),
        ("outer.drive", "\"wrench\""),
        ("outer.mass", "0.2"),
        ("outer.inertia", "[6e-5, 4e-5, 4e-5]"),
        ("load.x", ""),
        ("load.outer.x.force", "-1500"),
        ("load.rotating", "[{ force = \"50 N\", speed = 700, phase = \"90 deg\" }]"),
    ];
    let simulation = Simulation::new(&scene(THRUST, &changes)).unwrap();
    let (inner, outer) = (simulation.inputs().inner.applied, simulation.inputs().outer.applied);
    assert_eq!((inner.force, outer.force.x), (V::zeros(), -1500.0));
    assert!((outer.force.z - 50.0).abs() < 1e-12 && outer.force.y.abs() < 1e-12);
}

#[test]
fn invariant_no_step_skips_a_period() {
    // Steps as long as they may be: 10 us and more, whatever their error.
    let free = [
        ("solver.max_step", "1e-3"),
        ("solver.initial_step", "1e-3"),
        ("solver.tolerance", "1e-2"),
        ("solver.energy_error", "1"),
    ];
    let steps = |changes: &[(&str, &str)], end: f64| {
        let mut simulation = Simulation::new(&scene(THRUST, &[&free[..], changes].concat())).unwrap();
        simulation.advance_scripted(end).unwrap();
        simulation.state().statistics.steps
    };
    let plain = steps(&[], 1e-4);
    assert!(plain < 100, "{plain}");
    // 200 kHz: 20 periods in 0.1 ms; by a sine, as part of a sum, by a ripple, and by turning.
    let swings: [(&str, &str); 4] = [
        ("load.y.force", "{ amplitude = 1, frequency = \"200 kHz\" }"),
        ("friction.ball_race", "{ sum = [0.08, { amplitude = 1e-3, frequency = \"200 kHz\" }] }"),
        (
            "load.gear",
            "[{ torque = 0.1, pitch_radius = 0.02, pressure_angle = 0.3, teeth = 2000, ripple = 0.1 }]",
        ),
        ("load.rotating", "[{ force = 1, speed = 62831.853 }]"),
    ];
    for ((key, value), periods) in swings.into_iter().zip([20.0, 20.0, 20.0, 1.0]) {
        let taken = steps(&[(key, value)], 1e-4);
        assert!(f64::from(u32::try_from(taken).unwrap()) >= 16.0 * periods - 1e-9, "{key}: {taken} steps");
    }
    // One that begins later limits steps from there on.
    let late =
        steps(&[("load.y.force", "{ amplitude = 1, frequency = \"200 kHz\", begin = \"80 us\" }")], 1e-4);
    assert!((64..320).contains(&late), "{late}");
    // And a constraint that moves so: 1 nm at 20 kHz.
    let held = "{ displacement = { amplitude = 1e-9, frequency = \"20 kHz\", phase = \"90 deg\" } }";
    let taken = steps(&[("load.y", held)], 1e-4);
    assert!(taken >= 32, "{taken}");
}

#[test]
fn closed_form_a_swung_race_moves_by_its_sine() {
    let held = "{ displacement = { amplitude = \"1 um\", frequency = \"500 Hz\", phase = \"-90 deg\", mean = \"1 um\" } }";
    let scene = scene(THRUST, &[&HELD[1..], &[("load.y", held)]].concat());
    let mut simulation = Simulation::new(&scene).unwrap();
    for row in 1..=8 {
        let time = f64::from(row) * 2.5e-4;
        simulation.advance_scripted(time).unwrap();
        let place = simulation.outputs().inner.pose.position.y;
        let expected = 1e-6 * (1.0 - (TAU * 500.0 * time).cos());
        // Constraints hold to 1e-8 of a ball.
        assert!((place - expected).abs() < 1e-10, "{time}: {place} {expected}");
    }
}
