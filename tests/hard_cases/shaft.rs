//! Two bearings on one rigid shaft that the importer integrates, coupled by pose and wrench.

use nalgebra::{UnitQuaternion, Vector3};
use roulement::interface::variables::Variables;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::{Simulation, Snapshot};

use crate::gates::{change, converged, energy_residual, possible};
use crate::scenes::{ANGULAR, HELD, POSE, load, scene};

/// [s] communication step, at which 20 kg on these bearings are stable with an extrapolated pose.
const STEP: f64 = 2e-5;
/// [kg], [kg m2] mass and transverse inertia.
const MASS: f64 = 20.0;
const INERTIA: f64 = 0.4;
/// [m] the bearings' places along the shaft; it is loaded at 0.
const PLACES: [f64; 2] = [-0.1, 0.15];
/// [rad/s].
const SPEED: f64 = 200.0 * std::f64::consts::PI;
/// [N] thrust that the bearings are set against each other with.
const PRELOAD: f64 = 500.0;

/// Shaft with two angular-contact bearings, the second one turned round so that they lean against each other.
struct Shaft {
    bearings: [Simulation; 2],
    /// [m] where the preload holds each inner race in its own bearing.
    seats: [Vector3<f64>; 2],
    motion: Motion,
}

/// Displacement and small rotation of the shaft, their rates, and its turn.
#[derive(Clone, Copy, Default, PartialEq, Debug)]
struct Motion {
    time: f64,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    tilt: Vector3<f64>,
    rate: Vector3<f64>,
}

/// From world to the frame of a bearing: the second one is turned about y.
fn frame(k: usize) -> UnitQuaternion<f64> {
    UnitQuaternion::new(Vector3::y() * if k == 0 { 0.0 } else { std::f64::consts::PI })
}

/// [N] external force at a time [s]: grows within 10 ms.
fn external(time: f64) -> Vector3<f64> {
    Vector3::new(200.0, 1000.0, 0.0) * (time / 0.01).min(1.0)
}

impl Shaft {
    fn new(cap: f64) -> Self {
        let rows = format!("x = {{ force = {PRELOAD} }}\n{HELD}");
        let forward = scene(ANGULAR, &(load(60.0, 6000.0, &rows) + POSE));
        let backward = scene(ANGULAR, &(load(60.0, -6000.0, &rows) + POSE));
        let bearings = [forward, backward].map(|mut scene| {
            scene.solver.max_step.0 = cap;
            Simulation::new(&scene).unwrap()
        });
        let seats = [0, 1].map(|k: usize| bearings[k].inputs().inner.pose.position);
        Self { bearings, seats, motion: Motion::default() }
    }

    /// One communication step: bearings first, along the extrapolated motion; then the shaft with their forces.
    fn step(&mut self, n: u32) {
        let m = &mut self.motion;
        let end = f64::from(n + 1) * STEP;
        let spin = UnitQuaternion::new(m.tilt) * Vector3::x() * SPEED;
        let orientation = UnitQuaternion::new(m.tilt) * UnitQuaternion::new(Vector3::x() * (SPEED * m.time));
        let (mut force, mut moment) = (external(end), Vector3::zeros());
        for (k, bearing) in self.bearings.iter_mut().enumerate() {
            let (to, arm) = (frame(k).inverse(), Vector3::x() * PLACES[k]);
            let mut inputs = *bearing.inputs();
            inputs.inner.pose.position = self.seats[k] + to * (m.position + m.tilt.cross(&arm));
            inputs.inner.pose.orientation = to * orientation * to.inverse();
            inputs.inner.twist.velocity = to * (m.velocity + m.rate.cross(&arm));
            inputs.inner.twist.angular_velocity = to * (spin + m.rate);
            bearing.set_inputs(inputs);
            bearing.advance(end).unwrap();
            let wrench = &bearing.outputs().inner.wrench;
            force += to.inverse() * wrench.force;
            moment += to.inverse() * wrench.moment + arm.cross(&(to.inverse() * wrench.force));
        }
        moment.x = 0.0; // its speed is prescribed
        let h = end - m.time;
        m.velocity += force * (h / MASS);
        m.rate += moment * (h / INERTIA);
        m.position += m.velocity * h;
        m.tilt += m.rate * h;
        m.time = end;
    }

    /// Runs `from..to`, looking at every tenth step.
    fn run(&mut self, steps: std::ops::Range<u32>, mut look: impl FnMut(&Self, u32)) -> [Vec<Outputs>; 2] {
        let mut history = [0, 1].map(|k: usize| vec![self.bearings[k].outputs().clone()]);
        for n in steps {
            self.step(n);
            if (n + 1) % 10 == 0 {
                look(self, n + 1);
                for (outputs, bearing) in history.iter_mut().zip(&self.bearings) {
                    outputs.push(bearing.outputs().clone());
                }
            }
        }
        history
    }
}

#[test]
fn two_bearings_share_the_load_of_a_shaft() {
    const STEPS: u32 = 3000;
    let mut shaft = Shaft::new(1e-5);
    let variables = Variables::moving(shaft.bearings[0].scene(), true);
    let mut saved: Option<([Snapshot; 2], Motion)> = None;
    let history = shaft.run(0..STEPS, |shaft, n| {
        for bearing in &shaft.bearings {
            possible("shaft", bearing, &variables);
            converged("shaft", bearing);
        }
        if n == STEPS / 2 {
            saved = Some(([0, 1].map(|k: usize| shaft.bearings[k].snapshot()), shaft.motion));
        }
    });
    // replayed to the same bits
    let (snapshots, motion) = saved.unwrap();
    let mut other = Shaft::new(1e-5);
    for (bearing, snapshot) in other.bearings.iter_mut().zip(&snapshots) {
        assert!(bearing.restore(snapshot));
    }
    other.motion = motion;
    other.run(STEPS / 2..STEPS, |_, _| {});
    assert_eq!(other.motion, shaft.motion);
    // half the step cap
    let finer = Shaft::new(0.5e-5).run(0..STEPS, |_, _| {});
    let window = 200..=300;
    let arm = 0.023;
    for k in 0..2 {
        let energy = energy_residual(&history[k]);
        let (largest, what) = change(&history[k][window.clone()], &finer[k][window.clone()], arm);
        let s = shaft.bearings[k].state().statistics;
        println!(
            "\n| shaft, bearing {} | 60.0000 ms | {} | {:.2} | {} | {} | {:.2} | {energy:.0e} | {largest:.0e} |",
            k + 1,
            s.steps,
            0.06 / s.steps as f64 * 1e6,
            s.rejected_error,
            s.second_guesses + s.rejected_newton,
            s.newton.iterations as f64 / s.steps as f64
        );
        assert!(energy < 0.01 && largest < 0.02, "{what}");
        assert!(s.rejected_error + s.rejected_newton + s.second_guesses < 10, "{s:?}");
    }
    // Statics: forces and moments of both bearings on the shaft balance the load.
    let mean = |k: usize, moment: bool| {
        let sum = history[k][window.clone()].iter().fold(Vector3::zeros(), |sum: Vector3<f64>, o| {
            sum + frame(k) * if moment { o.inner.wrench.moment } else { o.inner.wrench.force }
        });
        sum / 101.0
    };
    let forces = [0, 1].map(|k| mean(k, false));
    let total = forces[0] + forces[1] + external(1.0);
    let moments = [0, 1].map(|k: usize| mean(k, true) + (Vector3::x() * PLACES[k]).cross(&forces[k]));
    let turning = moments[0] + moments[1];
    assert!(total.norm() < 1e-3 * 1000.0, "{total:?} N");
    assert!(turning.yz().norm() < 1e-3 * 1000.0 * 0.1, "{turning:?} N m");
    // The lever law, but for the bearings' own moments; the thrust goes to the bearing that it presses on.
    assert!((forces[0].y / -600.0 - 1.0).abs() < 0.05, "{forces:?}");
    assert!(forces[0].x < 0.0 && forces[1].x > 0.0 && forces[0].x.abs() > forces[1].x.abs());
}
