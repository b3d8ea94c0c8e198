//! Gate (f): without friction, damping and load, an oscillation gains no energy over 1e5 steps.

use roulement::simulation::Simulation;
use roulement::state::Statistics;

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
        assert!(work.abs() < 1e-6 * start, "{name}: work of {work} J");
        assert!(largest <= start * (1.0 + 1e-9), "{name}: {largest} J of {start} J");
        assert_eq!(statistics.rejected_newton, 0);
    }
}

#[test]
fn preloaded_bearing_rings() {
    Release {
        name: "preloaded",
        clearance: "-20 um",
        rpm: 0.0,
        cap: "10 us",
        tolerance: 1e-6,
        force: OBLIQUE,
    }
    .energy_never_exceeds_its_start();
}

#[test]
#[ignore = "long"]
fn preloaded_bearing_rings_in_small_steps() {
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
    Release { name, clearance: "-20 um", rpm: 6000.0, cap: "10 us", tolerance: 1e-6, force: OBLIQUE }
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

#[test]
#[ignore = "diagnostic"]
fn zz_energy() {
    let get = |k: &str, d: &str| std::env::var(k).unwrap_or_else(|_| d.to_string());
    let (cap, tol, end, alpha) =
        (get("CAP", "2 us"), get("TOL", "1e-6"), get("END", "0.25"), get("ALPHA", "0.05"));
    let changes = format!(
        "[bearing]\nballs = 5\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
         diametral_clearance = \"-20 um\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n\
         [effects]\ncreep = \"frictionless\"\n\
         [solver]\ninitial_step = \"1 us\"\nmax_step = \"{cap}\"\ntolerance = {tol}\nalpha_f = {alpha}\n\
         [load]\nduration = \"10 s\"\ninner_speed = 0.0\n{OBLIQUE}\n"
    );
    let mut simulation = Simulation::new(&scene(GROOVE, &changes)).unwrap();
    let end: f64 = end.parse().unwrap();
    let (mut last, mut up, mut down, mut biggest) = (f64::NAN, 0.0, 0.0, 0.0f64);
    let (mut n, mut start) = (0u64, f64::NAN);
    let mut ups = [0.0f64; 2];
    while simulation.time() < end {
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        let step = if n < 2 { 1e-6 } else { simulation.state().control.step() };
        let was = simulation.state().statistics;
        let touch_before: usize = simulation
            .outputs()
            .balls
            .iter()
            .map(|b| usize::from(b.inner.load > 0.0) + usize::from(b.outer.load > 0.0))
            .sum();
        simulation.advance(simulation.time() + step).unwrap();
        let o = simulation.outputs();
        n += 1;
        if n == 2 {
            start = o.stored_energy;
        }
        if n > 2 {
            let d = o.stored_energy - last;
            let touch: usize = o
                .balls
                .iter()
                .map(|b| usize::from(b.inner.load > 0.0) + usize::from(b.outer.load > 0.0))
                .sum();
            if d > 0.0 {
                up += d
            } else {
                down += d
            }
            if touch != touch_before {
                ups[0] += d
            } else {
                ups[1] += d
            }
            biggest = biggest.max(d);
        }
        let _ = was;
        last = o.stored_energy;
        if n % 5000 == 0 {
            let depth = o.balls.iter().map(|b| b.inner.load.max(b.outer.load)).fold(0.0, f64::max);
            println!(
                "@@ {:.4} n {n} E/E0-1 {:.4e} up {:.2e} down {:.2e} biggest {:.1e} change/same {:.2e} {:.2e} rej {} load {depth:.1}",
                o.time,
                last / start - 1.0,
                up / start,
                down / start,
                biggest / start,
                ups[0] / start,
                ups[1] / start,
                o.statistics.rejected_error
            );
        }
    }
}
