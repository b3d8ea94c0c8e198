//! What hard cases cost where nothing is said about steps, and what bearings cost that stand beside running ones. Writes two tables of
//! docs/stability.md.

use std::path::Path;

use cpu_time::ThreadTime;
use roulement::model::state::State;
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::Simulation;
use roulement::simulation::system::System;

use crate::gears::{LIGHT, gear_pair};
use crate::tables::{Noise, Row, compare, count, row};

const DOCUMENT: &str = "docs/stability.md";
const ANGULAR: &str = include_str!("../../../scenes/thrust.toml");
const GROOVE: &str = include_str!("../../../scenes/radial.toml");
const CAGE: &str = include_str!("../../../scenes/cage.toml");
const ASKEW: &str = include_str!("../../../scenes/misalignment.toml");
const PINION: &str = include_str!("../../../scenes/shafts/pinion.toml");

const IDEAL: (&str, &str) = ("effects.cage", "\"ideal\"");
const OIL: (&str, &str) = ("film", "{ iso_vg = 68, temperature = \"70 degC\" }");
/// 6000 rpm, braked from 5 to 15 ms.
const TO_REST: (&str, &str) = ("load.inner_speed", "[[0, \"6000 rpm\"], [0.005, \"6000 rpm\"], [0.015, 0]]");
const STANDS: (&str, &str) = ("load.inner_speed", "0");
const SWINGS: (&str, &str) =
    ("load.inner_speed", "{ mean = 0, amplitude = \"600 rpm\", frequency = \"50 Hz\" }");
const ALTERNATING: (&str, &str) =
    ("load.y.force", "{ mean = \"1.5 kN\", amplitude = \"1 kN\", frequency = \"200 Hz\" }");

/// A key of a scene and its value.
type Change = (&'static str, &'static str);

/// [-] energy that a case may leave open, over what it turned over.
const OPEN: f64 = 0.01;
/// [-] share of the steps that may be given up.
const GIVEN_UP: f64 = 0.01;

/// A scene that says nothing about steps.
fn scene(base: &str, changes: &[(&str, &str)]) -> Scene {
    let mut sections: toml::Table = base.parse().unwrap();
    sections.remove("solver");
    Scene::edited(&sections.to_string(), changes.iter().copied()).unwrap_or_else(|why| panic!("{why}"))
}

/// Work of a run so far.
#[derive(Clone, Copy, Debug, Default)]
struct Work {
    steps: f64,
    too_inaccurate: f64,
    given_up: f64,
    corrections: f64,
    /// \[s] time of the processor.
    cpu: f64,
    /// [-] energy left open over what was turned over.
    open: f64,
}

impl Work {
    fn of(state: &State, cpu: f64) -> Self {
        let counts = &state.statistics;
        let open = state.energies.unaccounted.abs() / state.energies.turned_over().max(1e-9);
        Self {
            steps: counts.steps as f64,
            too_inaccurate: counts.rejected_error as f64,
            given_up: counts.rejected_newton as f64,
            corrections: counts.newton.iterations as f64,
            cpu,
            open,
        }
    }

    /// Row of a case that ran for a time \[s], if it keeps what every case does.
    fn row(self, name: &str, time: f64) -> Row {
        println!("{name}: {self:?}");
        assert!(self.open < OPEN, "{name}: {self:?}");
        assert!(self.given_up <= 3.0 + GIVEN_UP * self.steps, "{name}: {self:?}");
        let numbers = vec![
            count(self.steps, 0),
            count(self.too_inaccurate, 0),
            count(self.given_up, 0),
            count(self.corrections / self.steps, 1),
            (format!("{:.2}", self.cpu / time), Noise::Size),
        ];
        row(format!("{name} | {}", 1e3 * time), numbers, "")
    }
}

/// Runs a bearing, and gives its work up to each of some times \[s].
fn runs(scene: &Scene, times: &[f64]) -> Vec<Work> {
    let mut simulation = Simulation::new(scene).unwrap_or_else(|why| panic!("{}: {why}", scene.title));
    let mut cpu = 0.0;
    times
        .iter()
        .map(|time| {
            let meter = ThreadTime::now();
            simulation.advance_scripted(*time).unwrap_or_else(|why| panic!("{}: {why}", scene.title));
            cpu += meter.elapsed().as_secs_f64();
            Work::of(simulation.state(), cpu)
        })
        .collect()
}

/// Work of a machine up to a time \[s].
fn machine(text: &str, time: f64) -> Work {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let scene = SystemScene::parse(text, None, &folder).unwrap_or_else(|why| panic!("{why}"));
    let mut system = System::new(&scene).unwrap_or_else(|why| panic!("{why}"));
    let meter = ThreadTime::now();
    system.advance(time).unwrap_or_else(|why| panic!("{why}"));
    let cpu = meter.elapsed().as_secs_f64();
    let of = |(_, bearing): (_, &Simulation)| Work::of(bearing.state(), cpu);
    system.bearings().map(of).reduce(|a, b| Work { open: a.open.max(b.open), ..a }).unwrap()
}

#[test]
#[ignore = "a minute; scripts/soak runs it"]
fn invariant_hard_cases_close_their_energy_and_hardly_give_up_where_nothing_is_said() {
    let whole = [("inner.shoulder_angle", "[1.5, 1.5]"), ("outer.shoulder_angle", "[1.5, 1.5]")];
    let land = "[\"1.7 mm\", \"1.7 mm\"]";
    let askew = |tilt: &'static str| {
        vec![
            ("outer.misalignment.ry", tilt),
            ("outer.shoulder_height", land),
            ("inner.shoulder_height", land),
            ("load.y.force", "1000"),
        ]
    };
    let touchdown = [
        ("load.inner_speed", "[[0, 0], [0.001, 0], [0.003, \"20000 rpm\"]]"),
        ("load.y", "{ force = [[0, 0], [0.001, 0], [0.0012, 3000], [0.0022, 300]] }"),
    ];
    let (ry, rz) = (("load.ry", "{ rotation = 0 }"), ("load.rz", "{ rotation = 0 }"));
    let emergency = ("load.inner_speed", "[[0, \"12000 rpm\"], [0.004, \"12000 rpm\"], [0.006, 0]]");
    let cases: Vec<(&str, &str, Vec<Change>, f64)> = vec![
        ("run to rest under thrust", ANGULAR, vec![TO_REST], 30e-3),
        ("run to rest under thrust, in oil", ANGULAR, vec![TO_REST, OIL], 30e-3),
        ("run to rest under radial load, ideal cage", GROOVE, vec![TO_REST, IDEAL], 30e-3),
        ("run to rest under radial load, no cage", GROOVE, vec![TO_REST], 30e-3),
        ("run to rest with a cage", CAGE, vec![TO_REST], 30e-3),
        ("oscillation through zero", ANGULAR, vec![SWINGS], 40e-3),
        ("oscillation through zero with a cage", CAGE, vec![SWINGS], 40e-3),
        ("oscillation through zero in oil", ANGULAR, vec![SWINGS, OIL], 40e-3),
        ("standstill under 1.5 +- 1 kN at 200 Hz", GROOVE, vec![STANDS, ALTERNATING], 100e-3),
        ("the same, ideal cage", GROOVE, vec![STANDS, ALTERNATING, IDEAL], 100e-3),
        ("misalignment of 5 mrad beside lands", GROOVE, askew("\"5 mrad\""), 20e-3),
        ("misalignment of 15 mrad beside lands", GROOVE, askew("\"15 mrad\""), 20e-3),
        ("emergency stop in oil", ANGULAR, vec![emergency, OIL], 20e-3),
        ("touchdown to 20,000 rpm in 2 ms", ANGULAR, [&touchdown[..], &whole[..], &[ry, rz]].concat(), 12e-3),
    ];
    let mut rows: Vec<Row> = cases
        .iter()
        .map(|(name, base, changes, time)| runs(&scene(base, changes), &[*time])[0].row(name, *time))
        .collect();
    let starts = |torque: f64| {
        let drive = format!("torque = {torque}\nstart_speed = 0.0");
        let loads = [("[337.8, -475.0, 1260.5]", "[0, 0, 0]"), ("[30.0, 0, -8.04]", "[0, 0, 0]")];
        loads
            .iter()
            .fold(PINION.replace("speed = \"6000 rpm\"", &drive), |text, (was, is)| text.replace(was, is))
    };
    let vanishing = PINION.replace("337.8,", "[[0, 338], [\"1 ms\", 7000], [\"2 ms\", 338]],");
    let reversing = "torque = [[0, 20], [\"1 ms\", 20], [\"1.2 ms\", -20], [\"5 ms\", -20]]";
    let keys = ["speed = \"300 rpm\"", reversing, "backlash = \"40 um\"\ndamping_ratio = 0.05"];
    for (name, text, time) in [
        ("start by a torque below breakaway, two bearings", starts(0.05), 20e-3),
        ("start by a torque above breakaway, two bearings", starts(0.6), 20e-3),
        ("loss of preload in a pair", vanishing, 3e-3),
        (
            "tooth impacts with backlash, four bearings",
            gear_pair(keys, LIGHT, false, 20.0, [-1.0, -5e-3]),
            5e-3,
        ),
    ] {
        rows.push(machine(&text, time).row(name, time));
    }
    let header =
        "case | simulated \\[ms] | steps / rejected by error / given up / corrections a step / CPU \\[s/s]";
    compare(DOCUMENT, "cases", header, &rows);
}

#[test]
#[ignore = "half a minute; scripts/soak runs it"]
fn regression_a_bearing_at_rest_costs_no_more_than_a_running_one_unless_something_rings() {
    // Running until 5 ms, braked until 15 ms, standing from 20 to 30 ms.
    let braked = [5e-3, 20e-3, 30e-3];
    let mut rows = vec![];
    let mut add = |name: &str, running: f64, standing: [f64; 2], most: f64| {
        println!("{name}: {running} {standing:?}");
        assert!(standing[0] < most * running, "{name}: {running} {standing:?} steps a millisecond");
        rows.push(row(name, vec![count(running, 0), count(standing[0], 0), count(standing[1], 1)], ""));
    };
    // Three times as many, before, with an ideal cage under an alternating load.
    for (name, base, changes, most) in [
        ("`scenes/thrust.toml`", ANGULAR, vec![TO_REST], 1.0),
        ("`scenes/cage.toml`", CAGE, vec![TO_REST], 1.0),
        ("`scenes/misalignment.toml`", ASKEW, vec![TO_REST], 1.5),
        ("`scenes/radial.toml`, ideal cage", GROOVE, vec![TO_REST, IDEAL], 1.0),
        ("`scenes/radial.toml`, no cage: balls fly and strike", GROOVE, vec![TO_REST], 18.0),
    ] {
        let work = runs(&scene(base, &changes), &braked);
        let stood = work[2].steps - work[1].steps;
        let corrections = (work[2].corrections - work[1].corrections) / stood;
        add(name, work[0].steps / 5.0, [stood / 10.0, corrections], most);
    }
    for (name, changes, most) in [
        ("`scenes/radial.toml` under 1.5 +- 1 kN at 200 Hz, 100 ms", vec![ALTERNATING], 0.35),
        ("the same, ideal cage", vec![ALTERNATING, IDEAL], 2.2),
    ] {
        let work =
            |speed: &[(&str, &str)]| runs(&scene(GROOVE, &[&changes[..], speed].concat()), &[100e-3])[0];
        let [running, standing] = [work(&[]), work(&[STANDS])];
        let corrections = standing.corrections / standing.steps;
        add(name, running.steps / 100.0, [standing.steps / 100.0, corrections], most);
    }
    let header = "scene | steps a millisecond, running / standing / corrections a step standing";
    compare(DOCUMENT, "rest", header, &rows);
}

/// Loads of a standing bearing where nothing is said about steps, against a tolerance of 1e-10: within the 2 % that histories are promised.
#[test]
#[ignore = "a minute; scripts/soak runs it"]
fn consistency_loads_of_a_standing_bearing_keep_two_percent() {
    let along = ("load.x", "{ force = \"0.5 kN\" }");
    let blow = ("load.y.force", "[[0, 1000], [0.001, 1000], [0.00105, 3000]]");
    for (name, changes, end) in [
        ("alternating, ideal cage", vec![ALTERNATING, IDEAL], 10e-3),
        ("alternating, no cage", vec![ALTERNATING], 10e-3),
        ("alternating across, along", vec![ALTERNATING, along], 6e-3),
        ("a blow", vec![blow], 6e-3),
    ] {
        let usual = scene(GROOVE, &[&changes[..], &[STANDS, ("effects.creep", "\"kalker_table\"")]].concat());
        let mut exact = usual.clone();
        exact.solver.tolerance = 1e-10;
        exact.solver.unresolved = 0.0;
        let mut both =
            [&usual, &exact].map(|scene| Simulation::new(scene).unwrap_or_else(|why| panic!("{why}")));
        let (mut square, mut largest) = (0.0f64, 0.0f64);
        let rows = 100;
        for row in 1..=rows {
            let time = end * f64::from(row) / f64::from(rows);
            both.iter_mut().for_each(|of| of.advance_scripted(time).unwrap_or_else(|why| panic!("{why}")));
            let [here, there] = [0, 1].map(|of| both[of].outputs());
            let mut worst = 0.0f64;
            for (one, other) in here.balls.iter().zip(&there.balls) {
                worst = worst.max((one.inner.load - other.inner.load).abs());
                largest = largest.max(other.inner.load);
            }
            square += worst * worst;
        }
        let error = (square / f64::from(rows)).sqrt() / largest;
        println!("{name}: {:.2} %, {} steps", 100.0 * error, both[0].state().statistics.steps);
        assert!(error < 0.02, "{name}: {error}");
    }
}
