//! Means since the last communication point: those of the steps over time, and what they add up to

use roulement::interface::variables::Variables;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::play::Scripted;

use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const CAGE: &str = include_str!("../../scenes/cage.toml");
const SUPPORT: &str = include_str!("../../scenes/effects/soft_housing.toml");
const ON: (&str, &str) = ("effects.mean_outputs", "true");
/// A mean, and what it is of.
const PAIRS: [&str; 17] = [
    "inner.force.x",
    "inner.force.y",
    "inner.force.z",
    "inner.moment.x",
    "inner.moment.y",
    "inner.moment.z",
    "inner.drive_torque",
    "outer.force.x",
    "outer.force.y",
    "outer.force.z",
    "outer.moment.x",
    "outer.moment.y",
    "outer.moment.z",
    "outer.drive_torque",
    "friction_power",
    "loss.total",
    "cage.speed",
];

/// Values of variables by name; not a number where a scene has none of that name.
fn values(scene: &Scene, simulation: &Simulation, names: &[String]) -> Vec<f64> {
    let rows = Variables::new(scene);
    let value = |name: &String| {
        let row = rows.rows().iter().find(|row| row.name == *name);
        row.map_or(f64::NAN, |row| rows.value(row, simulation.inputs(), simulation.outputs()))
    };
    names.iter().map(value).collect()
}

#[test]
fn closed_form_means_are_trapezoids_over_the_steps() {
    let of = PAIRS.map(str::to_string);
    let means = PAIRS.map(|name| format!("mean.{name}"));
    for (text, changes) in [
        (CAGE, &[ON, ("load.inner_speed", "[[0, 500], [\"2 ms\", 900]]")][..]),
        (
            THRUST,
            &[
                ON,
                ("effects.ambient", "{ density = 50.0, viscosity = 18e-6 }"),
                ("film", "{ viscosity = 0.02 }"),
            ],
        ),
        (SUPPORT, &[ON]),
    ] {
        let scene = scene(text, changes);
        let mut simulation = Simulation::new(&scene).unwrap();
        // At the start they are values of the moment.
        let now = values(&scene, &simulation, &of);
        for ((name, a), b) in of.iter().zip(&now).zip(values(&scene, &simulation, &means)) {
            assert!(a.is_nan() || (a - b).abs() <= 1e-9 * a.abs().max(1e-6), "{name}: {a} {b}");
        }
        let mut compared = 0;
        for point in 1..=3 {
            let end = 3e-4 * f64::from(point);
            let mut before = (simulation.time(), values(&scene, &simulation, &of));
            let (start, mut sums) = (before.0, vec![0.0; of.len()]);
            let mut largest = vec![0.0_f64; of.len()];
            let mut course = simulation.begin(end).unwrap();
            while simulation.time() < end {
                simulation.step(&mut course, end).unwrap();
                let now = (simulation.time(), values(&scene, &simulation, &of));
                for (i, sum) in sums.iter_mut().enumerate() {
                    *sum += 0.5 * (now.0 - before.0) * (before.1[i] + now.1[i]);
                    largest[i] = largest[i].max(now.1[i].abs());
                }
                before = now;
            }
            simulation.end(course, true);
            for (i, mean) in values(&scene, &simulation, &means).into_iter().enumerate() {
                let wanted = sums[i] / (end - start);
                let rounding = 1e-9 * largest[i].max(1e-6);
                assert!(wanted.is_nan() || (mean - wanted).abs() <= rounding, "{}: {mean} {wanted}", of[i]);
                compared += usize::from(!wanted.is_nan() && wanted != 0.0);
            }
        }
        assert!(compared > 20, "{compared}");
    }
}

#[test]
fn invariant_losses_of_all_points_add_up_and_reports_leave_the_motion_as_it_is() {
    let scene = scene(CAGE, &[ON]);
    let (mut simulation, mut plain) =
        (Simulation::new(&scene).unwrap(), Simulation::new(&Scene::parse(CAGE).unwrap()).unwrap());
    let mean = ["mean.loss.total".to_string()];
    let mut lost = 0.0;
    for point in 1..=7 {
        simulation.advance_scripted(1e-4 * f64::from(point)).unwrap();
        plain.advance_scripted(1e-4 * f64::from(point)).unwrap();
        lost += 1e-4 * values(&scene, &simulation, &mean)[0];
    }
    let wanted = simulation.outputs().dissipated;
    assert!((lost / wanted - 1.0).abs() < 1e-9, "{lost} {wanted}");
    assert_eq!(
        (&simulation.state().balls, &simulation.state().energies),
        (&plain.state().balls, &plain.state().energies)
    );
    // They go on from a snapshot, which is of no bearing without them.
    let snapshot = simulation.snapshot();
    let mut other = Simulation::new(&scene).unwrap();
    assert!(other.restore(&snapshot) && other.outputs() == simulation.outputs());
    assert!(!plain.restore(&snapshot));
}
