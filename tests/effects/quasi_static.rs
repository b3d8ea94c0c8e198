//! `solver.level = "equilibrium"`: rows and communication points are equilibria under their inputs, here and in a package.
#![allow(unsafe_code)]
#![allow(clippy::undocumented_unsafe_blocks)] // every pointer in here lives through its call

use roulement::effects::rating::{Sums, Turning};
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::fmi::v2::Status;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::play::{Rows, play};

use crate::fmi2_abi::*;

const STATICS: &str = include_str!("../../scenes/effects/statics.toml");

fn close(a: f64, b: f64, size: f64, what: &str) {
    assert!((a - b).abs() <= size, "{what}: {a} {b}");
}

#[test]
fn invariant_every_row_is_the_equilibrium_under_its_load() {
    let scene = Scene::parse(STATICS).unwrap();
    let mut simulation = Simulation::new(&scene).unwrap();
    let rows = Rows::of(&simulation);
    let mut seen = vec![];
    let played = play(&mut simulation, rows, |simulation| {
        seen.push((
            simulation.time(),
            simulation.outputs().clone(),
            simulation.state().race(Race::Inner).turned,
        ));
        std::ops::ControlFlow::<()>::Continue(())
    });
    let _ = played.unwrap();
    assert_eq!(seen.len(), 21);
    let model = simulation.model();
    for (time, outputs, turned) in &seen {
        let solution =
            equilibrium::solve(model, &EquilibriumInput::at(&scene, Gyroscopic::Friction, *time)).unwrap();
        let load = 3e3 * time;
        close(outputs.inner.pose.position.y, solution.displacement[1], 1e-15, "displacement");
        // Beside the normal loads there is the friction of balls that roll.
        close(-outputs.inner.wrench.force.y, load, 2e-3 * load + 0.1, "force");
        for (ball, expected) in outputs.balls.iter().zip(&solution.balls) {
            close(ball.inner.load, expected.report.inner_load, 1e-9 * (load + 1.0), "inner load");
            close(ball.outer.load, expected.report.outer_load, 1e-9 * (load + 1.0), "outer load");
        }
        if load > 0.0 {
            let stiffness = outputs.condensed.unwrap().stiffness;
            let expected = solution.stiffness[(1, 1)];
            close(stiffness[(1, 1)], expected, 1e-3 * expected, "stiffness");
        }
        // The race has turned all the same.
        close(*turned, 50.0 * std::f64::consts::PI * time, 1e-9, "turned");
        assert_eq!((outputs.work, outputs.dissipated, outputs.damping_power), (0.0, 0.0, 0.0));
    }
}

#[test]
fn identity_life_over_rows_is_that_of_the_loads_of_all_rows() {
    let scene = Scene::parse(&format!("{STATICS}\n[rating]\n")).unwrap();
    let mut simulation = Simulation::new(&scene).unwrap();
    let rating = simulation.model().rating.unwrap();
    let rates = |simulation: &Simulation| {
        let outputs = simulation.outputs();
        let loads = outputs.balls.iter().map(|ball| [ball.inner.load, ball.outer.load]);
        let [inner, outer] = Race::BOTH.map(|race| simulation.state().race(race).rate.x);
        rating.at(loads, Turning { spins: [inner, outer], ..Turning::default() })
    };
    let mut sums = Sums::default();
    sums.begin(rates(&simulation));
    for row in 1..=4 {
        simulation.advance_scripted(0.2 * f64::from(row)).unwrap();
        sums.add(rates(&simulation), 0.2);
        let (life, expected) = (simulation.outputs().life.unwrap().reference, rating.after(&sums).reference);
        close(life, expected, 1e-9 * expected, "life");
    }
    // The load has grown: its last value alone would give less.
    assert!(rating.life(&rates(&simulation).rates).reference < 0.7 * rating.after(&sums).reference);
}

#[test]
fn invariant_an_equilibrium_has_no_history() {
    // Through a large load or not, in one step or many: the same bits.
    let scene =
        Scene::edited(STATICS, [("load.y.force", "[[0, 0], [0.3, 3e3], [0.6, 500], [1, 700]]")]).unwrap();
    let at = |steps: &[f64]| {
        let mut simulation = Simulation::new(&scene).unwrap();
        steps.iter().for_each(|end| simulation.advance_scripted(*end).unwrap());
        simulation.outputs().inner.pose
    };
    let one = at(&[0.8]);
    assert_eq!(at(&[0.1, 0.3, 0.31, 0.8]), one);
    assert!(one.position.y > 1e-6);
}

#[test]
fn limit_a_slow_run_comes_to_the_equilibria() {
    // Prescribed races, supported and tilted ones: the motion settles where the equilibrium is.
    let text = include_str!("../../scenes/effects/shaft_support.toml");
    let statics = Scene::edited(text, [("solver", "{ level = \"equilibrium\" }")]).unwrap();
    let dynamic = Scene::edited(text, [("load.duration", "15e-3")]).unwrap();
    let mut still = Simulation::new(&statics).unwrap();
    still.advance_scripted(5e-3).unwrap();
    let mut run = Simulation::new(&dynamic).unwrap();
    let (mut sum, rows) = (nalgebra::Vector3::zeros(), 100);
    run.advance_scripted(5e-3).unwrap();
    for row in 1..=rows {
        run.advance_scripted(5e-3 + 1e-4 * f64::from(row)).unwrap();
        sum += run.outputs().inner.wrench.force;
    }
    let (mean, expected) = (sum / f64::from(rows), still.outputs().inner.wrench.force);
    assert!((mean - expected).norm() < 0.02 * expected.norm(), "{mean} {expected}");
}

#[test]
fn a_package_gives_the_equilibrium_at_every_communication_point() {
    let changes = [("solver", "{ level = \"equilibrium\" }"), ("load.inner_speed", "600.0")];
    let held = [("load.y", "{ displacement = 0.0 }"), ("load.z", "{ displacement = 0.0 }")];
    let tilts = [("load.ry", "{ rotation = 0.0 }"), ("load.rz", "{ rotation = 0.0 }")];
    let all: Vec<_> = changes.into_iter().chain(held).chain(tilts).collect();
    let text = Scene::edited(&scene_text("wrench"), all).unwrap().source;
    let scene = Scene::parse(&text).unwrap();
    let package = Package::new("statics", &text);
    let c = package.start();
    let model = roulement::model::Model::new(&scene).unwrap();
    // One long step is as good as a short one.
    let (mut time, steps) = (0.0, [(900.0, 1e-3), (2000.0, 0.5), (300.0, 10.0)]);
    for (force, step) in steps {
        let reference = package.reference("inner.applied_force.x");
        assert_eq!(unsafe { fmi2SetReal(c, &reference, 1, &force) }, Status::Ok);
        assert_eq!(unsafe { fmi2DoStep(c, time, step, 0) }, Status::Ok);
        time += step;
        let mut input = EquilibriumInput::from_scene(&scene, Gyroscopic::Friction);
        input.conditions[0] = equilibrium::Prescribed::Load(force);
        let solution = equilibrium::solve(&model, &input).unwrap();
        let found = real(c, package.reference("inner.position.x"));
        close(found, solution.displacement[0], 1e-14, "displacement");
        // Derivative of the displacement by the load: one over the stiffness.
        let (unknown, change, mut result) = (package.reference("inner.position.x"), 1.0, 0.0);
        let status =
            unsafe { fmi2GetDirectionalDerivative(c, &unknown, 1, &reference, 1, &change, &mut result) };
        assert_eq!(status, Status::Ok);
        let expected = 1.0 / solution.stiffness[(0, 0)];
        close(result, expected, 1e-3 * expected, "compliance");
    }
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn a_package_takes_the_frame_as_inputs() {
    let frame = ("effects.frame", "{ arm = [0, 0.15, 0] }");
    let held = [
        ("load.x", "{ displacement = 1.5e-5 }"),
        ("load.ry", "{ rotation = 0.0 }"),
        ("load.rz", "{ rotation = 0.0 }"),
    ];
    let level = ("solver", "{ level = \"equilibrium\" }");
    let text = Scene::edited(&scene_text("wrench"), held.into_iter().chain([frame, level])).unwrap().source;
    let package = Package::new("frame", &text);
    let c = package.start();
    let set = |name: &str, value: f64| {
        assert_eq!(unsafe { fmi2SetReal(c, &package.reference(name), 1, &value) }, Status::Ok);
    };
    let mut time = 0.0;
    let mut carried = |step: f64| {
        assert_eq!(unsafe { fmi2DoStep(c, time, step, 0) }, Status::Ok);
        time += step;
        ["y", "z"].map(|axis| -real(c, package.reference(&format!("inner.force.{axis}"))))
    };
    // The race of 0.2 kg: its weight, the carrier, both.
    set("frame.gravity.y", -981.0);
    let [y, z] = carried(1e-3);
    close(y, -196.2, 2.0, "weight");
    close(z, 0.0, 2.0, "weight across");
    set("frame.angular_velocity.x", 100.0);
    let [y, _] = carried(1e-3);
    close(y, -196.2 + 300.0, 3.0, "weight and carrier");
    set("frame.gravity.y", 0.0);
    let [y, _] = carried(1e-3);
    close(y, 300.0, 3.0, "carrier");
    set("frame.acceleration.z", 500.0);
    let [y, z] = carried(1e-3);
    close(y, 300.0, 3.0, "carrier beside an acceleration");
    close(z, -100.0, 3.0, "acceleration");
    // The package has no other gravity.
    let names: Vec<_> = package.rows.iter().map(|row| row.name.clone()).collect();
    assert!(!names.iter().any(|name| name.starts_with("effects.gravity")));
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn a_row_without_an_equilibrium_says_when() {
    // The load grows until the contacts are far beyond Hertz's theory.
    let text = "[[0.0, 0.0], [1.0, 1e9]]";
    let scene = Scene::edited(STATICS, [("load.y.force", text)]).unwrap();
    let mut simulation = Simulation::new(&scene).unwrap();
    let why = simulation.advance_scripted(0.25).unwrap_err().to_string();
    assert!(why.starts_with("at 0.25 s: ") && why.contains("equilibrium"), "{why}");
    assert_eq!(why.matches("0.25").count(), 1, "{why}");
}
