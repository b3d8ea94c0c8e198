//! Work-precision study of a scene: error against CPU time (`roulement cost`).
//!
//! A *lever* is a setting that trades accuracy for speed, such as the creep law, the tolerance or the largest step. The
//! study runs every lever at several values. Errors have two references that are never mixed: the same model at a tiny
//! step gives the numerical error of levers that leave the model as it is, the richest model gives the model error of
//! those that change it. Each reference has an error bar from a run at another step.

pub mod advice;
mod document;
pub mod figures;
pub mod json;
pub mod levers;
mod meter;
pub mod norms;
mod pool;
pub mod record;
pub mod regret;
pub mod report;
mod settling;
pub mod table;

use std::num::NonZero;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use thiserror::Error;

use crate::progress::ProgressBar;
use levers::{CreepModel, Level, Lever, ReferenceKind, Setting};
use norms::{Comparison, Errors, Norm, errors};
use pool::Job;
use record::{Record, record};
use regret::{Judged, Regret};
use roulement::scene::machine::MachineScene;
use roulement::scene::units::Time;
use roulement::simulation::machine::MachineError;

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
    pub scene: MachineScene,
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
    /// Whether the windows of the references have settled, a sentence for each: drift against noise, and how long the scene
    /// should run.
    pub settled: Vec<String>,
    /// Advice, a sentence for each quantity that is asked for.
    pub advice: Vec<String>,
    /// Regret of steps where nothing is said, and of those of the scene, beside the cheapest tolerance that keeps their promise, or why that
    /// is not known; none if it was not asked for.
    pub regret: Option<Result<Regret, String>>,
}

impl SceneStudy {
    /// Title of the scene, or its name.
    pub fn title(&self) -> &str {
        if self.scene.title().is_empty() { &self.name } else { self.scene.title() }
    }

    /// How much steps where nothing is said cost, and whether they keep their promise; nothing if that was not asked for.
    pub fn promise(&self) -> Vec<String> {
        match &self.regret {
            None => vec![],
            Some(Ok(regret)) => regret.sentences(),
            Some(Err(why)) => vec![format!("What the default steps cost beside others is not known: {why}.")],
        }
    }

    /// A setting judged by the promise, with its cost over the cheapest that keeps it.
    pub fn judged(&self, point: &Point) -> Option<(Judged, Option<f64>)> {
        let regret = self.regret.as_ref()?.as_ref().ok().filter(|_| point.lever == Lever::Default)?;
        let judged = *regret.steps.iter().find(|tried| tried.label == point.label)?.result.as_ref().ok()?;
        Some((judged, regret.of(&judged)))
    }

    /// Error bar of a reference.
    pub fn error_bar(&self, kind: ReferenceKind) -> &Errors {
        &self.error_bars[kind as usize]
    }

    /// Are there settings measured against a reference?
    pub fn has(&self, kind: ReferenceKind) -> bool {
        self.points_of(kind).next().is_some()
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

/// Why there is no study, or no run of a setting.
#[derive(Debug, Error)]
pub enum StudyError {
    /// It cannot start or go on.
    #[error(transparent)]
    Run(#[from] MachineError),
    /// There is nothing that settings trade.
    #[error(
        "this machine has no bearings of balls: what settings cost is compared by these; `roulement run --error` measures the error of a run"
    )]
    NoBalls,
    /// It was ended from outside.
    #[error("interrupted")]
    Interrupted,
}

/// Extent of a study, and how it is run.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Levers; empty is all.
    pub only: Vec<Lever>,
    /// [-] threads.
    pub threads: usize,
    /// Set from outside to end with what there is then.
    pub interrupted: Arc<AtomicBool>,
}

impl Default for Choice {
    /// All levers, on all cores.
    fn default() -> Self {
        let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
        Self { only: vec![], threads, interrupted: Arc::default() }
    }
}

impl Choice {
    fn has(&self, lever: Lever) -> bool {
        self.only.is_empty() || self.only.contains(&lever)
    }
}

/// Studies a scene with all levers on all cores; the bar shows what is running.
///
/// # Errors
/// See [`study_of`].
pub fn study(name: &str, scene: &MachineScene, progress: &ProgressBar) -> Result<SceneStudy, StudyError> {
    study_of(name, scene, &Choice::default(), progress)
}

/// Studies a scene; the bar shows what is running.
///
/// # Errors
/// If a reference cannot be run, or was interrupted: there is nothing to compare with then. Settings that fail or are interrupted are
/// part of the result.
pub fn study_of(
    name: &str,
    scene: &MachineScene,
    choice: &Choice,
    progress: &ProgressBar,
) -> Result<SceneStudy, StudyError> {
    if scene.bearings().is_empty() {
        return Err(StudyError::NoBalls);
    }
    let duration = scene.duration();
    let window_start = WINDOW_START * duration;
    let [fine, coarse] = levers::reference_steps(scene);
    let chosen = |settings: Vec<Setting>| settings.into_iter().filter(|s| choice.has(s.lever));
    let settings: Vec<Setting> =
        chosen(levers::model_settings(scene)).chain(chosen(levers::numerical_settings(scene))).collect();
    let has_model = settings.iter().any(|setting| setting.lever.reference() == ReferenceKind::Model);

    // Whether the two finest runs of the scene's own model stay together decides how runs are compared. The richest model
    // runs at the scene's own step, and at half of it.
    let mut references: Vec<(String, Setting)> = [fine, coarse]
        .map(|step| (format!("reference at {}", levers::seconds(step)), Setting::fixed_step(scene, step)))
        .into();
    if has_model {
        let richest = Setting::creep(scene, CreepModel::RICHEST);
        let mut half = richest.clone();
        half.scene.change_solver(|solver| {
            (solver.max_step, solver.initial_step) =
                (Time(0.5 * solver.max_step.0), Time(0.5 * solver.initial_step.0));
        });
        references.extend([("richest model".into(), richest), ("richest model, half the step".into(), half)]);
    }
    let needed = references.iter().map(|(what, setting)| (what.clone(), setting, true));
    let others = settings.iter().map(|s| (format!("{} {}", s.lever.name(), s.label), s, false));
    let jobs: Vec<Job<'_>> = needed
        .chain(others)
        .map(|(what, setting, needed)| Job { what: format!("{name}: {what}"), setting, needed })
        .collect();
    let run = |setting: &Setting| record(setting, &choice.interrupted);
    let mut results = pool::run_all(&jobs, choice, progress, run)?.into_iter();
    let mut finished = || results.next().unwrap_or(Err(StudyError::Interrupted));

    let (finest, second) = (finished()?, finished()?);
    let divergence = errors(&second, &finest, Comparison::Pointwise, window_start).worst().unwrap_or(0.0);
    let comparison = if divergence < SMOOTH { Comparison::Pointwise } else { Comparison::WindowMeans };
    let compare = |run: &Record, reference: &Record| errors(run, reference, comparison, window_start);
    let tiny = Reference { error_bar: compare(&second, &finest), run: finest };
    let rich = match has_model {
        true => {
            let (run, half) = (finished()?, finished()?);
            Some(Reference { error_bar: compare(&half, &run), run })
        }
        false => None,
    };
    let reference = |kind: ReferenceKind| match (kind, &rich) {
        (ReferenceKind::Model, Some(rich)) => rich,
        _ => &tiny,
    };
    let points: Vec<Point> = settings
        .iter()
        .map(|setting| {
            let measured = finished().map(|run| Measured {
                errors: compare(&run, &reference(setting.lever.reference()).run),
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
    let advice = advice::advise(&points, &settings, scene, |setting, kind| {
        progress.set_message(format!("{name}: to be sure of the advice, {}", setting.label));
        let run = record(setting, &choice.interrupted).ok()?;
        Some((compare(&run, &reference(kind).run), run.cost.cpu / duration))
    });
    // Equilibria have no steps.
    let judged = choice.has(Lever::Default) && scene.solver().level == roulement::scene::Level::Dynamic;
    let regret = judged.then(|| regret::regret(name, scene, choice, progress).map_err(|why| why.to_string()));
    let runs = [("reference", Some(&tiny)), ("richest model", rich.as_ref())];
    let settled = runs
        .into_iter()
        .filter_map(|(what, reference)| Some((what, &reference?.run.means)))
        .map(|(what, means)| settling::sentence(scene, what, means))
        .collect();
    let model_bar = rich.as_ref().map_or(Errors::default(), |rich| rich.error_bar);
    Ok(SceneStudy {
        name: name.to_string(),
        scene: scene.clone(),
        comparison,
        divergence,
        reference_step: fine,
        error_bars: [tiny.error_bar, model_bar],
        points,
        settled,
        advice,
        regret,
    })
}
