//! Losses of a bearing by part: all of them together are what torque times speed brings, and each is what its own law gives

use std::f64::consts::PI;

use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::losses::{LOSSES, Losses};
use roulement::simulation::play::Scripted;

use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const CAGE: &str = include_str!("../../scenes/cage.toml");
const OIL: (&str, &str) = ("film", "{ viscosity = 0.02 }");
const MIST: (&str, &str) = ("effects.ambient", "{ density = 50.0, viscosity = 18e-6 }");
const LAGS: (&str, &str) = ("effects.hysteresis", "true");

/// Energies \[J] over a part of a run: of torque times speed, of all work, and what is stored.
#[derive(Clone, Copy, Default)]
struct Sums {
    torque: f64,
    work: f64,
    stored: f64,
}

/// A number of every part.
fn each(losses: &Losses) -> [f64; LOSSES.len()] {
    LOSSES.map(|part| (part.get)(losses))
}

/// Runs a simulation by its script to a time, and shows it where each step has ended.
fn each_step(simulation: &mut Simulation, to: f64, mut see: impl FnMut(&Simulation)) {
    let mut course = simulation.begin(to).unwrap();
    while simulation.time() < to {
        simulation.step(&mut course, to).unwrap();
        see(simulation);
    }
    simulation.end(course, true);
}

/// Runs a scene to a time, and sums from there to another, from step to step by the trapezoidal rule.
fn sums(scene: &Scene, [from, to]: [f64; 2]) -> (Sums, [f64; LOSSES.len()]) {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.advance_scripted(from).unwrap();
    let start = simulation.instant();
    let energies = simulation.state().energies;
    let (mut sums, mut parts, mut before) = (Sums::default(), [0.0; LOSSES.len()], start.clone());
    each_step(&mut simulation, to, |bearing| {
        let now = bearing.instant();
        let half = 0.5 * (now.time - before.time);
        sums.torque += half * (before.torque_power + now.torque_power);
        for ((sum, a), b) in parts.iter_mut().zip(each(&before.losses)).zip(each(&now.losses)) {
            *sum += half * (a + b);
        }
        before = now;
    });
    let after = simulation.state().energies;
    sums.work = after.input + after.stiffened - energies.input - energies.stiffened;
    sums.stored = before.stored_energy - start.stored_energy;
    (sums, parts)
}

/// Name, text, changes, window \[s], parts that must be there.
type Case =
    (&'static str, &'static str, &'static [(&'static str, &'static str)], [f64; 2], &'static [&'static str]);

/// Steady runs. Mist and oil slow balls down before they are steady.
const STEADY: [Case; 8] = [
    ("dry", THRUST, &[], [25e-3, 50e-3], &["loss.sliding"]),
    ("dry, loaded askew", THRUST, &[("load.y", "{ force = 600.0 }")], [25e-3, 50e-3], &["loss.sliding"]),
    ("oil", THRUST, &[OIL], [25e-3, 50e-3], &["loss.sliding", "loss.rolling"]),
    ("hysteresis", THRUST, &[LAGS], [25e-3, 50e-3], &["loss.sliding", "loss.hysteresis"]),
    ("mist", THRUST, &[MIST], [60e-3, 100e-3], &["loss.sliding", "loss.drag"]),
    (
        "all of them",
        THRUST,
        &[OIL, LAGS, MIST],
        [60e-3, 100e-3],
        &["loss.sliding", "loss.rolling", "loss.hysteresis", "loss.drag"],
    ),
    ("cage", CAGE, &[], [25e-3, 50e-3], &["loss.sliding", "loss.cage", "loss.damping"]),
    (
        "cage in mist",
        CAGE,
        &[MIST],
        [40e-3, 80e-3],
        &["loss.sliding", "loss.cage", "loss.damping", "loss.drag"],
    ),
];

#[test]
fn invariant_all_losses_are_what_torque_times_speed_brings() {
    for (name, text, changes, window, there) in STEADY {
        let duration = format!("{}", window[1]);
        let scene = scene(text, &[changes, &[("load.duration", duration.as_str())]].concat());
        let (Sums { torque, work, stored, .. }, parts) = sums(&scene, window);
        let [total, own @ ..] = parts;
        println!("{name}: torque {torque:e}, work {work:e}, stored {stored:e}, lost {total:e}: {parts:?}");
        // The parts are all of it, and only those that the scene has are anything.
        assert!((own.iter().sum::<f64>() / total - 1.0).abs() < 1e-12, "{name}");
        for (part, value) in LOSSES[1..].iter().zip(own) {
            assert_eq!(
                (part.is_of)(&scene.effects),
                value != 0.0 || part.name == "loss.damping",
                "{name} {}",
                part.name
            );
            assert!(value != 0.0 || !there.contains(&part.name), "{name} {}", part.name);
        }
        // Work of any kind, less what is stored, is lost: to what the steps leave open of an energy.
        assert!(((work - stored) / total - 1.0).abs() < 1e-4, "{name}: {work} {stored} {total}");
        // What is steady has no other work, and stores nothing: balls pass by in periods that the window cuts.
        assert!((torque / total - 1.0).abs() < 2e-3, "{name}: {torque} {total}");
    }
}

#[test]
fn closed_form_drag_and_churning_of_every_ball() {
    let scene = scene(THRUST, &[OIL, LAGS, MIST]);
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.advance_scripted(5e-3).unwrap();
    let outputs = simulation.outputs();
    let (density, viscosity, radius) = (50.0, 18e-6, 0.5 * 9.525e-3);
    let mut drag = 0.0;
    for (ball, state) in outputs.balls.iter().zip(&simulation.state().balls) {
        // Schiller and Naumann below Re = 1000, 0.44 above; Dennis, Singh and Ingham.
        let speed = state.velocity.norm();
        let reynolds = 2.0 * radius * density * speed / viscosity;
        let coefficient = (24.0 / reynolds * (1.0 + 0.15 * reynolds.powf(0.687))).max(0.44);
        drag += 0.5 * density * coefficient * PI * radius * radius * speed.powi(3);
        let spin = ball.angular_velocity.norm();
        let reynolds = density * spin * radius * radius / viscosity;
        drag += 0.5 * density * radius.powi(5) * spin.powi(3) * (6.45 / reynolds.sqrt() + 32.1 / reynolds);
    }
    assert!((outputs.losses.drag / drag - 1.0).abs() < 1e-3, "{} {drag}", outputs.losses.drag);
    assert_eq!(outputs.losses.drag, outputs.drag_power);
    // Rolling resistance by the formula of the film, 2 F u of each contact, is what the forces take that act; hysteresis by its moment.
    let sum = |of: &dyn Fn(&roulement::simulation::outputs::ContactOutput) -> f64| {
        outputs.balls.iter().flat_map(|ball| Race::BOTH.map(|race| of(&ball[race]))).sum::<f64>()
    };
    let rolling = sum(&|contact| contact.film.rolling_power);
    assert!((outputs.losses.rolling / rolling - 1.0).abs() < 1e-3, "{} {rolling}", outputs.losses.rolling);
    let lagging = sum(&|contact| contact.resisting_power);
    assert!((outputs.losses.resisting / lagging - 1.0).abs() < 1e-12);
    let friction = sum(&|contact| contact.power);
    assert!((outputs.losses.sliding / (friction - rolling - lagging) - 1.0).abs() < 1e-2);
}

#[test]
fn invariant_heat_by_part_is_all_loss_but_for_damping() {
    // Whatever the speed does: as means since the last communication point.
    let on = ("effects.heat_outputs", "true");
    for (text, changes) in [
        (CAGE, &[on, MIST, ("load.inner_speed", "[[0, 500], [\"2 ms\", 900]]")][..]),
        (THRUST, &[on, MIST, OIL, LAGS]),
        (THRUST, &[on, ("effects.damping", "\"0.02 s/m\"")]),
    ] {
        let mut simulation = Simulation::new(&scene(text, changes)).unwrap();
        for point in 1..=3 {
            let mut before = simulation.instant();
            let mut lost = 0.0;
            let end = 4e-4 * f64::from(point);
            each_step(&mut simulation, end, |bearing| {
                let now = bearing.instant();
                let of = |losses: &Losses| losses.total() - losses.damping - losses.support;
                lost += 0.5 * (now.time - before.time) * (of(&before.losses) + of(&now.losses));
                before = now;
            });
            let heat = simulation.outputs().heat.unwrap();
            let all = heat.inner + heat.outer + heat.balls + heat.cage + heat.medium;
            assert!((all / (lost / 4e-4) - 1.0).abs() < 1e-9, "{all} {}", lost / 4e-4);
            assert_eq!(heat.medium > 0.0, changes.contains(&MIST));
        }
    }
}

#[test]
fn rows_of_what_is_off_are_not_there() {
    let names = |changes: &[(&str, &str)]| -> Vec<String> {
        let table = roulement::interface::variables::Variables::new(&scene(THRUST, changes));
        let of = |name: &&String| name.starts_with("loss.") || name.starts_with("heat.");
        table.rows().iter().map(|row| &row.name).filter(of).cloned().collect()
    };
    let undamped = ("effects.damping", "");
    assert_eq!(names(&[undamped]), ["loss.total", "loss.sliding"]);
    assert_eq!(
        names(&[OIL, LAGS, MIST]),
        ["loss.total", "loss.sliding", "loss.hysteresis", "loss.rolling", "loss.drag", "loss.damping"]
    );
    assert_eq!(
        names(&[undamped, ("film", "{ viscosity = 0.02, rolling_resistance = false }")]),
        ["loss.total", "loss.sliding"]
    );
    let heat = names(&[undamped, MIST, ("effects.heat_outputs", "true")]);
    assert_eq!(heat[3..], ["heat.inner", "heat.outer", "heat.balls", "heat.cage", "heat.medium"]);
}
