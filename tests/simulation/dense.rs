//! Dense output: what a run shows between the ends of its steps has the error of the steps, and asking for it moves nothing.

use std::ops::ControlFlow;

use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::play::{Rows, Scripted, play};

fn text(name: &str) -> String {
    let path = format!("{}/scenes/{name}.toml", roulement_tests::ROOT);
    std::fs::read_to_string(path).unwrap()
}

fn scene(name: &str, changes: &[(&str, &str)]) -> Scene {
    Scene::edited(&text(name), changes.iter().copied()).unwrap()
}

/// Rows of a run.
fn rows(scene: &Scene, rows: Rows) -> (Simulation, Vec<Outputs>) {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut seen = vec![];
    let _: ControlFlow<()> = play(&mut simulation, rows, |simulation| {
        seen.push(simulation.outputs().clone());
        ControlFlow::Continue(())
    })
    .unwrap();
    (simulation, seen)
}

/// Heat and means are reported since the last row.
fn without_means(outputs: &Outputs) -> Outputs {
    Outputs { heat: None, means: None, ..outputs.clone() }
}

/// Position, speed, force, torque and power of races and cage, over their sizes.
fn numbers(of: &Outputs, sizes: [f64; 4]) -> Vec<f64> {
    let [length, speed, force, torque] = sizes;
    let at = of.inner.pose.position;
    let loads = of.balls.iter().map(|ball| ball.outer.load / force);
    let own = [
        at.x / length,
        at.y / length,
        at.z / length,
        of.cage_speed / speed,
        of.inner.wrench.force.x / force,
        of.inner.wrench.force.y / force,
        of.friction_torque / torque,
    ];
    own.into_iter().chain(loads).collect()
}

#[test]
fn invariant_rows_leave_the_motion_as_it_is() {
    let duration = 2e-3;
    for name in [
        "thrust",
        "radial",
        "cage",
        "misalignment",
        "effects/loss_of_lubrication",
        "effects/spall",
        "effects/rating",
        "effects/soft_housing",
        "effects/planet_carrier",
    ] {
        let scene = scene(name, &[]);
        let (coarse, of_coarse) = rows(&scene, Rows::new(5e-4, duration));
        let (fine, of_fine) = rows(&scene, Rows::new(7.8125e-6, duration));
        let (one, other) = (coarse.state(), fine.state());
        assert_eq!((&one.balls, &one.bodies), (&other.balls, &other.bodies), "{name}");
        assert_eq!(
            (one.energies, one.rating, one.warm),
            (other.energies, other.rating, other.warm),
            "{name}"
        );
        assert_eq!((one.statistics, &one.supports), (other.statistics, &other.supports), "{name}");
        for (one, other) in of_coarse.iter().zip(of_fine.iter().step_by(64)) {
            assert!(without_means(one) == without_means(other), "{name} {}", one.time);
        }
        assert!(fine.state().statistics.steps < 256 || name != "thrust");
    }
}

#[test]
fn invariant_a_moment_near_the_end_of_a_step_is_that_end() {
    for name in ["thrust", "radial", "cage", "misalignment", "effects/heat", "effects/spall"] {
        let mut simulation = Simulation::new(&scene(name, &[])).unwrap();
        let mut course = simulation.begin(2e-3).unwrap();
        let mut before = simulation.outputs().clone();
        for _ in 0..20 {
            let start = simulation.time();
            simulation.step(&mut course, start).unwrap();
            let after = simulation.outputs().clone();
            let h = after.time - before.time;
            let force = after.loads().fold(1.0, f64::max);
            let sizes = [1e-6, after.inner.twist.angular_velocity.norm(), force, 1e-2 * force];
            for (time, end) in [(start + 1e-6 * h, &before), (after.time - 1e-6 * h, &after)] {
                simulation.look_back(&mut course, time);
                assert_eq!(simulation.time(), time);
                let seen = simulation.outputs().clone();
                for (seen, of) in numbers(&seen, sizes).into_iter().zip(numbers(end, sizes)) {
                    assert!((seen - of).abs() < 1e-5, "{name} at {time}: {seen} {of}");
                }
                let energies = |of: &Outputs| [of.work, of.dissipated, of.stored_energy];
                for (seen, of) in energies(&seen).into_iter().zip(energies(end)) {
                    assert!((seen - of).abs() < 1e-5 * of.abs() + 1e-9, "{name}: {seen} J, {of} J");
                }
                simulation.look_up(&mut course);
                assert_eq!(simulation.time(), after.time);
            }
            assert!(without_means(simulation.outputs()) == without_means(&after), "{name}");
            before = after;
        }
    }
}

/// A scene whose steps are all of one size.
fn fixed(scene: &Scene, step: f64) -> Scene {
    let mut scene = scene.clone();
    (scene.solver.max_step.0, scene.solver.initial_step.0) = (step, step);
    (scene.solver.tolerance, scene.solver.energy_error) = (1e3, 0.0);
    scene
}

/// Root mean squares over rows, four in a step, of the differences from a reference: of rows where steps end, and of those within.
fn errors(scene: &Scene, step: f64, reference: &[Outputs], sizes: [f64; 4]) -> [f64; 2] {
    let duration = reference.last().unwrap().time;
    let (simulation, rows) = rows(&fixed(scene, step), Rows::new(0.25 * step, duration));
    assert_eq!(
        simulation.state().statistics.steps as f64,
        (duration / step).round(),
        "steps are of one size"
    );
    let every = (reference.len() - 1) / (rows.len() - 1);
    let mut sums = [(0.0, 0); 2];
    for (index, (row, of)) in rows.iter().zip(reference.iter().step_by(every)).enumerate() {
        assert!((row.time - of.time).abs() < 1e-12);
        let (sum, count) = &mut sums[usize::from(index % 4 != 0)];
        for (row, of) in numbers(row, sizes).into_iter().zip(numbers(of, sizes)) {
            (*sum, *count) = (*sum + (row - of).powi(2), *count + 1);
        }
    }
    sums.map(|(sum, count)| (sum / f64::from(count)).sqrt())
}

#[test]
fn order_two_of_rows_within_steps_and_no_more_error_than_at_their_ends() {
    let sizes = [1e-6, 300.0, 100.0, 1e-2];
    let thrust = [
        ("load.x.force", "[[0, 1000], [\"0.4 ms\", 1400], [\"0.8 ms\", 900]]"),
        ("load.inner_speed", "[[0, 600], [\"0.8 ms\", 640]]"),
    ];
    let tilt = [("load.rz.rotation", "[[0, 0], [\"0.4 ms\", 1e-3], [\"0.8 ms\", 0]]")];
    for (name, changes, order) in [
        // Contacts stay closed, and steps resolve what goes on.
        ("thrust", &thrust[..], Some(1.7)),
        ("effects/oil_mist", &[], Some(1.7)),
        // Here they do not.
        ("misalignment", &tilt, None),
        ("effects/heat", &[], None),
        ("effects/growth", &[], None),
        ("effects/rating", &[], None),
        ("effects/stiffness", &[], None),
        ("effects/waviness", &[], None),
    ] {
        let scene = scene(name, changes);
        let duration = 8e-4;
        let (_, reference) = rows(&fixed(&scene, 1.5625e-7), Rows::new(duration / 256.0, duration));
        let found = [2.5e-5, 1.25e-5].map(|step| errors(&scene, step, &reference, sizes));
        println!("{name}: {found:?}");
        for [ends, within] in found {
            // A line between exact ends has an error of its own, of their order.
            assert!(within < 1.4 * ends, "{name}: {within} within steps, {ends} at their ends");
        }
        let of = (found[0][1] / found[1][1]).log2();
        assert!(order.is_none_or(|least| of > least), "{name}: order {of} of rows within steps");
    }
}

#[test]
fn invariant_heat_of_rows_adds_up_to_what_was_lost() {
    let scene = scene("cage", &[("effects.heat_outputs", "true"), ("load.duration", "\"3 ms\"")]);
    let (simulation, rows) = rows(&scene, Rows::new(3e-6, 3e-3));
    let start = rows[0].time;
    assert_eq!(start, 0.0);
    let heat = rows.windows(2).map(|pair| {
        let heat = pair[1].heat.unwrap();
        (heat.inner + heat.outer + heat.balls + heat.cage) * (pair[1].time - pair[0].time)
    });
    let lost = simulation.state().energies.friction;
    assert!((heat.sum::<f64>() / lost - 1.0).abs() < 1e-9, "{lost}");
}

#[test]
fn invariant_rows_leave_the_motion_of_a_shaft_as_it_is() {
    for name in ["shafts/housing", "shafts/pinion"] {
        let scene = MachineScene::parse(&text(name)).unwrap();
        let play = |interval: f64| {
            let mut machine = Machine::new(&scene).unwrap();
            let mut seen = vec![];
            let _: ControlFlow<()> = play(&mut machine, Rows::new(interval, 1e-3), |machine| {
                let of_bearings: Vec<_> =
                    machine.bearings().map(|(_, bearing)| bearing.outputs().clone()).collect();
                seen.push((machine.shaft().unwrap().outputs().clone(), of_bearings));
                ControlFlow::Continue(())
            })
            .unwrap();
            (machine, seen)
        };
        let ((coarse, of_coarse), (fine, of_fine)) = (play(2.5e-4), play(7.8125e-6));
        let state = |machine: &Machine| machine.shaft().unwrap().states()[0].clone();
        assert_eq!(state(&coarse), state(&fine), "{name}");
        for (one, other) in of_coarse.iter().zip(of_fine.iter().step_by(32)) {
            assert!(one == other, "{name} {}", one.0.time);
        }
        // Rings sit where the shaft is, between steps, too.
        for (shaft, bearings) in &of_fine {
            for (seat, bearing) in shaft.seats.iter().zip(bearings) {
                let across = bearing.inner.pose.position.z.abs();
                assert!((seat.displacement.z.abs() - across).abs() < 1e-12, "{name} {}", shaft.time);
            }
        }
    }
}
