//! A running bearing: model, state, inputs, and the one function that advances it.

mod cage_start;
mod error;
mod input_paths;
pub mod inputs;
pub mod outputs;
mod path;
pub mod play;
mod script;
mod slip;
mod spin_balance;
mod start;

use std::cmp::Ordering;
use std::f64::consts::PI;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::contact::creep::Law;
use crate::contact::shoulder::SMALL_LOAD;
use crate::dynamics::{
    Boundary, StepFailure, Workspace, advance_perturbed, failure_site, make_consistent, try_step,
};
use crate::equilibrium::{MAX_APPROACH, SIDES};
use crate::forces::Contacts;
use crate::model::Model;
use crate::model::bearing::neighbours;
use crate::model::bodies::Race;
use crate::model::state::{KeptMatrix, State};
use crate::scene::{BearingSection, Drive, Groups, Scene};
pub use error::SimulationError;
use input_paths::InputPaths;
use inputs::Inputs;
use outputs::{Outputs, towards_x};
use script::Script;
pub use script::{follows_time, scripted_groups};

/// [-] overlap of neighbouring balls over their diameter that a start may have: balls that just fit are moved by microns
/// where the load bends their orbit.
const START_OVERLAP: f64 = 1e-4;

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
        let model = Arc::new(Model::new(scene)?);
        let (inputs, state) = start::from_equilibrium(scene, &model, time)?;
        let paths = InputPaths::steady(&inputs, &state);
        let outputs = Outputs::new(&model, &state, &inputs.conditions());
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

    /// Refuses more balls than fit on the orbit that the equilibrium gives them. It knows nothing of their contacts.
    fn check_room(&self) -> Result<(), SimulationError> {
        let (Some(contact), bearing) = (&self.model.ball_contact, &self.model.bearing) else {
            return Ok(());
        };
        let approach = |(first, second): (usize, usize)| {
            contact.approach(&self.state.balls[first].motion(), &self.state.balls[second].motion())
        };
        let overlap = neighbours(self.state.balls.len()).map(approach).fold(f64::NEG_INFINITY, f64::max);
        if overlap <= START_OVERLAP * contact.diameter {
            return Ok(());
        }
        let orbit = (contact.diameter - overlap) / (PI / bearing.n_balls as f64).sin();
        let fit = BearingSection::most_balls(contact.diameter, orbit);
        Err(SimulationError::TooManyBalls { balls: bearing.n_balls, fit, overlap })
    }

    /// Goes on with a scene that differs in tunable parameters alone.
    pub fn tune(&mut self, scene: &Scene) {
        let gravity = self.model.gravity;
        Arc::make_mut(&mut self.model).tune(scene);
        self.scene = Arc::new(scene.clone());
        self.state.matrix = KeptMatrix::default();
        // The next step begins with the forces of this moment: weight that has come or gone is one of them.
        if self.model.gravity != gravity {
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
        self.outputs = Outputs::new(&self.model, &self.state, &self.inputs.conditions());
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
        let constraints = |state: &State| -> Vec<usize> {
            state.bodies.iter().map(|(_, body)| body.multipliers.len()).collect()
        };
        let same = snapshot.state.balls.len() == self.state.balls.len()
            && constraints(&snapshot.state) == constraints(&self.state)
            && snapshot.state.control.fits(&self.state.control)
            && [0, self.state.balls.len()].contains(&snapshot.state.matrix.balls.len())
            && snapshot.state.differences.len() == self.state.differences.len()
            && snapshot.state.differences.iter().all(|of_ball| {
                Race::BOTH.into_iter().all(|race| of_ball[race].fits(self.model.polynomials(race)))
            })
            && snapshot.state.statistics.plausible();
        if same {
            self.inputs = snapshot.inputs;
            self.state.clone_from(&snapshot.state);
            self.paths.clone_from(&snapshot.paths);
            self.outputs = Outputs::new(&self.model, &self.state, &self.inputs.conditions());
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
        inputs.inner.applied = script::applied(scene, time);
        inputs.inner.speed = scene.load.inner_speed.at(time);
        inputs.outer.speed = scene.load.outer_speed.at(time);
        if scene.friction.ball_race.is_table() {
            inputs.friction = scene.friction.ball_race.at(time);
        }
        for race in Race::BOTH {
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
            Err(_) => Contacts::new(&self.model, &self.state, &self.inputs.conditions()),
        };
        self.outputs = Outputs::of(&self.model, &self.state, &contacts, &self.inputs.conditions());
        if script.gives_inputs() {
            self.paths = self.paths.after_script(&self.inputs, &self.state);
        }
        result.and_then(|()| self.check_contacts(&contacts))?;
        let outputs = |p: &Perturbed| {
            let mut inputs = p.inputs;
            script.set_inputs(&self.scene, &p.paths, p.state.time, &mut inputs);
            Outputs::new(&self.model, &p.state, &inputs.conditions())
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
            let h = self.state.control.step_within(remaining);
            // The last step ends at the communication point to the bit.
            let last = h >= remaining * (1.0 - 1e-9);
            let next = if last { end } else { self.state.time + h };
            if next.partial_cmp(&self.state.time) != Some(Ordering::Greater) {
                return Err(SimulationError::LostInRounding { time: self.state.time, step: h });
            }
            let mut boundary = self.boundary(next);
            script.impose(&self.scene, &self.paths, &mut boundary);
            let start = (!perturbed.is_empty()).then(|| self.state.clone());
            let tried = try_step(&self.model, &mut self.state, &boundary, h, &mut self.workspace);
            let (cause, worst) = match tried {
                Ok(()) => {
                    self.check_creep(&boundary)?;
                    if let Some(mut start) = start {
                        // Renewed by the step itself.
                        start.differences.clone_from(&self.state.differences);
                        let scene = &self.scene;
                        let perturbed = perturbed.iter_mut().map(|p| {
                            let mut boundary = p.paths.boundary(boundary.time, p.inputs.conditions());
                            script.impose(scene, &p.paths, &mut boundary);
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
                let outputs = Outputs::new(&self.model, &self.state, &self.inputs.conditions());
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

    /// Refuses contacts that no material takes, or where no groove is.
    fn check_contacts(&self, contacts: &Contacts) -> Result<(), SimulationError> {
        let diameter = 2.0 * self.model.bearing.ball.radius;
        let thrust = self.model.bearing.is_thrust_bearing();
        let [least, most] = self.model.bearing.contact_angles();
        for race in Race::BOTH {
            let axis = self.state.race(race).motion().axis;
            for (index, ball) in contacts.balls.iter().enumerate() {
                let contact = &ball.raceways[race].geometry;
                let (time, ball, approach) = (self.state.time, index + 1, contact.approach);
                // The groove of the inner race opens away from its axis, that of the outer race towards it.
                let out = if race == Race::Inner { -1.0 } else { 1.0 };
                let radial = out * contact.normal.dot(&contact.radial);
                let off = match thrust {
                    true => {
                        let angle = (out * contact.normal.dot(&axis)).atan2(radial);
                        !(least..=most).contains(&angle)
                    }
                    false => radial < 0.0,
                };
                if approach > 0.0 && off {
                    return Err(SimulationError::LeftGroove { time, ball, race: race.name(), approach });
                }
                if approach > MAX_APPROACH * diameter {
                    return Err(SimulationError::Overload { time, ball, race: race.name(), approach });
                }
            }
        }
        self.check_shoulders(contacts)?;
        for pair in &contacts.ball_pairs {
            let (time, approach) = (self.state.time, pair.forces.approach);
            if approach > MAX_APPROACH * diameter {
                let (ball, next) = (pair.first + 1, pair.second + 1);
                return Err(SimulationError::BallsPressed { time, ball, next, approach });
            }
        }
        Ok(())
    }

    /// Refuses contacts that linear theory does not reach: their creep force is above what friction can carry.
    fn check_creep(&self, boundary: &Boundary) -> Result<(), SimulationError> {
        let contacts = self.model.contacts(&boundary.conditions);
        if !matches!(contacts.inner.law, Law::Linear) {
            return Ok(());
        }
        for (index, ball) in self.state.balls.iter().enumerate() {
            for race in Race::BOTH {
                let contact = contacts[race].evaluate(&ball.motion(), &self.state.race(race).motion());
                let force = contact.creep.longitudinal.hypot(contact.creep.lateral);
                let limit = contacts[race].friction * contact.load;
                if force > limit {
                    let (time, ball, race) = (self.state.time, index + 1, race.name());
                    return Err(SimulationError::BeyondLinear { time, ball, race, force, limit });
                }
            }
        }
        Ok(())
    }

    /// Refuses contacts beyond the shoulders of their race.
    fn check_shoulders(&self, contacts: &Contacts) -> Result<(), SimulationError> {
        for race in Race::BOTH {
            let on_race = || contacts.balls.iter().map(|ball| &ball.raceways[race]);
            let largest = on_race().map(|contact| contact.load).fold(0.0, f64::max);
            let axis = self.state.race(race).axes[0];
            for (index, contact) in on_race().enumerate().filter(|(_, c)| c.load > SMALL_LOAD * largest) {
                let Some(beyond) = self.model.bearing.shoulders[race].beyond(towards_x(contact, &axis))
                else {
                    continue;
                };
                return Err(SimulationError::BeyondShoulder {
                    time: self.state.time,
                    ball: index + 1,
                    race: race.name(),
                    load: contact.load,
                    side: SIDES[beyond.side],
                    angle: beyond.angle,
                    end: beyond.end,
                    why: self.model.bearing.why_beyond(race, &beyond),
                });
            }
        }
        Ok(())
    }

    fn boundary(&self, time: f64) -> Boundary {
        self.paths.boundary(time, self.inputs.conditions())
    }
}
