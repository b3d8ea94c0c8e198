//! A bearing step by step: the slave of the package, without its C interface.

use std::ffi::CStr;
use std::sync::{Arc, Mutex, MutexGuard};

use pyo3::buffer::PyBuffer;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use roulement::fmi::{FmuState, Instance, Log, Outcome, Status};
use roulement::interface::variables::{Causality, Kind, MachineVariables, Variable, Variables};
use roulement::scene::machine::MachineScene;
use roulement::simulation::system::System;

use crate::arrays::{numbers, write};
use crate::failures::{runtime, value};
use crate::scenes::Scene;

type Messages = Arc<Mutex<Vec<String>>>;

/// A running bearing.
#[pyclass(frozen)]
pub struct Simulation {
    instance: Mutex<Instance>,
    messages: Messages,
    scene: Arc<MachineScene>,
}

/// A point that a simulation was at.
#[pyclass(frozen)]
pub struct State(FmuState);

fn log_to(messages: &Messages) -> Log {
    let messages = Arc::clone(messages);
    let sink = move |status: Status, _: &CStr, text: &str| {
        // A refusal is told by its exception.
        if let (Ok(mut messages), Status::Ok | Status::Warning) = (messages.lock(), status) {
            messages.push(text.into());
        }
    };
    Log::new(Box::new(sink), true)
}

fn done<T>(outcome: Outcome<T>) -> PyResult<T> {
    outcome.map_err(|(status, why)| match status {
        Status::Error => value(why),
        _ => runtime(why),
    })
}

impl Simulation {
    fn lock(&self) -> PyResult<MutexGuard<'_, Instance>> {
        self.instance.lock().map_err(|_| runtime("this simulation was lost in a fault"))
    }

    /// Works on the simulation while other threads of Python run.
    fn work<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Instance) -> Outcome<T> + Send,
    ) -> PyResult<T> {
        py.detach(|| done(work(&mut *self.lock()?)))
    }
}

#[pymethods]
impl Simulation {
    #[new]
    fn new(py: Python<'_>, scene: &Scene, start: f64, values: Vec<(u32, f64)>) -> PyResult<Self> {
        let messages = Messages::default();
        let log = log_to(&messages);
        let instance = py.detach(|| {
            let mut instance = done(Instance::of_machine((*scene.0).clone(), log))?;
            done(instance.setup_experiment(start, None))?;
            instance.enter_initialization();
            for (reference, value) in values {
                let kind = instance.rows().get(reference as usize).map_or(Kind::Real, |row| row.kind);
                done(instance.set(&[reference], kind, &[value]))?;
            }
            done(instance.exit_initialization())?;
            Ok::<_, PyErr>(instance)
        })?;
        Ok(Self { instance: Mutex::new(instance), messages, scene: Arc::clone(&scene.0) })
    }

    /// Name, unit, causality and description of every variable of a scene's package, by reference.
    #[staticmethod]
    fn variables(scene: &Scene) -> PyResult<Vec<(String, &'static str, &'static str, String)>> {
        let scene = scene.resolved()?;
        let row = |row: &Variable| {
            let causality = match row.causality {
                Causality::Input => "input",
                Causality::Output => "output",
                Causality::Local => "local",
                Causality::Parameter => "parameter",
            };
            (row.name.clone(), row.unit.name, causality, row.description.clone())
        };
        Ok(match &scene {
            MachineScene::Bearing(scene) => Variables::new(scene).rows().iter().map(row).collect(),
            MachineScene::Shaft(scene) => {
                let system = System::new(scene).map_err(runtime)?;
                MachineVariables::new(&system).rows().iter().map(row).collect()
            }
        })
    }

    fn get(&self, py: Python<'_>, references: Vec<u32>, array: PyBuffer<f64>) -> PyResult<()> {
        let mut values = vec![0.0; references.len()];
        let mut instance = self.lock()?;
        for (reference, value) in references.iter().zip(&mut values) {
            let kind =
                instance.rows().get(*reference as usize).ok_or_else(|| PyKeyError::new_err(*reference))?.kind;
            done(instance.get(&[*reference], kind, std::slice::from_mut(value)))?;
        }
        write(py, &array, &values)
    }

    fn set(&self, py: Python<'_>, references: Vec<u32>, array: PyBuffer<f64>) -> PyResult<()> {
        let values = numbers(py, &array)?;
        if values.len() != references.len() {
            return Err(value(format!("{} values are needed, {} are given", references.len(), values.len())));
        }
        done(self.lock()?.set(&references, Kind::Real, &values))
    }

    fn set_derivatives(&self, py: Python<'_>, references: Vec<u32>, array: PyBuffer<f64>) -> PyResult<()> {
        let values = numbers(py, &array)?;
        if values.len() != references.len() {
            return Err(value(format!("{} values are needed, {} are given", references.len(), values.len())));
        }
        done(self.lock()?.set_input_derivatives(&references, &vec![1; references.len()], &values))
    }

    fn step(&self, py: Python<'_>, step: f64) -> PyResult<f64> {
        self.work(py, |instance| {
            instance.do_step(instance.time(), step)?;
            Ok(instance.time())
        })
    }

    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.lock()?.time())
    }

    /// Derivatives of unknowns by knowns, a row for each unknown, into an array.
    fn derivatives(
        &self,
        py: Python<'_>,
        unknowns: Vec<u32>,
        knowns: Vec<u32>,
        array: PyBuffer<f64>,
    ) -> PyResult<()> {
        let all = self.work(py, |instance| {
            let mut all = vec![0.0; unknowns.len() * knowns.len()];
            let mut column = vec![0.0; unknowns.len()];
            for (k, known) in knowns.iter().enumerate() {
                instance.directional_derivative(&unknowns, &[*known], &[1.0], &mut column)?;
                column.iter().enumerate().for_each(|(u, value)| all[u * knowns.len() + k] = *value);
            }
            Ok(all)
        })?;
        write(py, &array, &all)
    }

    fn snapshot(&self) -> PyResult<State> {
        Ok(State(self.lock()?.save()))
    }

    fn restore(&self, state: &State) -> PyResult<()> {
        done(self.lock()?.restore(&state.0))
    }

    fn to_bytes<'py>(&self, py: Python<'py>, state: &State) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = done(self.lock()?.serialise(&state.0))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn state_of_bytes(&self, bytes: &[u8]) -> PyResult<State> {
        done(self.lock()?.deserialise(bytes)).map(State)
    }

    fn copy(&self) -> PyResult<Self> {
        let messages = Messages::default();
        let instance = Mutex::new(self.lock()?.copy(log_to(&messages)));
        Ok(Self { instance, messages, scene: Arc::clone(&self.scene) })
    }

    /// Messages since they were asked for last.
    fn messages(&self) -> Vec<String> {
        self.messages.lock().map(|mut messages| std::mem::take(&mut *messages)).unwrap_or_default()
    }
}
