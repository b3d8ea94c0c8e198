//! A running bearing: model, state, inputs, and the one function that advances it.

mod cage_start;
mod error;
mod input_paths;
pub mod inputs;
mod limits;
pub mod outputs;
mod path;
pub mod play;
mod quasi_static;
mod script;
mod slip;
mod spin_balance;
mod start;
mod step_limits;
mod supported;

use std::cmp::Ordering;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::dynamics::{
    Boundary, StepFailure, Workspace, advance_perturbed, failure_site, make_consistent, try_step,
};
use crate::forces::Contacts;
use crate::model::bodies::Race;
use crate::model::state::{KeptMatrix, State};
use crate::model::{Conditions, Model};
use crate::scene::{Drive, Groups, Level, Scene};
pub use error::SimulationError;
use input_paths::InputPaths;
use inputs::Inputs;
use outputs::Outputs;
use script::Script;
pub use script::{follows_time, scripted_groups};

/// A simulation beside the running one, under slightly different inputs.
struct Perturbed {
    state: State,
    paths: InputPaths,
    inputs: Inputs,
}

/// All that changes in a simulation: enough to go on from here to the same bits, in any instance of the same scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    inputs: Inputs,
    state: State,
    paths: InputPaths,
}

impl Snapshot {
    /// \[s] time.
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
        Self::starting_at(scene, 0.0)
    }

    /// Prepares a scene and starts it at a time \[s], from the equilibrium under what its script says then.
    ///
    /// # Errors
    /// See [`SimulationError`].
    pub fn starting_at(scene: &Scene, time: f64) -> Result<Self, SimulationError> {
        Self::of_model(scene, Model::new(scene)?, time)
    }

    /// The same with a model that was built for the scene already.
    ///
    /// # Errors
    /// See [`SimulationError`].
    pub fn of_model(scene: &Scene, model: Model, time: f64) -> Result<Self, SimulationError> {
        let model = Arc::new(model);
        let (inputs, state) = start::from_equilibrium(scene, &model, time)?;
        let paths = InputPaths::steady(&inputs, &state);
        let outputs = Outputs::new(&model, &state, &conditions(&inputs, &state));
        let mut simulation = Self {
            scene: Arc::new(scene.clone()),
            model,
            inputs,
            state,
            paths,
            outputs,
            workspace: Workspace::default(),
        };
        simulation.check_room()?;
        simulation.settle();
        simulation.check_creep(&simulation.boundary(simulation.state.time))?;
        Ok(simulation)
    }

    /// Starts again from the present inputs: given poses and twists become the state of the races, the balls follow
    /// in the quasi-static equilibrium of that position.
    ///
    /// # Errors
    /// See [`SimulationError`].
    pub fn initialise(&mut self) -> Result<(), SimulationError> {
        self.state = start::from_inputs(&self.scene, &self.model, &mut self.inputs, self.state.time)?;
        self.paths = InputPaths::steady(&self.inputs, &self.state);
        self.check_room()?;
        self.settle();
        self.check_creep(&self.boundary(self.state.time))
    }

    /// Goes on with a scene that differs in tunable parameters alone.
    pub fn tune(&mut self, scene: &Scene) {
        let gravity = self.scene.effects.gravity.at(0.0);
        Arc::make_mut(&mut self.model).tune(scene);
        self.scene = Arc::new(scene.clone());
        self.state.matrix = KeptMatrix::default();
        // The next step begins with the forces of this moment: weight that has come or gone is one of them.
        let tuned = self.scene.effects.gravity.at(0.0);
        if tuned != gravity {
            self.inputs.effects.frame.motion.gravity = tuned;
            self.paths.set_frame(&self.inputs);
            self.settle();
        }
    }

    /// Sets the time \[s] of a simulation that has not moved yet, and leaves it where it is: its start does not follow the
    /// scene's script, as that of [`Simulation::starting_at`] does.
    pub fn set_start_time(&mut self, time: f64) {
        self.state.time = time;
        self.paths = InputPaths::steady(&self.inputs, &self.state);
        self.settle();
    }

    /// Consistent accelerations and outputs for the state as it is.
    fn settle(&mut self) {
        let boundary = self.boundary(self.state.time);
        make_consistent(&self.model, &mut self.state, &boundary);
        self.outputs = Outputs::new(&self.model, &self.state, &self.conditions());
    }

    /// \[s] time.
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

    /// [-] local error of the last step over the ball diameter, root mean square over all positions.
    pub fn local_error(&self) -> f64 {
        self.state.control.last_error() * self.model.solver.tolerance
    }

    /// Inputs as set last.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// Sets the inputs of the next step.
    pub fn set_inputs(&mut self, inputs: Inputs) {
        let effects = self.inputs.effects;
        self.inputs = inputs;
        // Gravity is no input where the frame does not move: it stays that of the scene.
        if self.scene.effects.frame.section.is_none() {
            self.inputs.effects.frame = effects.frame;
        }
    }

    /// Everything needed to come back to this point.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { inputs: self.inputs, state: self.state.clone(), paths: self.paths.clone() }
    }

    /// Goes to a point that a simulation of the same scene was at; false, with nothing changed, if the snapshot is of
    /// another bearing.
    #[must_use]
    pub fn restore(&mut self, snapshot: &Snapshot) -> bool {
        let constraints = |state: &State| -> Vec<usize> {
            state.bodies.iter().map(|(_, body)| body.multipliers.len()).collect()
        };
        let damaged = |state: &State| state.orientations.as_ref().map(Vec::len);
        let same = snapshot.state.balls.len() == self.state.balls.len()
            && constraints(&snapshot.state) == constraints(&self.state)
            && snapshot.state.control.fits(&self.state.control)
            && [0, self.state.balls.len()].contains(&snapshot.state.matrix.balls.len())
            && snapshot.state.matrix.balls.iter().all(|kept| kept.block.fits(self.model.moved_bodies()))
            && snapshot.state.differences.len() == self.state.differences.len()
            && snapshot.state.differences.iter().all(|of_ball| {
                Race::BOTH.into_iter().all(|race| of_ball[race].fits(self.model.polynomials(race)))
            })
            && snapshot.state.statistics.plausible()
            && snapshot.state.grown.is_some() == self.state.grown.is_some()
            && snapshot.state.rating.is_some() == self.state.rating.is_some()
            && snapshot.state.heat.is_some() == self.state.heat.is_some()
            && damaged(&snapshot.state) == damaged(&self.state)
            && snapshot.inputs.rises.is_some() == self.inputs.rises.is_some();
        if same {
            self.inputs = snapshot.inputs;
            self.state.clone_from(&snapshot.state);
            self.paths.clone_from(&snapshot.paths);
            self.outputs = Outputs::new(&self.model, &self.state, &self.conditions());
        }
        same
    }

    /// Outputs of the last communication point.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Inputs of the scene's own script at a time \[s]: loads, speeds, scripted motions and friction.
    pub fn scripted_inputs(&self, time: f64) -> Inputs {
        let mut inputs = self.inputs;
        let scene = &self.scene;
        inputs.inner.speed = scene.load.inner_speed.at(time);
        inputs.outer.speed = scene.load.outer_speed.at(time);
        if scene.friction.ball_race.is_table() {
            inputs.friction = scene.friction.ball_race.at(time);
        }
        if scene.effects.frame.section.is_some() {
            inputs.effects.frame.motion = scene.frame_at(time);
        }
        if scene.effects.growth.follows_time() {
            inputs.rises = scene.effects.growth.rises(time);
        }
        for race in Race::BOTH {
            inputs[race].applied = script::applied(scene, race, time);
            let now = self.paths.races[race].at(time).0;
            script::script_motion(scene, race, time, &now, &mut inputs[race]);
        }
        inputs
    }

    /// Runs its own steps to exactly `end` \[s] by the scene's script, which every step follows exactly; where it ends
    /// does not matter to the motion. The inputs are then those of the time reached.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_scripted(&mut self, end: f64) -> Result<(), SimulationError> {
        self.inputs = self.scripted_inputs(self.state.time);
        let advanced = self.advance_perturbed(end, &[], Groups::ALL);
        let scripted = self.scripted_inputs(self.state.time);
        let followed = self.inputs;
        self.inputs = scripted;
        // Poses to the last bit as the steps had them.
        for race in Race::BOTH {
            if self.paths.anchors[race].is_some() {
                self.inputs[race] = followed[race];
            }
        }
        advanced.map(drop)
    }

    /// Runs its own steps to exactly `end` \[s]. The inputs are taken as valid now, at the start.
    ///
    /// # Errors
    /// See [`SimulationError`]; the state is then that of the last converged step, at [`Simulation::time`]. Depth and place of
    /// contacts are looked at where the step ends.
    pub fn advance(&mut self, end: f64) -> Result<(), SimulationError> {
        self.advance_perturbed(end, &[], Groups::default()).map(drop)
    }

    /// Like [`Simulation::advance`], with some groups of inputs given by the scene's script where it has one. The inputs of
    /// these are then those of the time reached.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_with(&mut self, end: f64, scripted: Groups) -> Result<(), SimulationError> {
        self.advance_perturbed(end, &[], scripted).map(drop)
    }

    /// Like [`Simulation::advance`], with some groups of inputs given by the scene's script where it has one; also gives the outputs that slightly different inputs would have led to, in the same
    /// steps. They are exact to first order: take differences between perturbations of opposite sign.
    ///
    /// # Errors
    /// As [`Simulation::advance`], and if the Newton matrix of a step is singular.
    pub fn advance_perturbed(
        &mut self,
        end: f64,
        inputs: &[Inputs],
        scripted: Groups,
    ) -> Result<Vec<Outputs>, SimulationError> {
        let begin = self.state.time;
        if !(end > begin && end.is_finite()) {
            return Err(SimulationError::Backwards { from: begin, to: end });
        }
        if self.model.solver.level == Level::Equilibrium {
            return self.advance_by_equilibria(end, inputs, scripted);
        }
        if let Some(heat) = &mut self.state.heat {
            heat.mark(begin);
        }
        let script = Script::new(&self.scene, scripted);
        let mut given = self.inputs;
        self.script_fixed_races(begin, &mut given);
        self.inputs = given;
        script.begin(&mut self.paths, begin);
        let mut perturbed: Vec<Perturbed> = inputs
            .iter()
            .map(|inputs| {
                let mut inputs = *inputs;
                self.script_fixed_races(begin, &mut inputs);
                let paths = self.paths.towards(&inputs, begin, end - begin);
                Perturbed { state: self.state.clone(), paths, inputs }
            })
            .collect();
        self.paths = self.paths.towards(&self.inputs, begin, end - begin);
        let result = self.follow(&script, end, &mut perturbed);
        script.set_inputs(&self.scene, &self.paths, self.state.time, &mut self.inputs);
        // The last step's own evaluation, where it was accepted.
        let contacts = match &result {
            Ok(()) => self.workspace.contacts(&self.model),
            Err(_) => Contacts::new(&self.model, &self.state, &self.conditions()),
        };
        self.outputs = Outputs::of(&self.model, &self.state, &contacts, &self.conditions());
        if script.gives_inputs() {
            self.paths = self.paths.after_script(&self.inputs, &self.state);
        }
        result.and_then(|()| self.check_contacts(&contacts))?;
        let outputs = |p: &Perturbed| {
            let mut inputs = p.inputs;
            script.set_inputs(&self.scene, &p.paths, p.state.time, &mut inputs);
            Outputs::new(&self.model, &p.state, &conditions(&inputs, &p.state))
        };
        Ok(perturbed.iter().map(outputs).collect())
    }

    /// The scene's script says how a race moves that is fixed in its frame or hinged to it, but for a speed that is the same
    /// at all times: that is an input.
    fn script_fixed_races(&self, time: f64, inputs: &mut Inputs) {
        let load = &self.scene.load;
        for (race, section, speed) in [
            (Race::Inner, &self.scene.inner, &load.inner_speed),
            (Race::Outer, &self.scene.outer, &load.outer_speed),
        ] {
            if matches!(section.drive, Drive::Fixed | Drive::Hinge) {
                let now = self.paths.races[race].at(time).0;
                let input = &mut inputs[race];
                if speed.is_table() {
                    input.speed = speed.at(time);
                }
                script::script_motion(&self.scene, race, time, &now, input);
            }
        }
    }

    /// Steps to `end` \[s] and to the knots of the script on the way.
    fn follow(
        &mut self,
        script: &Script,
        end: f64,
        perturbed: &mut [Perturbed],
    ) -> Result<(), SimulationError> {
        let least = self.model.solver.min_step.0;
        let knots = script.knots(&self.scene, self.state.time, end, least);
        knots.into_iter().chain([end]).try_for_each(|stop| self.step_to(script, stop, perturbed))
    }

    fn step_to(
        &mut self,
        script: &Script,
        end: f64,
        perturbed: &mut [Perturbed],
    ) -> Result<(), SimulationError> {
        // The perturbed steps leave the running simulation as it is.
        let mut aside = Workspace::default();
        while self.state.time < end {
            let remaining = end - self.state.time;
            if let Some(limit) = step_limits::largest_step(&self.model, &self.state) {
                self.state.control.cap(limit);
            }
            let h = self.state.control.step_within(remaining);
            // The last step ends at the communication point to the bit.
            let last = h >= remaining * (1.0 - 1e-9);
            let next = if last { end } else { self.state.time + h };
            if next.partial_cmp(&self.state.time) != Some(Ordering::Greater) {
                return Err(SimulationError::LostInRounding { time: self.state.time, step: h });
            }
            let mut boundary = self.boundary(next);
            script.impose(&self.scene, &self.paths, &mut boundary);
            boundary.see_spins(&self.model);
            boundary.turn_balls(&self.model, &self.state);
            let start = (!perturbed.is_empty()).then(|| self.state.clone());
            let tried = try_step(&self.model, &mut self.state, &boundary, h, &mut self.workspace);
            let (cause, worst) = match tried {
                Ok(()) => {
                    self.check_creep(&boundary)?;
                    if let Some(mut start) = start {
                        // Renewed by the step itself.
                        start.differences.clone_from(&self.state.differences);
                        let (scene, model) = (&self.scene, &self.model);
                        let perturbed = perturbed.iter_mut().map(|p| {
                            let mut boundary = p.paths.boundary(boundary.time, p.inputs.friction);
                            script.impose(scene, &p.paths, &mut boundary);
                            boundary.see_spins(model);
                            boundary.turn_balls(model, &p.state);
                            (&mut p.state, boundary)
                        });
                        let accepted = &self.workspace;
                        if !advance_perturbed(
                            &self.model,
                            &start,
                            &boundary,
                            h,
                            perturbed,
                            accepted,
                            &mut aside,
                        ) {
                            return Err(SimulationError::Singular(start.time));
                        }
                    }
                    continue;
                }
                Err(StepFailure::Newton(_, worst)) => ("Newton's method does not converge", worst),
                Err(StepFailure::Error(worst)) => ("the local error stays above solver.tolerance", worst),
            };
            if !self.state.control.above_minimum() {
                let outputs = Outputs::new(&self.model, &self.state, &self.conditions());
                let site = failure_site(&self.model, &self.state, &boundary, worst, &self.workspace);
                let ball = &outputs.balls[site.ball - 1];
                return Err(SimulationError::StepTooSmall {
                    time: self.state.time,
                    min_step: self.model.solver.min_step.0,
                    cause,
                    site,
                    inner_load: ball.inner.load,
                    outer_load: ball.outer.load,
                });
            }
        }
        Ok(())
    }

    fn boundary(&self, time: f64) -> Boundary {
        let mut boundary = self.paths.boundary(time, self.inputs.friction);
        boundary.see_spins(&self.model);
        boundary
    }

    /// Conditions of every contact at the time reached.
    pub fn conditions(&self) -> Conditions {
        conditions(&self.inputs, &self.state)
    }
}

/// Conditions of every contact of a state under these inputs.
fn conditions(inputs: &Inputs, state: &State) -> Conditions {
    Conditions { friction: inputs.friction, warmth: state.grown.unwrap_or_default().warmth }
}
