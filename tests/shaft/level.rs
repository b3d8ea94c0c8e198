//! Bearings of a machine that are without states, `level = "equilibrium"`: beside those that have some, and alone.

use nalgebra::Vector3;
use roulement::interface::variables::MachineVariables;
use roulement::model::state::Statistics;
use roulement::scene::system::SystemScene;
use roulement::simulation::motions::Motion;
use roulement::simulation::system::System;

use crate::common::{GEARBOX, ROTOR, forces, imbalance, scene, stored, system};

/// The public three-stage gearbox.
const THREE_STAGE: &str = include_str!("../../examples/gearbox/three_stage.toml");

/// Some of the bearings of [`ROTOR`] without states.
fn rotor(without_states: &[&str]) -> String {
    without_states.iter().fold(ROTOR.to_string(), |text, name| {
        let own = format!("name = \"{name}\"\n");
        let level = format!("{own}level = \"equilibrium\"\n");
        assert!(text.contains(&own));
        text.replace(&own, &level)
    })
}

/// Means over the second half of a run: forces on the shaft, and displacement of its seats.
fn means(text: &str, end: f64) -> (System, Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
    let mut system = system(text);
    let count = system.bearings().count();
    let (mut sum, mut moved) = (vec![Vector3::zeros(); count], vec![Vector3::zeros(); count]);
    let looks = 400;
    for look in 1..=looks {
        system.advance(end * f64::from(look) / f64::from(looks)).unwrap_or_else(|why| panic!("{why}"));
        if 2 * look > looks {
            sum.iter_mut().zip(forces(&system)).for_each(|(sum, force)| *sum += force);
            moved.iter_mut().zip(&system.outputs().seats).for_each(|(sum, seat)| *sum += seat.displacement);
        }
    }
    let mean = |all: Vec<Vector3<f64>>| all.into_iter().map(|sum| sum / f64::from(looks / 2)).collect();
    (system, mean(sum), mean(moved))
}

#[test]
fn independent_means_are_those_of_bearings_with_states_and_energy_is_kept() {
    let (_, of_dynamics, moved) = means(ROTOR, 20e-3);
    let largest = of_dynamics.iter().map(Vector3::norm).fold(0.0, f64::max);
    let way = moved.iter().map(Vector3::norm).fold(0.0, f64::max);
    for without in [vec!["left"], vec!["left", "right"]] {
        let text = rotor(&without);
        let before = stored(&system(&text));
        let (system, own, own_moved) = means(&text, 20e-3);
        for (own, other) in own.iter().zip(&of_dynamics) {
            assert!((own - other).norm() < 0.01 * largest, "{without:?}: {own} {other}");
        }
        // Across the axis, by what stiffnesses differ; along it a preload of 300 N shifts the shaft, as little as friction makes of it.
        for (own, other) in own_moved.iter().zip(&moved) {
            assert!((own - other).yz().norm() < 0.02 * way, "{without:?}: {own} {other}");
        }
        let [of_shaft, of_bearings] = imbalance(&system, &before);
        assert!(of_shaft < 1e-3 && of_bearings < 1e-3, "{without:?}: {of_shaft:.2e} {of_bearings:.2e}");
    }
}

#[test]
fn invariant_a_replay_and_what_goes_on_from_a_snapshot_are_the_same_bits() {
    for without in [vec!["right"], vec!["left", "right"]] {
        let text = rotor(&without);
        let (mut one, mut other) = (system(&text), system(&text));
        for end in [0.4e-3, 1.1e-3] {
            one.advance(end).unwrap();
            other.advance(end).unwrap();
        }
        assert_eq!(one.snapshot(), other.snapshot());
        let saved = one.snapshot();
        one.advance(3e-3).unwrap();
        let mut fresh = system(&text);
        assert!(fresh.restore(&saved));
        fresh.advance(3e-3).unwrap();
        other.advance(2e-3).unwrap();
        assert!(other.restore(&saved));
        other.advance(3e-3).unwrap();
        for again in [&fresh, &other] {
            assert_eq!(one.snapshot(), again.snapshot());
            assert_eq!(one.outputs(), again.outputs());
        }
        // One with other levels is another machine.
        assert!(!system(ROTOR).restore(&saved));
    }
}

#[test]
fn invariant_its_variables_have_the_names_that_they_have_with_states() {
    let names = |text: &str| -> Vec<String> {
        MachineVariables::new(&system(text)).rows().iter().map(|row| row.name.clone()).collect()
    };
    assert_eq!(names(ROTOR), names(&rotor(&["left", "right"])));
}

#[test]
fn limit_balls_pass_as_with_states_while_the_load_stands_still() {
    // The shaft sinks and rises as balls pass: variable compliance, at the speed of the cage.
    let text = rotor(&["left", "right"])
        .replace("preload = { force = \"300 N\" }", "preload = { force = \"100 N\" }");
    let mut system = system(&text);
    let places = |system: &System| -> Vec<f64> {
        let (_, bearing) = system.bearings().next().unwrap();
        bearing.outputs().balls.iter().map(|ball| ball.azimuth).collect()
    };
    let start = places(&system);
    system.advance(10e-3).unwrap();
    let (_, bearing) = system.bearings().next().unwrap();
    let outputs = bearing.outputs();
    let turned = outputs.cage_speed * 10e-3;
    for (before, after) in start.iter().zip(places(&system)) {
        let way = (after - before - turned).rem_euclid(std::f64::consts::TAU);
        assert!(way.min(std::f64::consts::TAU - way) < 1e-6, "{way} {turned}");
    }
    assert!((outputs.cage_speed / outputs.rolling_speed - 1.0).abs() < 1e-3);
}

#[test]
fn closed_form_what_needs_states_is_refused_by_its_key() {
    let refuse = |set: &str| {
        let text = rotor(&["left"]).replacen(
            "[bearing.set]\neffects = { creep = \"saturated\", heathcote_slip = false }\n",
            set,
            1,
        );
        SystemScene::parse(&text, None, std::path::Path::new(".")).map(drop).map_err(|why| why.to_string())
    };
    refuse("[bearing.set]\n").unwrap();
    for (set, key) in [
        ("effects = { mean_outputs = true }", "effects.mean_outputs"),
        ("effects = { heat_outputs = true }", "effects.heat_outputs"),
        ("form = { inner = [{ order = 3, amplitude = \"1 um\", phase = 0 }] }", "form"),
        ("solver = { method = \"esdirk3\" }", "solver.method"),
    ] {
        let why = refuse(&format!("[bearing.set]\n{set}\n")).unwrap_err();
        assert!(why.contains(key) && why.contains("left") && why.contains("equilibrium"), "{why}");
    }
}

#[test]
fn invariant_a_gearbox_on_bearings_without_states_starts_in_balance() {
    let text = GEARBOX.replace("[[bearing]]\n", "[[bearing]]\nlevel = \"equilibrium\"\n");
    let scene = scene(&text);
    let mut system = System::new(&scene).unwrap();
    let start = forces(&system);
    let largest = start.iter().map(Vector3::norm).fold(0.0, f64::max);
    system.advance(2e-3).unwrap();
    for (now, then) in forces(&system).iter().zip(&start) {
        assert!((now - then).norm() < 0.02 * largest, "{now} {then}");
    }
}

#[test]
fn regression_work_of_the_integrator_is_counted_without_states_too() {
    // It stood with bearings that have states, and a machine without any told of no iterations.
    let work = |without: &[&str]| -> Vec<_> {
        let mut system = system(&rotor(without));
        system.advance(1e-3).unwrap();
        system.bearings().map(|(_, bearing)| bearing.state().statistics).collect()
    };
    for without in [vec!["left"], vec!["left", "right"]] {
        let all = work(&without);
        assert!(all[0].steps > 10 && all[0].newton.iterations >= all[0].steps, "{without:?}: {all:?}");
        assert_eq!((all[0].steps, all[0].newton.iterations), (all[1].steps, all[1].newton.iterations));
        let rejected = |of: &Statistics| (of.rejected_error, of.rejected_newton, of.second_guesses);
        assert_eq!(rejected(&all[0]), rejected(&all[1]));
        assert_eq!(all[0].contact_values, 0);
    }
}

#[test]
fn published_number_the_three_stage_gearbox_keeps_its_ratio_without_states() {
    let text = cheap(THREE_STAGE);
    let mut system = system(&text);
    let start: Vec<f64> = system.outputs().links.iter().take(3).map(|link| link.teeth.normal_force).collect();
    let (mut torque, mut normal, mut count) = (0.0, [0.0; 3], 0.0);
    for look in 1..=200 {
        system.advance(5e-3 * f64::from(look) / 200.0).unwrap();
        if look > 80 {
            let outputs = system.outputs();
            torque += outputs.shafts[0].torque;
            normal.iter_mut().zip(&outputs.links).for_each(|(sum, link)| *sum += link.teeth.normal_force);
            count += 1.0;
        }
    }
    // By the numbers of teeth, from 500 N m out; friction of bearings takes 0.4 % (2.8 W of 690).
    let hand = 500.0 * (23.0 / 67.0) * (13.0 / 76.0) * (14.0 / 87.0);
    assert!((torque / count / hand - 1.0).abs() < 0.01, "{} {hand}", torque / count);
    for (mean, start) in normal.iter().zip(&start) {
        assert!((mean / count / start - 1.0).abs() < 0.01, "{} {start}", mean / count);
    }
}

/// All bearings of the catalogue in a machine without states.
fn cheap(text: &str) -> String {
    let line = |line: &str| match line.starts_with("catalogue = ") {
        true => format!("{line}\nlevel = \"equilibrium\"\n"),
        false => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// \[s] CPU time of this thread's process so far.
fn cpu() -> f64 {
    // The 14th and 15th number after the name, in hundredths of a second.
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    let (_, rest) = stat.rsplit_once(')').unwrap();
    let ticks: f64 =
        rest.split_whitespace().skip(11).take(2).map(|ticks| ticks.parse::<f64>().unwrap()).sum();
    ticks / 100.0
}

/// Motions of a machine without states are those of its shafts on what bearings give way and damp: none of balls.
#[test]
fn independent_motions_without_states_are_those_of_a_shaft_with_them() {
    let motions = |text: &str| {
        let motions = system(text).motions().unwrap();
        assert!(motions.iter().all(|motion| !motion.grows()), "{motions:?}");
        motions
    };
    let (all, own) = (motions(ROTOR), motions(&rotor(&["left", "right"])));
    assert!(own.iter().all(|motion| motion.balls == 0.0), "{own:?}");
    // Those of the shaft, but for the ones that are beyond what balls follow at once.
    let of_shaft = || own.iter().filter(|motion| motion.frequency < 3e3);
    assert!(of_shaft().count() >= 4, "{own:?}");
    for motion in of_shaft() {
        let apart = |other: &Motion| (other.frequency / motion.frequency - 1.0).abs();
        let nearest = all.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap();
        assert!(apart(nearest) < 0.02, "{motion:?} {nearest:?}");
    }
    // Beside a bearing with states, too.
    let mixed = motions(&rotor(&["left"]));
    let lowest = |of: &[Motion]| of.iter().map(|motion| motion.frequency).fold(f64::INFINITY, f64::min);
    assert!((lowest(&mixed) / lowest(&own) - 1.0).abs() < 0.05, "{mixed:?}");
}

/// Default steps of machines without states are those of their shafts: few, and histories within the promise of 2 %.
#[test]
fn convergence_default_steps_keep_histories_of_fine_ones_without_states() {
    for (text, end) in [(cheap(GEARBOX), 10e-3), (cheap(THREE_STAGE), 4e-3)] {
        let run = |text: &str| {
            let mut system = system(text);
            let looks = (1..=40).map(|look| end * f64::from(look) / 40.0);
            let histories: Vec<_> = looks
                .map(|time| {
                    system.advance(time).unwrap();
                    forces(&system)
                })
                .collect();
            (histories.concat(), system.statistics().steps)
        };
        let (own, steps) = run(&text);
        let (fine, of_fine) = run(&format!("{text}\n[solver]\naccuracy = \"reference\"\n"));
        let square = |of: &[Vector3<f64>]| of.iter().map(Vector3::norm_squared).sum::<f64>();
        let apart: Vec<_> = own.iter().zip(&fine).map(|(own, fine)| own - fine).collect();
        let error = (square(&apart) / square(&fine)).sqrt();
        assert!(error < 5e-3, "{error:.2e}");
        assert!(10 * steps < of_fine, "{steps} of {of_fine}");
    }
}

/// Prints what a second of a machine costs in communication steps of 50 us, and its longest.
#[test]
#[ignore = "a measurement: cargo nextest run --release --test shaft --run-ignored only cost_ --no-capture"]
fn cost_a_second_of_machines_at_each_level() {
    let machines = [("rotor", ROTOR), ("pinion", GEARBOX), ("three_stage", THREE_STAGE)];
    for (name, text) in machines {
        for (level, text, end) in [("equilibrium", cheap(text), 0.2), ("dynamic", text.to_string(), 0.01)] {
            let mut system = system(&text);
            let (mut longest, mut time) = (0.0f64, 0.0);
            let begin = cpu();
            while time < end {
                time += 50e-6;
                let before = std::time::Instant::now();
                system.advance(time).unwrap();
                longest = longest.max(before.elapsed().as_secs_f64());
            }
            let spent = (cpu() - begin) / end;
            let work = system.bearings().next().unwrap().1.state().statistics;
            println!(
                "{name} {level}: {spent:.3} CPU s per s, {:.4} per bearing; {:.2} us a step of {:.2} us, longest 50 us {:.1} us; {work:?}",
                spent / system.bearings().count() as f64,
                spent * end / work.steps as f64 * 1e6,
                end / work.steps as f64 * 1e6,
                longest * 1e6,
            );
        }
    }
}

/// Prints how long communication steps of 50 us take without states, over a million of them, and 50,000 of a gearbox: what hardware in the loop has to wait for.
#[test]
#[ignore = "a measurement: cargo nextest run --release --test shaft --run-ignored only cost_longest --no-capture"]
fn cost_longest_of_a_million_steps() {
    for (name, text, steps) in [("rotor", ROTOR, 1_000_000), ("three_stage", THREE_STAGE, 50_000)] {
        let mut system = system(&cheap(text));
        let (mut micros, mut corrections): (Vec<f64>, Vec<u64>) = (vec![], vec![]);
        for step in 1..=steps {
            let done = system.statistics().newton.iterations;
            let begin = std::time::Instant::now();
            system.advance(50e-6 * f64::from(step)).unwrap();
            micros.push(1e6 * begin.elapsed().as_secs_f64());
            corrections.push(system.statistics().newton.iterations - done);
        }
        micros.sort_by(f64::total_cmp);
        let at = |share: f64| micros[(share * (micros.len() - 1) as f64) as usize];
        let largest = corrections.iter().max().unwrap();
        let mean = corrections.iter().sum::<u64>() as f64 / corrections.len() as f64;
        let steps = system.statistics().steps;
        println!(
            "{name}: {steps} steps; 50 us take {:.1} us in the middle, {:.1} in 1 of 1000, {:.1} in 1 of 100,000, at most {:.1}; Newton corrections {mean:.2} in the mean, at most {largest}; {:?}",
            at(0.5),
            at(0.999),
            at(0.99999),
            at(1.0),
            system.statistics()
        );
    }
}
