//! Gate (f): without friction, damping and load, an oscillation gains no energy over 1e5 steps.

use roulement::model::state::Statistics;
use roulement::simulation::Simulation;

use crate::figures;
use crate::scenes::{GROOVE, scene};

const STEPS: u64 = 100_000;

/// A bearing of five frictionless balls whose inner race is let go, within one step, from where a force held it.
struct Release {
    name: &'static str,
    clearance: &'static str,
    rpm: f64,
    cap: &'static str,
    tolerance: f64,
    force: &'static str,
}

/// Oblique pull, every direction free.
const OBLIQUE: &str =
    "x = { force = [[0.0, 200.0], [1e-9, 0.0]] }\ny = { force = [[0.0, 300.0], [1e-9, 0.0]] }";
/// Radial pull; the bearing has no end stop without friction, so that axial motion and tilt are held.
const RADIAL: &str = "y = { force = [[0.0, 300.0], [1e-9, 0.0]] }\nx = { displacement = 0.0 }\n\
                      ry = { rotation = 0.0 }\nrz = { rotation = 0.0 }";

impl Release {
    fn energy_never_exceeds_its_start(&self) {
        let Self { name, clearance, rpm, cap, tolerance, force } = self;
        let changes = format!(
            "[bearing]\nballs = 5\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
             diametral_clearance = \"{clearance}\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n\
             [effects]\ncreep = \"frictionless\"\n\
             [solver]\ninitial_step = \"1 us\"\nmax_step = \"{cap}\"\ntolerance = {tolerance:e}\n\
             [load]\nduration = \"10 s\"\ninner_speed = \"{rpm} rpm\"\n{force}\n"
        );
        let mut simulation = Simulation::new(&scene(GROOVE, &changes)).unwrap();
        let mut advance = |step: f64| {
            simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
            simulation.advance(simulation.time() + step).unwrap();
            let outputs = simulation.outputs();
            (outputs.stored_energy, outputs.work, outputs.statistics)
        };
        // The load fades within the second microsecond, after which nothing does work.
        advance(1e-6);
        let (start, work, _) = advance(1e-6);
        let (mut largest, mut last) = (f64::NEG_INFINITY, (start, work, Statistics::default()));
        while last.2.steps < STEPS {
            last = advance(1e-3);
            largest = largest.max(last.0);
        }
        let (end, work, statistics) = (last.0, last.1 - work, last.2);
        println!(
            "\n| {name} | {cap} | {tolerance:e} | {} | {} | {start:.3e} | {:.0e} | {end:.3e} |",
            statistics.steps,
            statistics.rejected_error,
            (largest - start) / start,
        );
        figures::compare_oscillation(name, cap, &statistics);
        assert!(work.abs() < 1e-6 * start, "{name}: work of {work} J");
        assert!(largest <= start * (1.0 + 1e-9), "{name}: {largest} J of {start} J");
        assert_eq!(statistics.rejected_newton, 0);
    }
}

#[test]
fn preloaded_bearing_rings() {
    // Within these 0.1 s the balls, which nothing holds sideways, do not run away yet.
    Release {
        name: "preloaded",
        clearance: "-20 um",
        rpm: 0.0,
        cap: "1 us",
        tolerance: 1e-6,
        force: OBLIQUE,
    }
    .energy_never_exceeds_its_start();
}

#[test]
#[ignore = "long"]
fn preloaded_bearing_rings_while_it_turns() {
    let name = "preloaded, 6000 rpm";
    Release { name, clearance: "-20 um", rpm: 6000.0, cap: "1 us", tolerance: 1e-6, force: OBLIQUE }
        .energy_never_exceeds_its_start();
}

#[test]
fn race_bounces_in_its_clearance() {
    let name = "clearance 20 um";
    Release { name, clearance: "20 um", rpm: 0.0, cap: "10 us", tolerance: 1e-6, force: RADIAL }
        .energy_never_exceeds_its_start();
}

#[test]
#[ignore = "long"]
fn race_bounces_in_its_clearance_in_small_steps() {
    let name = "clearance 20 um";
    Release { name, clearance: "20 um", rpm: 0.0, cap: "2 us", tolerance: 1e-8, force: RADIAL }
        .energy_never_exceeds_its_start();
}
