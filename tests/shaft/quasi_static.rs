//! `solver.level = "equilibrium"` of a shaft: every row and communication point is an equilibrium

use std::ops::ControlFlow;

use roulement::scene::system::SystemScene;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::{Rows, play};
use roulement::simulation::system::{Played, System};

use crate::common::{GEARBOX, ROTOR, forces, scene, system};

const HOUSING: &str = include_str!("../../scenes/shafts/housing.toml");

/// The same text at the level of equilibria.
fn quasi_static(text: &str) -> String {
    assert!(!text.contains("[solver]"));
    format!("{text}\n[solver]\nlevel = \"equilibrium\"\n")
}

/// What a machine does: forces on its shaft, places of the shaft, losses.
fn numbers(system: &System) -> Vec<f64> {
    let forces = forces(system).into_iter().flat_map(|force| [force.x, force.y, force.z]);
    let seats = system.outputs().seats.iter().flat_map(|seat| {
        let (d, r) = (seat.displacement * 1e8, seat.tilt * 1e6);
        [d.x, d.y, d.z, r.y, r.z]
    });
    let losses = system.bearings().map(|(_, bearing)| bearing.outputs().losses.total());
    forces.chain(seats).chain(losses).collect()
}

/// Statics end where 1e-10 of the forces is out of balance; losses come from spins of balls, which are iterated, and end at some 1e-7.
fn assert_alike(one: &System, other: &System, within: f64) {
    for (one, other) in numbers(one).into_iter().zip(numbers(other)) {
        assert!((one - other).abs() <= within * one.abs().max(1.0), "{one} {other}");
    }
}

#[test]
fn identity_rows_are_the_equilibria_of_their_times() {
    // A load that falls while the shaft runs up; an unbalance that turns; a housing on feet that is struck.
    let falling = GEARBOX
        .replace("force = [337.8, -475.0, 1260.5]", "force = [337.8, -475.0, [[0, 1260.5], [\"2 ms\", 600]]]")
        .replace("speed = \"6000 rpm\"", "speed = [[0, \"6000 rpm\"], [\"4 ms\", \"9000 rpm\"]]");
    let turning =
        ROTOR.replace("transverse_inertia = \"2e-3", "unbalance = \"200 g mm\"\ntransverse_inertia = \"2e-3");
    for text in [&falling, &turning, HOUSING] {
        let text = quasi_static(text);
        let scene = scene(&text);
        let mut machine = Machine::from(system(&text));
        let mut seen = vec![];
        let _: ControlFlow<()> = play(&mut machine, Rows::new(1.3e-3, 4e-3), |machine| {
            let system = machine.shaft().unwrap();
            let there = System::starting_at(&scene, system.time()).unwrap();
            assert_alike(system, &there, 1e-7);
            assert_eq!(system.outputs().shafts[0].spin.speed, there.outputs().shafts[0].spin.speed);
            let (turned, angle) =
                (system.outputs().shafts[0].spin.angle, there.outputs().shafts[0].spin.angle);
            assert!((turned - angle).abs() < 1e-12 * angle.abs().max(1.0), "{turned} {angle}");
            for (_, bearing) in system.bearings() {
                let outputs = bearing.outputs();
                assert!((outputs.inner.turned.abs() - turned).abs() < 1e-9 * turned.max(1.0));
                seen.push(outputs.life.map(|life| life.damage));
            }
            ControlFlow::Continue(())
        })
        .unwrap();
        assert_eq!(seen.len(), 2 * 5);
        assert!(seen.windows(3).all(|all| all[2] >= all[0]), "{seen:?}");
        assert_eq!(machine.bearings().map(|(_, bearing)| bearing.state().statistics.steps).max(), Some(0));
    }
}

#[test]
fn identity_inputs_lead_to_the_equilibrium_under_them() {
    let text = quasi_static(GEARBOX);
    let mut system = system(&text);
    let under = |force: f64, speed: f64| {
        let text = text.replace("1260.5", &format!("{force}")).replace("\"6000 rpm\"", &format!("{speed}"));
        System::new(&scene(&text)).unwrap()
    };
    let mut angle = 0.0;
    for (point, (force, speed)) in [(900.0, 628.0), (900.0, 700.0), (-300.0, 700.0)].into_iter().enumerate() {
        let mut inputs = system.inputs().clone();
        inputs.loads[0].force.z = force;
        angle += 1e-3 * 0.5 * (inputs.drives[0] + speed);
        inputs.drives[0] = speed;
        let bearings = || system.bearings().map(|(_, bearing)| *bearing.inputs()).collect::<Vec<_>>();
        // Two slightly different inputs beside it: what they lead to.
        let moved = |by: f64| {
            let mut moved = inputs.clone();
            moved.loads[0].force.z += by;
            (moved, bearings())
        };
        let beside = [moved(1.0), moved(-1.0)];
        let given = bearings();
        assert!(system.set_inputs(inputs, given));
        let none = Played::none(system.scene());
        let pair = system.advance_perturbed(1e-3 * (point + 1) as f64, &beside, &none).unwrap();
        assert_alike(&system, &under(force, speed), 1e-6);
        assert!(
            (system.outputs().shafts[0].spin.angle - angle).abs() < 1e-9,
            "{} {angle}",
            system.outputs().shafts[0].spin.angle
        );
        assert_alike(&pair[0], &under(force + 1.0, speed), 1e-6);
        assert_alike(&pair[1], &under(force - 1.0, speed), 1e-6);
        // A snapshot is of that point, and the next one follows from it.
        let snapshot = system.snapshot();
        let mut other = System::new(&scene(&text)).unwrap();
        assert!(other.restore(&snapshot));
        assert_eq!(numbers(&other), numbers(&system));
        assert_eq!(other.outputs().shafts[0].spin, system.outputs().shafts[0].spin);
    }
}

#[test]
fn refused_a_shaft_under_a_torque_has_no_equilibrium_of_its_turn() {
    let text = quasi_static(&GEARBOX.replace("speed = \"6000 rpm\"", "torque = 1.0"));
    let why = SystemScene::edited(&text).unwrap_err().to_string();
    assert!(why.contains("solver.level") && why.contains("needs a speed of the shaft"), "{why}");
}
