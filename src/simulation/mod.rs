//! A running bearing: model, state, inputs, and the one function that advances it.

pub mod inputs;
pub mod outputs;
pub mod path;
pub mod spin_balance;
pub mod start;

use std::cmp::Ordering;
use std::sync::Arc;

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::contact::geometry::GrooveContact;
use crate::dynamics::arrowhead::KeptMatrix;
use crate::dynamics::state::State;
use crate::dynamics::{
    Blame, Boundary, RaceLoad, StepFailure, Workspace, follow, make_consistent, to_blame, try_step,
};
use crate::equilibrium::{EquilibriumError, MAX_APPROACH};
use crate::kalker::nonlinear::KalkerError;
use crate::model::{INNER, Model, OUTER};
use crate::numerics::motion::Wrench;
use crate::scene::{Condition, Drive, Scene};
use crate::simulation::inputs::{Inputs, RaceInput};
use crate::simulation::outputs::Outputs;
use crate::simulation::path::{RAMP_WIDTH, RacePath, Ramp};

/// Why a simulation could not start or go on.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// No creep coefficients for the bearing's contacts.
    #[error("the creep law has no coefficients for this bearing: {0}")]
    Creep(#[from] KalkerError),
    /// No quasi-static equilibrium to start from.
    #[error("no equilibrium to start from: {0}")]
    Start(#[from] EquilibriumError),
    /// The step size fell below its minimum.
    #[error(
        "at {time} s the step fell below solver.min_step = {min_step} s: {cause}, worst at {blame} \
         (inner load {inner_load} N, outer load {outer_load} N)"
    )]
    StepTooSmall {
        /// [s] time reached.
        time: f64,
        /// [s] smallest step allowed.
        min_step: f64,
        /// What made the last step fail.
        cause: &'static str,
        /// Body, ball and contact it is laid to.
        blame: Blame,
        /// [N] load of that ball on the inner race.
        inner_load: f64,
        /// [N] its load on the outer race.
        outer_load: f64,
    },
    /// A contact is deeper than Hertz's theory reaches.
    #[error(
        "at {time} s ball {ball} is pressed into the {race} race by {approach:.3e} m: more than {MAX_APPROACH} of its \
         diameter, far beyond elastic Hertzian contact; the load is too large or the imposed motion is"
    )]
    Overload {
        /// [s] time.
        time: f64,
        /// Ball, counted from 1.
        ball: usize,
        /// Inner or outer.
        race: &'static str,
        /// [m] approach.
        approach: f64,
    },
    /// A contact lies where no groove is.
    #[error(
        "at {time} s ball {ball} touches the {race} race on the side where it has no groove, {approach:.3e} m deep: the \
         race has come past its balls; the load, the clearance or the motion is too large, or a cage is missing"
    )]
    LeftGroove {
        /// [s] time.
        time: f64,
        /// Ball, counted from 1.
        ball: usize,
        /// Inner or outer.
        race: &'static str,
        /// [m] approach.
        approach: f64,
    },
    /// The Newton matrix of a step that neighbours were to follow is singular.
    #[error("at {0} s the Newton matrix is singular")]
    Singular(f64),
    /// So late that a step no longer changes the time.
    #[error("at {time} s a step of {step} s is lost in rounding: begin nearer to time 0")]
    LostInRounding {
        /// [s] time reached.
        time: f64,
        /// [s] step.
        step: f64,
    },
    /// A step end that is not a time after the present one.
    #[error("cannot advance from {from} s to {to} s")]
    Backwards {
        /// [s] present time.
        from: f64,
        /// [s] asked for.
        to: f64,
    },
}

/// How inputs move during a communication step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct InputPaths {
    races: [RacePath; 2],
    /// Applied force, applied moment, speed.
    loads: [Ramp; 2],
}

/// A simulation beside the running one, under slightly different inputs.
struct Neighbour {
    state: State,
    paths: InputPaths,
    friction: f64,
}

/// All that changes in a simulation: enough to go on from here to the same bits, in any instance of the same scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    inputs: Inputs,
    state: State,
    paths: InputPaths,
}

impl Snapshot {
    /// [s] time.
    pub fn time(&self) -> f64 {
        self.state.time
    }
}

/// A bearing in motion. Cloning it saves everything; the clone goes on to the same bits.
#[derive(Clone, Debug)]
pub struct Simulation {
    scene: Arc<Scene>,
    model: Arc<Model>,
    inputs: Inputs,
    state: State,
    paths: InputPaths,
    outputs: Outputs,
    workspace: Workspace,
}

impl Simulation {
    /// Prepares a scene and starts it at time 0 from the quasi-static equilibrium under its load.
    ///
    /// # Errors
    /// See [`SimulationError`].
    pub fn new(scene: &Scene) -> Result<Self, SimulationError> {
        let model = Arc::new(Model::new(scene)?);
        let (inputs, state) = start::from_equilibrium(scene, &model)?;
        let paths = InputPaths::steady(&inputs, &state);
        let outputs = Outputs::new(&model, &state, inputs.friction);
        let mut simulation = Self {
            scene: Arc::new(scene.clone()),
            model,
            inputs,
            state,
            paths,
            outputs,
            workspace: Workspace::default(),
        };
        simulation.settle();
        Ok(simulation)
    }

    /// Starts again from the present inputs: given poses and twists become the state of the races, the balls follow
    /// in the quasi-static equilibrium of that position.
    ///
    /// # Errors
    /// See [`SimulationError`].
    pub fn initialise(&mut self) -> Result<(), SimulationError> {
        let time = self.state.time;
        self.state = start::from_inputs(&self.scene, &self.model, &mut self.inputs)?;
        self.state.time = time;
        self.paths = InputPaths::steady(&self.inputs, &self.state);
        self.settle();
        Ok(())
    }

    /// Goes on with a scene that differs in tunable parameters alone.
    pub fn tune(&mut self, scene: &Scene) {
        Arc::make_mut(&mut self.model).tune(scene);
        self.scene = Arc::new(scene.clone());
        self.state.matrix = KeptMatrix::default();
    }

    /// Sets the time of a simulation that has not moved yet [s].
    pub fn set_start_time(&mut self, time: f64) {
        self.state.time = time;
        self.paths = InputPaths::steady(&self.inputs, &self.state);
        self.settle();
    }

    /// Consistent accelerations and outputs for the state as it is.
    fn settle(&mut self) {
        let boundary = self.boundary(self.state.time);
        make_consistent(&self.model, &mut self.state, &boundary);
        self.outputs = Outputs::new(&self.model, &self.state, self.inputs.friction);
    }

    /// [s] time.
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Inputs as set last.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// Sets the inputs of the next step.
    pub fn set_inputs(&mut self, inputs: Inputs) {
        self.inputs = inputs;
    }

    /// Everything needed to come back to this point.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { inputs: self.inputs, state: self.state.clone(), paths: self.paths.clone() }
    }

    /// Goes to a point that a simulation of the same scene was at; false, with nothing changed, if the snapshot is of
    /// another bearing.
    #[must_use]
    pub fn restore(&mut self, snapshot: &Snapshot) -> bool {
        let constraints = |state: &State| state.races.each_ref().map(|race| race.multipliers.len());
        let same = snapshot.state.balls.len() == self.state.balls.len()
            && snapshot.state.cage.is_some() == self.state.cage.is_some()
            && constraints(&snapshot.state) == constraints(&self.state)
            && snapshot.state.control.fits(&self.state.control)
            && [0, self.state.balls.len()].contains(&snapshot.state.matrix.balls.len())
            && snapshot.state.differences.len() == self.state.differences.len()
            && snapshot.state.differences.iter().all(|of_ball| {
                [INNER, OUTER].into_iter().all(|race| of_ball[race].fits(self.model.polynomials(race)))
            })
            && snapshot.state.statistics.plausible();
        if same {
            self.inputs = snapshot.inputs;
            self.state.clone_from(&snapshot.state);
            self.paths.clone_from(&snapshot.paths);
            self.outputs = Outputs::new(&self.model, &self.state, self.inputs.friction);
        }
        same
    }

    /// Outputs of the last communication point.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Inputs of the scene's own script at a time [s]: loads, speeds and scripted motions.
    pub fn scripted_inputs(&self, time: f64) -> Inputs {
        let mut inputs = self.inputs;
        let load = &self.scene.load;
        let conditions = load.conditions();
        let value = |direction: usize| match &conditions[direction] {
            Condition::Load(schedule) => schedule.at(time),
            Condition::Motion(_) => 0.0,
        };
        inputs.inner.applied = Wrench {
            force: Vector3::new(value(0), value(1), value(2)),
            moment: Vector3::new(0.0, value(3), value(4)),
        };
        inputs.inner.speed = load.inner_speed.at(time);
        inputs.outer.speed = load.outer_speed.at(time);
        for (race, input) in [(INNER, &mut inputs.inner), (OUTER, &mut inputs.outer)] {
            start::script_motion(&self.scene, race, time, &self.paths.races[race].at(time).0, input);
        }
        inputs
    }

    /// Runs its own steps to exactly `end` [s]. The inputs are taken as valid now, at the start.
    ///
    /// # Errors
    /// See [`SimulationError`]; the state is then that of the last converged step, at [`Simulation::time`]. Depth and place of
    /// contacts are looked at where the step ends.
    pub fn advance(&mut self, end: f64) -> Result<(), SimulationError> {
        self.advance_with_neighbours(end, &[]).map(drop)
    }

    /// Like [`Simulation::advance`]; also gives the outputs that neighbouring inputs would have led to, in the same
    /// steps. They are exact to first order: take differences between neighbours on opposite sides.
    ///
    /// # Errors
    /// As [`Simulation::advance`], and if the Newton matrix of a step is singular.
    pub fn advance_with_neighbours(
        &mut self,
        end: f64,
        inputs: &[Inputs],
    ) -> Result<Vec<Outputs>, SimulationError> {
        let begin = self.state.time;
        if !(end > begin && end.is_finite()) {
            return Err(SimulationError::Backwards { from: begin, to: end });
        }
        self.script_fixed_races(begin);
        let mut neighbours: Vec<Neighbour> = inputs
            .iter()
            .map(|inputs| {
                let mut inputs = *inputs;
                if matches!(self.scene.outer.drive, Drive::Fixed | Drive::Hinge) {
                    inputs.outer = self.inputs.outer;
                }
                if self.scene.inner.drive == Drive::Fixed {
                    inputs.inner = self.inputs.inner;
                }
                let paths = self.paths.towards(&inputs, begin, end - begin);
                Neighbour { state: self.state.clone(), paths, friction: inputs.friction }
            })
            .collect();
        self.paths = self.paths.towards(&self.inputs, begin, end - begin);
        let result = self.step_to(end, &mut neighbours).and_then(|()| self.check_contacts());
        self.outputs = Outputs::new(&self.model, &self.state, self.inputs.friction);
        result?;
        Ok(neighbours.iter().map(|n| Outputs::new(&self.model, &n.state, n.friction)).collect())
    }

    /// A race that is fixed in its frame or hinged to it has no inputs: the scene's script says how it moves.
    fn script_fixed_races(&mut self, time: f64) {
        let load = &self.scene.load;
        for (race, section, speed) in
            [(INNER, &self.scene.inner, &load.inner_speed), (OUTER, &self.scene.outer, &load.outer_speed)]
        {
            if matches!(section.drive, Drive::Fixed | Drive::Hinge) {
                let input = if race == INNER { &mut self.inputs.inner } else { &mut self.inputs.outer };
                input.speed = speed.at(time);
                start::script_motion(&self.scene, race, time, &self.paths.races[race].at(time).0, input);
            }
        }
    }

    fn step_to(&mut self, end: f64, neighbours: &mut [Neighbour]) -> Result<(), SimulationError> {
        // The running simulation must not notice that it is followed.
        let mut aside = Workspace::default();
        while self.state.time < end {
            let remaining = end - self.state.time;
            let h = self.state.control.step_within(remaining);
            // The last step ends at the communication point to the bit.
            let last = h >= remaining * (1.0 - 1e-9);
            let next = if last { end } else { self.state.time + h };
            if next.partial_cmp(&self.state.time) != Some(Ordering::Greater) {
                return Err(SimulationError::LostInRounding { time: self.state.time, step: h });
            }
            let boundary = self.boundary(next);
            let start = (!neighbours.is_empty()).then(|| self.state.clone());
            let tried = try_step(&self.model, &mut self.state, &boundary, h, &mut self.workspace);
            let (cause, worst) = match tried {
                Ok(()) => {
                    if let Some(start) = start {
                        let neighbours = neighbours.iter_mut().map(|n| {
                            let boundary = n.paths.boundary(boundary.time, n.friction);
                            (&mut n.state, boundary)
                        });
                        let accepted = &self.workspace;
                        if !follow(&self.model, &start, &boundary, h, neighbours, accepted, &mut aside) {
                            return Err(SimulationError::Singular(start.time));
                        }
                    }
                    continue;
                }
                Err(StepFailure::Newton(_, worst)) => ("Newton's method does not converge", worst),
                Err(StepFailure::Error(worst)) => ("the local error stays above solver.tolerance", worst),
            };
            if !self.state.control.above_minimum() {
                let outputs = Outputs::new(&self.model, &self.state, self.inputs.friction);
                let blame = to_blame(&self.model, &self.state, &boundary, worst, &self.workspace);
                let ball = &outputs.balls[blame.ball - 1];
                return Err(SimulationError::StepTooSmall {
                    time: self.state.time,
                    min_step: self.model.solver.min_step.0,
                    cause,
                    blame,
                    inner_load: ball.inner.load,
                    outer_load: ball.outer.load,
                });
            }
        }
        Ok(())
    }

    /// Refuses contacts that no material takes, or where no groove is.
    fn check_contacts(&self) -> Result<(), SimulationError> {
        let radius = self.model.bearing.ball.radius;
        for (race, name) in [(INNER, "inner"), (OUTER, "outer")] {
            let motion = self.state.races[race].motion();
            for (index, ball) in self.state.balls.iter().enumerate() {
                let offset = ball.position - motion.position;
                let contact = GrooveContact::new(self.model.raceway(race), radius, &offset, &motion.axis);
                let (time, ball, approach) = (self.state.time, index + 1, contact.approach);
                // The groove of the inner race opens away from its axis, that of the outer race towards it.
                let out = if race == INNER { -1.0 } else { 1.0 };
                if approach > 0.0 && out * contact.normal.dot(&contact.radial) < 0.0 {
                    return Err(SimulationError::LeftGroove { time, ball, race: name, approach });
                }
                if approach > MAX_APPROACH * 2.0 * radius {
                    return Err(SimulationError::Overload { time, ball, race: name, approach });
                }
            }
        }
        Ok(())
    }

    fn boundary(&self, time: f64) -> Boundary {
        self.paths.boundary(time, self.inputs.friction)
    }
}

impl InputPaths {
    /// What they impose at a time [s].
    fn boundary(&self, time: f64, friction: f64) -> Boundary {
        let load = |race: usize| {
            let [fx, fy, fz, mx, my, mz, speed] = self.loads[race].at(time).into();
            let applied = Wrench { force: Vector3::new(fx, fy, fz), moment: Vector3::new(mx, my, mz) };
            RaceLoad { applied, speed }
        };
        Boundary {
            time,
            motion: [INNER, OUTER].map(|race| self.races[race].at(time)),
            loads: [INNER, OUTER].map(load),
            friction,
        }
    }

    /// Paths of a state that goes on as it is.
    fn steady(inputs: &Inputs, state: &State) -> Self {
        let races = [INNER, OUTER]
            .map(|race| RacePath::steady(state.time, &state.races[race].pose, &state.races[race].twist()));
        let loads = [&inputs.inner, &inputs.outer].map(|input| Ramp::constant(load_components(input)));
        Self { races, loads }
    }

    /// Paths from here on, over a communication step.
    fn towards(&self, inputs: &Inputs, time: f64, duration: f64) -> Self {
        let inputs = [&inputs.inner, &inputs.outer];
        let races = [INNER, OUTER].map(|race| {
            let (pose, twist) = self.races[race].at(time);
            let input = inputs[race];
            let target = (&input.pose, &input.twist, &input.twist_rate);
            RacePath::towards(time, (&pose, &twist), target.0, target.1, target.2, duration)
        });
        let loads = [INNER, OUTER]
            .map(|race| self.loads[race].towards(time, load_components(inputs[race]), duration));
        Self { races, loads }
    }
}

/// Applied force, applied moment and speed as one vector.
fn load_components(input: &RaceInput) -> SVector<f64, RAMP_WIDTH> {
    let (force, moment) = (input.applied.force, input.applied.moment);
    SVector::from([force.x, force.y, force.z, moment.x, moment.y, moment.z, input.speed])
}
