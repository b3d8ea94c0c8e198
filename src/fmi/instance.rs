//! An instance: its start, its phases, its variables.

use strum::VariantArray;

use super::log::Log;
use super::outcome::{Outcome, Status, error};
use super::resources;
use super::state::{Phase, State};
use crate::analysis::{auto, estimate};
use crate::effects;
use crate::interface::contradiction::Contradiction;
use crate::interface::model_description;
use crate::interface::variables::{Causality, Kind, Source, Variables};
use crate::model::bodies::Race;
use crate::scene::{Giver, Group, Groups, Level, Scene, Solver};
use crate::schema::numbers::Variability;
use crate::simulation::inputs::Inputs;
use crate::simulation::{Simulation, follows_time, scripted_groups};

/// A slave.
pub struct Instance {
    /// Messages to the importer.
    pub log: Log,
    /// Identifier of the package, in the model description and in serialised states.
    pub guid: String,
    /// The table of variables.
    pub variables: Variables,
    /// Start of everything, for a reset.
    fresh: Box<Simulation>,
    /// The running bearing.
    pub simulation: Simulation,
    /// State of the interface, beside that of the simulation.
    pub state: State,
    /// \[s] defined end of the experiment.
    pub stop: Option<f64>,
    /// Values of all variables at this point, if a step has led here.
    pub present: Option<Vec<f64>>,
    /// Derivatives of outputs by inputs at this point, if they were asked for.
    pub columns: Option<Vec<Vec<f64>>>,
    /// What was warned of.
    warned: Warned,
}

/// [-] steps in a row whose poses contradict their twists before that is told: a vibration may do so where it turns back.
const CONTRADICTIONS: u32 = 3;

/// Warnings, each of which is given once.
#[derive(Clone, Copy, Debug, Default)]
struct Warned {
    zero_quaternion: bool,
    /// Steps in a row whose poses contradict their twists.
    contradictions: u32,
}

impl Instance {
    /// A slave of the package whose resources are at `location`.
    ///
    /// # Errors
    /// If the scene cannot be read or started, or `guid` is not that of the scene's model description.
    pub fn new(guid: &str, location: &str, log: Log) -> Outcome<Self> {
        let path = resources::path(location)?.join(resources::SCENE_FILE);
        let failed = |why: String| (Status::Error, why);
        let scene = Scene::load(&path).map_err(|why| failed(why.to_string()))?;
        let instance = Self::of_scene(scene, log)?;
        let own = &instance.guid;
        if guid != own {
            return error(format!(
                "the guid {guid} is not that of this package, {own}: model description and library do not belong together"
            ));
        }
        Ok(instance)
    }

    /// A slave of a scene without a package.
    ///
    /// # Errors
    /// If the scene cannot be started.
    pub fn of_scene(scene: Scene, log: Log) -> Outcome<Self> {
        let failed = |why: String| (Status::Error, why);
        let (scene, found_out) = auto::resolve(scene).map_err(|why| failed(why.to_string()))?;
        found_out.iter().for_each(|note| log.write(Status::Ok, note));
        let variables = Variables::new(&scene);
        let guid = model_description::guid(&scene, &variables);
        let simulation = Simulation::new(&scene).map_err(|why| failed(why.to_string()))?;
        let values = variables.values(simulation.inputs(), simulation.outputs());
        Ok(Self {
            log,
            guid,
            variables,
            fresh: Box::new(simulation.clone()),
            simulation,
            state: State::new(values),
            stop: None,
            present: None,
            columns: None,
            warned: Warned::default(),
        })
    }

    /// The same slave once more, at the same point; its messages go elsewhere.
    pub fn copy(&self, log: Log) -> Self {
        Self {
            log,
            guid: self.guid.clone(),
            variables: self.variables.clone(),
            fresh: self.fresh.clone(),
            simulation: self.simulation.clone(),
            state: self.state.clone(),
            stop: self.stop,
            present: self.present.clone(),
            columns: self.columns.clone(),
            warned: self.warned,
        }
    }

    /// Sets the start time, before the start.
    ///
    /// # Errors
    /// If the start time is not finite or the stop time not after it.
    pub fn setup_experiment(&mut self, start: f64, stop: Option<f64>) -> Outcome {
        if !start.is_finite() {
            return error(format!("the start time {start} s is not a finite number"));
        }
        if let Some(stop) = stop.filter(|stop| !(*stop > start && stop.is_finite())) {
            return error(format!("the stop time {stop} s is not after the start time {start} s"));
        }
        if follows_time(self.simulation.scene()) && start != self.simulation.time() {
            // Where the script puts the bearing at that time; inputs that were set already stay as set.
            let scene = self.scene_with(&self.state.values)?;
            self.simulation =
                Simulation::starting_at(&scene, start).map_err(|why| (Status::Error, why.to_string()))?;
            self.state.applied.clone_from(&self.state.values);
            self.take_start_values();
        } else {
            self.simulation.set_start_time(start);
        }
        self.stop = stop;
        self.present = None;
        Ok(())
    }

    /// Groups of inputs that the scene's script gives.
    pub fn played(&self) -> Groups {
        let scene = self.simulation.scene();
        let scripted = scripted_groups(scene);
        Group::VARIANTS.iter().fold(Groups::default(), |groups, &group| {
            let scene_gives = scene.interface.inputs.of(group) == Giver::Scene;
            groups.with(group, scripted.contains(group) && scene_gives && !self.state.set.contains(group))
        })
    }

    /// Tells which scripts of the scene are played.
    fn announce_scripts(&self) {
        let scene = self.simulation.scene();
        let scripted = scripted_groups(scene);
        for &group in Group::VARIANTS.iter().filter(|group| scripted.contains(**group)) {
            if scene.interface.inputs.of(group) == Giver::Master {
                let why = format!(
                    "the scene's script of {group} is not played: interface.inputs.{group} = \"master\""
                );
                self.log.write(Status::Ok, &why);
            } else if self.state.set.contains(group) {
                self.log.write(
                    Status::Warning,
                    &format!("the scene's script of {group} is not played: they were set"),
                );
            } else {
                let played =
                    format!("the scene's script of {group} is played until one of these inputs is set");
                self.log.write(Status::Ok, &played);
            }
        }
    }

    /// From now on the importer gives the group of an input; a script of it ends.
    pub fn take_over(&mut self, index: usize) {
        let row = &self.variables.rows()[index];
        let Some(group) = row.group(self.simulation.scene()).filter(|group| !self.state.set.contains(*group))
        else {
            return;
        };
        let ends = self.state.phase == Phase::StepComplete && self.played().contains(group);
        self.state.set = self.state.set.with(group, true);
        if ends {
            let (name, time) = (&row.name, self.simulation.time());
            let why = format!("the scene's script of {group} ends at {time} s: {name} was set");
            self.log.write(Status::Warning, &why);
        }
    }

    /// Takes the start of the simulation for the inputs that the importer did not set.
    fn take_start_values(&mut self) {
        let start = self.variables.values(self.simulation.inputs(), self.simulation.outputs());
        for (index, row) in self.variables.rows().iter().enumerate() {
            if row.causality == Causality::Input && !self.state.given[index] {
                self.state.values[index] = start[index];
            }
        }
    }

    /// Begins initialization.
    pub fn enter_initialization(&mut self) {
        self.state.phase = Phase::Initialization;
    }

    /// Starts from the inputs as set.
    ///
    /// # Errors
    /// If the inputs allow no start.
    pub fn exit_initialization(&mut self) -> Outcome {
        self.refresh()?;
        self.state.previous_outputs =
            self.variables.values(self.simulation.inputs(), self.simulation.outputs());
        self.state.phase = Phase::StepComplete;
        self.announce_scripts();
        self.announce_goal();
        self.announce_level();
        self.announce_effects();
        Ok(())
    }

    /// Tells which effects are on, and which that are off would matter.
    fn announce_effects(&self) {
        // Estimates ask for an equilibrium, which nobody waits for who does not read them.
        if !self.log.tells(Status::Ok) {
            return;
        }
        let scene = self.simulation.scene();
        let lines = match estimate::verdicts(scene, self.simulation.model()) {
            Ok(verdicts) => effects::estimate::missed(&verdicts),
            Err(why) => vec![why.to_string()],
        };
        [scene.effects.simulated()].iter().chain(&lines).for_each(|line| self.log.write(Status::Ok, line));
    }

    /// Tells that no motion is simulated, where that is so.
    fn announce_level(&self) {
        if self.simulation.scene().solver.level == Level::Equilibrium {
            let what = "solver.level = \"equilibrium\": outputs are those of the equilibrium under the inputs of each step";
            self.log.write(Status::Ok, what);
        }
    }

    /// Tells what an error goal means here: a single run cannot measure its own error.
    fn announce_goal(&self) {
        if let Some(goal) = self.simulation.scene().solver.goal {
            let Solver { max_step, tolerance, .. } = self.simulation.scene().solver;
            self.log.write(
                Status::Ok,
                &format!(
                    "solver.accuracy.error = {:e}: this package runs once, with the settings that runs of the scene begin with \
                     (max_step {:e} s, tolerance {tolerance:e}), and does not measure its error; \"roulement run\" does",
                    goal.error, max_step.0
                ),
            );
        }
    }

    /// Starts from inputs and parameters that were set before the start; without any, the start is the scene's own.
    ///
    /// # Errors
    /// If they allow no start.
    pub fn refresh(&mut self) -> Outcome {
        if !self.state.changed {
            return Ok(());
        }
        let mut simulation = self.simulation.clone();
        let mut values = self.state.values.clone();
        if self.variables.parameters_differ(&self.state.values, &self.state.applied) {
            let scene = self.scene_with(&self.state.values)?;
            simulation = Simulation::starting_at(&scene, self.simulation.time())
                .map_err(|why| (Status::Error, why.to_string()))?;
            let start = self.variables.values(simulation.inputs(), simulation.outputs());
            for (index, row) in self.variables.rows().iter().enumerate() {
                if row.causality == Causality::Input && !self.state.given[index] {
                    values[index] = start[index];
                }
            }
        }
        if self.state.given.contains(&true) {
            let inputs = self.read_inputs(&values, simulation.inputs())?;
            simulation.set_inputs(inputs);
            simulation.initialise().map_err(|why| (Status::Error, why.to_string()))?;
        }
        self.simulation = simulation;
        self.state.applied.clone_from(&values);
        self.state.values = values;
        self.present = None;
        self.columns = None;
        self.state.changed = false;
        Ok(())
    }

    /// A simulation of the scene with the parameters among these values.
    pub fn with_parameters(&self, values: &[f64]) -> Outcome<Simulation> {
        Simulation::new(&self.scene_with(values)?).map_err(|why| (Status::Error, why.to_string()))
    }

    /// The scene with the parameters among these values.
    pub fn scene_with(&self, values: &[f64]) -> Outcome<Scene> {
        let mut scene = self.fresh.scene().clone();
        self.variables.set_parameters(&mut scene, values);
        scene.check().map_err(|why| (Status::Error, why.to_string()))?;
        Ok(scene)
    }

    /// Inputs of the values of all rows.
    ///
    /// # Errors
    /// See [`Variables::inputs`].
    fn read_inputs(&mut self, values: &[f64], base: &Inputs) -> Outcome<Inputs> {
        self.warn_of_zero_quaternion(values);
        self.variables.inputs(values, &self.state.rates, base).map_err(|why| (Status::Error, why.to_string()))
    }

    /// Inputs of the next step.
    ///
    /// # Errors
    /// See [`Variables::inputs`].
    pub fn next_inputs(&mut self) -> Outcome<Inputs> {
        let (values, base) = (self.state.values.clone(), *self.simulation.inputs());
        let inputs = self.read_inputs(&values, &base)?;
        self.warn_of_contradiction(&inputs);
        Ok(inputs)
    }

    /// Says once that a quaternion of zeros, that of an input which nothing is connected to, is taken for no rotation.
    fn warn_of_zero_quaternion(&mut self, values: &[f64]) {
        if self.warned.zero_quaternion {
            return;
        }
        if let Some(race) = self.variables.zero_quaternion(values).map(Race::name) {
            let what = format!("{race}.orientation is all zeros, as if not connected: taken as no rotation");
            self.log.write(Status::Warning, &what);
            self.warned.zero_quaternion = true;
        }
    }

    /// Says once that the poses of several steps contradict their twists. `next` are the inputs of the next step.
    fn warn_of_contradiction(&mut self, next: &Inputs) {
        let (step, before) = (self.state.last_step, self.simulation.inputs());
        // Before the second step, there is nothing to compare with.
        if self.warned.contradictions >= CONTRADICTIONS || step <= 0.0 {
            return;
        }
        // A script moves on within a step, and its pose and twist agree.
        let scripted = self.played().contains(Group::Tilts);
        let given = |race: Race| !scripted && self.variables.pose_is_given(race);
        let found = Race::BOTH
            .into_iter()
            .filter(|race| given(*race))
            .find_map(|race| Some((race, Contradiction::between(&before[race], &next[race], step)?)));
        let Some((race, contradiction)) = found else {
            self.warned.contradictions = 0;
            return;
        };
        self.warned.contradictions += 1;
        if self.warned.contradictions == CONTRADICTIONS {
            let (race, time) = (race.name(), self.simulation.time());
            let what = format!(
                "the pose of the {race} race contradicts its twist: {contradiction}, over the {step} s before {time} s"
            );
            self.log.write(Status::Warning, &what);
        }
    }

    /// Ends the simulation.
    pub fn terminate(&mut self) {
        self.state.phase = Phase::Terminated;
    }

    /// Puts the instance back to how it was when freshly instantiated.
    pub fn reset(&mut self) {
        self.simulation = (*self.fresh).clone();
        let values = self.variables.values(self.simulation.inputs(), self.simulation.outputs());
        self.state = State::new(values);
        self.stop = None;
        self.present = None;
        self.columns = None;
        self.warned = Warned::default();
    }

    /// Row of a value reference of one type.
    ///
    /// # Errors
    /// If there is no such variable.
    pub fn row(&self, reference: u32, kind: Kind) -> Outcome<usize> {
        let index = reference as usize;
        match self.variables.rows().get(index) {
            Some(row) if row.kind == kind => Ok(index),
            Some(row) => error(format!("{} (value reference {reference}) is not of type {kind:?}", row.name)),
            None => error(format!("there is no variable with value reference {reference}")),
        }
    }

    /// Values of variables of one type.
    ///
    /// # Errors
    /// If a reference is not that of such a variable, or the start is not possible.
    pub fn get(&mut self, references: &[u32], kind: Kind, values: &mut [f64]) -> Outcome {
        if self.state.phase == Phase::Initialization {
            self.refresh()?;
        }
        for (reference, value) in references.iter().zip(values) {
            let index = self.row(*reference, kind)?;
            let row = &self.variables.rows()[index];
            *value = match row.causality {
                Causality::Input | Causality::Parameter => self.state.values[index],
                Causality::Output | Causality::Local => match &self.present {
                    Some(present) => present[index],
                    None => self.variables.value(row, self.simulation.inputs(), self.simulation.outputs()),
                },
            };
        }
        Ok(())
    }

    /// Sets inputs.
    ///
    /// # Errors
    /// If a reference is not that of an input or a value not finite; nothing is then set.
    pub fn set(&mut self, references: &[u32], kind: Kind, values: &[f64]) -> Outcome {
        for (reference, value) in references.iter().zip(values) {
            let row = &self.variables.rows()[self.row(*reference, kind)?];
            if matches!(row.causality, Causality::Output | Causality::Local) {
                return error(format!("{} is an output and cannot be set", row.name));
            }
            if !value.is_finite() {
                return error(format!("{} = {value} is not a finite number", row.name));
            }
            if let Source::Parameter(parameter) = &row.source {
                if self.state.phase == Phase::StepComplete && parameter.variability == Variability::Fixed {
                    return error(format!("{} is fixed: it can be set before the start only", row.name));
                }
                parameter.range.check(parameter.key, *value).or_else(|why| error(why.to_string()))?;
            }
        }
        let started = self.state.phase == Phase::StepComplete;
        for (reference, value) in references.iter().zip(values) {
            let index = *reference as usize;
            let input = self.variables.rows()[index].causality == Causality::Input;
            // Inputs of a running simulation are read by the next step anyway.
            if !(started && input) {
                self.state.changed |= self.state.values[index] != *value;
            }
            self.state.given[index] |= input && !started;
            self.state.values[index] = *value;
            if input {
                self.take_over(index);
            }
        }
        Ok(())
    }
}
