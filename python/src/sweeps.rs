//! Sweeps: cases, their rows, and the directory that keeps them.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use pyo3::prelude::*;
use roulement_cli::sweep::SweepError;
use roulement_cli::sweep::all;
use roulement_cli::sweep::case::{self, Wanted};
use roulement_cli::sweep::cases::{Cases, base_of};
use roulement_cli::sweep::store::{PROGRAM, from_text, to_text};

use crate::failures::{file, scene as refused, value};

fn failed(why: SweepError) -> PyErr {
    match why {
        SweepError::Files(_) => file(why),
        SweepError::Scene(why) => refused(why),
        why => value(why),
    }
}

/// Cases, and a directory with what is done of them.
#[pyclass(frozen)]
pub struct Sweep {
    sweep: all::Sweep,
    directory: PathBuf,
}

#[pymethods]
impl Sweep {
    /// `cases` is the path of a table, or the text of one in TOML.
    #[new]
    #[pyo3(signature = (directory, path=None, text=None, scene=None, columns=vec![], growth=false))]
    fn new(
        py: Python<'_>,
        directory: PathBuf,
        path: Option<PathBuf>,
        text: Option<String>,
        scene: Option<String>,
        columns: Vec<String>,
        growth: bool,
    ) -> PyResult<Self> {
        py.detach(|| {
            let cases = match (&path, &text) {
                (Some(path), _) => Cases::load(path).map_err(failed)?,
                (None, text) => {
                    let mut cases = Cases::from_toml(text.as_deref().unwrap_or_default()).map_err(value)?;
                    cases.embed_files("".as_ref()).map_err(value)?;
                    cases
                }
            };
            let base = match (scene, &cases.scene) {
                (Some(text), _) => text,
                (None, Some(path)) => base_of(path).map_err(refused)?.0,
                (None, None) => return Err(value("name the base scene")),
            };
            let wanted = Wanted { columns, growth, ..Wanted::default() };
            let sweep = all::Sweep::new(cases, base, wanted, &directory).map_err(failed)?;
            Ok(Self { sweep, directory })
        })
    }

    fn __len__(&self) -> usize {
        self.sweep.names.len()
    }

    /// Cases, from 0, that are not done yet.
    fn missing(&self, py: Python<'_>) -> Vec<usize> {
        py.detach(|| self.sweep.missing())
    }

    /// Text of the scene of a case.
    fn scene_text(&self, case: usize) -> PyResult<String> {
        self.check(case)?;
        self.sweep.cases.text_of(&self.sweep.base, case).map_err(refused)
    }

    /// Runs cases on threads of this machine.
    fn run(
        &self,
        py: Python<'_>,
        cases: Vec<usize>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        cases.iter().try_for_each(|case| self.check(*case))?;
        let interrupted = AtomicBool::new(false);
        let over = AtomicBool::new(false);
        let count = std::sync::atomic::AtomicUsize::new(0);
        let threads = threads.unwrap_or_else(all::threads);
        let (ran, told) = py.detach(|| {
            std::thread::scope(|scope| {
                let run = scope.spawn(|| {
                    let ran = self.sweep.run(&cases, threads, &interrupted, || {
                        count.fetch_add(1, Ordering::Relaxed);
                    });
                    over.store(true, Ordering::Relaxed);
                    ran
                });
                // Signals and progress are told by the thread of Python.
                let mut told: PyResult<()> = Ok(());
                loop {
                    let is_over = over.load(Ordering::Relaxed) || run.is_finished();
                    if told.is_ok() {
                        told = Python::attach(|py| {
                            py.check_signals()?;
                            if let Some(progress) = &progress {
                                progress.call1(py, (count.load(Ordering::Relaxed), cases.len()))?;
                            }
                            Ok(())
                        });
                        if told.is_err() {
                            interrupted.store(true, Ordering::Relaxed);
                        }
                    }
                    if is_over {
                        break;
                    }
                    std::thread::sleep(Duration::from_millis(20));
                }
                (run.join().unwrap_or_else(|why| std::panic::resume_unwind(why)), told)
            })
        });
        told?;
        ran.map_err(failed)
    }

    /// Keeps the row of a case that was run elsewhere.
    fn put(&self, case: usize, row: &str) -> PyResult<()> {
        self.check(case)?;
        let Ok(name) = &self.sweep.names[case] else { return Ok(()) };
        let row = from_text(row).map_err(value)?;
        self.sweep.store.put(name, &row, None).map_err(failed)
    }

    /// Writes the summary of all cases; how many are done, have failed, and were not run.
    fn write_summary(&self, py: Python<'_>) -> PyResult<(usize, usize, usize)> {
        let counts = py.detach(|| self.sweep.write_summary(&self.directory)).map_err(failed)?;
        Ok((counts.done, counts.failed, counts.not_run))
    }
}

impl Sweep {
    fn check(&self, case: usize) -> PyResult<()> {
        let count = self.sweep.names.len();
        if case < count { Ok(()) } else { Err(value(format!("case {case} is not there: there are {count}"))) }
    }
}

/// Text of a base scene in a file, of a bearing or of a shaft with its bearings.
#[pyfunction]
pub fn base_scene(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    py.detach(|| base_of(&path).map(|(text, _)| text).map_err(refused))
}

/// Version of the program that rows come from, with revision and platform: part of the names of cases.
#[pyfunction]
pub fn version() -> &'static str {
    PROGRAM
}

/// Row of a case from the text of its scene, as text: what a worker on another machine does.
#[pyfunction]
pub fn case_row(py: Python<'_>, scene: &str, columns: Vec<String>, growth: bool) -> PyResult<String> {
    py.detach(|| {
        let wanted = Wanted { columns, growth, ..Wanted::default() };
        let row = case::run_text(scene, &wanted, None, &AtomicBool::new(false)).map_err(failed)?;
        to_text(&row.unwrap_or_default()).map_err(value)
    })
}
