//! The method of order 3 ([`roulement::numerics::esdirk`]): its order, its energy, and that a run repeats to the bit.

use std::ops::ControlFlow;

use nalgebra::Vector3;
use roulement::interface::model_description::render;
use roulement::model::state::State;
use roulement::scene::machine::MachineScene;
use roulement::scene::{Groups, Scene};
use roulement::schema::Method;
use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::{Rows, play};
use roulement::simulation::system::Played;

fn text(name: &str) -> String {
    let path = format!("{}/scenes/{name}.toml", roulement_tests::ROOT);
    std::fs::read_to_string(path).unwrap()
}

fn scene(name: &str, changes: &[(&str, &str)]) -> Scene {
    let method = [("solver.method", "\"esdirk3\"")];
    Scene::edited(&text(name), method.iter().chain(changes).copied()).unwrap()
}

/// Place of the inner race over a micrometre, loads of balls over 100 N and the cage's speed over 300 rad/s, after steps of one size.
fn after(scene: &Scene, step: f64, end: f64) -> Vec<f64> {
    let mut scene = scene.clone();
    (scene.solver.max_step.0, scene.solver.initial_step.0) = (step, step);
    (scene.solver.tolerance, scene.solver.energy_error) = (1e3, 0.0);
    let mut simulation = Simulation::new(&scene).unwrap();
    let _: ControlFlow<()> =
        play(&mut simulation, Rows::new(end, end), |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(simulation.state().statistics.steps as f64, (end / step).round(), "steps are of one size");
    let outputs = simulation.outputs();
    let place = outputs.inner.pose.position / 1e-6;
    let loads = outputs.balls.iter().map(|ball| ball.outer.load / 100.0);
    place.iter().copied().chain(loads).chain([outputs.cage_speed / 300.0]).collect()
}

fn distance(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The last row of a run to a time \[s].
fn run(machine: &mut Machine, end: f64) {
    let rows = Rows::new(end, end);
    let _: ControlFlow<()> = play(machine, rows, |_| ControlFlow::Continue(())).unwrap();
}

/// Forces that change with kinks where steps end, a speed that is a constraint and changes, all contacts closed.
const CHANGING: [(&str, &str); 2] = [
    ("load.x.force", "[[0, 1000], [\"0.4 ms\", 1400], [\"0.8 ms\", 900]]"),
    ("load.inner_speed", "[[0, 600], [\"0.4 ms\", 640], [\"0.8 ms\", 620]]"),
];

#[test]
fn order_three_with_constraints_where_contacts_stay_closed() {
    let scene = scene("thrust", &CHANGING);
    let end = 8e-4;
    let reference = after(&scene, 5e-7, end);
    let errors = [1e-5, 5e-6, 2.5e-6].map(|step| distance(&after(&scene, step, end), &reference));
    let orders = [0, 1].map(|k: usize| (errors[k] / errors[k + 1]).log2());
    println!("{errors:?} {orders:?}");
    assert!(orders.iter().all(|order| *order > 2.7), "{orders:?}");
    // The same solution as that of the other method, whose error is larger at the same step.
    let mut other = scene.clone();
    other.solver.method = Method::Hht;
    let of_other = [1e-5, 5e-6].map(|step| distance(&after(&other, step, end), &reference));
    println!("{of_other:?}");
    assert!(of_other[0] > 3.0 * of_other[1] && of_other[0] > 4.0 * errors[0], "{of_other:?}");
}

#[test]
fn invariant_runs_repeat_restore_and_show_rows_to_the_bit() {
    for name in ["radial", "cage", "effects/soft_housing", "effects/heat", "effects/spall", "shafts/pinion"] {
        let scene = method(name);
        let [mut one, mut other] = [0, 1].map(|_| Machine::new(&scene).unwrap());
        run(&mut one, 1e-3);
        let rows = Rows::new(1.7e-5, 1e-3);
        let _: ControlFlow<()> = play(&mut other, rows, |_| ControlFlow::Continue(())).unwrap();
        let states = |machine: &Machine| -> Vec<State> {
            machine
                .bearings()
                .map(|(_, bearing)| State { heat: None, means: None, ..bearing.state().clone() })
                .collect()
        };
        let bodies = |machine: &Machine| -> Vec<_> {
            machine
                .bearings()
                .map(|(_, bearing)| (bearing.state().balls.clone(), bearing.state().energies))
                .collect()
        };
        assert!(bodies(&one) == bodies(&other), "{name}: rows");
        let saved = one.snapshot();
        let mut restored = Machine::new(&scene).unwrap();
        assert!(restored.restore(&saved), "{name}");
        let played = match &scene {
            MachineScene::Shaft(scene) => Played::none(scene),
            MachineScene::Bearing(_) => Played::of_bearing(Groups::default()),
        };
        for machine in [&mut one, &mut restored] {
            machine.advance_with(1.3e-3, &played).unwrap();
        }
        assert!(states(&one) == states(&restored), "{name}: restored");
    }
}

fn method(name: &str) -> MachineScene {
    MachineScene::parse(&text(name)).unwrap().with(|scene| scene.solver.method = Method::Esdirk3)
}

#[test]
fn invariant_energy_is_accounted_for_to_half_a_per_cent() {
    for (name, end) in [("radial", 1e-2), ("cage", 5e-3), ("effects/heat", 5e-3)] {
        let left = [Method::Hht, Method::Esdirk3].map(|method| {
            let scene = MachineScene::parse(&text(name)).unwrap().with(|scene| scene.solver.method = method);
            let mut machine = Machine::new(&scene).unwrap();
            run(&mut machine, end);
            let (_, bearing) = machine.bearings().next().unwrap();
            let of = bearing.outputs();
            let started = Machine::new(&scene).unwrap();
            let stored = started.bearings().next().unwrap().1.outputs().stored_energy;
            let left = of.work + of.stiffened - of.dissipated - (of.stored_energy - stored);
            left.abs() / of.work.abs().max(of.dissipated)
        });
        println!("{name}: {left:?}");
        assert!(left[1] < 5e-3, "{name}: {left:?}");
    }
}

#[test]
fn an_ideal_cage_and_derivatives_are_refused_by_the_key() {
    let ideal = [("solver.method", "\"esdirk3\""), ("effects.cage", "\"ideal\"")];
    let message = Scene::edited(&text("thrust"), ideal).unwrap_err().to_string();
    for part in ["solver.method", "esdirk3", "ideal", "\"hht\""] {
        assert!(message.contains(part), "{message}");
    }
    let mut simulation = Simulation::new(&scene("thrust", &[])).unwrap();
    let inputs = *simulation.inputs();
    let refused = simulation.advance_perturbed(1e-4, &[inputs], Groups::default());
    assert!(refused.unwrap_err().to_string().contains("solver.method"));
    // A package says so.
    let described =
        |scene: &Scene| render(&Simulation::new(scene).unwrap(), "bearing", &|_| true).unwrap().xml;
    let provides = |value: &str| format!("providesDirectionalDerivative=\"{value}\"");
    assert!(described(&scene("thrust", &[])).contains(&provides("false")));
    assert!(described(&Scene::parse(&text("thrust")).unwrap()).contains(&provides("true")));
}

#[test]
fn limit_an_impact_ends_as_by_fine_steps_of_the_other_method() {
    // Balls that a reversal of the load throws from one race to the other.
    let end = 2e-3;
    let fine = |scene: &mut Scene| (scene.solver.tolerance, scene.solver.max_step.0) = (1e-10, 2e-6);
    let load = ("load.y.force", "[[0, 1500], [\"1 ms\", -1500], [\"2 ms\", -1500]]");
    let places = [Method::Hht, Method::Esdirk3].map(|method| {
        let mut scene = scene("radial", &[load]);
        scene.solver.method = method;
        if method == Method::Hht {
            fine(&mut scene);
        } else {
            (scene.solver.tolerance, scene.solver.max_step.0) = (1e-8, 1e-4);
        }
        let mut simulation = Simulation::new(&scene).unwrap();
        let _: ControlFlow<()> =
            play(&mut simulation, Rows::new(end, end), |_| ControlFlow::Continue(())).unwrap();
        (simulation.outputs().inner.pose.position, simulation.state().statistics)
    });
    let [(fine, _), (place, statistics)] = places;
    // It goes through the clearance, some 30 um.
    assert!((place - fine).norm() < 2e-7, "{place} {fine}");
    assert_eq!(statistics.rejected_newton, 0);
}

/// Places of the inner race over the first 5 ms, and contact evaluations a simulated second, one with derivatives counted as three.
fn path(scene: &Scene) -> (Vec<Vector3<f64>>, f64) {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut places = vec![];
    let _: ControlFlow<()> = play(&mut simulation, Rows::new(5e-5, 5e-3), |simulation| {
        places.push(simulation.outputs().inner.pose.position);
        ControlFlow::Continue(())
    })
    .unwrap();
    let counted = simulation.state().statistics;
    (places, (counted.contact_values + 3 * counted.contact_tangents) as f64 / 5e-3)
}

#[test]
fn regression_less_work_or_less_error_than_the_other_method_with_a_tolerance() {
    let oil = [("film", "{ iso_vg = 68, temperature = \"70 degC\" }"), ("effects.creep", "\"kalker_table\"")];
    for (name, changes, [error, work]) in
        [("radial", &[][..], [0.3, 0.75]), ("radial", &oil, [0.3, 0.75]), ("cage", &[], [0.5, 0.85])]
    {
        let scene = scene(name, changes);
        let with = |method: Method, step: f64, tolerance: f64| {
            let mut scene = scene.clone();
            scene.solver.method = method;
            (scene.solver.max_step.0, scene.solver.initial_step.0) = (step, step.min(1e-6));
            (scene.solver.tolerance, scene.solver.energy_error, scene.solver.unresolved) =
                (tolerance, 0.0, 0.0);
            path(&scene)
        };
        let (reference, _) = with(Method::Esdirk3, 5e-7, 1e-10);
        let size: f64 = reference.iter().map(Vector3::norm_squared).sum();
        let judged = |method, tolerance| {
            let (places, work) = with(method, 2e-4, tolerance);
            let missed: f64 =
                places.iter().zip(&reference).map(|(place, of)| (place - of).norm_squared()).sum();
            ((missed / size).sqrt(), work)
        };
        let table = [1e-7, 1e-8, 1e-9].map(|tolerance| {
            let of = [Method::Hht, Method::Esdirk3].map(|method| judged(method, tolerance));
            println!(
                "{name} {changes:?} {tolerance:e}: {:.1e} {:.3e}, {:.1e} {:.3e}",
                of[0].0, of[0].1, of[1].0, of[1].1
            );
            of
        });
        let [hht, esdirk3] = table[1];
        assert!(esdirk3.0 < error * hht.0 && esdirk3.1 < work * hht.1, "{name}: {hht:?} {esdirk3:?}");
    }
}

/// Loads of all balls on the outer race every 0.1 ms, and the steps it took.
fn loads(scene: &Scene, method: Method, tolerance: f64) -> (Vec<f64>, f64) {
    let mut scene = scene.clone();
    scene.solver.method = method;
    (scene.solver.max_step.0, scene.solver.initial_step.0) = (2e-4, 1e-6);
    (scene.solver.tolerance, scene.solver.energy_error, scene.solver.unresolved) = (tolerance, 0.0, 0.0);
    let mut simulation = Simulation::new(&scene).unwrap();
    let mut loads = vec![];
    for row in 1..=40 {
        // Steps end there.
        simulation.advance_with(1e-4 * f64::from(row), Groups::ALL).unwrap();
        loads.extend(simulation.outputs().balls.iter().map(|ball| ball.outer.load));
    }
    (loads, simulation.state().statistics.steps as f64)
}

#[test]
fn order_three_where_balls_run_over_the_edges_of_a_spall() {
    // Balls let go and touch again: Hertz's load and its damping begin without a kink, so that steps may go over a touch.
    let scene = scene("effects/spall", &[]);
    let (reference, _) = loads(&scene, Method::Esdirk3, 1e-11);
    assert!(reference.contains(&0.0), "no ball lets go");
    let orders = [(Method::Hht, 1.8), (Method::Esdirk3, 2.7)].map(|(method, least)| {
        let [coarse, fine] = [1e-7, 1e-9].map(|tolerance| loads(&scene, method, tolerance));
        let errors = [&coarse.0, &fine.0].map(|of| distance(of, &reference));
        let order = (errors[0] / errors[1]).ln() / (fine.1 / coarse.1).ln();
        println!("{method:?}: {errors:?} in {} and {} steps, order {order}", coarse.1, fine.1);
        (order, least)
    });
    assert!(orders.iter().all(|(order, least)| order > least), "{orders:?}");
}
