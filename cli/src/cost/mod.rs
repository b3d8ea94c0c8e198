//! Work-precision study of a scene: error against CPU time (`roulement cost`).
//!
//! A *lever* is a setting that trades accuracy for speed, such as the creep law, the tolerance or the largest step. The
//! study runs every lever at several values. Errors have two references that are never mixed: the same model at a tiny
//! step gives the numerical error of levers that leave the model as it is, the richest model gives the model error of
//! those that change it. Each reference has an error bar from a run at another step.

mod document;
pub mod figures;
pub mod levers;
mod meter;
pub mod norms;
pub mod record;
pub mod report;
pub mod table;

use indicatif::ProgressBar;

use levers::{CreepModel, Level, Lever, ReferenceKind, Setting};
use norms::{Comparison, Errors, Norm, errors};
use record::{Record, record};
use roulement::scene::Scene;
use roulement::scene::units::Time;
use roulement::simulation::SimulationError;

/// The scenes of the standard study: name and text.
pub const SCENES: [(&str, &str); 6] = [
    ("thrust", include_str!("../../../scenes/cost/thrust.toml")),
    ("load_zone", include_str!("../../../scenes/cost/load_zone.toml")),
    ("reversal", include_str!("../../../scenes/cost/reversal.toml")),
    ("speed_ramp", include_str!("../../../scenes/cost/speed_ramp.toml")),
    ("shock", include_str!("../../../scenes/cost/shock.toml")),
    ("misalignment", include_str!("../../../scenes/cost/misalignment.toml")),
];

/// [-] fraction of the duration from which on errors are measured.
const WINDOW_START: f64 = 0.25;
/// [-] a scene is smooth if its two finest runs differ by less than this in every quantity at equal times.
const SMOOTH: f64 = 1e-4;

/// A reference run and how far it can be trusted.
struct Reference {
    run: Record,
    /// [-] difference to the run at the other step: twice the step for the numerical reference, half for the model.
    error_bar: Errors,
}

/// A setting that was run.
#[derive(Clone, Debug)]
pub struct Point {
    /// Lever.
    pub lever: Lever,
    /// Value of the lever.
    pub label: String,
    /// Creep model.
    pub creep: CreepModel,
    /// Quasi-static or dynamic.
    pub level: Level,
    /// Cost and error, or why the run ended early.
    pub result: Result<Measured, String>,
}

/// Cost and error of a run.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Errors against the reference of the lever.
    pub errors: Errors,
    /// [-] CPU seconds per simulated second.
    pub cpu: f64,
    /// [1/s] instructions per simulated second, where the machine counts them.
    pub instructions: Option<f64>,
    /// Work of the integrator.
    pub work: roulement::model::state::Statistics,
}

/// The study of one scene.
#[derive(Clone, Debug)]
pub struct SceneStudy {
    /// Short name, for files.
    pub name: String,
    /// Scene.
    pub scene: Scene,
    /// How runs were compared: by their trajectories if the scene is smooth.
    pub comparison: Comparison,
    /// [-] difference of trajectories of the two finest runs, which decides that.
    pub divergence: f64,
    /// \[s] tiny step of the numerical reference.
    pub reference_step: f64,
    /// Error bars of the numerical and of the model reference.
    pub error_bars: [Errors; 2],
    /// All settings.
    pub points: Vec<Point>,
}

impl SceneStudy {
    /// Title of the scene, or its name.
    pub fn title(&self) -> &str {
        if self.scene.title.is_empty() { &self.name } else { &self.scene.title }
    }

    /// Error bar of a reference.
    pub fn error_bar(&self, kind: ReferenceKind) -> &Errors {
        &self.error_bars[kind as usize]
    }

    /// Settings measured against a reference, those that failed too.
    pub fn points_of(&self, kind: ReferenceKind) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(move |point| point.lever.reference() == kind)
    }

    /// Settings that no other beats in both CPU time and error of a norm (the worst if none is named), by CPU time.
    pub fn pareto(&self, kind: ReferenceKind, norm: Option<Norm>) -> Vec<(&Point, f64, f64)> {
        let error = |measured: &Measured| match norm {
            Some(norm) => measured.errors.get(norm),
            None => measured.errors.worst(),
        };
        let mut all: Vec<_> = self
            .points_of(kind)
            .filter_map(|point| {
                let measured = point.result.as_ref().ok()?;
                Some((point, measured.cpu, error(measured)?))
            })
            .collect();
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut least = f64::INFINITY;
        all.retain(|&(_, _, error)| {
            let better = error < least;
            least = least.min(error);
            better
        });
        all
    }
}

/// Studies a scene; the bar shows what is running.
///
/// # Errors
/// If a reference cannot be run: there is nothing to compare with then. Settings that fail are part of the result.
pub fn study(name: &str, scene: &Scene, progress: &ProgressBar) -> Result<SceneStudy, SimulationError> {
    let window_start = WINDOW_START * scene.load.duration.0;
    let [fine, coarse] = levers::reference_steps(scene);
    let numerical = levers::numerical_settings(scene);
    let model = levers::model_settings(scene);
    progress.set_length(4 + (numerical.len() + model.len()) as u64);
    progress.reset();
    let timed = |what: String, setting: &Setting| {
        progress.set_message(format!("{name}: {what}"));
        let result = record(setting);
        progress.inc(1);
        result
    };

    // numerical reference; whether its two finest runs stay together decides how runs are compared
    let reference_run = |step: f64| {
        timed(format!("reference at {}", levers::seconds(step)), &Setting::fixed_step(scene, step))
    };
    let (finest, second) = (reference_run(fine)?, reference_run(coarse)?);
    let divergence = errors(&second, &finest, Comparison::Pointwise, window_start).worst().unwrap_or(0.0);
    let comparison = if divergence < SMOOTH { Comparison::Pointwise } else { Comparison::WindowMeans };
    let compare = |run: &Record, reference: &Record| errors(run, reference, comparison, window_start);
    let tiny = Reference { error_bar: compare(&second, &finest), run: finest };

    // the richest model at the scene's own step, and at half of it
    let richest = Setting::creep(scene, CreepModel::RICHEST);
    let run = timed("richest model".into(), &richest)?;
    let mut finer = richest.scene.clone();
    let solver = &mut finer.solver;
    (solver.max_step, solver.initial_step) =
        (Time(0.5 * solver.max_step.0), Time(0.5 * solver.initial_step.0));
    let half = timed("richest model, half the step".into(), &Setting { scene: finer, ..richest })?;
    let rich = Reference { error_bar: compare(&half, &run), run };

    let duration = scene.load.duration.0;
    let points = model
        .iter()
        .chain(&numerical)
        .map(|setting| {
            let reference = match setting.lever.reference() {
                ReferenceKind::Numerical => &tiny,
                ReferenceKind::Model => &rich,
            };
            let result = timed(format!("{} {}", setting.lever.name(), setting.label), setting);
            let measured = result.map(|run| Measured {
                errors: compare(&run, &reference.run),
                cpu: run.cost.cpu / duration,
                instructions: run.cost.instructions.map(|count| count / duration),
                work: run.work,
            });
            Point {
                lever: setting.lever,
                label: setting.label.clone(),
                creep: CreepModel::of(&setting.scene),
                level: setting.level,
                result: measured.map_err(|why| why.to_string()),
            }
        })
        .collect();
    Ok(SceneStudy {
        name: name.to_string(),
        scene: scene.clone(),
        comparison,
        divergence,
        reference_step: fine,
        error_bars: [tiny.error_bar, rich.error_bar],
        points,
    })
}
