//! Friction of bearings without states: it brakes their shafts by the power that their contacts lose.

use roulement::model::bodies::Race;
use roulement::simulation::Simulation;
use roulement::simulation::system::System;

use crate::common::{GEARBOX, imbalance, stored, system, train};

/// [rad/s] speed of the pinion.
const SPEED: f64 = 200.0 * std::f64::consts::PI;

/// The pinion with both bearings at a level.
fn pinion(level: &str, changes: &[(&str, &str)]) -> String {
    let text =
        GEARBOX.replace("catalogue = \"7206 B\"", &format!("catalogue = \"7206 B\"\nlevel = \"{level}\""));
    changes.iter().fold(text, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// Means of torque of the shaft \[N m], friction torque of both bearings \[N m] and losses \[W] over the second half of a run.
fn means(text: &str, end: f64) -> [f64; 4] {
    let mut system = system(text);
    let looks = 200;
    let mut sum = [0.0; 4];
    for look in 1..=looks {
        system.advance(end * f64::from(look) / f64::from(looks)).unwrap();
        if 2 * look > looks {
            sum[0] += system.outputs().shafts[0].torque;
            for (own, (_, bearing)) in sum[1..3].iter_mut().zip(system.bearings()) {
                *own += bearing.outputs().friction_torque;
            }
            sum[3] += system.bearings().map(|(_, bearing)| bearing.outputs().losses.total()).sum::<f64>();
        }
    }
    sum.map(|sum| sum / f64::from(looks / 2))
}

#[test]
fn independent_friction_torques_are_those_of_bearings_with_states_and_bring_the_losses() {
    for changes in [&[][..], &[("[337.8, -475.0, 1260.5]", "[900.0, -475.0, 400.0]")]] {
        let with = means(&pinion("dynamic", changes), 20e-3);
        let without = means(&pinion("equilibrium", changes), 20e-3);
        for which in [1, 2] {
            let (with, without) = (with[which], without[which]);
            // Balls with states slip, and spin each by itself: 3 to 5 % under the first load.
            assert!((without / with - 1.0).abs() < 0.08, "{changes:?} {which}: {without} {with}");
        }
        let [torque, left, right, losses] = without;
        assert!(((left + right) * SPEED / losses - 1.0).abs() < 1e-3, "{left} {right} {losses}");
        // The mesh drives with 30 N m.
        let drive = torque + 30.0;
        assert!((drive / (left + right) - 1.0).abs() < 1e-3, "{torque} {left} {right}");
    }
}

/// A pinion that nothing drives, from a speed.
fn free(speed: &str) -> System {
    let drive = format!("torque = 0.0\nstart_speed = \"{speed}\"");
    let changes =
        [("speed = \"6000 rpm\"", drive.as_str()), ("moment = [30.0, 0, -8.04]", "moment = [0, 0, -8.04]")];
    system(&pinion("equilibrium", &changes))
}

#[test]
fn invariant_a_shaft_that_nothing_drives_loses_what_friction_takes() {
    let mut system = free("6000 rpm");
    let before = stored(&system);
    let at_start = system.outputs().shafts[0].spin.speed;
    let torque: f64 = system.bearings().map(|(_, b)| b.outputs().friction_torque).sum();
    system.advance(10e-3).unwrap();
    let spin = system.outputs().shafts[0].spin;
    let inertia = -torque * 10e-3 / (spin.speed - at_start);
    // That of the shaft: balls without states have none about it.
    assert!((inertia / 6e-4 - 1.0).abs() < 0.05, "{inertia} {at_start} {spin:?}");
    let rubbed: f64 = system.bearings().map(|(_, b)| b.state().energies.friction).sum();
    let lost = 0.5 * 6e-4 * (at_start * at_start - spin.speed * spin.speed);
    assert!((rubbed / lost - 1.0).abs() < 1e-2, "{rubbed} {lost}");
    let [shaft, bearings] = imbalance(&system, &before);
    assert!(shaft < 1e-6 && bearings < 1e-2, "{shaft:.2e} {bearings:.2e}");
}

#[test]
fn hard_case_a_shaft_that_friction_stops_stays_where_it_is() {
    let mut system = free("60 rpm");
    let mut slowest = f64::INFINITY;
    for k in 1..=100 {
        system.advance(1e-3 * f64::from(k)).unwrap();
        slowest = slowest.min(system.outputs().shafts[0].spin.speed);
    }
    let speed = system.outputs().shafts[0].spin.speed;
    assert!(speed.abs() < 1e-3 && slowest > -1e-3, "{speed} {slowest}");
    assert!(system.states().iter().all(|state| state.powers.input.is_finite()));
}

#[test]
fn invariant_friction_turns_round_with_the_speed() {
    let ramp = (
        "speed = \"6000 rpm\"",
        "speed = [[0, \"300 rpm\"], [\"2 ms\", \"300 rpm\"], [\"8 ms\", \"-300 rpm\"]]",
    );
    let mut system = system(&pinion("equilibrium", &[ramp]));
    let mut on_the_ring = |time: f64| {
        system.advance(time).unwrap();
        system
            .bearings()
            .map(|(_, b)| b.state().race(Race::Inner).bearing_wrench.moment.x)
            .collect::<Vec<_>>()
    };
    let before = on_the_ring(2e-3);
    let after = on_the_ring(10e-3);
    for (before, after) in before.iter().zip(&after) {
        assert!(*before != 0.0 && (after / before + 1.0).abs() < 0.02, "{before} {after}");
    }
}

/// Slowly turning, where no ball passes and neither load nor speed change.
#[test]
fn invariant_friction_follows_its_coefficient_at_once() {
    let slow = ("speed = \"6000 rpm\"", "speed = \"30 rpm\"");
    let friction = "level = \"equilibrium\"\nset = { friction = { ball_race = [[0, 0.1], [\"1 ms\", 0.1], [\"1.2 ms\", 0.02]] } }";
    let mut system = system(&pinion("equilibrium", &[slow, ("level = \"equilibrium\"", friction)]));
    let mut on_the_rings = |time: f64| {
        system.advance(time).unwrap();
        let of = |bearing: &Simulation| {
            let braked = bearing.state().race(Race::Inner).bearing_wrench.moment.x;
            let lost = bearing.outputs().friction_torque;
            assert!((braked.abs() / lost - 1.0).abs() < 0.02, "{time}: {braked} {lost}");
            lost
        };
        system.bearings().map(|(_, bearing)| of(bearing)).collect::<Vec<_>>()
    };
    let (before, after) = (on_the_rings(0.9e-3), on_the_rings(1.5e-3));
    for (before, after) in before.iter().zip(&after) {
        assert!(*after < 0.5 * before, "{before} {after}");
    }
}

#[test]
fn invariant_a_train_starts_in_balance_with_its_friction() {
    let text = train(3).replace("catalogue = \"6205\"", "catalogue = \"6205\"\nlevel = \"equilibrium\"");
    let system = system(&text);
    let shafts = &system.outputs().shafts;
    let bearings: Vec<_> = system.bearings().map(|(_, bearing)| bearing.outputs()).collect();
    for (k, shaft) in shafts.iter().enumerate().skip(1) {
        let friction: f64 = bearings[2 * k..2 * k + 2].iter().map(|of| of.friction_torque).sum();
        // Statics has the torque of balls in balance with their spin, the first step that of a common share.
        let left = 6e-4 * shaft.spin.acceleration;
        assert!(friction > 1e-3 && left.abs() < 0.02 * friction, "{k}: {left} {friction}");
    }
    let put_in: f64 = shafts.iter().map(|shaft| shaft.torque * shaft.spin.speed).sum();
    let losses: f64 = bearings.iter().map(|of| of.losses.total()).sum();
    assert!((put_in / losses - 1.0).abs() < 0.02, "{put_in} {losses}");
}
