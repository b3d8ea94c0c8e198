//! Outer rings that are parts of a shaft: hubs, idlers and planets that turn about a pin.

use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::common::{imbalance, run, stored, system};

/// \[rad/s] speed of the hub.
const SPEED: f64 = 200.0;

/// A hub with a belt pull on two 6206, on a pin that does not turn and is held by springs.
fn idler(drive: &str) -> String {
    format!(
        r#"
[[shaft]]
name = "pin"
speed = 0
mass = 0.5
polar_inertia = 5e-5
transverse_inertia = 4e-4
[[shaft]]
name = "hub"
{drive}
mass = 2.5
polar_inertia = 4e-3
transverse_inertia = 3e-3
[[shaft.load]]
name = "belt"
position = 0.004
force = [0, 600, -900]
[[bearing]]
name = "left"
shaft = "pin"
catalogue = "6206"
mounting = {{ position = -0.02, outer_shaft = "hub", preload = {{ force = 200 }} }}
[[bearing]]
name = "right"
shaft = "pin"
catalogue = "6206"
mounting = {{ position = 0.02, direction = "-x", outer_shaft = "hub", preload = {{ force = 200 }} }}
[[bearing]]
name = "frame_left"
shaft = "pin"
stiffness = {{ radial = 2e8, axial = 2e8, tilt = 1e5, radial_damping = 1e4, axial_damping = 1e4 }}
mounting = {{ position = -0.04 }}
[[bearing]]
name = "frame_right"
shaft = "pin"
stiffness = {{ radial = 2e8, radial_damping = 1e4 }}
mounting = {{ position = 0.04 }}
[load]
duration = 0.02
output_interval = 0.001
"#
    )
}

/// [rad/s] mean speed of the balls of a bearing around its axis.
fn orbit(system: &System, bearing: usize) -> f64 {
    let state = system.bearings().nth(bearing).unwrap().1.state();
    let of = |ball: &roulement::model::state::BallState| {
        let (r, v) = (ball.position, ball.velocity);
        (r.y * v.z - r.z * v.y) / (r.y * r.y + r.z * r.z)
    };
    state.balls.iter().map(of).sum::<f64>() / state.balls.len() as f64
}

/// The text of a package stands alone: it reads to the same machine.
#[test]
fn regression_the_text_of_a_package_has_the_hub_too() {
    let planetary =
        std::fs::read_to_string(format!("{}/examples/gearbox/planetary.toml", roulement_tests::ROOT))
            .unwrap();
    for text in [idler("speed = 200"), planetary] {
        let scene = SystemScene::edited(&text).unwrap();
        let packed = SystemScene::of_package(&scene.source).unwrap_or_else(|why| panic!("{why}"));
        assert_eq!(packed.source, scene.source);
        let [one, other] = [&scene, &packed].map(|scene| System::new(scene).unwrap());
        assert_eq!(one.outputs(), other.outputs());
    }
}

#[test]
fn closed_form_a_hub_that_turns_carries_its_belt_and_takes_the_balls_around() {
    let mut system = system(&idler(&format!("speed = {SPEED}")));
    let before = stored(&system);
    // Springs of the pin hold the pull: at the start, where all is in balance.
    let links: Vec<_> = system.outputs().links.iter().map(|link| link.state.force).collect();
    let pin = links[0] + links[1];
    assert!((pin[1] + 600.0).abs() < 1e-5 && (pin[2] - 900.0).abs() < 1e-5, "{pin}");
    system.advance(2e-3).unwrap();
    for (index, sign) in [1.0, -1.0].into_iter().enumerate() {
        let bearing = system.bearings().nth(index).unwrap().1;
        let model = &bearing.model().bearing;
        let outputs = bearing.outputs();
        let cosine = outputs.balls.iter().map(|ball| ball.outer.contact_angle.cos()).sum::<f64>()
            / outputs.balls.len() as f64;
        let exact = 0.5 * SPEED * (1.0 + 2.0 * model.ball.radius / model.pitch_diameter * cosine) * sign;
        let found = orbit(&system, index);
        assert!((found / exact - 1.0).abs() < 5e-3, "{found} {exact}");
        assert!((outputs.outer.twist.angular_velocity.x / (sign * SPEED) - 1.0).abs() < 1e-6);
        assert!(outputs.inner.twist.angular_velocity.x.abs() < 1e-6);
    }
    let [_, of_bearings] = imbalance(&system, &before);
    let hub = &system.outputs().shafts[1].energies;
    assert!(hub.unaccounted().abs() < 1e-5 * hub.turned_over(), "{hub:?}");
    assert!(of_bearings < 1e-2, "{of_bearings}");
    // The drive of the hub puts in what is lost, and the pin is held against the friction.
    let outputs = system.outputs();
    assert!(outputs.shafts[1].torque > 0.0 && outputs.shafts[0].torque < 0.0, "{:?}", outputs.shafts);
}

#[test]
fn closed_form_a_hub_under_a_torque_speeds_up_by_torque_over_inertia() {
    let system = run(&idler(&format!("torque = 8\nstart_speed = {SPEED}")), 2e-3);
    let gained = system.outputs().shafts[1].spin.speed - SPEED;
    // Its own inertia, and that of the balls that it takes along: they turn half as fast.
    let exact = 8.0 / 4e-3 * 2e-3;
    assert!((0.9..1.001).contains(&(gained / exact)), "{gained} {exact}");
}

/// The same machine with pin and hub turned in the other sense, and seen from the other end.
#[test]
fn invariant_a_hub_that_turns_the_other_way_has_the_opposite_torque() {
    let torque = |speed: f64| run(&idler(&format!("speed = {speed}")), 1e-3).outputs().shafts[1].torque;
    let [one, other] = [torque(SPEED), torque(-SPEED)];
    // The load is not symmetric about the plane that turns one into the other, but for its size: friction is.
    assert!((one + other).abs() < 0.05 * one.abs(), "{one} {other}");
}

#[test]
fn what_an_outer_ring_on_a_shaft_cannot_have_is_refused() {
    let text = idler("speed = 1");
    for (from, to, part) in [
        ("outer_shaft = \"hub\"", "outer_shaft = \"pin\"", "give another one"),
        ("outer_shaft = \"hub\"", "outer_shaft = \"rim\"", "there are: pin, hub"),
        ("outer_shaft = \"hub\"", "outer_shaft = \"hub\", offset = { y = 1e-5 }", "take housing, axial"),
        ("name = \"hub\"", "name = \"hub\"\norigin = [0, 0.01, 0]", "on one axis"),
        (
            "catalogue = \"6206\"\n",
            "catalogue = \"6206\"\nset = { load = { outer_speed = 3 } }\n",
            "mounting.outer_shaft",
        ),
    ] {
        assert!(text.contains(from));
        let why = SystemScene::edited(&text.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(why.contains(part), "{why}");
    }
}
