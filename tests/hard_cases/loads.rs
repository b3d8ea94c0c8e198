//! Heavy and skew loads: misalignment, moment, preload, counter-rotation.

use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};

use crate::gates::{Case, limits};
use crate::scenes::{ANGULAR, GROOVE, HELD, load, scene};

#[test]
fn misalignment_of_half_a_degree() {
    let outer = "[outer]\ndrive = \"fixed\"\nmisalignment = { ry = \"0.5 deg\" }\n";
    let groove = "[bearing]\nballs = 9\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
         diametral_clearance = \"30 um\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n";
    for (name, base, changes) in [
        ("misaligned by 0.5 deg, angular contact, tilt held", ANGULAR, load(30.0, 6000.0, &format!("x = {{ force = 1500.0 }}\n{HELD}"))),
        ("misaligned by 0.5 deg, deep groove, tilt held", GROOVE, load(30.0, 6000.0, "y = { force = 1000.0 }\nx = { displacement = 0.0 }\nry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n") + groove),
        ("misaligned by 0.5 deg, angular contact, tilt free", ANGULAR, load(30.0, 6000.0, "x = { force = 1500.0 }\n")),
    ] {
        let run = Case::new(name, scene(base, &(changes + outer)), limits(20000, 300, 100, 5.0)).pass();
        let last = run.last();
        let input = EquilibriumInput::from_scene(run.simulation.scene(), Gyroscopic::None);
        let e = equilibrium::solve(run.simulation.model(), &input).unwrap();
        println!("{:?} {:?}", e.load, last.inner.wrench);
        for b in &e.balls { print!("{:.1}:{:.0} ", b.azimuth.to_degrees(), b.report.inner_load); }
        println!();
        for b in &last.balls { print!("{:.1}:{:.0} {:.1} ", b.azimuth.to_degrees(), b.inner.load, b.orbital_speed); }
        println!();
    }
}

#[test]
fn high_moment_load() {
    let rows = "rz = { moment = 60.0 }\nx = { displacement = 0.0 }\ny = { displacement = 0.0 }\nz = { displacement = 0.0 }\n";
    let run = Case::new("60 N m on a deep-groove bearing", scene(GROOVE, &load(30.0, 6000.0, rows)), limits(20000, 300, 100, 5.0)).pass();
    let last = run.last();
    println!("{:?}", last.inner.wrench);
    for b in &last.balls { print!("{:.1}:{:.0} {:.1} ", b.azimuth.to_degrees(), b.inner.load, b.orbital_speed); }
}

#[test]
fn preload() {
    for micrometres in [-20.0, -200.0, -700.0] {
        let bearing = format!("[bearing]\nballs = 9\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
         diametral_clearance = \"{micrometres} um\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n");
        let rows = "y = { force = 500.0 }\nx = { force = 100.0 }\n";
        let name = format!("interference {} um", -micrometres);
        let run = Case::new(&name, scene(GROOVE, &(bearing + &load(20.0, 6000.0, rows))), limits(20000, 300, 100, 5.0)).pass();
        let last = run.last();
        for b in &last.balls { print!("{:.1}:{:.0} {:.1} ", b.azimuth.to_degrees(), b.inner.load, b.orbital_speed); }
        println!();
    }
}

#[test]
fn counter_rotating_races() {
    let rows = "x = { force = 1500.0 }\nouter_speed = \"-6000 rpm\"\n";
    let run = Case::new("races at 6000 and -6000 rpm", scene(ANGULAR, &load(20.0, 6000.0, rows)), limits(20000, 300, 100, 5.0)).pass();
    println!("{} {}", run.last().cage_speed, run.history[0].cage_speed);
}
