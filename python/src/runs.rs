//! Runs with their whole tables.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::{Rows, play_observed};
use roulement_cli::error::{Compared, Refined, Run, refine};
use roulement_cli::modes::warnings;
use roulement_cli::report::cells::{Cell, Column};
use roulement_cli::report::figures::Shown;
use roulement_cli::report::json;
use roulement_cli::report::machine_columns::MachineColumns;
use roulement_cli::report::parquet::ParquetWriter;
use roulement_cli::report::results::{Choice, Window};
use roulement_cli::watch::{Seen, Watch};

use crate::arrays::{bytes, numbers};
use crate::failures::{file, runtime, value};
use crate::scenes::Scene;

/// From one call of Python to the next: for Ctrl-C and progress.
const OFTEN: Duration = Duration::from_millis(100);

/// A run that came to its end.
struct Done {
    machine: Machine,
    seen: Seen,
    names: Vec<(String, String)>,
    table: Vec<f64>,
}

impl Compared for Done {
    fn comparable(&mut self) -> Run {
        self.seen.take_comparable(&self.machine, 0.0)
    }
}

/// Names and units of columns, bytes of the table, JSON of the summary.
type Results<'py> = (Vec<(String, String)>, Bound<'py, PyByteArray>, String);

/// Runs a scene; with an error goal, as often as that asks for.
#[pyfunction]
pub fn run<'py>(
    py: Python<'py>,
    scene: &Scene,
    columns: Vec<String>,
    window: (f64, f64),
    progress: Option<Py<PyAny>>,
) -> PyResult<Results<'py>> {
    let choice = Choice { columns, window: Window { from: window.0, to: window.1 } };
    let (mut done, summary) = py.detach(|| {
        let scene = scene.resolved()?;
        let played = |scene: &MachineScene, _: bool| played(scene, &choice, progress.as_ref());
        let Refined { mut run, rounds } = refine(&scene, played)?;
        if let Some((rounds, _)) = &rounds {
            run.seen.set_means(rounds.means());
        }
        run.seen.set_growing(&warnings(&scene, 0.0));
        let bars = rounds.as_ref().and_then(|(rounds, _)| rounds.bars()).unwrap_or_default();
        let mut bars = bars.into_iter();
        let figures = run.seen.figures(&run.machine).into_iter();
        let shown: Vec<_> = figures.map(|figures| Shown { figures, bars: bars.next() }).collect();
        let mut summary = json::of_machine(&run.machine, &run.seen, &shown);
        summary["error_goal"] = rounds.map(|(_, goal)| goal).into();
        Ok::<_, PyErr>((run, summary.to_string()))
    })?;
    let table = PyByteArray::new(py, &bytes(&std::mem::take(&mut done.table)));
    Ok((done.names, table, summary))
}

fn played(scene: &MachineScene, choice: &Choice, progress: Option<&Py<PyAny>>) -> PyResult<Done> {
    let mut machine = Machine::new(scene).map_err(runtime)?;
    let mut columns = MachineColumns::new(&machine, choice).map_err(value)?;
    let rows = Rows::of_scene(scene);
    let mut watch = Watch::of(&machine);
    let mut table = vec![];
    let mut told = Instant::now();
    let flow = play_observed(&mut machine, rows, &mut watch, |machine, watch| {
        watch.push(machine);
        table.extend(columns.row(machine).into_iter().flatten());
        let is_last = machine.time() >= rows.duration;
        if told.elapsed() < OFTEN && !(is_last && progress.is_some()) {
            return ControlFlow::Continue(());
        }
        told = Instant::now();
        let told = Python::attach(|py| {
            py.check_signals()?;
            if let Some(progress) = progress {
                progress.call1(py, (machine.time(), rows.duration))?;
            }
            Ok(())
        });
        match told {
            Ok(()) => ControlFlow::Continue(()),
            Err(why) => ControlFlow::Break(why),
        }
    });
    match flow {
        Err(why) => return Err(runtime(format!("at {:e} s: {why}", machine.time()))),
        Ok(ControlFlow::Break(why)) => return Err(why),
        Ok(ControlFlow::Continue(())) => {}
    }
    let names = columns.names().map(|(name, unit)| (name, unit.to_string())).collect();
    let seen = watch.finish(&machine);
    Ok(Done { machine, seen, names, table })
}

/// Writes a table of float64 as Parquet.
#[pyfunction]
pub fn write_parquet(
    py: Python<'_>,
    path: PathBuf,
    columns: Vec<(String, String)>,
    table: PyBuffer<f64>,
) -> PyResult<()> {
    let values = numbers(py, &table)?;
    py.detach(|| {
        let names = columns.iter().map(|(name, unit)| Column::number(name, unit)).collect();
        let mut file = ParquetWriter::create(&path, names)?;
        for row in values.chunks_exact(columns.len().max(1)) {
            file.push(row.iter().map(|value| Cell::Number(*value)))?;
        }
        file.finish()
    })
    .map_err(|why| file(format!("cannot write {}: {why}", path.display())))
}
