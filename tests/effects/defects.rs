//! Spalls of races against independent data (tests/data/effects/README.md), closed forms and invariants.

use std::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};
use roulement::contact::many::ContactGroup;
use roulement::contact::pair::PairForces;
use roulement::contact::{BallMotion, RaceMotion};
use roulement::effects::reports::Frequencies;
use roulement::model::bodies::Race;
use roulement::model::{Conditions, Model};
use roulement::scene::Scene;
use roulement::simulation::Simulation;

use crate::kernel::assert_derivatives_are_differences;

/// A 6206 as the data have it, its inner race held or loaded along y.
const BEARING: &str = "[bearing]\nballs = 9\nball_diameter = 9.525e-3\npitch_diameter = 46e-3\ninner_conformity = 0.52\n\
                       outer_conformity = 0.53\ndiametral_clearance = 10e-6\n";

fn table(text: &str) -> Vec<Vec<&str>> {
    text.lines().skip(1).map(|line| line.split(',').collect()).collect()
}

fn defect(on: &str, [length, width, depth]: [f64; 3], azimuth: f64) -> String {
    format!(
        "[[defect]]\non = \"{on}\"\nlength = {length:e}\nwidth = {width:e}\ndepth = {depth:e}\nazimuth = {azimuth}\n"
    )
}

#[test]
fn independent_data_drop_over_a_spall_is_that_of_boundary_elements() {
    let rows = table(include_str!("../data/effects/spall_elastic.csv"));
    let mut worst = 0.0f64;
    for row in &rows {
        let [length, width, depth, load, place, drop] =
            [2, 3, 4, 7, 11, 12].map(|i| row[i].parse::<f64>().unwrap());
        let text = format!(
            "{BEARING}[effects]\ncreep = \"frictionless\"\n[load]\n{}",
            defect(row[1], [length, width, depth], 0.3)
        );
        let model = Model::new(&Scene::parse(&text).unwrap()).unwrap();
        let contact = model.contact(Race::Outer, &Conditions::of_friction(0.0));
        let race = RaceMotion::resting(Vector3::zeros(), Vector3::x(), Vector3::y());
        let raceway = &model.bearing.outer;
        let bottom = raceway.groove_circle_radius + raceway.groove_radius;
        // Place of the ball at an arc from the middle, and how deep it has to go for the load.
        let depth_at = |arc: f64| {
            let angle = 0.3 + arc / bottom;
            let load_at = |deep: f64| {
                let radius = bottom - model.bearing.ball.radius + deep;
                let position = Vector3::new(0.0, angle.cos(), angle.sin()) * radius;
                contact.evaluated(&BallMotion { position, ..BallMotion::at_rest() }, &race).load
            };
            let (mut low, mut high) = (0.0, 5e-5);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if load_at(middle) < load { low = middle } else { high = middle }
            }
            low
        };
        let ours = depth_at(place) - depth_at(0.02);
        worst = worst.max((ours - drop).abs());
        assert!((ours - drop).abs() < 1.3e-6, "{row:?}: {ours:e}");
    }
    println!("{} places, worst {worst:.2e} m", rows.len());
    assert!(rows.len() > 60);
}

#[test]
fn independent_data_frequencies_of_damage() {
    for row in table(include_str!("../data/effects/defect_frequencies.csv")) {
        let x: Vec<f64> = row[1..].iter().map(|cell| cell.parse().unwrap()).collect();
        let (angle, inner, outer) = (x[0], x[1], x[2]);
        let (balls, ratio) = match row[0] {
            "6206" => (9, 9.525 / 46.0),
            "7206" => (13, 9.525 / 46.0),
            "209" => (9, 12.7 / 65.0),
            "218" => (16, 22.23 / 125.26),
            other => panic!("{other}"),
        };
        let cage = 0.5 * (inner * (1.0 - ratio * angle.cos()) + outer * (1.0 + ratio * angle.cos()));
        let ours = Frequencies::new([cage, inner, outer].map(|turns| TAU * turns), balls, ratio, angle.cos());
        for (ours, theirs) in
            [(ours.cage, x[3].abs()), (ours.outer, x[4]), (ours.inner, x[5]), (ours.ball, x[6])]
        {
            assert!((ours - theirs).abs() < 1e-9 * theirs.max(1.0), "{row:?}: {ours}");
        }
    }
}

/// An angular-contact bearing under thrust by displacement, every ball loaded, with a spall on a race.
fn running(on: &str, solver: &str, duration: &str) -> Scene {
    let bearing = BEARING.replace("diametral_clearance = 10e-6", "contact_angle = \"25 deg\"");
    let text = format!(
        "{bearing}[effects]\ncreep = \"saturated\"\ndamping = \"0.5 s/m\"\n{solver}[load]\ninner_speed = \"3000 rpm\"\n\
         x = {{ displacement = \"10 um\" }}\nduration = \"{duration}\"\n{}",
        defect(on, [1e-3, 3e-3, 1e-4], 0.2)
    );
    Scene::parse(&text).unwrap()
}

#[test]
fn closed_form_impacts_are_as_frequent_as_balls_pass_the_spall() {
    for (on, of) in [("outer", 0), ("inner", 1)] {
        let scene = running(on, "", "45 ms");
        let mut simulation = Simulation::new(&scene).unwrap();
        let interval = 1e-5;
        let mut force = vec![simulation.outputs().outer.wrench.force.x];
        let mut frequencies = 0.0;
        for i in 1..=4500u32 {
            simulation.advance(f64::from(i) * interval).unwrap();
            let outputs = simulation.outputs();
            force.push(outputs.outer.wrench.force.x);
            frequencies += [outputs.frequencies.outer, outputs.frequencies.inner][of] / 4500.0;
        }
        // A ball over the spall carries nothing: the thrust falls through the middle between all balls and one less.
        let [least, most] = [f64::min, f64::max].map(|f| force.iter().copied().reduce(f).unwrap());
        let mut sorted = force.clone();
        sorted.sort_by(f64::total_cmp);
        let usual = sorted[force.len() / 2];
        let level = usual * (1.0 - 0.5 / 9.0);
        assert!(usual - least > 0.1 * usual && most - usual < 2.0 * usual, "{least} {usual} {most}");
        let mut falls: Vec<f64> = vec![];
        for (i, pair) in force.windows(2).enumerate() {
            if pair[0] >= level && pair[1] < level {
                let time = (i as f64 + (pair[0] - level) / (pair[0] - pair[1])) * interval;
                // Not when what the impact left behind still rings.
                if falls.last().is_none_or(|last| time - last > 0.5 / frequencies) {
                    falls.push(time);
                }
            }
        }
        let between = (falls[falls.len() - 1] - falls[0]) / (falls.len() - 1) as f64;
        let error = between * frequencies - 1.0;
        println!(
            "{on}: {} impacts, interval {between:.6} s, 1/{frequencies:.4} Hz, off by {error:.1e}",
            falls.len()
        );
        assert!(falls.len() >= 7 && error.abs() < 1e-3, "{on}: {error}");
    }
}

#[test]
fn invariant_half_the_step_gives_the_same_peak_and_no_step_jumps_over_a_spall() {
    let peak = |interval: f64| {
        let mut simulation = Simulation::new(&running("outer", "", "8 ms")).unwrap();
        let count = (8e-3 / interval).round() as u32;
        let mut peak = 0.0f64;
        for i in 1..=count {
            simulation.advance(f64::from(i) * interval).unwrap();
            let loads = simulation.outputs().balls.iter().map(|ball| ball.outer.load);
            peak = loads.fold(peak, f64::max);
        }
        peak
    };
    let [whole, half] = [4e-6, 2e-6].map(peak);
    println!("peak {whole:.2} N, with half the step {half:.2} N");
    assert!((whole / half - 1.0).abs() < 0.02, "{whole} {half}");
    // Left alone, steps near the spall are a third of a contact's half width, and larger elsewhere.
    let scene =
        running("outer", "[solver]\nmax_step = 2e-4\ninitial_step = 1e-5\ntolerance = 1e-2\n", "50 ms");
    let mut simulation = Simulation::new(&scene).unwrap();
    let spall = 0.2;
    let (mut last, mut near) = (0u64, 0u32);
    for i in 1..=400u32 {
        let azimuth = |simulation: &Simulation| {
            let balls = &simulation.outputs().balls;
            balls.iter().map(|ball| (ball.azimuth - spall).abs()).fold(f64::INFINITY, f64::min)
        };
        let before = azimuth(&simulation);
        simulation.advance(f64::from(i) * 4e-5).unwrap();
        let after = azimuth(&simulation);
        let steps = simulation.outputs().statistics.steps;
        // 3.5 m/s over 0.1 mm: 8 us.
        if before < 0.015 && after < 0.015 {
            near += 1;
            assert!(steps - last >= 4, "{} steps in 40 us over the spall", steps - last);
        }
        last = steps;
    }
    assert!(near >= 2, "{near}");
}

#[test]
fn invariant_energy_of_balls_that_drop_into_spalls_is_that_of_the_work_in_the_limit_of_small_steps() {
    // Eight impacts, and so little friction that their energy counts. Forces are the slopes of the energy (below): what is left is that of
    // the steps in time.
    let imbalance = |step: f64| {
        let scene = running("outer", &format!("[solver]\nmax_step = {step:e}\n"), "20 ms");
        let mut simulation = Simulation::new(&scene).unwrap();
        let before = simulation.outputs().stored_energy;
        simulation.advance(20e-3).unwrap();
        let after = simulation.outputs();
        (after.stored_energy - before + after.dissipated - after.work) / after.work
    };
    let [coarse, fine] = [4e-6, 1e-6].map(imbalance);
    println!("imbalance {coarse:.1e} in steps of 4 us, {fine:.1e} of 1 us");
    assert!(fine.abs() < 1e-4 && coarse.abs() > 4.0 * fine.abs(), "{coarse:e} {fine:e}");
}

#[test]
fn invariant_lanes_are_single_balls_to_the_bit_and_derivatives_are_differences() {
    for on in ["outer", "inner"] {
        let simulation = Simulation::new(&running(on, "", "1 ms")).unwrap();
        let race = if on == "outer" { Race::Outer } else { Race::Inner };
        let contact = simulation.model().contact(race, &Conditions::of_friction(0.08));
        let seen = simulation.state().race(race).motion();
        let first = simulation.state().balls[0].motion();
        // Ball 1 at places before, over and behind the spall, 3 um deeper so that it still carries something there.
        let out = if on == "outer" { 4e-6 } else { -4e-6 };
        let at = |azimuth: f64| {
            let turn = UnitQuaternion::new(Vector3::x() * azimuth);
            let position = turn * (first.position + Vector3::new(0.0, out, 0.0));
            BallMotion {
                position,
                velocity: turn * first.velocity,
                angular_velocity: turn * first.angular_velocity,
            }
        };
        let motions: Vec<_> = (0..24).map(|i| at(0.1 + 0.008 * f64::from(i))).collect();
        let alone: Vec<_> = motions.iter().map(|motion| contact.evaluated(motion, &seen)).collect();
        assert!(alone.iter().filter(|contact| contact.load > 0.0).count() > 12);
        for (some, alone) in motions.chunks(4).zip(alone.chunks(4)) {
            let mut together = ContactGroup::filled(&alone[0]);
            together.evaluate(&contact, &seen, &BallMotion::of_balls(some));
            for (lane, alone) in alone.iter().enumerate() {
                assert_eq!(together.contact(lane), *alone);
            }
        }
        for ball in &motions {
            assert_derivatives_are_differences(&contact, ball, &seen, 1e-10, [1e-4, 1e-3]);
        }
    }
}

#[test]
fn a_ball_that_starts_over_a_spall_is_in_balance_there() {
    // The first ball stands over it, and the others take its load.
    let text = running("outer", "", "1 ms").source.replace("azimuth = 0.2", "azimuth = 0");
    let text = text.replace("displacement = \"10 um\"", "force = 500");
    let scene = Scene::parse(&text).unwrap();
    let outputs = Simulation::new(&scene).unwrap().outputs().clone();
    let loads: Vec<f64> = outputs.balls.iter().map(|ball| ball.outer.load).collect();
    assert!(loads[0] < 0.2 * loads[4], "{loads:?}");
    let force = outputs.outer.wrench.force.x;
    assert!((force - 500.0).abs() < 5.0, "{force}");
}

#[test]
fn wrong_defects_are_refused_by_key_value_and_range() {
    for (from, to, parts) in [
        ("length = 1e-3", "length = 0", &["defect[0].length = 0", "(0, 0.0047625] m"][..]),
        ("width = 3e-3", "width = 1", &["defect[0].width = 1"]),
        ("depth = 1e-4", "depth = nan", &["defect[0].depth = NaN"]),
        ("azimuth = 0.2", "azimuth = 8", &["defect[0].azimuth = 8", "[-7, 7] rad"]),
        ("on = \"outer\"", "on = \"shaft\"", &["shaft", "inner"]),
        ("azimuth = 0.2", "azimut = 0.2", &["azimut", "did you mean azimuth?"]),
    ] {
        let text = running("outer", "", "1 ms").source;
        assert!(text.contains(from), "{from}");
        let message = Scene::parse(&text.replace(from, to)).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
}

#[test]
fn invariant_forces_over_a_spall_are_the_slopes_of_the_energy() {
    for on in ["outer", "inner"] {
        let text =
            running(on, "", "1 ms").source.replace("saturated", "frictionless").replace("0.5 s/m", "0 s/m");
        let simulation = Simulation::new(&Scene::parse(&text).unwrap()).unwrap();
        let race = if on == "outer" { Race::Outer } else { Race::Inner };
        let contact = simulation.model().contact(race, &Conditions::of_friction(0.0));
        let seen = simulation.state().race(race).motion();
        let first = simulation.state().balls[0].motion();
        let out = if on == "outer" { 4e-6 } else { -4e-6 };
        let mut worst = 0.0f64;
        for i in 0..48 {
            let turn = UnitQuaternion::new(Vector3::x() * (0.1 + 0.004 * f64::from(i)));
            for side in [0.0, 5e-6, -5e-6] {
                let position = turn * (first.position + Vector3::new(side, out, 0.0));
                let at = |offset: Vector3<f64>| {
                    contact.evaluated(
                        &BallMotion { position: position + offset, ..BallMotion::at_rest() },
                        &seen,
                    )
                };
                let here = at(Vector3::zeros());
                for k in 0..3 {
                    let h = 1e-9;
                    let [before, after] =
                        [-h, h].map(|by| PairForces::from(&at(Vector3::ith(k, by))).elastic_energy());
                    let slope = (after - before) / (2.0 * h);
                    // What the stiffness changes with the contact angle is left out of the force, here as everywhere.
                    worst = worst.max((here.force[k] + slope).abs() / 300.0);
                }
            }
        }
        println!("{on}: force and slope of the energy differ by {worst:.1e} of 300 N");
        assert!(worst < 1e-3, "{on}: {worst:e}");
    }
}
