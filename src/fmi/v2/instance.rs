//! What the calls of the interface do, in safe code.

use std::path::PathBuf;

use percent_encoding::percent_decode_str;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::log::Log;
use super::state_machine::{Call, Phase, allowed};
use super::types::{CallbackFunctions, Status};
use crate::interface::model_description;
use crate::interface::variables::{Causality, Kind, Source, Variables};
use crate::scene::Scene;
use crate::scene::parameters::Variability;
use crate::simulation::inputs::Inputs;
use crate::simulation::{Simulation, Snapshot};

/// Name of the scene inside a package's resources folder.
pub const SCENE_FILE: &str = "scene.toml";
/// [-] relative disagreement of importer and instance about the time that is still rounding.
const TIME_TOLERANCE: f64 = 1e-9;
/// First bytes of a serialised state: what it is, and the version of its form.
const MAGIC: &[u8; 8] = b"rlmtFMU3";

/// A refusal or failure: its status and why.
pub type Outcome<T = ()> = Result<T, (Status, String)>;

/// A refusal with fmi2Error.
pub(super) fn error<T>(why: impl Into<String>) -> Outcome<T> {
    Err((Status::Error, why.into()))
}

/// The complete state of an instance between two calls.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FmuState {
    phase: u8,
    values: Vec<f64>,
    rates: Vec<f64>,
    previous_outputs: Vec<f64>,
    last_step: f64,
    changed: bool,
    given: Vec<bool>,
    applied: Vec<f64>,
    before: Option<Snapshot>,
    snapshot: Snapshot,
}

/// A slave.
pub struct Instance {
    /// Messages to the importer.
    pub log: Log,
    guid: String,
    pub(super) phase: Phase,
    pub(super) variables: Variables,
    /// Start of everything, for `fmi2Reset`.
    fresh: Box<Simulation>,
    pub(super) simulation: Simulation,
    /// The communication point before the last; none before the first step.
    pub(super) before: Option<Snapshot>,
    /// Derivatives of outputs by inputs at this point, if they were asked for.
    pub(super) columns: Option<Vec<Vec<f64>>>,
    /// Inputs and parameters as set, by value reference; entries of outputs are not used.
    values: Vec<f64>,
    /// Inputs that the importer set before the start; the others start where the parameters put them.
    given: Vec<bool>,
    /// Parameters, by value reference, that the simulation runs with.
    applied: Vec<f64>,
    /// First derivatives of the inputs.
    rates: Vec<f64>,
    /// Outputs at the communication point before the last.
    previous_outputs: Vec<f64>,
    last_step: f64,
    /// Were inputs (before the start) or parameters set that the simulation does not know of yet?
    changed: bool,
}

/// Path of a resource location: a `file:` URI, or a plain path as some importers pass.
fn resource_path(location: &str) -> Outcome<PathBuf> {
    let rest = match location.strip_prefix("file:") {
        None if location.contains("://") => {
            return error(format!("the resource location \"{location}\" is not a file: URI"));
        }
        None => return Ok(PathBuf::from(location)),
        Some(rest) => rest,
    };
    // file:/path, file:///path and file://localhost/path
    let path = match rest.strip_prefix("//") {
        Some(authority) => authority.find('/').map_or("", |slash| &authority[slash..]),
        None => rest,
    };
    let path = percent_decode_str(path)
        .decode_utf8()
        .map_err(|_| (Status::Error, format!("the resource location \"{location}\" is not UTF-8")))?;
    // file:///C:/path is C:/path on Windows
    let drive = path.len() > 2 && path.as_bytes()[2] == b':' && path.starts_with('/');
    Ok(PathBuf::from(if drive { &path[1..] } else { &path }))
}

impl Instance {
    /// A slave of the package whose resources are at `location`.
    ///
    /// # Errors
    /// If the scene cannot be read or started, or `guid` is not that of the scene's model description.
    pub fn new(
        name: &str,
        guid: &str,
        location: &str,
        callbacks: CallbackFunctions,
        logging: bool,
    ) -> Outcome<Self> {
        let path = resource_path(location)?.join(SCENE_FILE);
        let failed = |why: String| (Status::Error, why);
        let scene = Scene::load(&path).map_err(|why| failed(why.to_string()))?;
        let variables = Variables::new(&scene);
        let own = model_description::guid(&scene, &variables);
        if guid != own {
            return error(format!(
                "the guid {guid} is not that of this package, {own}: model description and library do not belong together"
            ));
        }
        let simulation = Simulation::new(&scene).map_err(|why| failed(why.to_string()))?;
        let values = variables.values(simulation.inputs(), simulation.outputs());
        Ok(Self {
            log: Log::new(callbacks, name, logging),
            guid: own,
            phase: Phase::Instantiated,
            rates: vec![0.0; values.len()],
            previous_outputs: values.clone(),
            given: vec![false; values.len()],
            applied: values.clone(),
            values,
            variables,
            fresh: Box::new(simulation.clone()),
            simulation,
            before: None,
            columns: None,
            last_step: 0.0,
            changed: false,
        })
    }

    /// Refuses a call that the standard does not allow now.
    ///
    /// # Errors
    /// The refusal.
    pub fn check(&self, call: Call) -> Outcome {
        if allowed(call, self.phase) {
            return Ok(());
        }
        error(format!("{call:?} is not allowed in phase {:?}", self.phase))
    }

    /// Notes the consequence of a status for the phase.
    pub fn settle(&mut self, call: Call, status: Status) {
        match status {
            Status::Fatal => self.phase = Phase::Fatal,
            // A value that was refused leaves the instance as it was, and so does an unwelcome call of no effect.
            Status::Error if call == Call::DoStep || call == Call::ExitInitializationMode => {
                self.phase = Phase::Error;
            }
            Status::Discard if call == Call::DoStep => self.phase = Phase::StepFailed,
            _ => {}
        }
    }

    /// `fmi2SetupExperiment`.
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
        self.simulation.set_start_time(start);
        Ok(())
    }

    /// `fmi2EnterInitializationMode`.
    pub fn enter_initialization(&mut self) {
        self.phase = Phase::Initialization;
    }

    /// `fmi2ExitInitializationMode`.
    ///
    /// # Errors
    /// If the inputs allow no start.
    pub fn exit_initialization(&mut self) -> Outcome {
        self.refresh()?;
        self.previous_outputs = self.variables.values(self.simulation.inputs(), self.simulation.outputs());
        self.phase = Phase::StepComplete;
        Ok(())
    }

    /// Starts from inputs and parameters that were set before the start; without any, the start is the scene's own.
    ///
    /// # Errors
    /// If they allow no start.
    pub(super) fn refresh(&mut self) -> Outcome {
        if !self.changed {
            return Ok(());
        }
        let mut simulation = self.simulation.clone();
        let mut values = self.values.clone();
        if self.variables.parameters_differ(&self.values, &self.applied) {
            simulation = self.with_parameters(&self.values)?;
            simulation.set_start_time(self.simulation.time());
            let start = self.variables.values(simulation.inputs(), simulation.outputs());
            for (index, row) in self.variables.rows().iter().enumerate() {
                if row.causality == Causality::Input && !self.given[index] {
                    values[index] = start[index];
                }
            }
        }
        if self.given.contains(&true) {
            simulation.set_inputs(self.read_inputs(&values, simulation.inputs())?);
            simulation.initialise().map_err(|why| (Status::Error, why.to_string()))?;
        }
        self.simulation = simulation;
        self.applied.clone_from(&values);
        self.values = values;
        self.columns = None;
        self.changed = false;
        Ok(())
    }

    /// A simulation of the scene with the parameters among these values.
    fn with_parameters(&self, values: &[f64]) -> Outcome<Simulation> {
        Simulation::new(&self.scene_with(values)?).map_err(|why| (Status::Error, why.to_string()))
    }

    /// The scene with the parameters among these values.
    fn scene_with(&self, values: &[f64]) -> Outcome<Scene> {
        let mut scene = self.fresh.scene().clone();
        self.variables.set_parameters(&mut scene, values);
        scene.check().map_err(|why| (Status::Error, why.to_string()))?;
        Ok(scene)
    }

    fn read_inputs(&self, values: &[f64], base: &Inputs) -> Outcome<Inputs> {
        self.variables.inputs(values, &self.rates, base).map_err(|why| (Status::Error, why.to_string()))
    }

    /// `fmi2Terminate`.
    pub fn terminate(&mut self) {
        self.phase = Phase::Terminated;
    }

    /// `fmi2Reset`: as freshly instantiated.
    pub fn reset(&mut self) {
        self.simulation = (*self.fresh).clone();
        self.values = self.variables.values(self.simulation.inputs(), self.simulation.outputs());
        self.previous_outputs.clone_from(&self.values);
        self.applied.clone_from(&self.values);
        self.given.fill(false);
        self.rates.fill(0.0);
        self.before = None;
        self.columns = None;
        self.last_step = 0.0;
        self.changed = false;
        self.phase = Phase::Instantiated;
    }

    /// Row of a value reference of one type.
    ///
    /// # Errors
    /// If there is no such variable.
    pub(super) fn row(&self, reference: u32, kind: Kind) -> Outcome<usize> {
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
        if self.phase == Phase::Initialization {
            self.refresh()?;
        }
        for (reference, value) in references.iter().zip(values) {
            let index = self.row(*reference, kind)?;
            let row = &self.variables.rows()[index];
            *value = match row.causality {
                Causality::Input | Causality::Parameter => self.values[index],
                Causality::Output => {
                    self.variables.value(row, self.simulation.inputs(), self.simulation.outputs())
                }
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
            if row.causality == Causality::Output {
                return error(format!("{} is an output and cannot be set", row.name));
            }
            if !value.is_finite() {
                return error(format!("{} = {value} is not a finite number", row.name));
            }
            if let Source::Parameter(parameter, _) = row.source {
                if self.phase == Phase::StepComplete && parameter.variability == Variability::Fixed {
                    return error(format!("{} is fixed: it can be set before the start only", row.name));
                }
                parameter.range.check(parameter.key, *value).or_else(|why| error(why.to_string()))?;
            }
        }
        let started = self.phase == Phase::StepComplete;
        for (reference, value) in references.iter().zip(values) {
            let index = *reference as usize;
            let input = self.variables.rows()[index].causality == Causality::Input;
            // Inputs of a running simulation are read by the next step anyway.
            if !(started && input) {
                self.changed |= self.values[index] != *value;
            }
            self.given[index] |= input && !started;
            self.values[index] = *value;
        }
        Ok(())
    }

    /// First derivatives of inputs by time.
    ///
    /// # Errors
    /// If an order is not 1, a reference not that of an input, or a value not finite; nothing is then set.
    pub fn set_input_derivatives(&mut self, references: &[u32], orders: &[i32], values: &[f64]) -> Outcome {
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let row = &self.variables.rows()[self.row(*reference, Kind::Real)?];
            if row.causality != Causality::Input {
                return error(format!("{} is no input: it takes no input derivative", row.name));
            }
            if *order != 1 {
                return error(format!("input derivatives of order {order} are not offered, only of order 1"));
            }
            if !value.is_finite() {
                return error(format!("the derivative of {} = {value} is not a finite number", row.name));
            }
        }
        for (reference, value) in references.iter().zip(values) {
            self.rates[*reference as usize] = *value;
        }
        Ok(())
    }

    /// First derivatives of outputs by time: their change over the last communication step.
    ///
    /// # Errors
    /// If an order is not 1 or a reference not that of an output.
    pub fn output_derivatives(&self, references: &[u32], orders: &[i32], values: &mut [f64]) -> Outcome {
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let index = self.row(*reference, Kind::Real)?;
            let row = &self.variables.rows()[index];
            if row.causality != Causality::Output {
                return error(format!("{} is no output: it has no output derivative", row.name));
            }
            if *order != 1 {
                return error(format!(
                    "output derivatives of order {order} are not offered, only of order 1"
                ));
            }
            let now = self.variables.value(row, self.simulation.inputs(), self.simulation.outputs());
            let change = now - self.previous_outputs[index];
            *value = if self.last_step > 0.0 { change / self.last_step } else { 0.0 };
        }
        Ok(())
    }

    /// `fmi2DoStep`.
    ///
    /// # Errors
    /// fmi2Error for a time that is not the instance's or a step that is not positive; fmi2Discard if the step cannot
    /// be finished: the state is then that of the last time reached.
    pub fn do_step(&mut self, time: f64, step: f64) -> Outcome {
        let now = self.simulation.time();
        if !(step > 0.0 && step.is_finite()) {
            return error(format!("the communication step {step} s is not positive"));
        }
        let scale = now.abs().max(time.abs()).max(step);
        if time.is_nan() || (time - now).abs() > TIME_TOLERANCE * scale {
            return error(format!("the communication point {time} s is not the instance's time {now} s"));
        }
        if time + step <= now {
            return error(format!("the communication step {step} s is lost in rounding at {now} s"));
        }
        let inputs = self.read_inputs(&self.values, self.simulation.inputs())?;
        if self.changed {
            self.simulation.tune(&self.scene_with(&self.values)?);
            self.applied.clone_from(&self.values);
            self.changed = false;
        }
        self.previous_outputs = self.variables.values(self.simulation.inputs(), self.simulation.outputs());
        let before = self.before.insert(self.simulation.snapshot());
        self.columns = None;
        self.simulation.set_inputs(inputs);
        let advanced = self.simulation.advance(time + step);
        // A derivative belongs to the communication point that it was set for.
        self.rates.fill(0.0);
        let reached = self.simulation.time();
        self.last_step = reached - now;
        let values = self.variables.values(self.simulation.inputs(), self.simulation.outputs());
        if !values.iter().all(|value| value.is_finite()) {
            let restored = self.simulation.restore(before);
            debug_assert!(restored, "a snapshot of this very simulation fits it");
            self.last_step = 0.0;
            return Err((Status::Discard, format!("a result is not a number after {now} s")));
        }
        advanced.map_err(|why| (Status::Discard, why.to_string()))
    }

    /// [s] time of the last state that was reached.
    pub fn time(&self) -> f64 {
        self.simulation.time()
    }

    /// The complete state.
    pub fn state(&self) -> FmuState {
        FmuState {
            phase: self.phase as u8,
            values: self.values.clone(),
            rates: self.rates.clone(),
            previous_outputs: self.previous_outputs.clone(),
            last_step: self.last_step,
            changed: self.changed,
            given: self.given.clone(),
            applied: self.applied.clone(),
            before: self.before.clone(),
            snapshot: self.simulation.snapshot(),
        }
    }

    /// Goes back to a state of this package.
    ///
    /// # Errors
    /// If the state is of another scene.
    pub fn set_state(&mut self, state: &FmuState) -> Outcome {
        let phases = [
            Phase::Instantiated,
            Phase::Initialization,
            Phase::StepComplete,
            Phase::StepFailed,
            Phase::Terminated,
            Phase::Error,
        ];
        let sizes = [&state.values, &state.rates, &state.previous_outputs, &state.applied];
        let phase = phases.into_iter().find(|phase| *phase as u8 == state.phase);
        let fits = sizes.iter().all(|list| list.len() == self.values.len())
            && state.given.len() == self.values.len();
        let (Some(phase), true) = (phase, fits) else {
            return error("the FMU state is of another scene");
        };
        let no_number = "the FMU state holds a value that is not a number";
        if !sizes.into_iter().flatten().chain([&state.last_step]).all(|value| value.is_finite()) {
            return error(no_number);
        }
        let mut rebuilt = None;
        if self.variables.parameters_differ(&state.applied, &self.applied) {
            rebuilt = Some(self.with_parameters(&state.applied)?);
        }
        let simulation = rebuilt.as_mut().unwrap_or(&mut self.simulation);
        let here = simulation.snapshot();
        if !simulation.restore(&state.snapshot) {
            return error("the FMU state is of another scene");
        }
        let values = self.variables.values(simulation.inputs(), simulation.outputs());
        if !values.iter().all(|value| value.is_finite()) {
            let restored = simulation.restore(&here);
            debug_assert!(restored, "a snapshot of this very simulation fits it");
            return error(no_number);
        }
        if let Some(rebuilt) = rebuilt {
            self.simulation = rebuilt;
        }
        self.given.clone_from(&state.given);
        self.applied.clone_from(&state.applied);
        self.phase = phase;
        self.values.clone_from(&state.values);
        self.rates.clone_from(&state.rates);
        self.previous_outputs.clone_from(&state.previous_outputs);
        self.before.clone_from(&state.before);
        self.columns = None;
        self.last_step = state.last_step;
        self.changed = state.changed;
        Ok(())
    }

    /// A state as bytes: magic, guid, length of the content, checksum, content.
    ///
    /// # Errors
    /// If the content cannot be written, which would be a fault of this library.
    pub fn serialise(&self, state: &FmuState) -> Outcome<Vec<u8>> {
        let content = postcard::to_allocvec(state).map_err(|why| (Status::Error, why.to_string()))?;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(self.guid.as_bytes());
        bytes.extend((content.len() as u64).to_le_bytes());
        bytes.extend(Sha256::digest(&content));
        bytes.extend(content);
        Ok(bytes)
    }

    /// A state from bytes.
    ///
    /// # Errors
    /// If the bytes are not a whole and unaltered state of this very package.
    pub fn deserialise(&self, bytes: &[u8]) -> Outcome<FmuState> {
        let refuse = |why: &str| error(format!("the serialised FMU state is refused: {why}"));
        let Some(rest) = bytes.strip_prefix(MAGIC) else {
            return refuse("it was not written by this version of roulement");
        };
        let Some(rest) = rest.strip_prefix(self.guid.as_bytes()) else {
            return refuse("it is of another package");
        };
        let (Some((length, rest)), true) = (rest.split_first_chunk::<8>(), rest.len() >= 8 + 32) else {
            return refuse("it is cut off");
        };
        let (checksum, content) = rest.split_at(32);
        // Before the content is looked at: the importer's size may be wrong.
        if content.len() as u64 != u64::from_le_bytes(*length) {
            return refuse("its length is wrong");
        }
        if Sha256::digest(content).as_slice() != checksum {
            return refuse("its checksum is wrong");
        }
        postcard::from_bytes(content).or_else(|why| refuse(&why.to_string()))
    }
}
