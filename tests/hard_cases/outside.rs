//! What is around the bearing: supports soft and stiff, and a planet in its carrier.

use nalgebra::Vector3;
use roulement::model::bodies::Race;
use roulement::scene::Scene;

use crate::gates::{Case, Run, limits};
use crate::scenes::{FLAT, GROOVE, load, scene};

const CARRIER: &str = include_str!("../../scenes/effects/planet_carrier.toml");

const STEPS: &str = "{ tolerance = 1e-7, max_step = 3e-6, initial_step = 1e-6 }";

/// Mean force on a race over the second half [N].
fn mean_force(run: &Run, race: Race) -> Vector3<f64> {
    let late = &run.history[run.history.len() / 2..];
    late.iter().map(|outputs| outputs[race].wrench.force).sum::<Vector3<f64>>() / late.len() as f64
}

/// The deep-groove bearing in a housing of this stiffness [N/m].
fn housed(stiffness: f64, rest: &str) -> Scene {
    let (turned, damping) = (stiffness * 5e-4, 1e-3 * (0.3 * stiffness).sqrt());
    scene(
        GROOVE,
        &format!(
            "[outer]\ndrive = \"fixed\"\n[outer.support]\nmass = 0.3\ninertia = [3e-4, 2e-4, 2e-4]\n\
             stiffness = [{stiffness:?}, {stiffness:?}, {stiffness:?}, {turned:?}, {turned:?}, {turned:?}]\n\
             damping = [{damping:?}, {damping:?}, {damping:?}, 0, 0, 0]\n[solver]\ntolerance = 1e-7\nmax_step = 3e-6\ninitial_step = 1e-6\n{rest}"
        ),
    )
}

#[test]
fn supports_soft_and_stiff() {
    for (name, stiffness, most) in [
        ("housing of 5 N/um, load doubled in 2 ms", 5e6, limits(4200, 20, 10, 3.0)),
        ("housing of 100 N/um, load doubled in 2 ms", 1e8, limits(4200, 20, 10, 3.0)),
        ("housing of 1 MN/um, load doubled in 2 ms", 1e12, limits(4200, 20, 10, 3.0)),
    ] {
        let rows = format!("y = {{ force = [[0, 1000], [1e-3, 1000], [3e-3, 2000]] }}\n{FLAT}");
        let mut case = Case::new(name, housed(stiffness, &load(10.0, 3000.0, &rows)), most);
        // The gates set inputs at rows: a table is then a ramp from row to row.
        case.window = [0.6, 1.0];
        let run = case.pass();
        // The housing carries the load, on its spring.
        let carried = mean_force(&run, Race::Outer);
        assert!((carried.y / 2000.0 - 1.0).abs() < 0.05, "{name}: {carried}");
        let late = &run.history[run.history.len() / 2..];
        let deflection =
            late.iter().map(|o| o.supports[1].unwrap().displacement.y).sum::<f64>() / late.len() as f64;
        assert!((deflection * stiffness / carried.y - 1.0).abs() < 0.05, "{name}: {deflection} m");
    }
}

#[test]
fn planet_carrier_at_speed() {
    // At 1000 rpm, 168 g, balls that nothing holds would fly: there the bearing is preloaded.
    for (rpm, clearance, most) in
        [(200.0, "10e-6", limits(4200, 20, 10, 3.0)), (1000.0, "-40e-6", limits(4200, 20, 10, 3.0))]
    {
        let name = format!("planet in a carrier at {rpm} rpm");
        let turn = rpm * std::f64::consts::TAU / 60.0;
        let frame = format!("{{ angular_velocity = [{turn:?}, 0, 0], arm = [0, 0.15, 0] }}");
        let scene = Scene::edited(
            CARRIER,
            [
                ("effects.frame", frame.as_str()),
                ("solver", STEPS),
                ("cage", ""),
                ("effects.cage", ""),
                ("bearing.diametral_clearance", clearance),
            ],
        )
        .unwrap();
        let run = Case::new(&name, scene, most).pass();
        // The pin carries the gear load and planet and balls in the field of the carrier.
        let ball = run.simulation.model().bearing.ball.mass;
        let pull = turn * turn * 0.15 * (1.5 + 9.0 * ball);
        let force = mean_force(&run, Race::Inner);
        assert!((force.y / pull - 1.0).abs() < 0.05, "{name}: {force}, {pull} N");
        assert!((force.z / 800.0 - 1.0).abs() < 0.05, "{name}: {force}");
    }
}
