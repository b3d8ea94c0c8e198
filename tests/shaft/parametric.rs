//! A mesh whose stiffness varies drives the swing of its shafts by itself, within the borders of Mathieu's equation and not beyond them.

use crate::common::{MODULE, gear_pair, system};

/// [N/m] mean stiffness, [-] its variation, [N m] torque, [kg m2] inertia of the driven gear.
const STIFFNESS: f64 = 2e6;
const VARIES: f64 = 0.3;
const TORQUE: f64 = 30.0;
const INERTIA: f64 = 1e-4;

/// Borders of the first region of `y'' + (a - 2 q cos 2 t) y = 0`: the characteristic values b1 and a1 (Abramowitz and Stegun 1972, 20.2.25).
fn borders(q: f64) -> [f64; 2] {
    [-1.0, 1.0].map(|sign| {
        1.0 + sign * q - q.powi(2) / 8.0 - sign * q.powi(3) / 64.0 - q.powi(4) / 1536.0
            + sign * 11.0 * q.powi(5) / 36864.0
    })
}

/// Frequency of the mesh at each border over twice the natural one, the higher one first: `a = (2 w0/w)^2` and `q = e a/2`.
fn frequencies() -> [f64; 2] {
    [0, 1].map(|border| {
        let a = (0..100).fold(1.0, |a, _| borders(0.5 * VARIES * a)[border]);
        1.0 / f64::sqrt(a)
    })
}

/// \[N] largest and smallest normal force over the first 25 ms at a mesh frequency over twice the natural one.
fn swings(frequency: f64) -> [f64; 2] {
    let base = 0.5 * MODULE * 40.0 * 20f64.to_radians().cos();
    let own = (STIFFNESS / INERTIA).sqrt() * base;
    let speed = 2.0 * own * frequency / 20.0;
    // So heavy that nothing moves but the second gear, which turns.
    let heavy = format!("mass = 1e6\npolar_inertia = {INERTIA}\ntransverse_inertia = 1e6");
    let keys = [
        &format!("speed = {speed}"),
        &format!("torque = {TORQUE}"),
        &format!(
            "stiffness = {STIFFNESS}\ndamping_ratio = 0\nbacklash = 5e-3\n\
             stiffness_variation = [{{ amplitude = {VARIES}, phase = \"90 deg\" }}]"
        ),
    ];
    let mut system = system(&gear_pair([keys[0], keys[1], keys[2]], &heavy, false, 0.0, 1.0));
    let mut found = [f64::INFINITY, 0.0];
    for look in 1..=1000 {
        system.advance(2.5e-5 * f64::from(look)).unwrap();
        let force = system.outputs().links[0].teeth.normal_force.abs();
        found = [found[0].min(force), found[1].max(force)];
    }
    found
}

#[test]
fn published_borders_of_mathieu_s_equation_are_those_of_a_mesh_that_varies() {
    let [low, high] = {
        let [one, other] = frequencies();
        [one.min(other), one.max(other)]
    };
    // To first order they lie a quarter of the variation apart about 1, on each side.
    assert!((high - low - 0.5 * VARIES).abs() < 0.1 * VARIES, "{low} {high}");
    let width = high - low;
    let mean = TORQUE / (0.5 * MODULE * 40.0 * 20f64.to_radians().cos());
    // Within a tenth of the region's width on both sides of each border. Inside, the swing grows until the teeth part; outside it is what the variation
    // forces, and beats.
    for (inside, outside) in
        [(low + 0.1 * width, low - 0.1 * width), (high - 0.1 * width, high + 0.1 * width)]
    {
        let [grown, bounded] = [inside, outside].map(swings);
        assert!(grown[0] == 0.0, "{inside}: {grown:?} of {mean}");
        assert!(bounded[0] > 0.2 * mean && bounded[1] < 1.8 * mean, "{outside}: {bounded:?} of {mean}");
    }
}
