//! A shaft that another program drives at its flange: angle and speed in, torque out; and torque in, angle and speed out.

use roulement::interface::variables::{Causality, MachineVariables};
use roulement::scene::system::SystemScene;
use roulement::simulation::system::{Motion, Played, System};

use crate::common::{LIGHT, forces, gear_pair, system};

/// Two gears: what drives the first shaft, which the second brakes.
fn pair(keys: &str) -> String {
    gear_pair([keys, "torque = 20", "backlash = 1e-4"], LIGHT, false, 15.0, [1.0, -0.005])
}

/// \[s] communication step, and their number.
const STEP: f64 = 5e-5;
const STEPS: u32 = 40;

/// [rad/s2] acceleration of the drive from 200 rad/s on.
const GAIN: f64 = 5e3;

/// Where the drive is at a time.
fn at(time: f64) -> Motion {
    Motion {
        value: 0.3 + 200.0 * time + 0.5 * GAIN * time * time,
        rate: 200.0 + GAIN * time,
        acceleration: GAIN,
    }
}

/// One communication step of a system whose first flange is given.
fn step(system: &mut System, turn: Motion, end: f64) {
    let mut inputs = system.inputs().clone();
    inputs.flanges[0] = Some(turn);
    let bearings = system.bearings().map(|(_, bearing)| *bearing.inputs()).collect();
    assert!(system.set_inputs(inputs, bearings));
    let none = Played::none(system.scene());
    system.advance_with(end, &none).unwrap();
}

#[test]
fn identity_a_flange_that_is_given_turns_as_a_table_of_its_speed() {
    let end = STEP * f64::from(STEPS);
    let table = format!("speed = [[0, 200], [{end}, {}]]", 200.0 + GAIN * end);
    let mut played = system(&pair(&table));
    let mut given = system(&pair(&format!("flange = true\n{table}")));
    for n in 0..STEPS {
        let (from, to) = (STEP * f64::from(n), STEP * f64::from(n + 1));
        played.advance(to).unwrap();
        let Motion { value, .. } = at(from);
        step(&mut given, Motion { value: value - 0.3, ..at(from) }, to);
    }
    let [one, other] = [&played, &given].map(|system| system.outputs().shafts[0].clone());
    assert!((one.spin.angle - other.spin.angle).abs() < 1e-12 && one.spin.angle > 0.4, "{:?}", other.spin);
    assert!((one.spin.speed - other.spin.speed).abs() < 1e-9);
    assert!((one.torque / other.torque - 1.0).abs() < 1e-6, "{} {}", one.torque, other.torque);
    for (one, other) in forces(&played).iter().zip(forces(&given)) {
        assert!((one - other).norm() < 1e-6 * other.norm(), "{one} {other}");
    }
}

#[test]
fn invariant_a_flange_follows_the_angle_that_is_given_and_not_the_speed_alone() {
    let mut machine = system(&pair("flange = true\nspeed = 200"));
    // A drive that swings: its speed is given 3 % wrong, and the angle brings it back in every step.
    let angle = |time: f64| 200.0 * time + 1e-3 * (1.0 - (6e3 * time).cos());
    let speed = |time: f64| 200.0 + 6.0 * (6e3 * time).sin();
    for n in 0..STEPS {
        let (from, to) = (STEP * f64::from(n), STEP * f64::from(n + 1));
        let rate = 1.03 * speed(from);
        let value = angle(to) - rate * STEP;
        step(&mut machine, Motion { value, rate, acceleration: 0.0 }, to);
        let after = &machine.outputs().shafts[0];
        assert!((after.spin.angle - angle(to)).abs() < 1e-12, "{}", after.spin.angle - angle(to));
    }
    let energies = &machine.outputs().shafts[0].energies;
    assert!(energies.worked > 1.0, "{energies:?}");
    assert!(energies.unaccounted().abs() < 1e-4 * energies.turned_over(), "{energies:?}");
}

#[test]
fn a_flange_has_angle_and_speed_or_torque_as_inputs() {
    let of = |keys: &str, name: &str| {
        let system = system(&pair(keys));
        let rows = MachineVariables::new(&system);
        rows.rows().iter().find(|row| row.name == name).unwrap().causality
    };
    for (keys, inputs, outputs) in [
        ("speed = 200", &["one.speed"][..], &["one.angle", "one.torque"][..]),
        ("flange = true\nspeed = 200", &["one.angle", "one.speed"], &["one.torque"]),
        ("torque = -10\nstart_speed = 200", &["one.torque"], &["one.angle", "one.speed"]),
    ] {
        assert!(inputs.iter().all(|name| of(keys, name) == Causality::Input), "{keys}");
        assert!(outputs.iter().all(|name| of(keys, name) == Causality::Output), "{keys}");
    }
    let why = SystemScene::edited(&pair("flange = true\ntorque = 5")).unwrap_err().to_string();
    assert!(why.contains("shaft.flange") && why.contains("needs speed"), "{why}");
}
