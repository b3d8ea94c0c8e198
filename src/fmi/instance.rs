//! An instance: its start, its phases, its variables.

use std::path::Path;

use super::log::Log;
use super::outcome::{Outcome, Status, error};
use super::resources;
use super::state::{Phase, State};
use super::unit::Unit;
use crate::analysis::auto;
use crate::interface::model_description;
use crate::interface::variables::{Causality, Kind, Offered, Variable};
use crate::scene::machine::MachineScene;
use crate::scene::{Giver, Scene};
use crate::schema::numbers::Variability;
use crate::simulation::alarms::Alarms;
use crate::simulation::driven::MachineSnapshot;

/// A slave.
pub struct Instance {
    /// Messages to the importer.
    pub log: Log,
    /// Identifier of the package, in the model description and in serialised states.
    pub guid: String,
    /// Start of everything, for a reset.
    fresh: Unit,
    /// Unit that is simulated.
    pub(super) unit: Unit,
    /// State of the interface, beside that of what is simulated.
    pub state: State,
    /// \[s] defined end of the experiment.
    pub stop: Option<f64>,
    /// Values of all variables at this point, if a step has led here and many were asked for.
    pub present: Option<Vec<f64>>,
    /// Values of all variables at the point before, if a derivative by time was asked for.
    pub previous: Option<Vec<f64>>,
    /// Derivatives of outputs by inputs at this point: columns of inputs that were asked for.
    pub columns: Option<Vec<Vec<f64>>>,
    /// Of each variable: were derivatives by it asked for at this point, or at the last one where some were? Empty before the first.
    pub asked: Vec<bool>,
    /// Derivatives of outputs by the rates of inputs at this point, if they were asked for.
    pub(super) rate_columns: Option<Vec<Vec<f64>>>,
    /// Warnings that were given.
    warned: Warned,
    /// Watch on pressures and motions, for warnings in the log.
    pub(super) alarms: Alarms,
    /// Do rates of inputs hold until they are set again, as inputs do? Otherwise they are those of one step.
    pub(super) keeps_rates: bool,
    /// Memory of a snapshot.
    pub(super) spare: Option<MachineSnapshot>,
}

/// [-] steps in a row whose poses contradict their twists before that is told: a vibration may do so where it turns back.
const CONTRADICTIONS: u32 = 3;

/// Part of all variables that is read in one call from which on all values are computed together: one by one they take longer.
const MANY: usize = 3;

/// Warnings, each of which is given once.
#[derive(Clone, Copy, Debug, Default)]
struct Warned {
    zero_quaternion: bool,
    /// Steps in a row whose poses contradict their twists.
    contradictions: u32,
}

impl Instance {
    /// A slave of the package whose resources are in a folder.
    ///
    /// # Errors
    /// If the scene cannot be read or started, or `guid` is not that of the scene's model description.
    pub fn new(guid: &str, folder: &Path, log: Log) -> Outcome<Self> {
        let path = folder.join(resources::SCENE_FILE);
        let failed = |why: String| (Status::Error, why);
        let scene = MachineScene::of_package(&path).map_err(|why| failed(why.to_string()))?;
        let instance = Self::of_machine(scene, log)?;
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
        Self::of_machine(scene.into(), log)
    }

    /// A slave of whatever a scene describes, without a package.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn of_machine(scene: MachineScene, log: Log) -> Outcome<Self> {
        let found_out = auto::resolve_machine(scene, false);
        let (scene, notes) = found_out.map_err(|why| (Status::Error, why.to_string()))?;
        notes.iter().for_each(|note| log.write(Status::Ok, note));
        let source = scene.source().to_string();
        Ok(Self::of_unit(Unit::new(scene)?, &source, log))
    }

    fn of_unit(unit: Unit, source: &str, log: Log) -> Self {
        Self {
            log,
            guid: model_description::guid(source, unit.rows()),
            fresh: unit.clone(),
            state: State::new(unit.values(), unit.scripts().len()),
            unit,
            stop: None,
            present: None,
            previous: None,
            columns: None,
            asked: vec![],
            rate_columns: None,
            warned: Warned::default(),
            alarms: Alarms::default(),
            keeps_rates: false,
            spare: None,
        }
    }

    /// The variables; the index of a row is its value reference.
    pub fn rows(&self) -> &[Variable] {
        self.unit.rows()
    }

    /// Are its variables arrays, where FMI has them?
    pub fn has_arrays(&self) -> bool {
        self.unit.has_arrays()
    }

    /// Copy of the slave at the same point; its messages go elsewhere.
    pub fn copy(&self, log: Log) -> Self {
        Self {
            log,
            guid: self.guid.clone(),
            fresh: self.fresh.clone(),
            unit: self.unit.clone(),
            state: self.state.clone(),
            stop: self.stop,
            present: self.present.clone(),
            previous: self.previous.clone(),
            columns: self.columns.clone(),
            asked: self.asked.clone(),
            warned: self.warned,
            alarms: self.alarms.clone(),
            rate_columns: self.rate_columns.clone(),
            keeps_rates: self.keeps_rates,
            spare: None,
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
        if self.unit.follows_time() && start != self.unit.time() {
            let written = self.unit.duration();
            if !(0.0..=written).contains(&start) {
                let why = format!(
                    "the start time {start} s is outside the scene's scripts, which are written for 0 to load.duration = {written} s: \
                     tables keep their first or last value there"
                );
                self.log.write(Status::Warning, &why);
            }
            // Where the script puts it at that time; inputs that were set already stay as set.
            self.unit.start_at(start, &self.state.values)?;
            self.state.applied.clone_from(&self.state.values);
            self.take_start_values();
        } else {
            self.unit.set_start_time(start)?;
        }
        self.stop = stop;
        self.present = None;
        Ok(())
    }

    /// Scripts of the scene that are played.
    pub fn played(&self) -> Vec<bool> {
        let scripts = self.unit.scripts().iter();
        scripts.zip(&self.state.set).map(|(giver, set)| *giver == Some(Giver::Scene) && !set).collect()
    }

    /// Tells which scripts of the scene are played.
    fn announce_scripts(&self) {
        for (script, giver) in self.unit.scripts().iter().enumerate() {
            let Some(giver) = giver else {
                continue;
            };
            let (name, group) = self.unit.script_name(script);
            if *giver == Giver::Master {
                let why = format!(
                    "the scene's script of {name} is not played: interface.inputs.{group} = \"master\""
                );
                self.log.write(Status::Ok, &why);
            } else if self.state.set[script] {
                self.log.write(
                    Status::Warning,
                    &format!("the scene's script of {name} is not played: they were set"),
                );
            } else {
                let played =
                    format!("the scene's script of {name} is played until one of these inputs is set");
                self.log.write(Status::Ok, &played);
            }
        }
    }

    /// From now on the importer gives what an input is given together with; a script of it ends.
    pub fn take_over(&mut self, index: usize) {
        let Some(script) = self.unit.script_of(index).filter(|script| !self.state.set[*script]) else {
            return;
        };
        let ends = self.state.phase == Phase::StepComplete && self.played()[script];
        self.state.set[script] = true;
        if ends {
            let (name, time) = (&self.unit.rows()[index].name, self.unit.time());
            let group = self.unit.script_name(script).0;
            let why = format!("the scene's script of {group} ends at {time} s: {name} was set");
            self.log.write(Status::Warning, &why);
        }
    }

    /// Takes the start of the simulation for the inputs that the importer did not set.
    fn take_start_values(&mut self) {
        let start = self.unit.values();
        for &index in self.unit.inputs() {
            if !self.state.given[index] {
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
        self.state.phase = Phase::StepComplete;
        self.announce_scripts();
        self.unit.announce(&self.log);
        Ok(())
    }

    /// Starts from inputs and parameters that were set before the start; without any, the start is the scene's own.
    ///
    /// # Errors
    /// If they allow no start.
    pub fn refresh(&mut self) -> Outcome {
        if !self.state.changed {
            return Ok(());
        }
        let mut unit = self.unit.clone();
        let mut values = self.state.values.clone();
        if unit.parameters_differ(&self.state.values, &self.state.applied) {
            let now = unit.time();
            unit.start_at(now, &values)?;
            let start = unit.values();
            for &index in unit.inputs() {
                if !self.state.given[index] {
                    values[index] = start[index];
                }
            }
        }
        if self.state.given.contains(&true) {
            self.warn_of_zero_quaternion(&values);
            unit.prepare(&values, &self.state.rates)?;
            unit.initialise()?;
        }
        self.unit = unit;
        self.state.applied.clone_from(&values);
        self.state.values = values;
        self.present = None;
        self.previous = None;
        self.forget_columns();
        self.state.changed = false;
        Ok(())
    }

    /// Takes the inputs of the next step.
    ///
    /// # Errors
    /// If one is not allowed.
    pub fn prepare(&mut self) -> Outcome {
        let values = std::mem::take(&mut self.state.values);
        self.warn_of_zero_quaternion(&values);
        let prepared = self.unit.prepare(&values, &self.state.rates);
        self.state.values = values;
        prepared?;
        self.warn_of_contradiction();
        Ok(())
    }

    /// Says once that a quaternion of zeros, that of an input which nothing is connected to, is taken for no rotation.
    fn warn_of_zero_quaternion(&mut self, values: &[f64]) {
        if self.warned.zero_quaternion {
            return;
        }
        if let Some(race) = self.unit.zero_quaternion(values) {
            let what = format!("{race}.orientation is all zeros, as if not connected: taken as no rotation");
            self.log.write(Status::Warning, &what);
            self.warned.zero_quaternion = true;
        }
    }

    /// Says once that the poses of several steps contradict their twists; those that were prepared are of the next step.
    fn warn_of_contradiction(&mut self) {
        let step = self.state.last_step;
        // Before the second step, there is nothing to compare with.
        if self.warned.contradictions >= CONTRADICTIONS || step <= 0.0 {
            return;
        }
        let Some((race, contradiction)) = self.unit.contradiction(step, &self.played()) else {
            self.warned.contradictions = 0;
            return;
        };
        self.warned.contradictions += 1;
        if self.warned.contradictions == CONTRADICTIONS {
            let time = self.unit.time();
            let what = format!(
                "the pose of {race} contradicts its twist: {contradiction}, over the {step} s before {time} s"
            );
            self.log.write(Status::Warning, &what);
        }
    }

    /// Derivatives are of another point from now on.
    pub(super) fn forget_columns(&mut self) {
        self.columns = None;
        self.rate_columns = None;
    }

    /// Ends the simulation.
    pub fn terminate(&mut self) {
        self.state.phase = Phase::Terminated;
    }

    /// Puts the instance back to how it was when freshly instantiated.
    pub fn reset(&mut self) {
        self.unit = self.fresh.clone();
        self.state = State::new(self.unit.values(), self.unit.scripts().len());
        self.stop = None;
        self.present = None;
        self.previous = None;
        self.forget_columns();
        self.warned = Warned::default();
        self.alarms = Alarms::default();
    }

    /// Row of a value reference of one type.
    ///
    /// # Errors
    /// If there is no such variable.
    pub fn row(&self, reference: u32, kind: Kind) -> Outcome<usize> {
        let index = reference as usize;
        match self.unit.rows().get(index) {
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
        let stepped = self.state.last_step > 0.0;
        if stepped && self.present.is_none() && MANY * references.len() > self.unit.rows().len() {
            self.present = Some(self.unit.values());
        }
        let (rows, set, present) = (self.unit.rows(), &self.state.values[..], self.present.as_deref());
        for (reference, value) in references.iter().zip(values) {
            let index = *reference as usize;
            let Some(row) = rows.get(index).filter(|row| row.kind == kind) else {
                return self.row(*reference, kind).map(drop);
            };
            *value = match row.causality {
                Causality::Input | Causality::Parameter => set[index],
                Causality::Output | Causality::Local => match present {
                    Some(present) => present[index],
                    None => self.unit.value(index),
                },
            };
            if stepped && !value.is_finite() {
                return error(format!("{} is not a number at {} s", row.name, self.unit.time()));
            }
        }
        Ok(())
    }

    /// Sets inputs.
    ///
    /// # Errors
    /// If a reference is not that of an input or a value not finite; nothing is then set.
    pub fn set(&mut self, references: &[u32], kind: Kind, values: &[f64]) -> Outcome {
        for (reference, value) in references.iter().zip(values) {
            let row = &self.unit.rows()[self.row(*reference, kind)?];
            if matches!(row.causality, Causality::Output | Causality::Local) {
                return error(format!("{} is an output and cannot be set", row.name));
            }
            if !value.is_finite() {
                return error(format!("{} = {value} is not a finite number", row.name));
            }
            if let Some(Offered { range, variability, .. }) = row.offered() {
                if self.state.phase == Phase::StepComplete && variability == Variability::Fixed {
                    return error(format!("{} is fixed: it can be set before the start only", row.name));
                }
                range.check(&row.name, *value).or_else(|why| error(why.to_string()))?;
            }
        }
        let started = matches!(self.state.phase, Phase::StepComplete | Phase::Intermediate);
        for (reference, value) in references.iter().zip(values) {
            let index = *reference as usize;
            let input = self.unit.rows()[index].causality == Causality::Input;
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
