//! A running bearing: model, state, inputs, and the one function that advances it.

mod advance;
pub mod alarms;
pub mod cage_push;
mod cage_start;
pub mod circling;
pub mod course;
pub mod driven;
mod entering;
mod error;
mod input_paths;
pub mod inputs;
pub mod instant;
mod limits;
pub mod losses;
pub mod machine;
pub mod margins;
pub mod motions;
mod orientation;
pub mod outputs;
mod path;
pub mod play;
mod point;
mod quasi_static;
mod script;
mod slip;
mod spin_balance;
mod start;
mod start_state;
mod step_limits;
mod supported;
pub mod system;
mod together;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::analysis::auto;
use crate::dynamics::system::StepBuffers;
use crate::dynamics::{Boundary, Workspace, make_consistent};
use crate::effects::growth::Warmth;
use crate::model::bodies::Race;
use crate::model::state::{KeptMatrix, State};
use crate::model::{Conditions, Model};
use crate::numerics::lanes::WIDTH;
use crate::scene::{Groups, Scene, Schedule};
pub use error::SimulationError;
use input_paths::InputPaths;
use inputs::{Inputs, RaceInput};
use point::Point;
pub use script::{follows_time, scripted_groups};

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
    point: Point,
    workspace: Workspace,
    /// Buffers of the steps of all bearings that take them together, in the first of these.
    buffers: StepBuffers,
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
        if scene.effects.auto.on {
            let (scene, _) = auto::resolve(scene.clone())?;
            return Self::of_model(&scene, Model::new(&scene)?, time);
        }
        Self::of_model(scene, Model::new(scene)?, time)
    }

    /// Prepares a scene as [`Simulation::starting_at`] does, with a model that was built for it already, whose effects are as they are written.
    ///
    /// # Errors
    /// See [`SimulationError`].
    pub fn of_model(scene: &Scene, model: Model, time: f64) -> Result<Self, SimulationError> {
        let model = Arc::new(model);
        let (inputs, state) = start::from_equilibrium(scene, &model, time)?;
        let paths = InputPaths::steady(&inputs, &state);
        let point = Point::new(conditions(&inputs, &state), false);
        let mut simulation = Self {
            scene: Arc::new(scene.clone()),
            model,
            inputs,
            state,
            paths,
            point,
            workspace: Workspace::default(),
            buffers: StepBuffers::default(),
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
        // Outputs of this point are those of the parameters that led here.
        self.outputs();
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
        self.reach(false);
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

    /// That, in the memory of an earlier one.
    pub fn snapshot_into(&self, snapshot: &mut Snapshot) {
        let Snapshot { inputs, state, paths } = snapshot;
        *inputs = self.inputs;
        state.copy_from(&self.state);
        paths.clone_from(&self.paths);
    }

    /// Goes to a point that a simulation of the same scene was at; false, with nothing changed, if the snapshot is of
    /// another bearing.
    #[must_use]
    pub fn restore(&mut self, snapshot: &Snapshot) -> bool {
        let same = self.fits(snapshot);
        if same {
            self.inputs = snapshot.inputs;
            self.state.copy_from(&snapshot.state);
            self.paths.clone_from(&snapshot.paths);
            self.reach(false);
        }
        same
    }

    /// Is this a point that a simulation of the same scene could be at?
    fn fits(&self, snapshot: &Snapshot) -> bool {
        let constraints = |state: &State| -> Vec<usize> {
            state.bodies.iter().map(|(_, body)| body.multipliers.len()).collect()
        };
        let shares = self.model.spacing.is_some();
        let pockets = |state: &State| state.spacing.as_ref().map(|turn| turn.pockets.len());
        let damaged = |state: &State| state.orientations.as_ref().map(Vec::len);
        snapshot.state.balls.len() == self.state.balls.len()
            && constraints(&snapshot.state) == constraints(&self.state)
            && snapshot.state.control.fits(&self.state.control)
            && [0, self.state.balls.len()].contains(&snapshot.state.matrix.balls.len())
            && snapshot.state.matrix.blocks.len() >= snapshot.state.matrix.balls.len().div_ceil(WIDTH)
            && snapshot.state.matrix.blocks.iter().all(|block| block.fits(self.model.moved_bodies(), shares))
            && snapshot.state.matrix.border.fits(self.model.border_size(), self.model.moved_bodies())
            && snapshot.state.differences.len() == self.state.differences.len()
            && snapshot.state.differences.iter().all(|of_ball| {
                Race::BOTH.into_iter().all(|race| of_ball[race].fits(self.model.polynomials(race)))
            })
            && snapshot.state.statistics.plausible()
            && snapshot.state.grown.is_some() == self.state.grown.is_some()
            && snapshot.state.rating.is_some() == self.state.rating.is_some()
            && snapshot.state.heat.is_some() == self.state.heat.is_some()
            && snapshot.state.means.is_some() == self.state.means.is_some()
            && snapshot.state.warm.is_some() == self.state.warm.is_some()
            && pockets(&snapshot.state) == pockets(&self.state)
            && damaged(&snapshot.state) == damaged(&self.state)
            && snapshot.inputs.rises.is_some() == self.inputs.rises.is_some()
    }

    /// Inputs of the scene's own script at a time \[s]: loads, speeds, scripted motions and friction.
    pub fn scripted_inputs(&self, time: f64) -> Inputs {
        let mut inputs = self.inputs;
        let scene = &self.scene;
        if scene.friction.ball_race.is_scripted() {
            inputs.friction = scene.friction.ball_race.at(time);
        }
        if scene.effects.frame.section.is_some() {
            inputs.effects.frame.motion = scene.frame_at(time);
        }
        if scene.effects.film.schedule().is_some_and(Schedule::is_scripted) {
            inputs.effects.lubrication = scene.effects.film.lubrication(time);
        }
        if scene.effects.growth.follows_time() {
            inputs.rises = scene.effects.growth.rises(time);
        }
        for race in Race::BOTH {
            inputs[race] = self.scripted_race(race, time);
        }
        inputs
    }

    /// Those of a race: loads, speed and scripted motion.
    fn scripted_race(&self, race: Race, time: f64) -> RaceInput {
        let scene = &self.scene;
        let speed = match race {
            Race::Inner => &scene.load.inner_speed,
            Race::Outer => &scene.load.outer_speed,
        };
        let applied = script::applied(scene, race, time);
        let mut input = RaceInput { speed: speed.at(time), applied, ..self.inputs[race] };
        script::script_motion(scene, race, time, &self.paths.races[race].at(time).0, &mut input);
        input
    }

    /// Does its script come to other values within a span \[s] of time?
    pub fn script_changes_within(&self, from: f64, to: f64) -> bool {
        script::Script::new(&self.scene, Groups::ALL).changes_within(&self.scene, from, to)
    }

    /// Scripted its own steps to exactly `end` \[s], where the last of them ends, by the scene's script, which every step follows exactly. The
    /// inputs are then those of the time reached.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_scripted(&mut self, end: f64) -> Result<(), SimulationError> {
        self.inputs = self.scripted_inputs(self.state.time);
        let advanced = self.advance_with(end, Groups::ALL);
        self.take_scripted_inputs();
        advanced
    }

    /// Sets the inputs to what the script says now.
    fn take_scripted_inputs(&mut self) {
        let scripted = self.scripted_inputs(self.state.time);
        let followed = self.inputs;
        self.inputs = scripted;
        // Poses to the last bit as the steps had them.
        for race in Race::BOTH {
            if self.paths.anchors[race].is_some() {
                self.inputs[race] = followed[race];
            }
        }
    }

    fn boundary(&self, time: f64) -> Boundary {
        let mut boundary = self.paths.boundary(time, &self.inputs);
        boundary.see_spins(&self.model);
        boundary.see_temperatures(&self.state);
        boundary
    }

    /// Conditions of every contact at the time reached.
    pub fn conditions(&self) -> Conditions {
        conditions(&self.inputs, &self.state)
    }
}

/// Conditions of every contact of a state under these inputs.
fn conditions(inputs: &Inputs, state: &State) -> Conditions {
    conditions_with(inputs.friction, inputs.effects.lubrication, state)
}

/// The same with a friction coefficient and a share of lubrication.
fn conditions_with(friction: f64, lubrication: f64, state: &State) -> Conditions {
    let spins = Race::BOTH.map(|race| state.race(race).rate.x);
    let warmth = state.grown.map_or(Warmth { spins, ..Warmth::default() }, |grown| grown.warmth);
    Conditions { friction, warmth, lubrication }
}
