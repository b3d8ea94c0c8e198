//! Gate (f): without friction, damping and load, an oscillation gains no energy over 1e5 steps.

use roulement::simulation::Simulation;

use crate::scenes::{GROOVE, scene};

/// [J] kinetic and elastic energy after every thousandth of 1e5 steps, of an inner race let go from where `force` held
/// it.
fn energies(clearance: &str, alpha_f: f64, rpm: f64, step: &str, force: &str) -> (Vec<f64>, Simulation) {
    let changes = format!(
        "[bearing]\nballs = 5\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
         diametral_clearance = \"{clearance}\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n\
         [effects]\ncreep = \"frictionless\"\n\
         [solver]\nalpha_f = {alpha_f}\ninitial_step = \"{step}\"\nmax_step = \"{step}\"\ntolerance = 1e-2\n\
         [load]\nduration = \"1 s\"\ninner_speed = \"{rpm} rpm\"\n{force}\n"
    );
    let scene = scene(GROOVE, &changes);
    let step = scene.solver.max_step.0;
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
    simulation.advance(step).unwrap();
    let mut energies = vec![];
    for thousand in 1..=100 {
        let inputs = simulation.scripted_inputs(simulation.time());
        assert_eq!(inputs.inner.applied.force.norm(), 0.0);
        simulation.set_inputs(inputs);
        simulation.advance(step * f64::from(1000 * thousand)).unwrap();
        energies.push(simulation.outputs().stored_energy);
    }
    (energies, simulation)
}

#[test]
fn energy_never_grows() {
    // 300 N and 200 N, gone after a nanosecond.
    let force = "x = { force = [[0.0, 200.0], [1e-9, 0.0]] }\ny = { force = [[0.0, 300.0], [1e-9, 0.0]] }";
    let radial = "y = { force = [[0.0, 300.0], [1e-9, 0.0]] }\nx = { displacement = 0.0 }\nry = { rotation = 0.0 }\nrz = { rotation = 0.0 }";
    for (name, clearance, alpha_f, rpm, step, force) in [
        ("preloaded", "-20 um", 0.05, 0.0, "1 us", force),
        ("preloaded", "-20 um", 1e-6, 0.0, "1 us", force),
        ("preloaded, turning", "-20 um", 0.05, 6000.0, "1 us", force),
        ("preloaded, turning", "-20 um", 1e-6, 6000.0, "1 us", force),
        ("clearance", "20 um", 0.05, 0.0, "1 us", radial),
        ("clearance", "20 um", 1e-6, 0.0, "1 us", radial),
        ("preloaded, 5 us", "-20 um", 0.05, 0.0, "5 us", force),
        ("preloaded, 5 us", "-20 um", 1e-6, 0.0, "5 us", force),
    ] {
        let (energies, simulation) = energies(clearance, alpha_f, rpm, step, force);
        let statistics = simulation.state().statistics;
        let largest = energies.iter().copied().fold(0.0, f64::max);
        println!("\n| {name} {alpha_f} {rpm} | {} {} | {:e} {:e} {:e} {:e} | max {:e} | {} |", statistics.steps, statistics.rejected_error, energies[0], energies[1], energies[50], energies[99], largest - energies[0], simulation.outputs().work);
    }
}
