//! Where a system starts: the shaft in balance on its bearings under its loads, balls in the quasi-static equilibrium of that.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Vector3, Vector6};

use super::super::inputs::Inputs;
use super::super::start::held_load;
use super::super::{Simulation, SimulationError};
use super::inputs::{Given, Played, ShaftInputs, ShaftPaths, scripted_spin};
use super::{System, SystemError, SystemOutputs, loads, stations};
use crate::dynamics::carried::SeatMotion;
use crate::dynamics::system::{Joint, Seat, StructureLoad};
use crate::equilibrium::{self, EquilibriumInput, Gyroscopic, Prescribed};
use crate::model::Model;
use crate::model::bodies::Race;
use crate::model::structure::{
    Map, Shaft, Spin, Structure, StructureEnergies, StructurePowers, StructureState, Turning,
};
use crate::numerics::motion::Wrench;
use crate::numerics::step_control::StepControl;
use crate::scene::system::{MountedScene, SystemScene};

/// [N/m] of a steel bearing's order: what a stiffness is shifted by where a step makes no progress.
const TYPICAL_STIFFNESS: f64 = 1e7;
/// [-] imbalance over the forces at work that is aimed at, and that is accepted where rounding in the bearings' equilibria stands against
/// less.
const TOLERANCE: f64 = 1e-10;
const ROUNDED: f64 = 1e-6;
/// [-] imbalance below which a step must lower it.
const NEAR: f64 = 1e-4;
/// [-] longest step over the smallest ball diameter.
const LONGEST_STEP: f64 = 0.01;
/// Most steps.
const MAX_ITERATIONS: u32 = 400;

impl System {
    /// Prepares a system and starts it at time 0, from the equilibrium under its loads.
    ///
    /// # Errors
    /// See [`SystemError`].
    pub fn new(scene: &SystemScene) -> Result<Self, SystemError> {
        Self::starting_at(scene, 0.0)
    }

    /// Prepares a system and starts it at a time \[s], from the equilibrium under what its scripts say then.
    ///
    /// # Errors
    /// See [`SystemError`].
    pub fn starting_at(scene: &SystemScene, time: f64) -> Result<Self, SystemError> {
        Self::start(scene, time, None)
    }

    /// Starts again at the present time, from the equilibrium under the present inputs.
    ///
    /// # Errors
    /// See [`SystemError`].
    pub fn initialise(&mut self) -> Result<(), SystemError> {
        let bearings: Vec<Inputs> = self.bearings.iter().map(|bearing| bearing.inputs).collect();
        *self = Self::start(&self.scene, self.time, Some((&self.inputs, &bearings)))?;
        Ok(())
    }

    /// Starts under these inputs of shaft and bearings, or those of the scripts.
    fn start(
        scene: &SystemScene,
        time: f64,
        given: Option<(&ShaftInputs, &[Inputs])>,
    ) -> Result<Self, SystemError> {
        let shaft = Shaft::new(&scene.shaft, &stations(scene)).map_err(SystemError::Shaft)?;
        let inside = |mounted: &MountedScene| {
            let name = mounted.name.clone();
            move |source: SimulationError| SystemError::Bearing { name, source }
        };
        let mut bearings = vec![];
        let mut joints = vec![];
        for (index, mounted) in scene.bearings.iter().enumerate() {
            let mut bearing = Simulation::starting_at(&mounted.scene, time).map_err(inside(mounted))?;
            if let Some((_, inputs)) = given {
                bearing.set_inputs(inputs[index]);
            }
            let offset = preload(mounted, &bearing.model).map_err(inside(mounted))?;
            let seat = seat(&shaft.stations[index], mounted.mounting.direction.sign(), offset);
            joints.push(Joint { bearing: index, race: Race::Inner, structure: 0, seat });
            bearings.push(bearing);
        }
        let structure = &shaft.structure;
        let scripted = ShaftInputs::scripted(scene, time);
        let inputs = given.map_or(scripted, |(shaft, _)| shaft.clone());
        let spin = initial_spin(scene, &inputs, structure.turning, time);
        let mut state = at_rest(structure, spin);
        let paths = ShaftPaths::steady(&inputs, time, spin.angle);
        // What scripts say at this time is among the inputs.
        let played = Played::none(scene);
        let load = loads::at(&Given { scene, paths: &paths, played: &played }, &shaft, &state, time, time);
        let bearings_now = &mut bearings;
        let mut statics =
            Statics { scene, time, structure, load: &load, joints: &joints, bearings: bearings_now };
        state.coordinates = statics.solve(&state)?;
        for (joint, mounted) in joints.iter().zip(&scene.bearings) {
            let bearing = &mut bearings[joint.bearing];
            place(bearing, &seat_motion(structure, &joint.seat, &state));
            bearing.initialise().map_err(inside(mounted))?;
            Arc::make_mut(&mut bearing.model).carry(joint.race);
            bearing.settle();
        }
        make_consistent(structure, &mut state, &load, &joints, &bearings);
        let solver = scene.solver();
        let control = StepControl::new(solver.initial_step.0, solver.min_step.0, solver.max_step.0);
        bearings.iter_mut().for_each(|bearing| bearing.state.control = control);
        let mut system = Self {
            scales: structure.scales(),
            scene: Arc::new(scene.clone()),
            shaft: Arc::new(shaft),
            bearings,
            joints: Arc::new(joints),
            inputs,
            paths,
            state,
            control,
            time,
            outputs: SystemOutputs::default(),
            workspace: Default::default(),
        };
        system.report();
        Ok(system)
    }
}

/// Turn of a shaft at the start.
fn initial_spin(scene: &SystemScene, inputs: &ShaftInputs, turning: Turning, time: f64) -> Spin {
    match turning {
        Turning::Free => {
            Spin { speed: scene.shaft.start_speed.map_or(0.0, |speed| speed.0), ..Spin::default() }
        }
        Turning::Given | Turning::Still => {
            let scripted = scripted_spin(scene, time);
            let acceleration = if inputs.drive == scripted.speed { scripted.acceleration } else { 0.0 };
            Spin { speed: inputs.drive, acceleration, ..scripted }
        }
    }
}

/// A structure that rests but for its spin.
fn at_rest(structure: &Structure, spin: Spin) -> StructureState {
    let zero = DVector::zeros(structure.size());
    let mut rates = zero.clone();
    if structure.turning == Turning::Free {
        rates[structure.size() - 1] = spin.speed;
    }
    StructureState {
        coordinates: zero.clone(),
        rates,
        accelerations: zero.clone(),
        total: zero.clone(),
        remainder: zero,
        spin,
        torque: 0.0,
        powers: StructurePowers::default(),
        energies: StructureEnergies::default(),
    }
}

/// \[m] axial way of a bearing's inner race by its preload, along the bearing's x axis.
fn preload(mounted: &MountedScene, model: &Model) -> Result<f64, SimulationError> {
    let preload = mounted.mounting.preload;
    let Some(force) = preload.force else {
        return Ok(preload.displacement.map_or(0.0, |way| way.0));
    };
    let mut problem = EquilibriumInput::from_scene(&mounted.scene, Gyroscopic::Friction);
    problem.conditions = [Prescribed::Motion(0.0); 5];
    problem.conditions[0] = Prescribed::Load(force.0);
    (problem.inner_speed, problem.outer_speed) = (0.0, 0.0);
    problem.frame = Default::default();
    Ok(equilibrium::solve(model, &problem)?.displacement[0])
}

/// The seat of a bearing at a station, whose x axis points along the shaft (1) or against it (-1), by half a turn about z.
fn seat(station: &Map, direction: f64, offset: f64) -> Seat {
    let signs = [direction, direction, 1.0];
    let map = Map::from_fn(station.ncols(), |row, column| station[(row, column)] * signs[row % 3]);
    Seat { map, offset: Vector3::new(offset, 0.0, 0.0), direction }
}

/// Motion of a seat.
fn seat_motion(structure: &Structure, seat: &Seat, state: &StructureState) -> SeatMotion {
    let StructureState { coordinates, rates, accelerations, spin, .. } = state;
    let given = (structure.turning == Turning::Given).then_some(spin);
    seat.motion([coordinates, rates, accelerations], given)
}

/// Puts the inner race of a bearing on its seat.
fn place(bearing: &mut Simulation, seat: &SeatMotion) {
    let input = &mut bearing.inputs.inner;
    input.pose = seat.pose();
    input.twist = seat.twist();
    input.speed = seat.rates.x;
    input.axis = None;
}

/// Accelerations and torque of the structure in its state, under what the bearings do.
fn make_consistent(
    structure: &Structure,
    state: &mut StructureState,
    load: &StructureLoad,
    joints: &[Joint],
    bearings: &[Simulation],
) {
    let mut total = &load.force + structure.own_forces(&state.coordinates, &state.rates, &state.spin);
    let mut axial = 0.0;
    let mut from_bearings = DVector::zeros(structure.size());
    for Joint { bearing, race, seat, .. } in joints {
        let Wrench { force, moment } = bearings[*bearing].state.race(*race).bearing_wrench;
        let (moments, _) = seat_motion(structure, seat, state).generalised(&moment);
        from_bearings += seat.map.tr_mul(&crate::model::state::stack(&force, &moments));
        axial += seat.direction * moments.x;
    }
    total += &from_bearings;
    state.accelerations =
        structure.mass.clone().lu().solve(&total).unwrap_or_else(|| DVector::zeros(structure.size()));
    state.spin = structure.spin([&state.coordinates, &state.rates, &state.accelerations], state.spin);
    state.total = total;
    let turns = structure.turning == Turning::Given;
    let inertial = structure.spin_torque(&state.coordinates, &state.accelerations, &state.spin);
    state.torque = if turns { inertial - axial - load.axial_moment } else { 0.0 };
    let drive = if turns { (state.torque + load.axial_moment) * state.spin.speed } else { 0.0 };
    let of_spin = if turns { axial * state.spin.speed } else { 0.0 };
    state.powers = StructurePowers {
        input: load.force.dot(&state.rates) + drive,
        bearings: -(from_bearings.dot(&state.rates) + of_spin),
        damping: state.rates.dot(&(&structure.damping * &state.rates)),
    };
    let stored = structure.stored(&state.coordinates, &state.rates, &state.spin);
    state.energies = StructureEnergies { stored, at_start: stored, ..StructureEnergies::default() };
}

/// The shaft at rest on its bearings.
struct Statics<'a> {
    scene: &'a SystemScene,
    /// \[s] time of the start.
    time: f64,
    structure: &'a Structure,
    load: &'a StructureLoad,
    joints: &'a [Joint],
    bearings: &'a mut [Simulation],
}

/// A trial of the statics.
struct Trial {
    residual: DVector<f64>,
    stiffness: DMatrix<f64>,
    /// \[N] largest force at work.
    force: f64,
}

impl Statics<'_> {
    /// Coordinates in balance. What is shifted where a step makes no progress is the stiffness; a step is progress where the
    /// unbalanced forces do work in it, as the potential then falls.
    fn solve(&mut self, start: &StructureState) -> Result<DVector<f64>, SystemError> {
        let scales = self.structure.scales();
        let mut state = start.clone();
        let smallest = |bearing: &Simulation| 2.0 * bearing.model.bearing.ball.radius;
        let longest = LONGEST_STEP * self.bearings.iter().map(smallest).fold(f64::INFINITY, f64::min);
        let mut here = self.evaluate(&state)?;
        let mut shift = 0.0;
        let mut refused = None;
        let size = |trial: &Trial| trial.residual.component_div(&scales).amax();
        for iterations in 0..MAX_ITERATIONS {
            let allowed = if shift > 1e12 { ROUNDED } else { TOLERANCE };
            if size(&here) <= allowed * here.force.max(1.0) {
                return Ok(state.coordinates);
            }
            if shift > 1e12 {
                let residual = size(&here);
                // What a bearing says is the reason, where it is one.
                return Err(refused.unwrap_or(SystemError::NoEquilibrium { iterations, residual }));
            }
            let mut matrix = here.stiffness.clone();
            for (i, scale) in scales.iter().enumerate() {
                matrix[(i, i)] += shift * TYPICAL_STIFFNESS * scale * scale;
            }
            self.hold_turn(&mut matrix);
            let step = matrix.lu().solve(&here.residual).map(|mut step| {
                let way = step.component_mul(&scales).amax();
                if way > longest {
                    step *= longest / way;
                }
                step
            });
            let trial = step.filter(|step| step.iter().all(|v| v.is_finite())).and_then(|step| {
                let moved = StructureState { coordinates: &state.coordinates + &step, ..state.clone() };
                let trial = self.evaluate(&moved).map_err(|why| refused = Some(why)).ok()?;
                let work = 0.5 * (&here.residual + &trial.residual).dot(&step);
                let downhill = work > 0.0 && size(&here) > NEAR * here.force;
                (downhill || size(&trial) < size(&here) * (1.0 - 1e-6)).then_some((moved, trial))
            });
            match trial {
                Some((moved, trial)) => {
                    (state, here) = (moved, trial);
                    shift = if shift < 1e-9 { 0.0 } else { shift * 0.1 };
                }
                None => shift = if shift == 0.0 { 1e-9 } else { shift * 5.0 },
            }
        }
        Err(SystemError::NoEquilibrium { iterations: MAX_ITERATIONS, residual: size(&here) })
    }

    /// The turn of a shaft is not a matter of statics.
    fn hold_turn(&self, matrix: &mut DMatrix<f64>) {
        if self.structure.turning == Turning::Free {
            let last = matrix.nrows() - 1;
            matrix.row_mut(last).fill(0.0);
            matrix.column_mut(last).fill(0.0);
            matrix[(last, last)] = 1.0;
        }
    }

    fn evaluate(&mut self, state: &StructureState) -> Result<Trial, SystemError> {
        let structure = self.structure;
        let mut residual = &self.load.force - &structure.stiffness * &state.coordinates;
        let mut stiffness = structure.stiffness.clone();
        let mut force = self.load.force.component_div(&structure.scales()).amax();
        for joint in self.joints {
            let bearing = &mut self.bearings[joint.bearing];
            place(bearing, &seat_motion(structure, &joint.seat, state));
            let (load, matrix) = held_load(&bearing.scene, &bearing.model, &mut bearing.inputs, self.time)
                .map_err(|source| SystemError::Bearing {
                    name: self.scene.bearings[joint.bearing].name.clone(),
                    source,
                })?;
            let [x, y, z, about_y, about_z] = load;
            let held = Vector6::new(x, y, z, 0.0, about_y, about_z);
            residual -= joint.seat.map.tr_mul(&held);
            force = force.max(held.fixed_rows::<3>(0).amax());
            let row = |i: usize| if i < 3 { i } else { i + 1 };
            let mut whole = nalgebra::Matrix6::zeros();
            for i in 0..5 {
                for k in 0..5 {
                    whole[(row(i), row(k))] = matrix[(i, k)];
                }
            }
            stiffness += joint.seat.map.tr_mul(&(whole * &joint.seat.map));
        }
        if structure.turning == Turning::Free {
            let last = residual.len() - 1;
            residual[last] = 0.0;
        }
        Ok(Trial { residual, stiffness, force })
    }
}
