//! Runs by the scene's script: exact in every step, whatever the distance of rows.

use std::ops::ControlFlow;

use nalgebra::{UnitQuaternion, Vector3};
use roulement::Simulation;
use roulement::scene::Scene;
use roulement::simulation::play::{Rows, play};

use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const RADIAL: &str = include_str!("../../scenes/radial.toml");
const MISALIGNMENT: &str = include_str!("../../scenes/misalignment.toml");

/// Plays a scene to a time \[s] and shows every row.
fn run(scene: &Scene, interval: f64, duration: f64, mut row: impl FnMut(&Simulation)) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    let _: ControlFlow<()> = play(&mut simulation, Rows::new(interval, duration), |simulation| {
        row(simulation);
        ControlFlow::Continue(())
    })
    .unwrap();
    simulation
}

/// Steps of 2^-17 s, whose sums are exact, whatever their local error.
const FORCED: [(&str, &str); 4] = [
    ("solver.max_step", "7.62939453125e-6"),
    ("solver.initial_step", "7.62939453125e-6"),
    ("solver.tolerance", "1e-2"),
    ("load.duration", "0.004"),
];

#[test]
fn invariant_forced_steps_give_the_same_bits_for_every_output_interval() {
    let step = f64::from_bits(0x3ee0_0000_0000_0000);
    assert_eq!(step, 7.62939453125e-6);
    let wrench = [
        ("load.inner_speed", "[[0, 500], [0.00390625, 700]]"),
        ("load.x.force", "[[0, 1500], [0.001953125, 2500], [0.00390625, 1200]]"),
        ("outer.misalignment.ry", "[[0, 0], [0.00390625, 1e-4]]"),
        ("friction.ball_race", "[[0, 0.08], [0.00390625, 0.02]]"),
    ];
    let pose = [
        ("load.inner_speed", "[[0, 500], [0.00390625, 700]]"),
        ("load.ry.rotation", "[[0, 0], [0.00390625, 3e-4]]"),
        ("load.y.displacement", "[[0, 0], [0.001953125, 2e-6]]"),
    ];
    for scene in
        [scene(THRUST, &[&FORCED[..], &wrench].concat()), scene(MISALIGNMENT, &[&FORCED[..], &pose].concat())]
    {
        let [fine, coarse, one] = [2.0, 64.0, 512.0].map(|steps| {
            let run = run(&scene, steps * step, 512.0 * step, |_| ());
            assert_eq!(run.state().statistics.steps, 512, "{}", scene.title);
            run
        });
        for other in [&coarse, &one] {
            assert_eq!(fine.state(), other.state(), "{}", scene.title);
            assert_eq!(fine.outputs(), other.outputs());
            assert_eq!(fine.inputs(), other.inputs());
        }
    }
}

#[test]
fn closed_form_a_speed_ramp_is_followed_at_every_output_interval() {
    let ramp = [("load.inner_speed", "[[0, 0], [\"15 ms\", \"6000 rpm\"]]"), ("bearing.balls", "5")];
    let scene = scene(RADIAL, &ramp);
    let full = 200.0 * std::f64::consts::PI;
    let runs = [2e-5, 2e-4, 1e-3, 5e-3].map(|interval| {
        run(&scene, interval, 1e-2, |simulation| {
            let spin = simulation.outputs().inner.twist.angular_velocity.x;
            let expected = full * simulation.time() / 15e-3;
            // Accepted violation of the constraint: 1e-8 rad/s; the race tilts by rounding alone.
            assert!((spin - expected).abs() < 1e-6, "{interval}: {spin}, {expected}");
            assert!((simulation.inputs().inner.speed - expected).abs() < 1e-9, "the row's own time");
        })
    });
    // What is lost depends on the steps alone, which the tolerance (1e-6 of a ball) chooses; five balls do not meet: 31 % apart when inputs were
    // those of the row before.
    let lost = runs.each_ref().map(|run| run.outputs().dissipated);
    for one in lost {
        assert!((one / lost[0] - 1.0).abs() < 5e-3, "{lost:?}");
    }
}

#[test]
fn invariant_a_pulse_between_two_rows_is_played() {
    let pulse = "[[\"1.1 ms\", 0], [\"1.15 ms\", \"5 kN\"], [\"1.65 ms\", \"5 kN\"], [\"1.7 ms\", 0]]";
    let scene = scene(RADIAL, &[("load.y.force", "0.0"), ("load.z.force", pulse)]);
    let largest =
        |run: &Simulation| run.outputs().balls.iter().map(|ball| ball.inner.load).fold(0.0, f64::max);
    let runs = [2e-5, 2e-4, 1e-3].map(|interval| run(&scene, interval, 3e-3, |_| ()));
    let peaks = [2e-5, 1.4e-3].map(|interval| largest(&run(&scene, interval, 1.4e-3, |_| ())));
    assert!(peaks[0] > 1000.0, "the pulse reaches the balls: {peaks:?}");
    assert!((peaks[0] / peaks[1] - 1.0).abs() < 1e-2, "{peaks:?}");
    let work = runs.each_ref().map(|run| run.outputs().dissipated);
    for one in work {
        assert!((one / work[0] - 1.0).abs() < 2e-2, "{work:?}");
    }
}

#[test]
fn invariant_every_row_is_of_its_own_time() {
    let tilt = "[[0, 0], [\"5 ms\", 1e-3]]";
    let scene = scene(
        MISALIGNMENT,
        &[
            ("load.ry.rotation", tilt),
            ("load.x.force", ""),
            ("load.x.displacement", "[[0, 0], [\"5 ms\", \"8 um\"]]"),
        ],
    );
    let mut rows = vec![];
    run(&scene, 1e-3, 5e-3, |simulation| {
        let (given, outputs) = (&simulation.inputs().inner, &simulation.outputs().inner);
        let s = (simulation.time() / 5e-3).min(1.0);
        let smooth = s * s * (3.0 - 2.0 * s);
        assert!((given.pose.position.x - 8e-6 * smooth).abs() < 1e-18);
        assert_eq!(given.pose.position, outputs.pose.position);
        let axis = UnitQuaternion::new(Vector3::new(0.0, 1e-3 * smooth, 0.0)) * Vector3::x();
        assert!((given.pose.orientation * Vector3::x() - axis).norm() < 1e-15);
        assert!(given.pose.orientation.angle_to(&outputs.pose.orientation) < 1e-15);
        assert!((given.twist.angular_velocity - outputs.twist.angular_velocity).norm() < 1e-9);
        rows.push(simulation.time());
    });
    assert_eq!(rows.len(), 6);
}

#[test]
fn invariant_a_start_at_a_later_time_is_where_the_script_is() {
    let tilted = scene(MISALIGNMENT, &[("load.ry.rotation", "[[0, 0], [\"10 ms\", 3e-3]]")]);
    let mut late = Simulation::starting_at(&tilted, 0.02).unwrap();
    let axis = UnitQuaternion::new(Vector3::new(0.0, 3e-3, 0.0)) * Vector3::x();
    let before = late.outputs().inner.wrench.moment.y;
    late.advance_scripted(0.02 + 1e-5).unwrap();
    let outputs = late.outputs();
    assert!((outputs.inner.pose.orientation * Vector3::x() - axis).norm() < 1e-12);
    assert!(outputs.inner.twist.angular_velocity.y.abs() < 5.0, "it does not tilt");
    assert!((outputs.inner.wrench.moment.y / before - 1.0).abs() < 0.05 && before.abs() > 1.0);
    // A scene whose tables have ended is the scene of constants.
    let constant = scene(MISALIGNMENT, &[("load.ry.rotation", "3e-3")]);
    let same = Simulation::new(&constant).unwrap();
    assert_eq!(late.inputs().inner.speed, same.inputs().inner.speed);
    assert!((before - same.outputs().inner.wrench.moment.y).abs() < 1e-9 * before.abs());
}
