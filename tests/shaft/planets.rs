//! Planets on ball bearings in a carrier, seen from that: ratio and loads by hand, load sharing, centrifugal loads, teeth in step with where planets stand.

use std::f64::consts::TAU;
use std::path::Path;

use nalgebra::Vector3;
use roulement::interface::variables::{Causality, MachineVariables};
use roulement::scene::system::SystemScene;
use roulement::simulation::Simulation;
use roulement::simulation::system::System;

use crate::common::{imbalance, stored, system};

/// Teeth of sun and ring, \[m] distance of the axes, [rad/s] speed of the carrier, [N m] torque of the sun.
const SUN: f64 = 25.0;
const RING: f64 = 83.0;
const ARM: f64 = 0.054;
const CARRIER: f64 = 400.0 * TAU / 60.0;
const TORQUE: f64 = 62.5;
/// \[kg] mass of a planet with its pin, without the balls between them.
const RINGS: f64 = 0.37 + 0.071;
/// \[m] base radius of the sun.
const BASE: f64 = 0.025 * 0.939_692_620_785_908_4;

/// The shipped example, with the law of creep that takes least, and what is changed.
fn stage(changes: &[(&str, &str)]) -> String {
    let folder = Path::new(roulement_tests::ROOT).join("examples/gearbox/planetary.toml");
    let text = std::fs::read_to_string(folder).unwrap();
    let law = "catalogue = \"6203\"\nset = { effects = { creep = \"saturated\", heathcote_slip = false } }";
    let text = text.replace("catalogue = \"6203\"", law);
    changes.iter().fold(text, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// Teeth that do not vary.
const EVEN: [(&str, &str); 2] =
    [("amplitude = \"10 %\"", "amplitude = \"0 %\""), ("amplitude = \"8 %\"", "amplitude = \"0 %\"")];

/// Force of a link on its first end.
fn force(system: &System, name: &str) -> Vector3<f64> {
    let index = system.scene().link_names().position(|own| own == name).unwrap();
    system.outputs().links[index].state.force.fixed_rows::<3>(0).into_owned()
}

/// \[N] sizes of the normal forces of the sun's three meshes.
fn shares(system: &System) -> [f64; 3] {
    [1, 2, 3].map(|n| {
        let index = system.scene().link_names().position(|own| own == format!("sun-planet{n}")).unwrap();
        system.outputs().links[index].teeth.normal_force.abs()
    })
}

/// Radial and tangential direction of a planet, 1 to 3.
fn directions(n: u32) -> [Vector3<f64>; 2] {
    let angle = TAU * f64::from(n - 1) / 3.0;
    [Vector3::new(0.0, angle.cos(), angle.sin()), Vector3::new(0.0, -angle.sin(), angle.cos())]
}

#[test]
fn closed_form_ratio_torques_and_loads_of_pins() {
    let system = system(&stage(&EVEN));
    let outputs = system.outputs();
    // Seen from outside the sun turns 1 + 83/25 times as fast as the carrier, and the ring stands.
    let speed = |shaft: usize| outputs.shafts[shaft].spin.speed + CARRIER;
    assert!((speed(0) / CARRIER - (1.0 + RING / SUN)).abs() < 1e-12, "{}", speed(0) / CARRIER);
    assert!(speed(1).abs() < 1e-9, "{}", speed(1));

    // The sun's torque to the rounding of its balance, by three meshes; friction of the planets' bearings takes 0.3 % of the ring's at most.
    let normal = TORQUE / (3.0 * BASE);
    for share in shares(&system) {
        assert!((share / normal - 1.0).abs() < 1e-4, "{share} {normal}");
    }
    let ring = outputs.shafts[1].torque / (TORQUE * RING / SUN);
    assert!((ring - 1.0).abs() < 3e-3, "{ring}");
    let held = -outputs.holding[0] / (TORQUE * (1.0 + RING / SUN));
    assert!((held - 1.0).abs() < 3e-3, "{held}");

    // Twice the tangential force of the sun on every pin.
    let tangential = TORQUE / (3.0 * 0.025);
    for n in 1..=3 {
        let pin = force(&system, &format!("fit{n}")).dot(&directions(n)[1]);
        assert!((pin.abs() / (2.0 * tangential) - 1.0).abs() < 3e-3, "{pin} {tangential}");
        let bearings: f64 = [2 * n - 2, 2 * n - 1]
            .map(|index| {
                let on_pin = system.bearings().nth(index as usize).unwrap().1.outputs().inner.wrench.force;
                on_pin.y.hypot(on_pin.z)
            })
            .iter()
            .sum();
        assert!((bearings / (2.0 * tangential) - 1.0).abs() < 1e-2, "{bearings}");
    }
}

#[test]
fn closed_form_pins_hold_their_planets_against_mass_times_radius_times_speed_squared() {
    for speed in [CARRIER, 10.0 * CARRIER] {
        let rpm = 60.0 * speed / TAU;
        let [frame, ring] = [format!("[\"{rpm} rpm\", 0, 0]"), format!("speed = \"{} rpm\"", -rpm)];
        let changes = [EVEN[0], EVEN[1], ("[\"400 rpm\", 0, 0]", &frame), ("speed = \"-400 rpm\"", &ring)];
        let system = system(&stage(&changes));
        // Parts are 10 to 20 um away from where they stand at rest.
        let balls =
            |bearing: &Simulation| bearing.state().balls.len() as f64 * bearing.model().bearing.ball.mass;
        let balls: f64 = system.bearings().take(2).map(|(_, bearing)| balls(bearing)).sum();
        assert!(balls > 0.04 * RINGS, "{balls}");
        for found in pulls(&system) {
            let apart = found / ((RINGS + balls) * ARM * speed * speed) - 1.0;
            assert!(apart.abs() < 1e-3, "{rpm} rpm: {found} N, {apart:e}");
        }
    }
}

/// \[N] what every pin is pulled outwards with beyond the forces of the teeth.
fn pulls(system: &System) -> [f64; 3] {
    [1, 2, 3].map(|n| {
        let names = [format!("sun-planet{n}"), format!("planet{n}-ring"), format!("fit{n}")];
        let [sun, ring, pin] = names.map(|name| force(system, &name));
        (sun - ring - pin).dot(&directions(n)[0])
    })
}

#[test]
fn closed_form_a_floating_sun_shares_its_load_where_a_held_one_does_not() {
    // The second pin sits 20 um further on around the axis.
    let [_, along] = directions(2);
    let off = format!(
        "mounting = {{ position = 0, housing = \"carrier\", offset = {{ y = {}, z = {} }} }}\n\n[[mesh]]\nname = \"sun-planet2\"",
        2e-5 * along.y,
        2e-5 * along.z
    );
    let seat = "mounting = { position = 0, housing = \"carrier\" }\n\n[[mesh]]\nname = \"sun-planet2\"";
    let changes = [EVEN[0], EVEN[1], (seat, off.as_str())];
    let floating = shares(&system(&stage(&changes)));
    let held = [changes[0], changes[1], changes[2], ("radial = \"0.2 N/um\"", "radial = \"2 kN/um\"")];
    let held = shares(&system(&stage(&held)));
    let mean = TORQUE / (3.0 * BASE);
    // Three forces at 120 degrees are in balance where they are alike; the spline takes 0.2 N for each um that the sun goes.
    for share in floating {
        assert!((share / mean - 1.0).abs() < 0.01, "{floating:?}");
    }
    let sum: f64 = held.iter().sum();
    assert!((sum / (3.0 * mean) - 1.0).abs() < 1e-4, "{held:?}");
    assert!((held[1] / mean - 1.0).abs() > 0.1, "{held:?}");
}

#[test]
fn invariant_a_planetary_stage_keeps_its_energy_its_torques_and_its_bits() {
    let text = stage(&[]);
    let run = || {
        let mut machine = system(&text);
        let (mut sum, mut count) = ([0.0; 2], 0.0);
        for look in 1..=160 {
            let time = 2.5e-5 * f64::from(look);
            machine.advance(time).unwrap();
            if time > 2e-3 {
                sum[0] += machine.outputs().shafts[1].torque;
                sum[1] -= machine.outputs().holding[0];
                count += 1.0;
            }
        }
        (machine, sum.map(|sum| sum / count))
    };
    let before = stored(&system(&text));
    let (one, [ring, carrier]) = run();
    assert!((ring / (TORQUE * RING / SUN) - 1.0).abs() < 0.01, "{ring}");
    assert!((carrier / (TORQUE * (1.0 + RING / SUN)) - 1.0).abs() < 0.01, "{carrier}");
    let outputs = one.outputs();
    let put_in: f64 = outputs.shafts.iter().map(|shaft| shaft.energies.worked).sum();
    let of_shafts = outputs.shafts.iter().map(|shaft| shaft.energies.unaccounted());
    let of_housings = outputs.housings.iter().map(|housing| housing.energies.unaccounted());
    let of_links = outputs.links.iter().map(|link| link.state.unaccounted());
    for open in of_shafts.chain(of_housings).chain(of_links) {
        assert!(open.abs() < 1e-4 * put_in, "{open:e} of {put_in:e}");
    }
    let [_, of_bearings] = imbalance(&one, &before);
    assert!(of_bearings < 1e-3, "{of_bearings:e}");
    let (again, _) = run();
    assert_eq!(one.outputs(), again.outputs());
}

#[test]
fn closed_form_teeth_of_planets_come_and_go_as_these_stand_around_the_sun() {
    let turned: Vec<f64> =
        SystemScene::edited(&stage(&[])).unwrap().meshes.iter().map(|mesh| mesh.turned).collect();
    // By teeth: 25/3 and 83/3 of them later at the next planet, which are a third and two thirds of a tooth.
    for (index, mesh) in turned.iter().enumerate() {
        let (planet, teeth) = (index / 2, if index % 2 == 0 { SUN } else { RING });
        let tooth = if index % 2 == 0 { SUN } else { 29.0 } * mesh / TAU;
        let expected = -teeth * planet as f64 / 3.0;
        let apart = (tooth - expected) - (tooth - expected).round();
        assert!(apart.abs() < 1e-6, "{index}: {tooth} {expected}");
    }
    // So do the forces: each mesh of the sun swings a third of a period after the one before.
    let mut machine = system(&stage(&[]));
    let frequency = CARRIER * RING;
    let (from, periods, looks) = (4e-3, 2.0, 80);
    let mut sums = [[0.0; 2]; 3];
    for look in 0..looks {
        let time = from + periods * TAU / frequency * f64::from(look) / f64::from(looks);
        machine.advance(time).unwrap();
        let (sin, cos) = (frequency * time).sin_cos();
        for (sum, share) in sums.iter_mut().zip(shares(&machine)) {
            *sum = [sum[0] + share * cos, sum[1] + share * sin];
        }
    }
    let phases = sums.map(|[cos, sin]| sin.atan2(cos));
    for (one, next) in [(0, 1), (1, 2)] {
        let later = (phases[next] - phases[one]).rem_euclid(TAU) / TAU;
        assert!((later - 1.0 / 3.0).abs() < 0.03, "{later} {sums:?}");
    }
}

#[test]
fn a_planet_that_does_not_fit_between_the_teeth_is_refused() {
    // 110 degrees on: 33 teeth of 108. 111 are 33.3.
    let at = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        format!("origin = [0, \"{} mm\", \"{} mm\"]", 54.0 * cos, 54.0 * sin)
    };
    let own = "origin = [0, \"-27 mm\", \"46.7653718 mm\"]";
    assert!(SystemScene::edited(&stage(&[(own, &at(110.0))])).is_ok());
    let why = SystemScene::edited(&stage(&[(own, &at(111.0))])).unwrap_err().to_string();
    for part in
        ["shaft \"planet2\": shaft.origin", "stands 111.0000 deg", "25 + 83 teeth", "110.0000", "113.3333"]
    {
        assert!(why.contains(part), "{why}");
    }
}

#[test]
fn a_planetary_stage_has_the_carrier_s_speed_as_input_and_its_torque_as_output() {
    let system = system(&stage(&[]));
    let variables = MachineVariables::new(&system);
    let has = |name: &str, causality: Causality| {
        variables.rows().iter().any(|row| row.name == name && row.causality == causality)
    };
    assert!(has("frame.angular_velocity.x", Causality::Input) && has("ring.speed", Causality::Input));
    assert!(has("sun.torque", Causality::Input) && has("sun.speed", Causality::Output));
    assert!(has("output.moment.x", Causality::Output) && has("ring.torque", Causality::Output));
}
