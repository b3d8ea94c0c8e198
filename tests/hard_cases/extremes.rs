//! Few and many balls, soft and stiff ones, clearance to its limit, far from the origin, and very long.

use nalgebra::Vector3;
use roulement::simulation::Simulation;
use roulement::simulation::inputs::Inputs;

use crate::gates::{Case, Limits, Run, limits};
use crate::scenes::{ANGULAR, FLAT, GROOVE, HELD, POSE, ROLLING_START, groove, load, scene};

fn bearing(balls: u32, diameter: &str) -> String {
    format!(
        "[bearing]\nballs = {balls}\nball_diameter = \"{diameter}\"\npitch_diameter = \"46 mm\"\n\
         contact_angle = \"25 deg\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n"
    )
}

#[test]
fn ball_counts() {
    // Fewer than three balls hold no race in the middle.
    for (balls, diameter, held) in
        [(1, "9.525 mm", HELD), (2, "9.525 mm", HELD), (3, "9.525 mm", ""), (40, "3 mm", "")]
    {
        let force = f64::from(30 * balls);
        let rows = format!("x = {{ force = {force} }}\n{held}");
        let scene = scene(ANGULAR, &(bearing(balls, diameter) + &load(20.0, 6000.0, &rows)));
        let run = Case::new(&format!("{balls} balls"), scene, limits(2300, 10, 10, 3.0)).pass();
        let thrust = -run.last().inner.wrench.force.x;
        assert!((thrust / force - 1.0).abs() < 2e-3, "{thrust} N");
        assert!(run.last().cage_slip.abs() < 0.01, "{}", run.last().cage_slip);
    }
}

#[test]
fn soft_and_stiff() {
    for (name, modulus, ratio, force) in [("rubber, 5 MPa", 5e6, 0.49, 2.0), ("1e13 Pa", 1e13, 0.2, 1500.0)] {
        let material =
            |section| format!("[{section}]\nyoungs_modulus = {modulus}\npoisson_ratio = {ratio}\n");
        let rows = format!("x = {{ force = {force} }}\n");
        let scene = scene(ANGULAR, &(material("ball") + &material("race") + &load(20.0, 600.0, &rows)));
        let run = Case::new(name, scene, limits(2300, 10, 20, 2.0)).pass();
        let thrust = -run.last().inner.wrench.force.x;
        assert!((thrust / force - 1.0).abs() < 0.03, "{thrust} N");
    }
}

#[test]
fn balls_on_their_groove_centre() {
    // The largest clearance there is: before it takes load every ball sits exactly where a groove has no normal.
    let rows = format!("y = {{ force = 100.0 }}\n{FLAT}");
    let scene = scene(GROOVE, &(groove(762.0, 0.52) + &load(10.0, 0.0, &rows)));
    let run = Case::new("balls at rest on their groove centres", scene, limits(2000, 20, 20, 4.0)).pass();
    assert!((run.last().inner.wrench.force.y / -100.0 - 1.0).abs() < 0.05);
}

#[test]
fn far_from_the_origin() {
    let run = |far: Vector3<f64>| -> Run {
        let importer = move |simulation: &Simulation, point: u32| -> (Inputs, f64) {
            let mut inputs = simulation.scripted_inputs(simulation.time());
            // The script holds these directions at the origin.
            inputs.inner.pose.position.y = far.y;
            inputs.inner.pose.position.z = far.z;
            (inputs, f64::from(point + 1) * 1e-4)
        };
        let name = format!("{:.0} m from the origin", far.norm());
        let rows = format!("x = {{ force = 1500.0 }}\n{HELD}");
        let changes = load(20.0, 6000.0, &rows) + POSE + "\n[outer]\ndrive = \"pose\"\n" + ROLLING_START;
        let mut case = Case::new(&name, scene(ANGULAR, &changes), limits(2300, 5, 5, 3.0));
        case.displaced = far;
        case.importer = Some(&importer);
        case.pass()
    };
    let here = run(Vector3::zeros());
    for (far, digits) in [(Vector3::new(10.0, -5.0, 2.0), 1e-8), (Vector3::new(1000.0, -500.0, 200.0), 1e-6)]
    {
        let there = run(far);
        for (a, b) in here.history.iter().zip(&there.history) {
            let difference = (a.inner.wrench.force - b.inner.wrench.force).norm();
            assert!(difference < digits * a.inner.wrench.force.norm(), "{difference} N at {} s", a.time);
        }
    }
}

/// The inner race turns `revolutions` times at 30,000 rpm, the outer one so fast the other way that the cage hardly
/// moves.
fn many_revolutions(revolutions: f64, limit: Limits) {
    let ratio = 0.5 * (1.0 - 9.525 / 46.0 * 25f64.to_radians().cos());
    let outer = -30_000.0 * ratio / (1.0 - ratio);
    let rows = format!(
        "x = {{ force = 500.0 }}\n{HELD}outer_speed = \"{outer} rpm\"\noutput_interval = {}\n",
        revolutions * 2e-5
    );
    let changes = bearing(1, "9.525 mm")
        + &load(revolutions * 2.0, 30_000.0, &rows)
        + "[inner]\ndrive = \"fixed\"\n[solver]\nmax_step = 1e-3\n";
    let name = format!("{revolutions:e} revolutions at 30,000 rpm, cage nearly at rest");
    let run = Case::new(&name, scene(ANGULAR, &changes), limit).pass();
    // Nothing has drifted: the races' angles, their orientations' unit length, the load, the rolling of the ball.
    let last = run.last();
    let turned = last.inner.turned / std::f64::consts::TAU;
    assert!((turned / revolutions - 1.0).abs() < 1e-9, "{turned}");
    assert!((last.inner.pose.orientation.norm() - 1.0).abs() < 1e-15);
    assert!((last.balls[0].inner.load / run.history[10].balls[0].inner.load - 1.0).abs() < 1e-3);
}

#[test]
fn a_thousand_revolutions() {
    many_revolutions(1e3, limits(18_000, 10, 10, 3.0));
}

#[test]
#[ignore = "long"]
fn a_million_revolutions() {
    many_revolutions(1e6, limits(18_000_000, 10_000, 10_000, 3.0));
}
