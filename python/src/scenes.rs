//! Scenes, their equilibria and effects, their packages, and what accuracy costs.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use indicatif::ProgressBar;
use pyo3::prelude::*;
use roulement::analysis::{auto, estimate};
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::interface::model_description::{Version, all, render};
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement::simulation::system::{MachineEquilibrium, largest_speed};
use roulement::{Model, scene};
use roulement_cli::cage;
use roulement_cli::check::check as check_file;
use roulement_cli::cost::{Choice, report, study_of};
use roulement_cli::duty::DutyRating;
use roulement_cli::duty::loads::Duty;
use roulement_cli::duty::say::with_duty;
use roulement_cli::fits::{Fits, with_fits};
use roulement_cli::package::{library_beside as built_with, write_fmu};
use roulement_cli::report::json;
use roulement_cli::sweep::all::threads;
use serde_json::{Map, Value};

use crate::failures::{file, runtime, scene as refused, value};

/// A scene of a bearing, or of a shaft with its bearings; immutable.
#[pyclass(frozen)]
pub struct Scene(pub Arc<MachineScene>);

impl Scene {
    /// With its effects found out where it asks for that.
    pub fn resolved(&self) -> PyResult<MachineScene> {
        auto::resolve_machine(MachineScene::clone(&self.0), false).map(|(scene, _)| scene).map_err(runtime)
    }
}

#[pymethods]
impl Scene {
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        py.detach(|| MachineScene::load(&path)).map(|scene| Self(Arc::new(scene))).map_err(refused)
    }

    #[staticmethod]
    fn parse(text: &str) -> PyResult<Self> {
        MachineScene::parse(text).map(|scene| Self(Arc::new(scene))).map_err(refused)
    }

    fn edited(&self, changes: Vec<(String, String)>) -> PyResult<Self> {
        let text = scene::Scene::edited_text(self.0.source(), changes);
        let scene = text.and_then(|text| MachineScene::edited(&text));
        scene.map(|scene| Self(Arc::new(scene))).map_err(refused)
    }

    /// Names of its bearings; that of a bearing alone is empty.
    #[getter]
    fn bearings(&self) -> Vec<String> {
        self.0.bearings().into_iter().map(|(name, _)| name.to_string()).collect()
    }

    #[getter]
    fn source(&self) -> &str {
        self.0.source()
    }

    #[getter]
    fn title(&self) -> &str {
        self.0.title()
    }

    fn notes(&self) -> Vec<String> {
        self.0.notes()
    }

    /// Equilibrium as JSON.
    fn equilibrium(&self, py: Python<'_>, gyroscopic: Option<&str>) -> PyResult<String> {
        let by_friction = matches!(gyroscopic, None | Some("friction"));
        let gyroscopic = match gyroscopic.unwrap_or("outer-race-control") {
            "outer-race-control" => Gyroscopic::OuterRaceControl,
            "inner-race-control" => Gyroscopic::InnerRaceControl,
            "least-heat" => Gyroscopic::LeastHeat,
            "none" => Gyroscopic::None,
            "friction" => Gyroscopic::Friction,
            other => {
                return Err(value(format!(
                    "gyroscopic = {other:?} is none of \"outer-race-control\", \"inner-race-control\", \"least-heat\", \
                     \"none\", \"friction\""
                )));
            }
        };
        py.detach(|| {
            let scene = self.resolved()?;
            let duty = DutyRating::of_scene(&scene, threads()).map_err(runtime)?;
            let fits = Fits::of(&scene, threads()).map_err(runtime)?;
            let rated = |report| with_fits(with_duty(report, duty.as_ref()), fits.as_ref()).to_string();
            let scene = match scene {
                MachineScene::Bearing(scene) => scene,
                MachineScene::Shaft(_) if !by_friction => {
                    return Err(value(
                        "gyroscopic: on a shaft friction carries the gyroscopic moments of balls",
                    ));
                }
                MachineScene::Shaft(scene) => {
                    let found =
                        MachineEquilibrium::of(&scene, 0.0, largest_speed(&scene)).map_err(runtime)?;
                    return Ok(rated(found.to_json()));
                }
            };
            let model = Model::new(&scene).map_err(runtime)?;
            let input = EquilibriumInput::from_scene(&scene, gyroscopic);
            let solution = equilibrium::solve(&model, &input).map_err(runtime)?;
            let mut report = solution.to_json();
            report["peak_pressure"] = solution.peak_pressure(&model).into();
            Ok(rated(report))
        })
    }

    /// Rating under the loads of a table, or over its own duty, in balance or run, as JSON.
    fn rating(&self, py: Python<'_>, loads: Option<PathBuf>, runs: bool) -> PyResult<String> {
        py.detach(|| {
            let scene = self.resolved()?;
            let duty = match &loads {
                Some(path) => Duty::of_table(path, &scene),
                None => Duty::of_scene(&scene),
            };
            let duty = duty.map_err(value)?;
            let rating = match runs {
                true => DutyRating::in_runs(&duty, threads()),
                false => DutyRating::of(&duty, threads()),
            };
            Ok(rating.map_err(runtime)?.to_json().to_string())
        })
    }

    /// Effects as JSON.
    fn effects(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| {
            let scene = match self.resolved()? {
                MachineScene::Bearing(scene) => {
                    let model = Model::new(&scene).map_err(runtime)?;
                    let verdicts = estimate::verdicts(&scene, &model).map_err(runtime)?;
                    return json::effects(&scene, &verdicts)
                        .map(|report| report.to_string())
                        .map_err(runtime);
                }
                scene @ MachineScene::Shaft(_) => scene,
            };
            let machine = Machine::new(&scene).map_err(runtime)?;
            let MachineScene::Shaft(system) = &scene else { return Ok(String::new()) };
            let all = estimate::verdicts_of_shaft(system);
            let of = |((name, bearing), verdicts): ((&str, &roulement::Simulation), estimate::Verdicts)| {
                let report = json::effects(bearing.scene(), &verdicts.map_err(runtime)?).map_err(runtime)?;
                Ok::<_, PyErr>((name.to_string(), report))
            };
            let reports = machine.bearings().zip(all).map(of).collect::<PyResult<Map<_, _>>>()?;
            Ok(Value::Object(reports).to_string())
        })
    }

    /// Motions of its cages under pushes as JSON.
    fn cage(&self, py: Python<'_>, jobs: Option<usize>) -> PyResult<String> {
        py.detach(|| {
            let never = AtomicBool::new(false);
            let cages = cage::pushed(&self.resolved()?, jobs.unwrap_or_else(threads), &never, |_| {});
            Ok(cage::to_json(&cages.map_err(runtime)?).to_string())
        })
    }

    /// Model description of its package.
    fn describe(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        py.detach(|| {
            let machine = Machine::new(&self.0).map_err(runtime)?;
            render(&machine, name, &all).map(|description| description.xml).map_err(runtime)
        })
    }
}

/// What a file is: kind, lines, and whether it can be run.
#[pyfunction]
pub fn check(py: Python<'_>, path: PathBuf) -> (String, Vec<String>, bool) {
    let found = py.detach(|| check_file(&path));
    (found.kind, found.lines, found.good)
}

/// The shared library beside the program, which was built together with this package.
#[pyfunction]
pub fn library_beside(program: PathBuf) -> PyResult<PathBuf> {
    built_with(&program).map_err(file)
}

/// Version of FMI by its number.
fn version(fmi: u32) -> PyResult<Version> {
    match fmi {
        2 => Ok(Version::V2),
        3 => Ok(Version::V3),
        other => Err(value(format!("fmi = {other} is neither 2 nor 3"))),
    }
}

/// Writes the FMU of a scene.
#[pyfunction]
pub fn package(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    libraries: Vec<PathBuf>,
    name: &str,
    columns: Vec<String>,
    fmi: u32,
) -> PyResult<()> {
    let version = version(fmi)?;
    py.detach(|| {
        write_fmu(&scene.resolved()?, &version.into(), name, &columns, &libraries, &path).map_err(file)
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
