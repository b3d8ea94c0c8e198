//! Shafts of beams that twist: frequencies, twist at rest, energy.

use std::f64::consts::{PI, TAU};

use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::common::system;

/// \[m] length of the shaft and its diameter.
const LENGTH: f64 = 0.4;
const DIAMETER: f64 = 0.025;
/// [kg m2] discs at both ends.
const DISCS: [f64; 2] = [0.1, 0.2];

/// [N m2] torsional rigidity of steel, G J.
fn rigidity() -> f64 {
    206e9 / 2.6 * polar()
}

/// \[m4] polar moment of the section.
fn polar() -> f64 {
    PI / 32.0 * DIAMETER.powi(4)
}

/// A bearing on a shaft.
fn bearing(name: &str, shaft: &str, at: &str, way: &str) -> String {
    format!(
        "[[bearing]]\nname = \"{name}\"\n{shaft}\ncatalogue = \"6205\"\n\
         mounting = {{ position = \"{at}\", direction = \"{way}\", preload = {{ force = \"200 N\" }} }}\n\
         [bearing.set]\neffects = {{ creep = \"saturated\", heathcote_slip = false }}\n"
    )
}

const LOAD: &str = "[load]\nduration = \"5 ms\"\noutput_interval = \"100 us\"\n";

/// A shaft between two discs, with keys of its drive.
fn between_discs(keys: &str) -> String {
    let disc = |at: f64, polar: f64| {
        format!(
            "[[shaft.disc]]\nposition = {at}\nmass = 2\npolar_inertia = {polar}\ntransverse_inertia = 0.1\n"
        )
    };
    format!(
        "[shaft]\n{keys}\ntorsion = true\n[[shaft.section]]\nfrom = 0.0\nto = {LENGTH}\nouter_diameter = {DIAMETER}\n"
    ) + &disc(0.0, DISCS[0])
        + &disc(LENGTH, DISCS[1])
        + &bearing("left", "", "50 mm", "+x")
        + &bearing("right", "", "350 mm", "-x")
        + LOAD
}

/// [rad/s] lowest frequency of a rod whose ends carry discs [kg m2]: where this function of it is zero, by bisection.
fn lowest(of: impl Fn(f64) -> f64, near: f64) -> f64 {
    let (mut low, mut high) = (0.5 * near, 1.5 * near);
    assert!(of(low) * of(high) < 0.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(low) * of(middle) > 0.0 { low = middle } else { high = middle }
    }
    low
}

#[test]
fn closed_form_two_discs_swing_against_each_other_or_against_the_drive() {
    let (rigidity, speed) = (rigidity(), (206e9 / 2.6 / 7800f64).sqrt());
    // Moment that a rod of a length needs at its end, and its turn there: with a disc at the other end, or held there.
    let beyond = |omega: f64, length: f64, other: Option<f64>| {
        let k = omega / speed;
        let (sin, cos) = (k * length).sin_cos();
        match other {
            // Turn cos(kx) + b sin(kx) from the disc on: GJ k b = -J w2.
            Some(disc) => {
                let b = -disc * omega * omega / (rigidity * k);
                [rigidity * k * (b * cos - sin), cos + b * sin]
            }
            None => [rigidity * k * cos, sin],
        }
    };
    let with = |[moment, turn]: [f64; 2], disc: f64, omega: f64| moment - disc * omega * omega * turn;
    let stiffness = rigidity / LENGTH;
    let apart = lowest(
        |omega| with(beyond(omega, LENGTH, Some(DISCS[0])), DISCS[1], omega),
        (stiffness * (1.0 / DISCS[0] + 1.0 / DISCS[1])).sqrt(),
    );
    let held = |length: f64, disc: f64| {
        let near = (rigidity / length / disc).sqrt();
        lowest(|omega| with(beyond(omega, length, None), disc, omega), near)
    };
    for (keys, expected) in [
        // Where the turn of a free shaft is taken does not matter.
        ("torque = 0", vec![apart]),
        ("torque = 0\ndrive_position = \"170 mm\"", vec![apart]),
        // A speed that is given holds its place.
        ("speed = 0", vec![held(LENGTH, DISCS[1])]),
        ("speed = 0\ndrive_position = \"400 mm\"", vec![held(LENGTH, DISCS[0])]),
        ("speed = 0\ndrive_position = \"100 mm\"", vec![held(0.1, DISCS[0]), held(0.3, DISCS[1])]),
    ] {
        let modes = system(&between_discs(keys)).modes().unwrap().unwrap();
        for omega in expected {
            let nearest = modes.iter().map(|mode| (mode.frequency * TAU / omega - 1.0).abs());
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-6, "{keys}: {nearest:e}, expected {} Hz", omega / TAU);
        }
    }
}

/// Two shafts of beams that mesh at 40 and at 80 mm from their left ends, with keys of both.
fn geared(keys: [&str; 2]) -> String {
    let shaft = |name: &str, origin: &str, keys: &str| {
        format!(
            "[[shaft]]\nname = \"{name}\"\norigin = {origin}\n{keys}\n\
             [[shaft.section]]\nfrom = 0.0\nto = 0.2\nouter_diameter = {DIAMETER}\n"
        ) + &bearing(&format!("{name}-left"), &format!("shaft = \"{name}\""), "10 mm", "+x")
            + &bearing(&format!("{name}-right"), &format!("shaft = \"{name}\""), "120 mm", "-x")
    };
    shaft("one", "[0, 0, 0]", keys[0])
        + &shaft("two", "[\"-40 mm\", 0, \"60 mm\"]", keys[1])
        + "[[mesh]]\nname = \"mesh\"\nnormal_module = \"2 mm\"\ngears = [\n\
           { shaft = \"one\", position = \"40 mm\", teeth = 20, face_width = \"20 mm\" },\n\
           { shaft = \"two\", position = \"80 mm\", teeth = 40, face_width = \"20 mm\" }]\n"
        + LOAD
}

#[test]
fn closed_form_a_torque_twists_the_shaft_between_drive_and_gear() {
    let torque = 50.0;
    let angle = |keys: [&str; 2]| system(&geared(keys)).outputs().shafts[1].spin.angle;
    let stiff = angle(["speed = 0\ntorsion = false", &format!("torque = {torque}\ntorsion = false")]);
    for (place, length) in [("", 0.08), ("drive_position = \"200 mm\"", 0.12)] {
        let twisted = angle(["speed = 0\ntorsion = false", &format!("torque = {torque}\n{place}")]);
        let hand = torque * length / rigidity();
        assert!(((twisted - stiff) / hand - 1.0).abs() < 1e-6, "{place}: {} {hand}", twisted - stiff);
    }
    // The first shaft carries half of it over 40 mm, and lets the second one go by half the twist.
    let twisted = angle(["speed = 0", &format!("torque = {torque}\ntorsion = false")]);
    let hand = 0.5 * (0.5 * torque) * 0.04 / rigidity();
    assert!(((twisted - stiff) / hand - 1.0).abs() < 1e-6, "{} {hand}", twisted - stiff);
}

#[test]
fn invariant_shafts_that_twist_keep_their_energy_while_speed_and_torque_change() {
    // Both ways of a drive: the speed that is given changes, and the torque too.
    let speed = "speed = [[0, \"600 rpm\"], [\"2 ms\", \"660 rpm\"]]\nretardation_time = \"0.3 us\"";
    let torque = "torque = [[0, 30], [\"0.5 ms\", 30], [\"0.6 ms\", 60]]\nretardation_time = \"0.3 us\"";
    let of = |torsion: &str| {
        let mut system = system(&geared([&format!("{speed}\n{torsion}"), &format!("{torque}\n{torsion}")]));
        system.advance(2e-3).unwrap();
        system
    };
    let twisting = of("");
    let size = |system: &System| system.snapshot();
    assert!(size(&twisting) != size(&of("torsion = false")));
    assert!(size(&twisting) == size(&of("torsion = true")), "meshed beams twist");
    let outputs = twisting.outputs();
    for shaft in &outputs.shafts {
        let (open, over) = (shaft.energies.unaccounted(), shaft.energies.turned_over());
        assert!(open.abs() < 1e-5 * over, "{open:e} of {over:e}");
    }
    let mesh = &outputs.links[0].state;
    assert!(mesh.unaccounted().abs() < 1e-3 * mesh.damped, "{:e} {:e}", mesh.unaccounted(), mesh.damped);
}

#[test]
fn refusals_of_twist_name_the_key() {
    for (keys, key) in
        [("torsion = true", "shaft.torsion"), ("drive_position = 0.01", "shaft.drive_position")]
    {
        let text = format!(
            "[shaft]\nspeed = 1\nmass = 1\npolar_inertia = 1e-3\ntransverse_inertia = 1e-3\n{keys}\n{}{LOAD}",
            bearing("left", "", "0 mm", "+x")
        );
        let refusal = SystemScene::parse(&text, None, "".as_ref()).unwrap_err().to_string();
        assert!(refusal.contains(key) && refusal.contains("[[shaft.section]]"), "{refusal}");
    }
    let text = between_discs("speed = 1\ndrive_position = \"500 mm\"");
    let refusal = SystemScene::parse(&text, None, "".as_ref()).unwrap_err().to_string();
    assert!(
        ["shaft.drive_position", "0.5 m", "[0, 0.4] m"].iter().all(|part| refusal.contains(part)),
        "{refusal}"
    );
}
