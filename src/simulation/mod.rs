//! A running bearing: model, state, inputs, and the one function that advances it.

mod error;
mod input_paths;
pub mod inputs;
pub mod outputs;
mod path;
pub mod play;
mod spin_balance;
mod start;

use std::cmp::Ordering;
use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

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
use crate::numerics::motion::Wrench;
use crate::scene::{BearingSection, Condition, Drive, Scene};
pub use error::SimulationError;
use input_paths::InputPaths;
use inputs::Inputs;
use outputs::{Outputs, towards_x};

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
        let model = Arc::new(Model::new(scene)?);
        let (inputs, state) = start::from_equilibrium(scene, &model)?;
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
        self.check_room()?;
        self.settle();
        Ok(())
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
        Arc::make_mut(&mut self.model).tune(scene);
        self.scene = Arc::new(scene.clone());
        self.state.matrix = KeptMatrix::default();
    }

    /// Sets the time of a simulation that has not moved yet \[s].
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

    /// Inputs of the scene's own script at a time \[s]: loads, speeds and scripted motions.
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
        for race in Race::BOTH {
            let now = self.paths.races[race].at(time).0;
            start::script_motion(&self.scene, race, time, &now, &mut inputs[race]);
        }
        inputs
    }

    /// Runs its own steps to exactly `end` \[s]. The inputs are taken as valid now, at the start.
    ///
    /// # Errors
    /// See [`SimulationError`]; the state is then that of the last converged step, at [`Simulation::time`]. Depth and place of
    /// contacts are looked at where the step ends.
    pub fn advance(&mut self, end: f64) -> Result<(), SimulationError> {
        self.advance_perturbed(end, &[]).map(drop)
    }

    /// Like [`Simulation::advance`]; also gives the outputs that slightly different inputs would have led to, in the same
    /// steps. They are exact to first order: take differences between perturbations of opposite sign.
    ///
    /// # Errors
    /// As [`Simulation::advance`], and if the Newton matrix of a step is singular.
    pub fn advance_perturbed(
        &mut self,
        end: f64,
        inputs: &[Inputs],
    ) -> Result<Vec<Outputs>, SimulationError> {
        let begin = self.state.time;
        if !(end > begin && end.is_finite()) {
            return Err(SimulationError::Backwards { from: begin, to: end });
        }
        self.script_fixed_races(begin);
        let mut perturbed: Vec<Perturbed> = inputs
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
                Perturbed { state: self.state.clone(), paths, inputs }
            })
            .collect();
        self.paths = self.paths.towards(&self.inputs, begin, end - begin);
        let result = self.step_to(end, &mut perturbed);
        // The last step's own evaluation, where it was accepted.
        let contacts = match &result {
            Ok(()) => self.workspace.contacts(&self.model),
            Err(_) => Contacts::new(&self.model, &self.state, &self.inputs.conditions()),
        };
        self.outputs = Outputs::of(&self.model, &self.state, &contacts, &self.inputs.conditions());
        result.and_then(|()| self.check_contacts(&contacts))?;
        let outputs = |p: &Perturbed| Outputs::new(&self.model, &p.state, &p.inputs.conditions());
        Ok(perturbed.iter().map(outputs).collect())
    }

    /// A race that is fixed in its frame or hinged to it has no inputs: the scene's script says how it moves.
    fn script_fixed_races(&mut self, time: f64) {
        let load = &self.scene.load;
        for (race, section, speed) in [
            (Race::Inner, &self.scene.inner, &load.inner_speed),
            (Race::Outer, &self.scene.outer, &load.outer_speed),
        ] {
            if matches!(section.drive, Drive::Fixed | Drive::Hinge) {
                let now = self.paths.races[race].at(time).0;
                let input = &mut self.inputs[race];
                input.speed = speed.at(time);
                start::script_motion(&self.scene, race, time, &now, input);
            }
        }
    }

    fn step_to(&mut self, end: f64, perturbed: &mut [Perturbed]) -> Result<(), SimulationError> {
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
            let boundary = self.boundary(next);
            let start = (!perturbed.is_empty()).then(|| self.state.clone());
            let tried = try_step(&self.model, &mut self.state, &boundary, h, &mut self.workspace);
            let (cause, worst) = match tried {
                Ok(()) => {
                    if let Some(mut start) = start {
                        // Renewed by the step itself.
                        start.differences.clone_from(&self.state.differences);
                        let perturbed = perturbed.iter_mut().map(|p| {
                            let boundary = p.paths.boundary(boundary.time, p.inputs.conditions());
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
        for race in Race::BOTH {
            for (index, ball) in contacts.balls.iter().enumerate() {
                let contact = &ball.raceways[race].geometry;
                let (time, ball, approach) = (self.state.time, index + 1, contact.approach);
                // The groove of the inner race opens away from its axis, that of the outer race towards it.
                let out = if race == Race::Inner { -1.0 } else { 1.0 };
                if approach > 0.0 && out * contact.normal.dot(&contact.radial) < 0.0 {
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
