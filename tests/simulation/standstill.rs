//! Bearings that start, stop, stand, turn back and swing: every variable of them is a number of the size that it has while they run

use std::ops::ControlFlow;

use roulement::interface::variables::{Kind, Variable, Variables};
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::play::{Rows, play};

use crate::scenes::scene;

const STOP: &str = include_str!("../data/rest/stop_and_reverse.toml");
/// Reports that are off by default.
const REPORTS: [(&str, &str); 3] = [
    ("effects.stiffness_outputs", "true"),
    ("effects.frequency_outputs", "true"),
    ("effects.heat_outputs", "true"),
];
/// [-] over the largest value of a run: no mechanics of a stop needs more, and a quotient by nothing has far more.
const LARGER: f64 = 1e3;

/// Largest sizes of all variables over a run at speeds; a value that is not finite is one that is not finite.
fn largest(speeds: &str) -> Vec<(Variable, f64)> {
    largest_until("120 ms", speeds, &mut |_| ())
}

/// The same over a duration, with a look at every row.
fn largest_until(duration: &str, speeds: &str, each: &mut dyn FnMut(&Outputs)) -> Vec<(Variable, f64)> {
    let duration = format!("\"{duration}\"");
    let changes = [("load.inner_speed", speeds), ("load.duration", &duration)];
    let scene = scene(STOP, &[&REPORTS[..], &changes].concat());
    let mut simulation = Simulation::new(&scene).unwrap();
    let variables = Variables::new(&scene);
    let mut sizes = vec![0.0; variables.rows().len()];
    let rows = Rows::new(2e-4, scene.load.duration.0);
    let _: ControlFlow<()> = play(&mut simulation, rows, |simulation| {
        for (size, row) in sizes.iter_mut().zip(variables.rows()) {
            let value = variables.value(row, simulation.inputs(), simulation.outputs()).abs();
            *size = if value.is_nan() { f64::INFINITY } else { f64::max(*size, value) };
        }
        each(simulation.outputs());
        ControlFlow::Continue(())
    })
    .unwrap();
    variables.rows().to_vec().into_iter().zip(sizes).collect()
}

#[test]
fn invariant_whatever_the_speed_does_variables_have_the_size_of_running() {
    let running = largest("\"300 rpm\"");
    for speeds in [
        "[[0, \"300 rpm\"], [0.02, \"300 rpm\"], [0.04, 0], [0.08, 0], [0.1, \"-300 rpm\"]]",
        "[[0, 0], [0.02, 0], [0.06, \"300 rpm\"]]",
        "[[0, \"300 rpm\"], [0.02, 0]]",
        "0",
        "{ mean = 0, amplitude = \"300 rpm\", frequency = \"20 Hz\", phase = \"90 deg\" }",
    ] {
        for ((row, size), (_, runs)) in largest(speeds).into_iter().zip(&running) {
            // What running does not have is measured by its typical size.
            let allowed = LARGER * if *runs > 0.0 { *runs } else { row.nominal };
            // Counts of the integrator have no size. Damping goes with one over the speed, and says so.
            let told =
                row.name.starts_with("damping.") && row.description.contains("no property of the bearing");
            let fits = size < allowed || matches!(row.kind, Kind::Integer) || told;
            assert!(
                fits && size.is_finite(),
                "{speeds}: {} {size} {}, running {runs}",
                row.name,
                row.unit.name
            );
        }
    }
}

#[test]
fn invariant_slip_is_bounded_while_balls_skid_through_a_reversal() {
    // From 20,000 rpm back in 2 ms: the balls go on forwards while rolling turns back.
    let mut seen = [f64::INFINITY, f64::NEG_INFINITY];
    let speeds = "[[0, \"20000 rpm\"], [0.005, \"20000 rpm\"], [0.007, \"-20000 rpm\"], [0.02, \"-20000 rpm\"], [0.021, 0]]";
    // It stands soon after the script does.
    largest_until("30 ms", speeds, &mut |outputs| {
        let (slip, speed, rolling) = (outputs.cage_slip, outputs.cage_speed, outputs.rolling_speed);
        seen = [seen[0].min(slip), seen[1].max(slip)];
        assert!((-2.0..=3.0).contains(&slip), "{slip} at {} s", outputs.time);
        // From the floor on, and while the balls are not twice as fast, it is the plain quotient.
        if rolling.abs() > 1e-3 / 0.023 && speed.abs() < 2.0 * rolling.abs() {
            assert_eq!(slip, 1.0 - speed / rolling);
        }
    });
    // Ahead of rolling first, against it then.
    assert!(seen[0] < -0.5 && seen[1] > 1.5, "{seen:?}");
}
