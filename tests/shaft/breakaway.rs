//! Shafts that start from rest by a torque: one below that of breakaway creeps, one above it goes off.

use crate::common::{GEARBOX, imbalance, stored, system};

/// The pinion shaft under its preload alone, with another drive.
fn driven(drive: &str) -> String {
    GEARBOX
        .replace("speed = \"6000 rpm\"", drive)
        .replace("[337.8, -475.0, 1260.5]", "[0, 0, 0]")
        .replace("[30.0, 0, -8.04]", "[0, 0, 0]")
}

/// Time of a start \[s].
const TIME: f64 = 20e-3;
/// [kg m2] polar inertia of the shaft.
const INERTIA: f64 = 6e-4;

/// Speed [rad/s] at three quarters and at the end of a start under a torque \[N m].
fn started(torque: f64) -> [f64; 2] {
    let mut system = system(&driven(&format!("torque = {torque}\nstart_speed = 0.0")));
    let before = stored(&system);
    let mut speed = |time: f64| {
        system.advance(time).unwrap();
        system.outputs().shafts[0].spin.speed
    };
    let speeds = [0.75, 1.0].map(|part| speed(part * TIME));
    let left = imbalance(&system, &before);
    assert!(left[0] < 1e-4 && left[1] < 1e-2, "{left:?}");
    speeds
}

#[test]
fn hard_case_a_torque_below_breakaway_creeps_and_one_above_it_goes_off() {
    // Friction of both bearings that turn slowly, a thousand times as fast as the regularisation of their contacts.
    let mut slow = system(&driven("speed = \"60 rpm\""));
    slow.advance(2e-3).unwrap();
    let breakaway: f64 = slow.bearings().map(|(_, b)| b.outputs().friction_torque).sum();
    assert!(breakaway > 1e-3, "{breakaway}");
    let free = |torque: f64| torque / INERTIA * TIME;
    // At rest means at the speed of regularisation: friction has become as large as the torque, and the speed stays.
    let [before, end] = started(0.5 * breakaway);
    assert!(end > 0.0 && end < 0.3 * free(0.5 * breakaway), "{end} {}", free(0.5 * breakaway));
    assert!((end - before) < 0.02 * free(0.5 * breakaway), "{before} {end}");
    // What is beyond friction accelerates shaft and balls.
    let [before, end] = started(3.0 * breakaway);
    let gained = end / free(2.0 * breakaway);
    assert!((0.7..1.05).contains(&gained), "{gained}");
    assert!((before / end / 0.75 - 1.0).abs() < 0.05, "{before} {end}");
}
