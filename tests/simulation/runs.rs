//! Whole runs: energy, steady loads, symmetry, determinism.

use std::ops::ControlFlow;

use roulement::Inputs;
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::play::{Rows, play};
use roulement::simulation::{Simulation, SimulationError};

use crate::scenes::{HELD, scene};

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const RADIAL: &str = include_str!("../../scenes/radial.toml");
const MISALIGNMENT: &str = include_str!("../../scenes/misalignment.toml");

fn thrust() -> Scene {
    Scene::parse(THRUST).unwrap()
}

fn radial() -> Scene {
    Scene::parse(RADIAL).unwrap()
}

/// Runs a scene by its own script and returns its outputs at every communication point.
fn run(scene: &Scene, points: u32) -> (Simulation, Vec<Outputs>) {
    let mut simulation = Simulation::new(scene).unwrap();
    let interval = simulation.scene().load.output_interval.0;
    let rows = Rows::new(interval, f64::from(points) * interval);
    let mut history = vec![];
    let _: ControlFlow<()> = play(&mut simulation, rows, |simulation| {
        history.push(simulation.outputs().clone());
        ControlFlow::Continue(())
    })
    .unwrap();
    (simulation, history)
}

#[test]
fn invariant_energy_balance_and_work_of_the_thrust_case() {
    let (simulation, history) = run(&thrust(), 500);
    let (first, last) = (&history[0], &history[500]);
    let balance = last.work - last.dissipated - (last.stored_energy - first.stored_energy);
    // Asked for: 1 % of the work; the scheme does far better.
    assert!(balance.abs() < 1e-4 * last.work, "{balance} J of {} J", last.work);
    assert!(last.work > 1.0);
    // Drive power is dissipated power but for the slow change of the balls' own spin.
    let drive = last.inner.drive_torque * last.inner.twist.angular_velocity.x;
    assert!((drive / last.friction_power - 1.0).abs() < 5e-3, "{drive} W, {} W", last.friction_power);
    for ball in &last.balls {
        assert!(ball.inner.power > 0.0 && ball.outer.power > 0.0);
    }
    // One or two corrections a step.
    let s = &simulation.state().statistics;
    assert!(s.newton.iterations as f64 <= 2.5 * s.steps as f64, "{s:?}");
    assert_eq!(s.rejected_newton, 0);
}

#[test]
fn invariant_all_balls_are_alike_under_pure_thrust() {
    let (_, history) = run(&thrust(), 100);
    let balls = &history[100].balls;
    for ball in balls {
        assert!((ball.inner.load / balls[0].inner.load - 1.0).abs() < 1e-9);
        assert!((ball.outer.contact_angle / balls[0].outer.contact_angle - 1.0).abs() < 1e-9);
        assert!((ball.orbital_speed / balls[0].orbital_speed - 1.0).abs() < 1e-9);
    }
}

#[test]
fn invariant_kept_matrices_change_costs_and_not_results() {
    let pose = ("inner.drive", "\"pose\"");
    let (kept, history) = run(&scene(THRUST, &[pose]), 50);
    let (new, reference) = run(&scene(THRUST, &[pose, ("solver.matrix_reuse", "0.0")]), 50);
    let (last, expected) = (&history[50], &reference[50]);
    // Both solve to eight digits of the load or to 1e-6 N in every step, whichever is more.
    assert!((last.inner.wrench.force - expected.inner.wrench.force).norm() < 1e-7 * 1500.0);
    assert!((last.dissipated / expected.dissipated - 1.0).abs() < 1e-7);
    for (ball, other) in last.balls.iter().zip(&expected.balls) {
        assert!((ball.position - other.position).norm() < 1e-10);
    }
    let matrices = |run: &Simulation| run.state().statistics.newton.factorisations;
    assert!(5 * matrices(&kept) < matrices(&new), "{} {}", matrices(&kept), matrices(&new));
}

#[test]
fn regression_rows_of_bodies_serve_several_steps() {
    // The race spins in a load zone that stays. Rows are new where a block of a ball is.
    let new = |reuse: &str| {
        let mut simulation = Simulation::new(&scene(RADIAL, &[("solver.matrix_reuse", reuse)])).unwrap();
        let (mut last, mut new) = (vec![], 0);
        let _: ControlFlow<()> = play(&mut simulation, Rows::new(1e-5, 5e-3), |simulation| {
            let rows = &simulation.state().matrix.border.rows;
            new += u32::from(*rows != last);
            last.clone_from(rows);
            ControlFlow::Continue(())
        })
        .unwrap();
        (new, simulation.state().statistics)
    };
    let ((kept, with), (all, without)) = (new("0.3"), new("0.0"));
    assert!(all >= 500 && 2 * kept < all, "{kept} of {all}");
    // They take no correction more than blocks do alone: a step has 2.7, and 2.0 with nothing kept.
    let more = with.newton.iterations as f64 / with.steps as f64;
    assert!(with.steps == without.steps && more < 2.9, "{with:?} {without:?}");
}

#[test]
fn regression_balls_at_the_edge_of_the_load_zone_cost_few_corrections() {
    // Whether the energy of a step is within its budget may hang on the last digits, in which the two runs below differ.
    let fast = [
        ("solver.accuracy", "\"fast\""),
        ("solver.energy_error", "0"),
        ("solver.tolerance", ""),
        ("solver.max_step", ""),
    ];
    let (repaired, history) = run(&scene(RADIAL, &fast), 100);
    // 4.5 corrections a step; 7.2 where thrown balls were not brought back alone first.
    let statistics = repaired.state().statistics;
    assert!((statistics.newton.iterations as f64) < 5.0 * statistics.steps as f64, "{statistics:?}");
    assert_eq!(statistics.rejected_newton, 0);
    let nothing_kept = [&fast[..], &[("solver.matrix_reuse", "0.0")]].concat();
    let (all, reference) = run(&scene(RADIAL, &nothing_kept), 100);
    assert_eq!(all.state().statistics.steps, statistics.steps);
    let (last, expected) = (&history[100], &reference[100]);
    // Both solve to eight digits of the load or to 1e-6 N in every step, whichever is more.
    assert!((last.inner.pose.position - expected.inner.pose.position).norm() < 1e-12);
    // A ball that leaves the load zone takes along what its last step there left: a speed, at most the tolerance times the step over its mass.
    let model = repaired.model();
    let largest = last.balls.iter().map(|ball| ball.inner.load).fold(0.0, f64::max);
    let time = repaired.time();
    let drift = 1e-8 * largest * (time / statistics.steps as f64) / model.bearing.ball.mass * time;
    for (ball, other) in last.balls.iter().zip(&expected.balls) {
        let bound = if ball.inner.load > 0.0 { 1e-11 } else { drift };
        assert!((ball.position - other.position).norm() < bound, "{bound}");
    }
}

#[test]
fn closed_form_steady_thrust_load_and_race_speed() {
    // Where spin slides on both races, nothing but contact damping ends the axial swing of the start; here it sticks on one.
    let (_, history) = run(&scene(THRUST, &[("start.spin_balance", "false")]), 500);
    let last = &history[500];
    assert!((last.inner.wrench.force.x + 1500.0).abs() < 1e-3, "{}", last.inner.wrench.force.x);
    assert!((last.inner.twist.angular_velocity.x - 200.0 * std::f64::consts::PI).abs() < 1e-8);
    let axial: f64 = last.balls.iter().map(|b| b.inner.load * b.inner.contact_angle.sin()).sum();
    // What the normal loads leave of the thrust is carried by lateral creep forces, at most mu Q.
    assert!((axial - 1500.0).abs() < 0.08 * 10.0 * last.balls[0].inner.load);
}

#[test]
fn invariant_both_drives_agree_on_the_steady_loads() {
    let (_, wrench) = run(&thrust(), 300);
    let last = &wrench[300];
    // The same bearing held where the wrench-driven one settled.
    let place = format!("{{ displacement = {:e} }}", last.inner.pose.position.x);
    let held = scene(THRUST, &[("inner.drive", "\"pose\""), ("load.x", &place)]);
    let (_, pose) = run(&held, 300);
    let other = &pose[300];
    let relative = |a: f64, b: f64| (a / b - 1.0).abs();
    assert!(relative(other.inner.wrench.force.x, last.inner.wrench.force.x) < 5e-3);
    for (a, b) in other.balls.iter().zip(&last.balls) {
        assert!(relative(a.inner.load, b.inner.load) < 5e-3);
        assert!(relative(a.outer.load, b.outer.load) < 5e-3);
    }
    assert!(relative(other.inner.drive_torque, last.inner.drive_torque) < 5e-3);
}

#[test]
fn invariant_dynamic_loads_lie_near_the_quasi_static_ones() {
    for scene in [thrust(), radial()] {
        let (simulation, history) = run(&scene, 300);
        let solve = |gyroscopic| {
            let input = EquilibriumInput::from_scene(&scene, gyroscopic);
            equilibrium::solve(simulation.model(), &input).unwrap()
        };
        let (control, none) = (solve(Gyroscopic::OuterRaceControl), solve(Gyroscopic::None));
        let largest =
            |e: &equilibrium::Equilibrium| e.balls.iter().map(|b| b.report.inner_load).fold(0.0, f64::max);
        let band = (largest(&control) - largest(&none)).abs() + 0.01 * largest(&none);
        // Balls travel through the load zone: the largest load ever seen is the one under the load.
        let seen =
            history[200..].iter().flat_map(|o| o.balls.iter().map(|b| b.inner.load)).fold(0.0, f64::max);
        assert!((seen - largest(&none)).abs() < band, "{seen} N, {} N", largest(&none));
    }
}

#[test]
fn closed_form_cage_speed_of_the_radial_case() {
    let (simulation, history) = run(&radial(), 300);
    let expected = simulation.model().bearing.epicyclic_speed(0.0, 200.0 * std::f64::consts::PI, 0.0);
    let mean = history[100..].iter().map(|o| o.cage_speed).sum::<f64>() / 201.0;
    assert!((mean / expected - 1.0).abs() < 1e-3, "{mean} {expected}");
}

#[test]
fn invariant_reruns_and_snapshots_give_the_same_bits() {
    let (mut one, history) = run(&radial(), 40);
    let (_, again) = run(&radial(), 40);
    assert_eq!(history, again);
    let snapshot = one.snapshot();
    let interval = one.scene().load.output_interval.0;
    one.advance(41.0 * interval).unwrap();
    one.advance(42.0 * interval).unwrap();
    // In another instance, which never was at that point.
    let mut other = Simulation::new(one.scene()).unwrap();
    assert!(other.restore(&snapshot));
    other.advance(41.0 * interval).unwrap();
    other.advance(42.0 * interval).unwrap();
    assert_eq!(one.outputs(), other.outputs());
    assert_eq!(one.state(), other.state());
}

#[test]
fn identity_a_snapshot_in_the_memory_of_an_earlier_one_is_a_new_one() {
    let mut kept = None;
    // Each bearing in the memory of the one before, then in its own.
    for text in [THRUST, include_str!("../../scenes/cage.toml"), RADIAL, MISALIGNMENT] {
        let mut simulation = Simulation::new(&Scene::parse(text).unwrap()).unwrap();
        for point in 1..=3 {
            simulation.advance_scripted(f64::from(point) * 1e-4).unwrap();
            let kept = kept.get_or_insert_with(|| simulation.snapshot());
            simulation.snapshot_into(kept);
            // As bytes, which tell zeros of unlike sign apart.
            let [ours, new] = [&*kept, &simulation.snapshot()].map(|s| postcard::to_allocvec(s).unwrap());
            assert!(ours == new, "{} at point {point}", simulation.scene().title);
        }
    }
}

#[test]
fn invariant_a_restored_state_knows_nothing_of_oblique_rolling_and_goes_on_to_the_same_bits() {
    const INTERVAL: f64 = 1e-4;
    // A race that tips to and fro before it turns: balls roll across their grooves, and then along them.
    let turning = ("load.inner_speed", "[[0, 0], [0.0015, 0], [0.003, 600]]");
    let moved = ("load.ry.rotation", "[[0, 0], [0.0005, 2e-4], [0.001, 0], [0.01, 0]]");
    let driven = ("load.ry.moment", "[[0, 0], [0.0005, 0.5], [0.001, 0], [0.01, 0]]");
    for scene in [scene(MISALIGNMENT, &[turning, moved]), scene(THRUST, &[turning, driven])] {
        let fresh = Simulation::new(&scene).unwrap();
        let mut one = fresh.clone();
        let mut least = vec![];
        for point in 1..=40 {
            let mut other = fresh.clone();
            let snapshot = postcard::to_allocvec(&one.snapshot()).unwrap();
            assert!(other.restore(&postcard::from_bytes(&snapshot).unwrap()));
            let next = f64::from(point) * INTERVAL;
            for simulation in [&mut one, &mut other] {
                simulation.advance_scripted(next).unwrap();
            }
            // As bytes, which tell zeros of unlike sign apart.
            let [ours, restored] = [&one, &other].map(|s| postcard::to_allocvec(&s.snapshot()).unwrap());
            assert!(ours == restored, "{} at {next} s", scene.title);
            let conditions = one.conditions();
            let cosines = one.state().balls.iter().flat_map(|ball| {
                Race::BOTH.map(|race| {
                    let contact = one.model().contact(race, &conditions);
                    contact.evaluated(&ball.motion(), &one.state().race(race).motion()).rolling_cosine.abs()
                })
            });
            least.push(cosines.fold(1.0, f64::min));
        }
        assert!(least[..10].iter().any(|cosine| *cosine < 0.9), "{least:?}");
        assert!(least[35..].iter().all(|cosine| *cosine > 0.999), "{least:?}");
    }
}

#[test]
fn all_creep_laws_run_both_scenes() {
    for law in ["frictionless", "regularised", "saturated"] {
        for text in [THRUST, RADIAL] {
            let scene = scene(text, &[("effects.creep", &format!("\"{law}\""))]);
            let (simulation, history) = run(&scene, 50);
            let last = &history[50];
            assert!(last.inner.wrench.force.norm() > 1000.0, "{law}");
            let s = &simulation.state().statistics;
            assert!(s.rejected_newton * 20 <= s.steps, "{law}: {s:?}");
        }
    }
}

#[test]
fn regression_linear_theory_is_refused_where_it_does_not_hold() {
    let linear = ("effects.creep", "\"linear\"");
    // Balls that stand while a race turns slide: refused at the start.
    let skid = scene(THRUST, &[linear, ("start.orbital_speed", "0.0")]);
    let message = Simulation::new(&skid).unwrap_err().to_string();
    for part in ["at 0 s", "linear", "ball 1", "race", "mu Q", "saturated"] {
        assert!(message.contains(part), "{message}\nshould say {part}");
    }
    // Small spin and creep: friction 2 leaves room for both; a race that stops at once then is refused in its step.
    let room = [linear, ("friction.ball_race", "2.0")];
    let (simulation, history) = run(&scene(THRUST, &room), 50);
    assert!(history[50].inner.wrench.force.norm() > 1000.0);
    let largest = |outputs: &Outputs| {
        let contacts = outputs.balls.iter().flat_map(|ball| [ball.inner, ball.outer]);
        contacts.map(|c| c.force_longitudinal.hypot(c.force_lateral) / (2.0 * c.load)).fold(0.0, f64::max)
    };
    assert!(history.iter().all(|outputs| largest(outputs) <= 1.0));
    let mut slick = simulation;
    let end = slick.time() + 1e-3;
    slick.set_inputs(Inputs { friction: 1e-4, ..*slick.inputs() });
    let failed = slick.advance(end);
    assert!(matches!(failed, Err(SimulationError::BeyondLinear { time, .. }) if time > 0.0 && time < end));
    assert!(slick.time() < end);
    // A standing bearing creeps nowhere.
    let still = scene(THRUST, &[linear, ("load.inner_speed", "0.0")]);
    Simulation::new(&still).unwrap().advance(1e-4).unwrap();
}

#[test]
fn misaligned_outer_race_changes_the_ball_speeds_once_per_orbit() {
    let changes = [&[("outer.misalignment.ry", "\"0.01 deg\"")][..], &HELD].concat();
    let (_, history) = run(&scene(THRUST, &changes), 200);
    let last = &history[200];
    let loads: Vec<f64> = last.balls.iter().map(|b| b.inner.load).collect();
    let (low, high) = loads.iter().fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(*v), h.max(*v)));
    assert!(high > 1.1 * low, "{loads:?}");
    // Once per turn: first harmonic of the load over azimuth beats the second.
    let harmonic = |k: f64| {
        let (c, s) = last.balls.iter().fold((0.0, 0.0), |(c, s), b| {
            (c + b.inner.load * (k * b.azimuth).cos(), s + b.inner.load * (k * b.azimuth).sin())
        });
        c.hypot(s)
    };
    assert!(harmonic(1.0) > 5.0 * harmonic(2.0), "{loads:?}");
}

#[test]
fn steps_that_make_no_sense_are_refused() {
    let mut simulation = Simulation::new(&thrust()).unwrap();
    for end in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(simulation.advance(end), Err(SimulationError::Backwards { .. })));
    }
    assert_eq!(simulation.time(), 0.0);
}

#[test]
fn closed_form_counter_rotating_rings_leave_the_cage_nearly_at_rest() {
    let (simulation, history) = run(&scene(THRUST, &[("load.outer_speed", "\"-6000 rpm\"")]), 200);
    let last = &history[200];
    let speed = 200.0 * std::f64::consts::PI;
    let angle = 0.5 * (last.balls[0].inner.contact_angle + last.balls[0].outer.contact_angle);
    let expected = simulation.model().bearing.epicyclic_speed(angle, speed, -speed);
    assert!((last.cage_speed - expected).abs() < 1e-2 * speed, "{} {expected}", last.cage_speed);
    assert!((last.outer.twist.angular_velocity.x + speed).abs() < 1e-9);
}

#[test]
fn start_from_rest_reaches_the_epicyclic_speed_without_failures() {
    let speed = "[[0.0, 0.0], [0.02, \"6000 rpm\"]]";
    let (_, history) = run(&scene(THRUST, &[("load.inner_speed", speed)]), 300);
    assert_eq!(history[0].cage_speed, 0.0);
    let last = &history[300];
    assert!(last.cage_slip.abs() < 0.02, "{}", last.cage_slip);
    // Friction only ever takes energy, and the balls only ever gain speed.
    assert!(history.windows(2).all(|pair| pair[1].dissipated >= pair[0].dissipated));
    assert!(history[..200].windows(2).all(|pair| pair[1].cage_speed >= pair[0].cage_speed - 1e-3));
    let balance = last.work - last.dissipated - (last.stored_energy - history[0].stored_energy);
    assert!(balance.abs() < 1e-2 * last.work, "{balance} of {}", last.work);
}

#[test]
fn invariant_outputs_of_the_last_step_are_those_of_its_state() {
    let kalker = scene(THRUST, &[("effects.creep", "\"kalker\"")]);
    let slip = scene(RADIAL, &[("effects.creep", "\"kalker_table\""), ("effects.heathcote_slip", "true")]);
    let [cage, misalignment] =
        [include_str!("../../scenes/cage.toml"), include_str!("../../scenes/misalignment.toml")]
            .map(|text| Scene::parse(text).unwrap());
    for scene in [thrust(), radial(), cage, kalker, slip, misalignment] {
        let mut simulation = Simulation::new(&scene).unwrap();
        for point in 1..=3 {
            simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
            simulation.advance(f64::from(point) * 1.3e-4).unwrap();
            let (model, state) = (simulation.model(), simulation.state());
            let afresh = Outputs::new(model, state, &simulation.conditions());
            assert_eq!(*simulation.outputs(), afresh, "{}", simulation.scene().title);
        }
    }
}

#[test]
fn invariant_outputs_are_those_of_their_point_whenever_they_are_asked_for() {
    let friction = scene(THRUST, &[("inner.drive", "\"pose\"")]);
    let tuned = scene(THRUST, &[("inner.drive", "\"pose\""), ("effects.damping", "\"0.1 s/m\"")]);
    let mut asked = Simulation::new(&friction).unwrap();
    asked.advance(1.3e-4).unwrap();
    let mut silent = Simulation::new(&friction).unwrap();
    silent.advance(1.3e-4).unwrap();
    let expected = asked.outputs().clone();
    // Inputs and parameters of the next step are not those that led here.
    silent.set_inputs(Inputs { friction: 0.02, ..*silent.inputs() });
    assert_eq!(*silent.clone().outputs(), expected);
    silent.tune(&tuned);
    assert_eq!(*silent.outputs(), expected);
    // A step that fails leaves the outputs of where it ended.
    let mut inputs = *asked.inputs();
    inputs.inner.pose.position.x = f64::NAN;
    asked.set_inputs(inputs);
    assert!(asked.advance(2e-4).is_err());
    assert_eq!(asked.outputs().time, asked.time());
    assert_eq!(asked.outputs().balls[0].position, asked.state().balls[0].position);
}

#[test]
fn invariant_what_is_not_a_number_is_never_a_solution() {
    let mut simulation = Simulation::new(&Scene::parse(THRUST).unwrap()).unwrap();
    for direction in 0..3 {
        let before = simulation.state().clone();
        let mut inputs = *simulation.inputs();
        inputs.inner.applied.force[direction] = f64::NAN;
        simulation.set_inputs(inputs);
        assert!(simulation.advance(simulation.time() + 1e-5).is_err(), "force {direction}");
        let state = simulation.state();
        assert_eq!((state.time, &state.balls), (before.time, &before.balls));
        simulation = Simulation::new(&Scene::parse(THRUST).unwrap()).unwrap();
    }
}

/// Balls without friction under tilt and centrifugal force: nothing is put in but what the changing stiffness of contacts does.
#[test]
fn invariant_energy_closes_without_friction_at_any_contact_angle() {
    let scene = scene(
        THRUST,
        &[
            ("effects.creep", "\"frictionless\""),
            ("effects.damping", ""),
            ("bearing.contact_angle", ""),
            ("bearing.diametral_clearance", "\"-1 um\""),
            ("load.x", "{ force = 130 }"),
            ("load.y", "{ force = 440 }"),
            ("load.ry", "{ rotation = 0.0009 }"),
            ("load.inner_speed", "4000"),
            ("load.duration", "\"2 ms\""),
            ("solver", "{ max_step = \"0.2 us\", tolerance = 1e-9 }"),
        ],
    );
    let mut simulation = Simulation::new(&scene).unwrap();
    let stored = simulation.outputs().stored_energy;
    simulation.advance_scripted(2e-3).unwrap();
    let last = simulation.outputs();
    let balance = last.work - last.dissipated - (last.stored_energy - stored);
    // The stiffness of the contacts alone put in 40 times as much.
    assert!(
        last.work.abs() > 1e-7 && balance.abs() < 0.025 * last.work.abs(),
        "{balance:e} of {:e}",
        last.work
    );
}

/// A thrust that halves within 0.1 ms, with steps that are long for the bounce that follows.
const LET_GO: &str = "[bearing]\nballs = 12\nball_diameter = \"33 mm\"\npitch_diameter = \"153 mm\"\ncontact_angle = \"39 deg\"\n\
    [friction]\nball_race = 0.018\n[effects]\ncreep = \"kalker_table\"\ndamping = 0.05\n\
    [inner]\ndrive = \"wrench\"\nmass = 58\ninertia = [0.34, 0.21, 0.21]\n[solver]\naccuracy = \"fast\"\n\
    [load]\nduration = \"5 ms\"\noutput_interval = \"0.1 ms\"\ninner_speed = -77\ny = { force = 3700 }\n\
    x = { force = [[0, 103e3], [\"2 ms\", 103e3], [\"2.1 ms\", 51.5e3]] }\n";

#[test]
fn invariant_energy_closes_where_steps_look_at_it() {
    // Where one run ends turns on its last digits: the mean of nine neighbours does not.
    let open = |change: (&str, &str)| {
        let mut sums = (0.0, 0);
        for across in ["3000", "3700", "4400"] {
            for left in ["45e3", "51.5e3", "58e3"] {
                let thrust = format!("{{ force = [[0, 103e3], [\"2 ms\", 103e3], [\"2.1 ms\", {left}]] }}");
                let across = format!("{{ force = {across} }}");
                let changes = [change, ("load.x", &*thrust), ("load.y", &*across)];
                let (simulation, history) = run(&scene(LET_GO, &changes), 50);
                let last = simulation.outputs();
                let stored = last.stored_energy - history[0].stored_energy;
                let balance = last.work + last.stiffened - last.dissipated - stored;
                let open = balance.abs() / last.work.abs().max(last.dissipated);
                assert!(open < 0.1, "{open} with {across}, {thrust}");
                sums = (sums.0 + open / 9.0, sums.1 + last.statistics.steps);
            }
        }
        sums
    };
    let (blind, steps) = open(("solver.energy_error", "0"));
    let (looking, more) = open(("solver.energy_error", "0.01"));
    assert!(blind > 0.04, "{blind} in {steps} steps");
    // Steps that follow all of what comes and goes, and those with own losses, are excused (`Energies::error_since`).
    assert!(
        looking < 0.02 && looking < 0.25 * blind && more < 2 * steps,
        "{looking} in {more} steps, {blind} in {steps}"
    );
}
