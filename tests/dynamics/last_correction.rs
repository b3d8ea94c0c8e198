//! Steps of balls between races of prescribed motion: what the last correction, which is not evaluated, leaves, and what it saves.

use roulement::forces::Contacts;
use roulement::model::state::BallState;
use roulement::numerics::size::larger;
use roulement::simulation::Simulation;

use crate::scenes;

/// Fixed steps: the tolerance is too large to matter.
const EVEN: [(&str, &str); 2] = [("solver.tolerance", "1e-2"), ("solver.energy_error", "0")];

/// \[N] largest difference of the forces that a state has from those of its contacts, evaluated afresh; moments over the radius.
fn not_evaluated(simulation: &Simulation) -> f64 {
    let (model, state) = (simulation.model(), simulation.state());
    let contacts = Contacts::new(model, state, &simulation.conditions());
    let ambient = model.ambient(&simulation.inputs().effects.frame.motion);
    let of_ball = |(index, ball): (usize, &BallState)| {
        let afresh = contacts.on_ball(index, ambient.on_ball(&ball.motion()));
        let force = (ball.total.force - afresh.force).amax();
        larger(force, (ball.total.moment - afresh.moment).amax() / model.bearing.ball.radius)
    };
    state.balls.iter().enumerate().map(of_ball).fold(0.0, larger)
}

/// The thrust case with a law, its inner race in drive pose.
fn thrust(law: &str) -> Simulation {
    let law = format!("\"{law}\"");
    let mut changes = EVEN.to_vec();
    changes.extend([
        ("effects.creep", law.as_str()),
        ("solver.initial_step", "\"10 us\""),
        ("inner.drive", "\"pose\""),
    ]);
    Simulation::new(&scenes::scene(include_str!("../../scenes/thrust.toml"), &changes)).unwrap()
}

#[test]
fn invariant_forces_of_a_step_are_those_of_its_contacts_within_the_tolerance() {
    let scenes = [
        ("misalignment", include_str!("../../scenes/misalignment.toml")),
        ("load zone", include_str!("../../scenes/cost/load_zone.toml")),
        ("thrust", include_str!("../../scenes/thrust.toml")),
    ];
    for (name, text) in scenes {
        for (law, step) in
            [("saturated", 1e-5), ("kalker_table", 1e-5), ("saturated", 5e-5), ("kalker_table", 1e-4)]
        {
            let (law_text, step_text) = (format!("\"{law}\""), format!("{step:e}"));
            let mut changes = EVEN.to_vec();
            changes.extend([
                ("effects.creep", law_text.as_str()),
                ("solver.max_step", &step_text),
                ("solver.initial_step", &step_text),
                ("inner.drive", "\"pose\""),
            ]);
            let mut simulation = Simulation::new(&scenes::scene(text, &changes)).unwrap();
            let (mut worst, mut small, mut steps) = (0.0f64, 0, 0);
            while simulation.time() < 8e-3 {
                simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
                let tolerance = simulation.state().force_tolerance;
                simulation.advance(simulation.time() + step).unwrap();
                let share = not_evaluated(&simulation) / tolerance;
                worst = larger(worst, share);
                small += u32::from(share < 0.1);
                steps += 1;
            }
            println!(
                "{name}, {law}, {step:e} s: {worst:.3} of the tolerance at most, below 0.1 in {small} of {steps} steps"
            );
            // Nothing would be left if no step ended with a correction that is not evaluated.
            assert!(worst > 0.0 && worst <= 1.0, "{name}, {law}, {step:e} s: {worst}");
        }
    }
}

#[test]
fn invariant_an_even_step_is_evaluated_once() {
    for law in ["saturated", "regularised", "kalker_table"] {
        let mut simulation = thrust(law);
        let mut to = |end: f64| {
            while simulation.time() < end - 1e-9 {
                let next = simulation.time() + 1e-4;
                simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
                simulation.advance(next).unwrap();
            }
            simulation.state().statistics
        };
        let (before, after) = (to(5e-3), to(25e-3));
        let per_step =
            (after.contact_values - before.contact_values) as f64 / (after.steps - before.steps) as f64;
        println!("{law}: {per_step:.2} contacts a step");
        // Ten balls have twenty contacts; before there was a last correction, steps evaluated 38 to 40.
        assert!((20.0..21.0).contains(&per_step), "{law}: {per_step}");
    }
}

#[test]
fn invariant_without_friction_nothing_damps_the_swing_of_balls_along_their_grooves() {
    // Size [m] and frequency [Hz] of the swing of a ball's axial place in 5 ms from a time on.
    let swings = |law: &str| {
        let mut simulation = thrust(law);
        [5e-3, 45e-3].map(|from| {
            simulation.advance_scripted(from).unwrap();
            let places: Vec<f64> = (1..=500)
                .map(|step| {
                    simulation.advance_scripted(from + f64::from(step) * 1e-5).unwrap();
                    simulation.state().balls[3].position.x
                })
                .collect();
            let mean = places.iter().sum::<f64>() / places.len() as f64;
            let size = places.iter().map(|x| (x - mean).abs()).fold(0.0, larger);
            let crossings = places.windows(2).filter(|two| (two[0] < mean) != (two[1] < mean)).count();
            (size, crossings as f64 / 2.0 / 5e-3)
        })
    };
    let [early, late] = swings("frictionless");
    println!("without friction: {:.2e} m, later {:.2e} m, {:.0} Hz", early.0, late.0, late.1);
    // The scheme takes some of it, in 190 swings.
    assert!(late.0 > 0.7 * early.0 && late.0 < early.0);
    // One crossing more in 5 ms is 100 Hz.
    assert!((late.1 - 4.8e3).abs() <= 100.0, "{} Hz", late.1);
    // A guess goes on straight: it misses by the bend of the acceleration in a step, far more than Newton's tolerance.
    let simulation = thrust("frictionless");
    let turn = 2.0 * std::f64::consts::PI * late.1;
    let missed = simulation.model().bearing.ball.mass * turn.powi(4) * 1e-5f64.powi(2) * late.0;
    let tolerance = simulation.state().force_tolerance;
    println!("a guess misses by {missed:.1e} N, {:.0} tolerances", missed / tolerance);
    assert!(missed > 100.0 * tolerance);
    let [_, damped] = swings("saturated");
    println!("with it: {:.2e} m", damped.0);
    // Friction leaves what Newton's tolerance does.
    assert!(damped.0 < 1e-3 * late.0);
}
