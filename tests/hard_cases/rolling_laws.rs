//! Standstill, a jump of friction and a reversal with the richer rolling contact laws.

use roulement::simulation::Simulation;
use roulement::simulation::inputs::Inputs;

use crate::gates::{Case, limits};
use crate::scenes::{ANGULAR, load, ramp, scene};

const COMBINED: &str = "x = { force = 1500.0 }\ny = { force = 300.0 }\n";

/// Laws with the section that asks for them: the nonlinear theory, the same with Heathcote slip, and the paper's law
/// with spin coupling, which is always full; and the nonlinear theory in polynomials, frozen for each step.
const LAWS: [(&str, &str); 4] = [
    ("kalker_table", "creep = \"kalker_table\""),
    ("kalker_table, Heathcote slip", "creep = \"kalker_table\"\nheathcote_slip = true"),
    ("regularised", "creep = \"regularised\""),
    ("kalker", "creep = \"kalker\""),
];

fn effects(law: &str) -> String {
    format!("[effects]\n{law}\ndamping = \"0.02 s/m\"\n")
}

#[test]
fn standstill() {
    for (name, law) in LAWS {
        let name = format!("standstill, {name}");
        let rows = format!("{COMBINED}rz = {{ moment = 3.0 }}\n");
        let scene = scene(ANGULAR, &(load(10.0, 0.0, &rows) + &effects(law)));
        // `regularised`, whose forces bend sharply at rest, takes 3.7 corrections and 1.6 matrices a step.
        let run = Case::new(&name, scene, limits(1200, 5, 90, 7.0)).pass();
        let (first, last) = (&run.history[0], run.last());
        let largest = first.balls.iter().map(|ball| ball.inner.load).fold(0.0, f64::max);
        for (a, b) in first.balls.iter().zip(&last.balls) {
            assert!(
                (a.position - b.position).norm() < 5e-9 && b.angular_velocity.norm() < 2e-4,
                "{name}: {b:?}"
            );
            assert!((a.inner.load - b.inner.load).abs() < 5e-4 * largest, "{name}");
        }
    }
}

#[test]
fn loss_of_lubrication() {
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        inputs.friction = if point < 30 { 0.01 } else { 0.15 };
        (inputs, f64::from(point + 1) * 1e-4)
    };
    for (name, law) in LAWS {
        let name = format!("friction from 0.01 to 0.15 at once, {name}");
        let low = "[friction]\nball_race = 0.01\n";
        let scene = scene(ANGULAR, &(load(6.0, 6000.0, COMBINED) + low + &effects(law)));
        let mut case = Case::new(&name, scene, limits(720, 10, 10, 6.0));
        case.importer = Some(&importer);
        let run = case.pass();
        let (before, after) = (&run.history[30], &run.history[31]);
        assert!(after.friction_power > 5.0 * before.friction_power, "{name}");
        let usual = (run.history[29].inner.pose.position - before.inner.pose.position).norm();
        let step = (after.inner.pose.position - before.inner.pose.position).norm();
        assert!(step < 3.0 * usual + 1e-7, "{name}: {step} m, {usual} m");
    }
}

#[test]
fn speed_reversal() {
    for (name, law) in LAWS {
        let name = format!("speed from 6000 to -6000 rpm in 5 ms, {name}");
        let speed = "[[0.0, \"6000 rpm\"], [0.001, \"6000 rpm\"], [0.006, \"-6000 rpm\"]]";
        let scene = scene(ANGULAR, &(ramp(11.0, speed, "x = { force = 1500.0 }\n") + &effects(law)));
        let run = Case::new(&name, scene, limits(1400, 10, 10, 4.0)).pass();
        assert!(run.last().cage_slip.abs() < 0.03 && run.last().cage_speed < 0.0, "{}", run.last().cage_slip);
        assert!(run.history.windows(2).all(|pair| pair[1].dissipated >= pair[0].dissipated), "{name}");
    }
}
