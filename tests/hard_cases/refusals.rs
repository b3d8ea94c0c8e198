//! Refusals: a run that cannot go on ends with its cause, its time, the ball and its contacts; never with a wrong answer.

use roulement::simulation::Simulation;

use crate::gates::refuses;
use crate::scenes::{ANGULAR, CAGE, FLAT, GROOVE, groove, load, scene};

/// Runs a scene to its refusal.
fn refusal(base: &str, changes: &str) -> String {
    let scene = scene(base, changes);
    let mut simulation = match Simulation::new(&scene) {
        Ok(simulation) => simulation,
        Err(why) => return why.to_string(),
    };
    loop {
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        if let Err(why) = simulation.advance(simulation.time() + 1e-4) {
            return why.to_string();
        }
        assert!(simulation.time() < scene.load.duration.0, "it was not refused");
    }
}

#[test]
fn a_step_that_may_not_be_small_enough() {
    let rows = "x = { force = [[0.0, 1500.0], [0.001, 1500.0], [0.00105, 50000.0]] }\n";
    let solver = "[solver]\ninitial_step = \"10 us\"\nmin_step = \"10 us\"\nmax_step = \"10 us\"\n";
    let why = refusal(ANGULAR, &(load(5.0, 6000.0, rows) + solver));
    refuses(
        "shock, steps held at 10 us",
        &why,
        &["at 0.00", "local error", "ball", "inner race", "inner load", "outer load"],
    );
}

/// Steps held at 10 us.
const HELD_STEPS: &str = "[solver]\ninitial_step = \"10 us\"\nmin_step = \"10 us\"\nmax_step = \"10 us\"\n";

#[test]
fn a_race_that_steps_cannot_follow() {
    // A moment that flings a light race about before its balls know.
    let light = "[inner]\ndrive = \"wrench\"\nmass = 0.02\ninertia = [6e-6, 4e-6, 4e-6]\n";
    let rows = "x = { force = 300.0 }\nrz = { moment = [[0.0, 0.0], [0.001, 0.0], [0.00101, 50.0]] }\n";
    let why = refusal(ANGULAR, &(load(5.0, 6000.0, rows) + HELD_STEPS + light));
    let parts = ["at 0.00", "local error", "worst at the inner race, at its contact with ball"];
    refuses("moment on a race of 20 g, steps held at 10 us", &why, &parts);
}

#[test]
fn a_cage_that_steps_cannot_follow() {
    // A cage lighter than a ball runs into balls that are slower.
    let light = "[cage]\nmass = \"0.2 g\"\ninertia = [1.1e-7, 6e-8, 6e-8]\npocket_clearance = \"0.2 mm\"\n\
                 guided_by = \"balls\"\n";
    let start = "[start]\norbital_speed = 200.0\n";
    let rest = "x = { force = 1500.0 }\n[friction]\nball_race = 0.0\nball_cage = 0.0\n";
    let why = refusal(CAGE, &(load(5.0, 6000.0, rest) + HELD_STEPS + start + light));
    refuses(
        "blow on a cage of 0.2 g, steps held at 10 us",
        &why,
        &["at 7e-5 s", "worst at the cage, at its contact with ball"],
    );
}

#[test]
fn a_race_that_nothing_holds() {
    // One ball takes thrust, but lets the race turn about it until the ball is out of its groove.
    let one = "[bearing]\nballs = 1\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
               contact_angle = \"25 deg\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n";
    let why = refusal(ANGULAR, &(load(5.0, 6000.0, "x = { force = 100.0 }\n") + one));
    refuses(
        "thrust on a single ball",
        &why,
        &["no equilibrium to start from", "ball 1", "inner race", "groove"],
    );
}

#[test]
fn interference_beyond_elastic_contact() {
    let rows = "y = { force = 1000.0 }\nx = { displacement = 0.0 }\n";
    let why = refusal(GROOVE, &(load(5.0, 6000.0, rows) + &groove(-900.0, 0.52)));
    refuses("interference 0.9 mm", &why, &["ball", "pressed in", "beyond elastic"]);
}

#[test]
fn a_load_that_crushes_while_it_runs() {
    let rows = "x = { force = [[0.0, 1500.0], [0.001, 1500.0], [0.002, 1e7]] }\n";
    let why = refusal(ANGULAR, &load(5.0, 6000.0, rows));
    refuses("thrust of 10 MN", &why, &["at 0.00", "ball", "inner"]);
}

#[test]
fn a_race_that_falls_between_its_balls() {
    // A millimetre of clearance under a radial load, and no cage that would keep the balls apart.
    let rows = format!("y = {{ force = 5000.0 }}\n{FLAT}");
    let why = refusal(GROOVE, &(groove(1000.0, 0.56) + &load(200.0, 6000.0, &rows)));
    refuses(
        "radial load, clearance 1 mm, no cage",
        &why,
        &["at 0.", "ball", "race on the side", "no groove"],
    );
}
