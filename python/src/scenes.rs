//! Scenes, their equilibria and effects, their packages, and what accuracy costs.

use std::path::PathBuf;
use std::sync::Arc;

use indicatif::ProgressBar;
use pyo3::prelude::*;
use roulement::analysis::{auto, estimate};
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::interface::model_description::render;
use roulement::scene::system::SystemScene;
use roulement::{Model, scene};
use roulement_cli::cost::{Choice, report, study_of};
use roulement_cli::package::{library_beside as built_with, write_fmu, write_system_fmu};
use roulement_cli::report::json;

use crate::failures::{file, runtime, scene as refused, value};

/// A scene, immutable.
#[pyclass(frozen)]
pub struct Scene(pub Arc<scene::Scene>);

impl Scene {
    /// With its effects found out where it asks for that.
    pub fn resolved(&self) -> PyResult<scene::Scene> {
        auto::resolve((*self.0).clone()).map(|(scene, _)| scene).map_err(runtime)
    }
}

#[pymethods]
impl Scene {
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        py.detach(|| scene::Scene::load(&path)).map(|scene| Self(Arc::new(scene))).map_err(refused)
    }

    #[staticmethod]
    fn parse(text: &str) -> PyResult<Self> {
        scene::Scene::parse(text).map(|scene| Self(Arc::new(scene))).map_err(refused)
    }

    fn edited(&self, changes: Vec<(String, String)>) -> PyResult<Self> {
        scene::Scene::edited(&self.0.source, changes).map(|scene| Self(Arc::new(scene))).map_err(refused)
    }

    #[getter]
    fn source(&self) -> &str {
        &self.0.source
    }

    #[getter]
    fn title(&self) -> &str {
        &self.0.title
    }

    fn notes(&self) -> Vec<String> {
        self.0.notes()
    }

    /// Equilibrium as JSON.
    fn equilibrium(&self, py: Python<'_>, gyroscopic: &str) -> PyResult<String> {
        let gyroscopic = match gyroscopic {
            "outer-race-control" => Gyroscopic::OuterRaceControl,
            "none" => Gyroscopic::None,
            "friction" => Gyroscopic::Friction,
            other => {
                return Err(value(format!(
                    "gyroscopic = {other:?} is none of \"outer-race-control\", \"none\", \"friction\""
                )));
            }
        };
        py.detach(|| {
            let scene = self.resolved()?;
            let model = Model::new(&scene).map_err(runtime)?;
            let input = EquilibriumInput::from_scene(&scene, gyroscopic);
            let solution = equilibrium::solve(&model, &input).map_err(runtime)?;
            let mut report = solution.to_json();
            report["peak_pressure"] = solution.peak_pressure(&model).into();
            Ok(report.to_string())
        })
    }

    /// Effects as JSON.
    fn effects(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| {
            let scene = self.resolved()?;
            let verdicts =
                estimate::verdicts(&scene, &Model::new(&scene).map_err(runtime)?).map_err(runtime)?;
            json::effects(&scene, &verdicts).map(|report| report.to_string()).map_err(runtime)
        })
    }

    /// Model description of its package.
    fn describe(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        py.detach(|| {
            let simulation = roulement::Simulation::new(&self.0).map_err(runtime)?;
            render(&simulation, name).map(|description| description.xml).map_err(runtime)
        })
    }
}

/// The shared library beside the program, which was built together with this package.
#[pyfunction]
pub fn library_beside(program: PathBuf) -> PyResult<PathBuf> {
    built_with(&program).map_err(file)
}

/// Writes the FMU of a scene.
#[pyfunction]
pub fn package(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    libraries: Vec<PathBuf>,
    name: &str,
) -> PyResult<()> {
    py.detach(|| write_fmu(&scene.resolved()?, name, &libraries, &path).map_err(file))
}

/// Writes the FMU of a shaft with its bearings from its file.
#[pyfunction]
pub fn package_shaft(
    py: Python<'_>,
    file_of_shaft: PathBuf,
    path: PathBuf,
    libraries: Vec<PathBuf>,
    name: &str,
) -> PyResult<()> {
    py.detach(|| {
        let scene = SystemScene::load(&file_of_shaft).map_err(refused)?;
        write_system_fmu(&scene, name, &libraries, &path).map_err(file)
    })
}

/// Runs the study of accuracy against CPU time into a directory; gives the files.
#[pyfunction]
pub fn cost(
    py: Python<'_>,
    scene: &Scene,
    name: &str,
    directory: PathBuf,
    threads: Option<usize>,
) -> PyResult<Vec<PathBuf>> {
    py.detach(|| {
        let choice = Choice { threads: threads.unwrap_or(Choice::default().threads), ..Choice::default() };
        let study = study_of(name, &scene.resolved()?, &choice, &ProgressBar::hidden()).map_err(runtime)?;
        std::fs::create_dir_all(&directory).map_err(file)?;
        report::write(&[study], &directory).map_err(file)
    })
}
