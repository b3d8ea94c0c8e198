//! One run of one setting: its samples and its cost.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::levers::{Inputs, Level, Setting};
use super::meter::{Cost, Meter};
use super::{StudyError, WINDOW_START};
use crate::report::means::{Blocks, Means};
use roulement::model::bodies::Race;
use roulement::model::state::Statistics;
use roulement::numerics::motion::{Pose, Twist};
use roulement::scene::{Drive, Groups};
use roulement::simulation::Simulation;
use roulement::simulation::inputs;
use roulement::simulation::machine::{Machine, MachineError};
use roulement::simulation::outputs::Outputs;
use roulement::simulation::play::{Rows, play_with};
use roulement::simulation::system::{Played, ShaftInputs};

/// \[s] CPU time after which a run is not repeated any more, and the largest number of runs.
const ENOUGH_TIME: f64 = 0.4;
const MOST_RUNS: u32 = 3;
/// \[s] how far ahead the rate of a scripted twist is taken.
const RATE_STEP: f64 = 1e-7;

/// Sample of a run at a communication point.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// \[s] time.
    pub time: f64,
    /// \[N] force of the bearing on the inner race, then its moments about y and z over the pitch radius.
    pub wrench: [f64; 5],
    /// \[m] displacement of the inner race, then its tilts about y and z times the pitch radius.
    pub displacement: [f64; 5],
    /// [N m] friction torque.
    pub friction_torque: f64,
    /// \[W] friction power.
    pub friction_power: f64,
    /// \[W] friction power of all contacts with the inner race and with the outer.
    pub race_power: [f64; 2],
    /// \[W] part of both by spin moments.
    pub spin_power: f64,
    /// \[N] largest load of a contact with a race.
    pub largest_load: f64,
    /// \[Pa] largest peak pressure of a contact with a race.
    pub peak_pressure: f64,
    /// [rad/s] orbital speed of every ball.
    pub orbital_speed: Vec<f64>,
    /// [rad/s] cage speed.
    pub cage_speed: f64,
    /// \[J] lost since the start.
    pub dissipated: f64,
    /// \[J] work put in less what was lost and what is stored.
    pub unaccounted: f64,
}

impl Sample {
    fn new(outputs: &Outputs, pitch_radius: f64) -> Self {
        let (force, moment) = (outputs.inner.wrench.force, outputs.inner.wrench.moment / pitch_radius);
        let position = outputs.inner.pose.position - outputs.outer.pose.position;
        let axis = outputs.inner.pose.orientation * Vector3::x() * pitch_radius;
        let pressures =
            outputs.balls.iter().flat_map(|ball| [&ball.inner, &ball.outer]).map(|c| c.peak_pressure);
        Self {
            time: outputs.time,
            wrench: [force.x, force.y, force.z, moment.y, moment.z],
            displacement: [position.x, position.y, position.z, -axis.z, axis.y],
            friction_torque: outputs.friction_torque,
            friction_power: outputs.friction_power,
            race_power: Race::BOTH.map(|race| outputs.contact_power(|ball| ball[race].power)),
            spin_power: outputs.contact_power(|ball| ball.inner.spin_power + ball.outer.spin_power),
            largest_load: outputs.loads().fold(0.0, f64::max),
            peak_pressure: pressures.fold(0.0, f64::max),
            orbital_speed: outputs.balls.iter().map(|ball| ball.orbital_speed).collect(),
            cage_speed: outputs.cage_speed,
            dissipated: outputs.dissipated,
            unaccounted: outputs.work - outputs.dissipated - outputs.stored_energy,
        }
    }
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Record {
    /// Samples of every bearing from the start on.
    pub bearings: Vec<Vec<Sample>>,
    /// Cost without the start; the least of some runs.
    pub cost: Cost,
    /// Work of the integrator.
    pub work: Statistics,
    /// Was it integrated in time?
    pub level: Level,
    /// Means of every bearing by its name over the window in which errors are measured, and whether they have settled.
    pub means: Vec<(String, Means)>,
}

/// Runs a setting, repeatedly if it is short.
///
/// # Errors
/// If the run cannot start or go on, or was interrupted.
pub fn record(setting: &Setting, interrupted: &AtomicBool) -> Result<Record, StudyError> {
    let start = Machine::new(&setting.scene)?;
    let mut best = run(setting, start.clone(), interrupted)?;
    let (mut total, mut runs) = (best.cost.cpu, 1);
    while total < ENOUGH_TIME && runs < MOST_RUNS {
        let again = run(setting, start.clone(), interrupted)?.cost;
        total += again.cpu;
        runs += 1;
        if again.cpu < best.cost.cpu {
            best.cost = again;
        }
    }
    Ok(best)
}

fn run(setting: &Setting, mut machine: Machine, interrupted: &AtomicBool) -> Result<Record, StudyError> {
    let rows = Rows::new(setting.communication, setting.scene.duration());
    let radius = |bearing: &Simulation| 0.5 * bearing.model().bearing.pitch_diameter;
    let none = || Vec::with_capacity(rows.count() as usize + 1);
    let mut bearings: Vec<Vec<Sample>> = machine.bearings().map(|_| none()).collect();
    let mut blocks: Vec<Blocks> =
        machine.bearings().map(|(_, bearing)| Blocks::of_bearing(bearing)).collect();
    let meter = Meter::start();
    let flow = play_with(
        &mut machine,
        rows,
        |machine, end| advance(setting, machine, end),
        |machine| {
            for ((_, bearing), (samples, blocks)) in
                machine.bearings().zip(bearings.iter_mut().zip(&mut blocks))
            {
                samples.push(Sample::new(bearing.outputs(), radius(bearing)));
                blocks.push(&bearing.outputs().into());
            }
            if interrupted.load(Ordering::Relaxed) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        },
    )?;
    if flow.is_break() {
        return Err(StudyError::Interrupted);
    }
    let cost = meter.stop();
    let means = machine.bearings().zip(&blocks);
    let means =
        means.filter_map(|((name, _), blocks)| Some((name.to_string(), blocks.means_from(WINDOW_START)?)));
    let means = means.collect();
    Ok(Record { bearings, cost, work: machine.statistics(), level: setting.level, means })
}

/// Takes a machine to the time \[s] of the next communication point.
fn advance(setting: &Setting, machine: &mut Machine, end: f64) -> Result<(), MachineError> {
    match (setting.level, &mut *machine) {
        (Level::Dynamic, Machine::Bearing(simulation)) => {
            simulation.set_inputs(inputs_of_step(simulation, setting.inputs, end));
            simulation.advance(end)?;
        }
        (Level::Dynamic, Machine::Shaft(system)) if setting.lever.is_communication() => {
            let known = if setting.inputs == Inputs::Ahead { end } else { system.time() };
            let shaft = ShaftInputs::scripted(system.scene(), known);
            let bearings = system.bearings().map(|(_, bearing)| *bearing.inputs()).collect();
            let fit = system.set_inputs(shaft, bearings);
            debug_assert!(fit, "inputs of this very shaft fit it");
            // What an importer gives are loads and drives; friction and temperatures are the scene's.
            let none = Played::none(system.scene());
            let played = Played { bearings: vec![Groups::ALL; none.bearings.len()], ..none };
            system.advance_with(end, &played)?;
        }
        (Level::Dynamic, Machine::Shaft(system)) => system.advance(end)?,
        (Level::Equilibrium, Machine::Bearing(simulation)) => {
            simulation.set_start_time(end);
            simulation.set_inputs(simulation.scripted_inputs(end));
            simulation.initialise()?;
        }
        (Level::Equilibrium, Machine::Shaft(_)) => *machine = Machine::starting_at(&setting.scene, end)?,
    }
    Ok(())
}

/// Inputs that an importer sets at the start of a step to `end` \[s].
fn inputs_of_step(simulation: &Simulation, knows: Inputs, end: f64) -> inputs::Inputs {
    let now = simulation.time();
    let mut inputs = simulation.scripted_inputs(now);
    let pose_driven = simulation.scene().inner.drive == Drive::Pose;
    match knows {
        Inputs::Held => {}
        Inputs::Derivatives => {
            let later = simulation.scripted_inputs(now + RATE_STEP).inner.twist;
            let twist = &inputs.inner.twist;
            inputs.inner.twist_rate = Twist {
                velocity: (later.velocity - twist.velocity) / RATE_STEP,
                angular_velocity: (later.angular_velocity - twist.angular_velocity) / RATE_STEP,
            };
        }
        Inputs::Ahead => {
            let duration = end - now;
            let here = inputs;
            inputs = simulation.scripted_inputs(end);
            if pose_driven {
                let target =
                    pose_at_end(&simulation.state().race(Race::Inner).pose, &here, &inputs, duration);
                // The model goes on from the inputs with their twist: they are set back so that it ends on the target.
                let Twist { velocity, angular_velocity } = inputs.inner.twist;
                inputs.inner.pose = Pose {
                    position: target.position - velocity * duration,
                    orientation: UnitQuaternion::new(-angular_velocity * duration) * target.orientation,
                };
            }
        }
    }
    inputs
}

/// Where the script has the inner race at the end of a step: its position and axis; the turn about that axis, which a
/// script does not give, goes on at the mean of the speeds.
fn pose_at_end(now: &Pose, here: &inputs::Inputs, ahead: &inputs::Inputs, duration: f64) -> Pose {
    let axis = now.orientation * Vector3::x();
    let target = ahead.inner.pose.orientation * Vector3::x();
    let turned = axis * (0.5 * (here.inner.speed + ahead.inner.speed) * duration);
    // Exact for the smallest of tilts, where the arc cosine of a dot product has eight digits.
    let tilt =
        UnitQuaternion::new_normalize(Quaternion::from_parts(1.0 + axis.dot(&target), axis.cross(&target)));
    Pose {
        position: ahead.inner.pose.position,
        orientation: tilt * UnitQuaternion::new(turned) * now.orientation,
    }
}
