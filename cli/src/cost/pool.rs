//! The runs of a study on all cores. What a run gives does not depend on the others, but for its time.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use roulement::scene::CreepLaw;

use super::levers::{CreepModel, Level, Setting};
use super::{Choice, StudyError};
use crate::progress::ProgressBar;

/// A run to be done.
pub struct Job<'a> {
    /// Text of the progress.
    pub what: String,
    /// Setting.
    pub setting: &'a Setting,
    /// Is nothing to be had without it?
    pub needed: bool,
}

impl Job<'_> {
    /// [-] about how long it takes, for the progress and for the order: long ones first, so that no core waits at the end.
    pub fn weight(&self) -> u64 {
        let scene = &self.setting.scene;
        let step = match self.setting.level {
            // About as long as twenty steps each.
            Level::Equilibrium => self.setting.communication / 20.0,
            // What tolerances ask of balls of a centimetre that have been struck.
            Level::Dynamic => {
                let solver = scene.solver();
                let of_tolerance = 5e-5 * (solver.tolerance / 1e-6).powf(0.4);
                solver.max_step.0.min(of_tolerance).min(self.setting.communication)
            }
        };
        let law = match CreepModel::of(scene).law {
            CreepLaw::Kalker => 6.0,
            CreepLaw::KalkerTable => 2.0,
            _ => 1.0,
        };
        (law * scene.duration() / step).ceil().max(1.0) as u64
    }
}

/// Runs all jobs on some threads; the bar shows which. A job that was not begun was interrupted.
///
/// # Errors
/// Why a needed job failed.
pub fn run_all<T: Send>(
    jobs: &[Job<'_>],
    choice: &Choice,
    progress: &ProgressBar,
    run: impl Fn(&Setting) -> Result<T, StudyError> + Sync,
) -> Result<Vec<Result<T, StudyError>>, StudyError> {
    progress.set_length(jobs.iter().map(Job::weight).sum());
    progress.reset();
    let mut order: Vec<usize> = (0..jobs.len()).collect();
    order.sort_by_key(|&job| (!jobs[job].needed, u64::MAX - jobs[job].weight()));
    let (next, over) = (AtomicUsize::new(0), AtomicBool::new(false));
    let results = Mutex::new(jobs.iter().map(|_| None).collect::<Vec<_>>());
    let work = || {
        while !over.load(Ordering::Relaxed) && !choice.interrupted.load(Ordering::Relaxed) {
            let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) else { break };
            let job = &jobs[index];
            progress.set_message(job.what.clone());
            let result = run(job.setting);
            progress.inc(job.weight());
            if job.needed && result.is_err() {
                over.store(true, Ordering::Relaxed);
            }
            // No thread panics while it holds the lock.
            if let Ok(mut results) = results.lock() {
                results[index] = Some(result);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..choice.threads.clamp(1, jobs.len().max(1)) {
            scope.spawn(work);
        }
        work();
    });
    let mut results = results.into_inner().unwrap_or_default();
    let failed = |(job, result): (&Job<'_>, &Option<Result<T, StudyError>>)| {
        job.needed && matches!(result, Some(Err(_)))
    };
    if let Some(index) = jobs.iter().zip(&results).position(failed)
        && let Some(Err(why)) = results.swap_remove(index)
    {
        return Err(why);
    }
    // As none that is needed has failed, a job was not begun only where all were interrupted.
    Ok(results.into_iter().map(|result| result.unwrap_or(Err(StudyError::Interrupted))).collect())
}
