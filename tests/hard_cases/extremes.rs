//! Few and many balls, soft and stiff ones, far from the origin, and very long.

use nalgebra::Vector3;
use roulement::inputs::Inputs;
use roulement::simulation::Simulation;

use crate::gates::{Case, limits};
use crate::scenes::{ANGULAR, HELD, POSE, load, scene};

fn bearing(balls: u32, diameter: &str) -> String {
    format!(
        "[bearing]\nballs = {balls}\nball_diameter = \"{diameter}\"\npitch_diameter = \"46 mm\"\n\
         contact_angle = \"25 deg\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n"
    )
}

#[test]
fn ball_counts() {
    for (balls, diameter, held) in [(1, "9.525 mm", HELD), (2, "9.525 mm", HELD), (3, "9.525 mm", ""), (40, "3 mm", "")] {
        let rows = format!("x = {{ force = {} }}\n{held}", 30 * balls);
        let name = format!("{balls} balls");
        let run = Case::new(&name, scene(ANGULAR, &(bearing(balls, diameter) + &load(20.0, 6000.0, &rows))), limits(100_000, 100, 100, 5.0)).pass();
        println!("{:?} {}", run.last().inner.wrench.force, run.last().cage_slip);
    }
}

#[test]
fn soft_and_stiff() {
    for (name, modulus, nu, force) in [("5 MPa rubber", 5e6, 0.49, 2.0), ("1e13 Pa", 1e13, 0.2, 1500.0)] {
        let material = format!("[ball]\nyoungs_modulus = {modulus}\npoisson_ratio = {nu}\n[race]\nyoungs_modulus = {modulus}\npoisson_ratio = {nu}\n");
        let rows = format!("x = {{ force = {force} }}\n");
        let run = Case::new(name, scene(ANGULAR, &(material + &load(20.0, 600.0, &rows))), limits(100_000, 100, 100, 5.0)).pass();
        println!("{:?} {} {}", run.last().inner.wrench.force, run.last().cage_slip, run.last().inner.pose.position.x);
    }
}

#[test]
fn far_from_the_origin() {
    let rows = format!("x = {{ force = 1500.0 }}\n{HELD}");
    let run = |far: Vector3<f64>| {
        let importer = move |simulation: &Simulation, point: u32| -> (Inputs, f64) {
            let mut inputs = simulation.scripted_inputs(simulation.time());
            // The script holds these directions at the origin.
            inputs.inner.pose.position.y = far.y;
            inputs.inner.pose.position.z = far.z;
            (inputs, f64::from(point + 1) * 1e-4)
        };
        let name = format!("bearing {:.0} m from the origin", far.norm());
        let scene = scene(ANGULAR, &(load(20.0, 6000.0, &rows) + POSE + "\n[outer]\ndrive = \"pose\"\n"));
        let mut case = Case::new(&name, scene, limits(100_000, 100, 100, 5.0));
        case.displaced = far;
        case.importer = Some(&importer);
        case.pass()
    };
    let here = run(Vector3::zeros());
    for far in [Vector3::new(10.0, -5.0, 2.0), Vector3::new(1000.0, -500.0, 200.0)] {
        let there = run(far);
        for i in [1, 50, 200] {
            println!("{:?} {:?}", here.history[i].inner.wrench.force, there.history[i].inner.wrench.force);
        }
    }
}
