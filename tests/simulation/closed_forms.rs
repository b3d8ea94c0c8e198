//! Bearings in motion against closed forms of textbooks: cage speed, variable compliance, free vibration, gyroscopic moment,
//! spin moment of complete sliding.

use std::f64::consts::TAU;

use roulement::analysis::single_contact::{Law, RollingContact};
use roulement::scene::CreepLaw;
use roulement::simulation::Simulation;

use crate::evidence;
use crate::mechanics::{Hertz, creep_coefficients, elliptic, pair};
use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const DIAMETER: f64 = 9.525e-3;
const STEEL: (f64, f64) = (206e9, 0.3);

/// Goes on by the scene's script in steps \[s].
fn go_on(simulation: &mut Simulation, interval: f64) {
    simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
    simulation.advance(simulation.time() + interval).unwrap();
}

#[test]
fn closed_form_cage_speed_with_both_rings_turning() {
    // Slow, so that both contact angles are one: w_c = (w_i (1 - g) + w_o (1 + g))/2, g = D cos(a)/d_m.
    for (inner, outer) in [(300.0, 0.0), (300.0, -120.0), (100.0, 250.0), (0.0, 300.0)] {
        let speeds = [
            ("load.inner_speed", &*format!("\"{inner} rpm\"")),
            ("load.outer_speed", &*format!("\"{outer} rpm\"")),
        ];
        let mut simulation = Simulation::new(&scene(THRUST, &speeds)).unwrap();
        let (mut sum, points) = (0.0, 100);
        for _ in 0..points {
            go_on(&mut simulation, 1e-4);
            sum += simulation.outputs().cage_speed;
        }
        let ball = &simulation.outputs().balls[0];
        let ratio = DIAMETER * ball.outer.contact_angle.cos() / (2.0 * ball.position.yz().norm());
        let expected = 0.5 * (inner * (1.0 - ratio) + outer * (1.0 + ratio)) * TAU / 60.0;
        let mean = sum / f64::from(points);
        println!("{inner} and {outer} rpm: {mean} rad/s, closed form {expected}");
        assert!((mean - expected).abs() < 1e-4 * (inner + f64::abs(outer)) * TAU / 60.0, "{mean} {expected}");
    }
}

/// [N/m^1.5] a ball between its races in series: `Q = K (d_i + d_o)^1.5`, conformity 0.52 on a pitch diameter of 46 mm at a
/// contact angle \[rad].
fn ball_between_races(angle: f64) -> f64 {
    let compliance = pair([STEEL, STEEL]).0;
    let ratio = DIAMETER * angle.cos() / 46e-3;
    let (ball, groove) = (2.0 / DIAMETER, 1.0 / (0.52 * DIAMETER));
    let along = |sign: f64| ball + sign * ball * ratio / (1.0 - sign * ratio);
    let contact = |along: f64| Hertz::new([along, ball - groove], compliance).stiffness;
    let [inner, outer] = [contact(along(1.0)), contact(along(-1.0))];
    (inner.powf(-2.0 / 3.0) + outer.powf(-2.0 / 3.0)).powf(-1.5)
}

/// A radial bearing without clearance, its inner race free along y alone.
const RADIAL: [(&str, &str); 13] = [
    ("bearing.contact_angle", ""),
    ("bearing.diametral_clearance", "0.0"),
    ("effects.creep", "\"saturated\""),
    ("effects.damping", "\"0.02 s/m\""),
    ("inner.mass", "1.0"),
    ("load.x", "{ displacement = 0.0 }"),
    ("load.y", "{ force = 1000.0 }"),
    ("load.z", "{ displacement = 0.0 }"),
    ("load.ry", "{ rotation = 0.0 }"),
    ("load.rz", "{ rotation = 0.0 }"),
    ("start.spin_balance", "false"),
    ("solver.max_step", "\"20 us\""),
    ("solver.tolerance", "1e-7"),
];

/// Balls at azimuths \[rad] from the load that carry it: deflection \[m] along it, by bisection of
/// `sum K (d cos)^1.5 cos = F`.
fn deflection(stiffness: f64, force: f64, azimuths: &[f64]) -> f64 {
    let carried = |d: f64| -> f64 {
        azimuths
            .iter()
            .map(|azimuth| stiffness * (d * azimuth.cos()).max(0.0).powf(1.5) * azimuth.cos())
            .sum()
    };
    let (mut low, mut high) = (0.0, 1e-3);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if carried(middle) < force { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn closed_form_variable_compliance() {
    // Ten balls pass the load in turn: the race goes up and down between a ball below it and a gap below it.
    let changes = [&RADIAL[..], &[("load.inner_speed", "\"600 rpm\"")]].concat();
    let mut simulation = Simulation::new(&scene(THRUST, &changes)).unwrap();
    let pitch = TAU / 10.0;
    let cage = 0.5 * 600.0 * TAU / 60.0 * (1.0 - DIAMETER / 46e-3);
    let passage = pitch / cage;
    let interval = passage / 200.0;
    let rows: Vec<(f64, f64)> = (0..3000)
        .map(|_| {
            go_on(&mut simulation, interval);
            (simulation.time(), simulation.outputs().inner.pose.position.y)
        })
        .collect();
    let mean = rows.iter().map(|row| row.1).sum::<f64>() / rows.len() as f64;
    // Fourier coefficients at the frequency of passages; their phase advances where the true frequency is another.
    let at_passages = |rows: &[(f64, f64)]| {
        let part = |f: fn(f64) -> f64| {
            2.0 / rows.len() as f64 * rows.iter().map(|(t, y)| (y - mean) * f(TAU * t / passage)).sum::<f64>()
        };
        (part(f64::cos), part(f64::sin))
    };
    let (first, last) = rows.split_at(rows.len() / 2);
    let phase = |(cos, sin): (f64, f64)| sin.atan2(cos);
    let behind = (phase(at_passages(last)) - phase(at_passages(first))) / TAU;
    let frequency = 1.0 - behind / (first.len() as f64 / 200.0);
    let (cos, sin) = at_passages(last);
    let amplitude = cos.hypot(sin);
    let stiffness = ball_between_races(0.0);
    let at = |shift: f64| {
        let azimuths: Vec<f64> = (0..10).map(|ball| pitch * (f64::from(ball) + shift)).collect();
        deflection(stiffness, 1000.0, &azimuths)
    };
    let expected =
        (0..200).map(|i| f64::from(i) / 200.0).map(|s| at(s) * (TAU * s).cos()).sum::<f64>().abs() / 100.0;
    println!(
        "frequency over closed form {frequency}, amplitude {amplitude:.4e} m, closed form {expected:.4e} m"
    );
    println!("mean deflection {mean:.4e} m, closed form {:.4e} and {:.4e} m", at(0.0), at(0.5));
    assert!((frequency - 1.0).abs() < 5e-4, "{frequency}");
    assert!((amplitude - expected).abs() < 0.07 * expected, "{amplitude} {expected}");
}

#[test]
fn closed_form_free_vibration_along_the_axis() {
    // Ten balls between races that shift along the axis, and a heavy race: w^2 = F'(x)/m. The contact angle follows
    // x + A sin(a_0) = (A + d) sin(a), A being the distance of the groove centres.
    let changes = [
        ("effects.creep", "\"frictionless\""),
        ("effects.damping", ""),
        ("inner.mass", "20.0"),
        ("load.inner_speed", "0.0"),
        ("load.y", "{ displacement = 0.0 }"),
        ("load.z", "{ displacement = 0.0 }"),
        ("load.ry", "{ rotation = 0.0 }"),
        ("load.rz", "{ rotation = 0.0 }"),
        ("start.inner_velocity", "[2e-4, 0.0, 0.0]"),
        ("start.spin_balance", "false"),
    ];
    let mut simulation = Simulation::new(&scene(THRUST, &changes)).unwrap();
    let rest = simulation.outputs().inner.pose.position.x;
    let (mut crossings, mut before) = (vec![], (0.0, 0.0));
    while crossings.len() < 21 {
        go_on(&mut simulation, 1e-5);
        let now = (simulation.time(), simulation.outputs().inner.pose.position.x - rest);
        if before.1 < 0.0 && now.1 >= 0.0 {
            crossings.push(before.0 - before.1 * (now.0 - before.0) / (now.1 - before.1));
        }
        before = now;
        assert!(simulation.time() < 0.2);
    }
    let measured = 20.0 / (crossings[20] - crossings[0]);
    let (free, angle) = (0.04 * DIAMETER, 25f64.to_radians());
    let stiffness = ball_between_races(angle);
    let force = |x: f64| {
        let (axial, radial) = (free * angle.sin() + x, free * angle.cos());
        let length = axial.hypot(radial);
        10.0 * stiffness * (length - free).max(0.0).powf(1.5) * axial / length
    };
    let (mut low, mut high) = (0.0, 1e-3);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if force(middle) < 1500.0 { low = middle } else { high = middle }
    }
    assert!((rest - low).abs() < 2e-3 * low, "{rest} {low}");
    let slope = (force(low + 1e-9) - force(low - 1e-9)) / 2e-9;
    // Half of the balls' displacement is the race's: a quarter of their mass moves along.
    let balls = 10.0 * 7800.0 * DIAMETER.powi(3) * std::f64::consts::PI / 6.0;
    let expected = (slope / (20.0 + 0.25 * balls)).sqrt() / TAU;
    println!("{measured} Hz, closed form {expected} Hz");
    assert!((measured - expected).abs() < 2e-3 * expected, "{measured} {expected}");
}

#[test]
fn closed_form_gyroscopic_moment_of_the_balls() {
    // A ball that turns about an axis at a pitch angle b to the bearing's, while it orbits with w_c, asks for
    // J w_c w_b sin(b) about its direction of motion; lateral friction of both races gives it. Rolling on the inner race, at the
    // radius R_i of the contact, w_b cos(a - b) = (w_i - w_c) R_i/r, and w_c = w_i R_i/(R_i + R_o).
    for rpm in [3000.0, 6000.0, 12000.0] {
        let speed = format!("\"{rpm} rpm\"");
        let mut simulation =
            Simulation::new(&scene(THRUST, &[("load.inner_speed", &*speed), ("effects.creep", "")])).unwrap();
        let (radius, points, skipped) = (0.5 * DIAMETER, 200, 100);
        let (mut moment, mut expected, mut lateral) = (0.0, 0.0, 0.0);
        for point in 0..points + skipped {
            go_on(&mut simulation, 1e-4);
            if point < skipped {
                continue;
            }
            let outputs = simulation.outputs();
            for ball in &outputs.balls {
                // Rolling is against the motion of the ball at its inner contact and along it at the outer one.
                moment += radius * (ball.outer.force_lateral - ball.inner.force_lateral);
                lateral += radius * ball.outer.force_lateral.abs();
                let around = ball.position.yz().norm();
                let [inner, outer] = [(&ball.inner, -1.0), (&ball.outer, 1.0)]
                    .map(|(contact, sign)| around + sign * radius * contact.contact_angle.cos());
                let race = rpm * TAU / 60.0;
                let orbit = race * inner / (inner + outer);
                let out = ball.position / ball.position.norm();
                let across = ball.angular_velocity.y * out.y + ball.angular_velocity.z * out.z;
                let pitch = across.atan2(orbit - ball.angular_velocity.x);
                let spin = (race - orbit) * inner / radius / (ball.inner.contact_angle - pitch).cos();
                let inertia = 7800.0 * DIAMETER.powi(5) * std::f64::consts::PI / 60.0;
                expected += inertia * orbit * spin * pitch.sin();
            }
        }
        println!(
            "{rpm} rpm: friction {:.4e} N m a ball, closed form {:.4e}, the outer race's share alone {:.4e}",
            moment / f64::from(10 * points),
            expected / f64::from(10 * points),
            lateral / f64::from(10 * points)
        );
        assert!((moment - expected).abs() < 1e-3 * expected.abs(), "{rpm}: {moment} {expected}");
        let per_ball = [expected, moment, lateral].map(|sum| sum / f64::from(10 * points));
        evidence::compare(&rpm.to_string(), &per_ball);
    }
}

#[test]
fn closed_form_spin_moment_of_complete_sliding() {
    // Under a spin so large that all of the contact slides about its centre: 3/8 mu Q a E(1 - b^2/a^2), a the longer semi-axis;
    // 3 pi/16 mu Q a on a circle.
    for axis_ratio in [1.0, 0.3, 0.1, 3.0] {
        let (a, b) = (1e-4 * f64::sqrt(axis_ratio), 1e-4 / f64::sqrt(axis_ratio));
        let (long, short) = (f64::max(a, b), f64::min(a, b));
        let expected = 0.375 * long / 1e-4 * elliptic(1.0 - (short / long).powi(2)).1;
        let moment = |law: Law, spin: f64| {
            let contact = RollingContact {
                id: String::new(),
                poisson_ratio: 0.3,
                shear_modulus: 80e9,
                friction: 0.08,
                peak_pressure: 2e9,
                semi_axis_x: a,
                semi_axis_y: b,
                rolling_angle: 0.0,
                creep_x: 0.0,
                creep_y: 0.0,
                spin,
                curvature: 0.0,
            };
            contact.evaluate(law).unwrap().mz
        };
        // Linear theory's moment is some hundred times the limit.
        let of = |law: CreepLaw| moment(Law::Simulated(law), 2e4) / expected;
        let [table, saturated, regularised] =
            [CreepLaw::KalkerTable, CreepLaw::Saturated, CreepLaw::Regularised].map(of);
        let polynomials = moment(Law::Kalker(5), 2e4) / expected;
        println!(
            "{axis_ratio}: closed form {expected:.4}; over it table {table:.4}, polynomials {polynomials:.4}, saturated \
             {saturated:.4}, regularised {regularised:.4}"
        );
        assert!((table - 1.0).abs() < 5e-3, "{axis_ratio}: {table}");
        evidence::compare(&axis_ratio.to_string(), &[table, polynomials, regularised, saturated]);
        // One factor for force and moment leaves linear theory's lateral force of spin in complete sliding; the
        // moment is less by its share.
        let [_, _, c23, c33] = creep_coefficients(axis_ratio, 0.3);
        let share = (c33 / expected) / f64::hypot(c33 / expected, c23);
        assert!((saturated / share - 1.0).abs() < 0.01, "{axis_ratio}: {saturated} {share}");
    }
}
