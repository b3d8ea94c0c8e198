//! Texts with units through the reader of scenes.

use std::time::{Duration, Instant};

use roulement::scene::Scene;

const THRUST: &str = include_str!("../../../scenes/thrust.toml");

/// A bearing of a test rig (ER-10K), in inches.
const ER10K: &str = r#"
[bearing]
balls = 8
ball_diameter = "0.3125 in"
pitch_diameter = "1.319 in"
diametral_clearance = "10 um"
[inner]
drive = "wrench"
mass = "2 kg"
inertia = ["1e-3 kg m2", "1e-3 kg m2", "1e-3 kg m2"]
[load]
inner_speed = "600 rpm"
y = { force = "100 N" }
"#;

/// Of these a calculator made numbers, or went on for ever: 30.1 N of `1.5 e3 N`, 40.8 N of `15e N`, 60 N of `5 dozen N`.
#[test]
fn regression_what_is_no_number_with_a_unit_is_refused_at_once() {
    for text in [
        "1e-e N",
        "4e-k5 mm",
        "1.5 e3 N",
        "15e N",
        "1.5.5 N",
        "1500 N per 2",
        "5 dozen N",
        "5 half N",
        "1 e 5 N",
        "5 N!",
        "5 pi N",
        "5 N + 3 N",
        "5 -3 N",
        "2 3 N",
        "5 N to kN",
        "5 c kg/s",
        "5 gravity kg",
    ] {
        let begin = Instant::now();
        let value = format!("\"{text}\"");
        let refusal = Scene::edited(THRUST, [("load.x.force", &value)]).unwrap_err().to_string();
        // A scene is read in milliseconds; the rest is what a busy machine may keep a thread waiting.
        assert!(begin.elapsed() < Duration::from_secs(2), "{text}");
        for part in ["load.x.force", text, "1.5 kN"] {
            assert!(refusal.contains(part), "{refusal}\nshould name {part}");
        }
    }
    for unit in ["e-e N", "e3 N", "e N", ".5 N", "N per 2", "dozen N", "half N", "e 5 N", "N!", "2 N"] {
        let table = format!("{{ table = [[0, 1]], unit = \"{unit}\" }}");
        let refusal = Scene::edited(THRUST, [("load.x.force", &table)]).unwrap_err().to_string();
        assert!(refusal.contains("load.x.force") && refusal.contains(unit), "{refusal}");
    }
}

#[test]
fn an_unknown_unit_is_told_with_the_nearest_known() {
    for (key, text, meant) in [
        ("bearing.ball_diameter", "9.525 milimeter", "did you mean millimeter?"),
        ("bearing.ball_diameter", "9.525 MM", "did you mean mm?"),
        ("ball.youngs_modulus", "206 gpa", "did you mean GPa?"),
        ("load.x.force", "1.5 KN", "did you mean kN?"),
        ("load.inner_speed", "6000 RPM", "did you mean rpm?"),
        ("load.inner_speed", "6000 rmp", "did you mean rpm?"),
        ("load.inner_speed", "10 Hz", "rpm, rad/s or deg/s"),
        ("load.x.force", "1 mm^7", "powers are whole numbers from -4 to 4"),
    ] {
        let refusal = Scene::edited(THRUST, [(key, &format!("\"{text}\""))]).unwrap_err().to_string();
        for part in [key, text, meant] {
            assert!(refusal.contains(part), "{refusal}\nshould name {part}");
        }
    }
}

/// Orders of a bearing by its geometry: balls over a place of the outer and of the inner race, turns of a ball and of the cage, as
/// the maker prints them.
#[test]
fn published_number_orders_of_a_bearing_in_inches() {
    let bearing = Scene::parse(ER10K).unwrap().bearing;
    let [ball, pitch] = [bearing.ball_diameter.0, bearing.pitch_diameter.0];
    assert_eq!([ball, pitch], [0.3125 * 0.0254, 1.319 * 0.0254]);
    let ratio = ball / pitch;
    let cage = 0.5 * (1.0 - ratio);
    let orders = [8.0 * cage, 8.0 * (1.0 - cage), 0.5 * (1.0 - ratio * ratio) / ratio, cage];
    for (order, printed) in orders.into_iter().zip([3.052, 4.948, 1.992, 0.381]) {
        // Printed digits, not all of them rounded.
        assert!(f64::abs(order - printed) <= 1e-3, "{order} and {printed}");
    }
}
