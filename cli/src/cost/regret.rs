//! Cost of steps beside the cheapest tolerance that keeps the promise of steps where nothing is said: means within 1 %, histories but
//! that of the torque within 2 %.
//!
//! Costs are contact evaluations, which repeat to the last one. The tolerances are tried alone, with all motion followed; all are
//! judged by a run with a quarter of the steps of twice the usual tolerance.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use roulement::model::state::Statistics;
use roulement::scene::Solver;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::{Rows, play_observed};

use super::levers::{Lever, Setting, usual_settings};
use super::pool::{self, Job};
use super::{Choice, StudyError};
use crate::error::{Difference, Run};
use crate::progress::ProgressBar;
use crate::watch::Watch;

/// [-] promised errors of means, and of histories but that of the friction torque.
pub const PROMISED: [f64; 2] = [0.01, 0.02];
/// The promise in words.
pub const PROMISE: &str = "1 % of means and 2 % of histories";
/// [-] tolerances that are tried, over that of the default.
const TOLERANCES: [f64; 6] = [2e4, 2e3, 2e2, 2e1, 2.0, 0.2];
/// [-] price of an evaluation with exact derivatives, in evaluations.
const TANGENT: u64 = 3;

/// A run judged by the promise.
#[derive(Clone, Copy, Debug)]
pub struct Judged {
    /// [-] largest error over what is promised: kept up to 1.
    pub over: f64,
    /// [-] error of the history of the torque, of which nothing is promised.
    pub torque: f64,
    /// [-] contact evaluations, one with derivatives counts as three; of a machine without states those of its equations.
    pub evaluations: u64,
}

impl Judged {
    fn of(run: &Run, evaluations: u64, reference: &Run) -> Self {
        let difference = Difference::of(run, reference);
        let (mut over, mut torque) = (0.0f64, 0.0f64);
        for (i, (part, own)) in run.quantities().enumerate() {
            over = over.max(difference.means[i] / PROMISED[0]);
            match part.quantities[own].name.contains("torque") {
                true => torque = torque.max(difference.histories[i]),
                false => over = over.max(difference.histories[i] / PROMISED[1]),
            }
        }
        Self { over, torque, evaluations }
    }

    /// Is the promise kept?
    pub fn keeps(&self) -> bool {
        self.over <= 1.0
    }
}

/// Steps that were tried.
#[derive(Clone, Debug)]
pub struct Tried {
    /// Their name.
    pub label: String,
    /// [-] their tolerance.
    pub tolerance: f64,
    /// Outcome of them, or why there is none.
    pub result: Result<Judged, String>,
}

/// Cost of the steps of a scene beside the cheapest tolerance that keeps the promise.
#[derive(Clone, Debug)]
pub struct Regret {
    /// Steps where nothing is said, then those of the scene if it says some: labels of the lever `default`.
    pub steps: Vec<Tried>,
    /// Tolerances alone, the largest first.
    pub tolerances: Vec<Tried>,
}

impl Regret {
    /// The cheapest tolerance that keeps the promise.
    pub fn cheapest(&self) -> Option<(&Tried, Judged)> {
        let judged = self.tolerances.iter().filter_map(|tried| Some((tried, *tried.result.as_ref().ok()?)));
        judged.filter(|(_, judged)| judged.keeps()).min_by_key(|(_, judged)| judged.evaluations)
    }

    /// [-] cost of steps over that of the cheapest tolerance that keeps the promise; none if no tolerance does.
    pub fn of(&self, judged: &Judged) -> Option<f64> {
        self.cheapest().map(|(_, cheapest)| judged.evaluations as f64 / cheapest.evaluations as f64)
    }

    /// A sentence for each of the steps.
    pub fn sentences(&self) -> Vec<String> {
        let of = |Tried { label, result, .. }: &Tried| {
            let judged = match result {
                Ok(judged) => judged,
                Err(why) => return format!("{label}: failed: {why}."),
            };
            let cheapest = self.cheapest().map(|(tried, _)| tried.tolerance).zip(self.of(judged));
            let broken =
                format!("{label} do NOT keep {PROMISE} here: errors are up to {:.2} times that", judged.over);
            match (judged.keeps(), cheapest) {
                (true, Some((tolerance, regret))) => format!(
                    "{label}: {regret:.2} times the cost of the cheapest tolerance that keeps {PROMISE} ({tolerance:.1e})."
                ),
                (true, None) => {
                    format!("{label} keep {PROMISE}, and no tolerance alone that was tried does.")
                }
                (false, Some((tolerance, regret))) => format!(
                    "{broken}; the cheapest tolerance that does ({tolerance:.1e}) costs {:.2} times as much.",
                    1.0 / regret
                ),
                (false, None) => format!("{broken}, and no tolerance alone that was tried does."),
            }
        };
        self.steps.iter().map(of).collect()
    }
}

/// Plays a scene: what comes of it, and its evaluations ([`Judged::evaluations`]).
///
/// # Errors
/// If the run cannot start or go on, or was interrupted.
pub fn played(scene: &MachineScene, interrupted: &AtomicBool) -> Result<(Run, u64), StudyError> {
    let mut machine = Machine::new(scene)?;
    let mut watch = Watch::of(&machine);
    let flow = play_observed(&mut machine, Rows::of_scene(scene), &mut watch, |machine, watch| {
        watch.push(machine);
        if interrupted.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    if flow.is_break() {
        return Err(StudyError::Interrupted);
    }
    let Statistics { contact_values, contact_tangents, newton, steps, .. } = machine.statistics();
    let work = match contact_values + TANGENT * contact_tangents {
        // Bearings without states count none: every correction and every step evaluates the whole machine.
        0 => newton.iterations + steps,
        work => work,
    };
    Ok((watch.finish(&machine).take_comparable(&machine, 0.0), work))
}

/// A scene with this many times the tolerance, all motion followed.
fn with_tolerance(scene: &MachineScene, factor: f64) -> MachineScene {
    scene.with_solver(|solver| {
        solver.tolerance *= factor;
        solver.unresolved = 0.0;
    })
}

/// Cost of steps where nothing is said, and of those of the scene, beside the cheapest tolerance that keeps the promise.
///
/// # Errors
/// If there is no reference, or it was interrupted.
pub fn regret(
    name: &str,
    scene: &MachineScene,
    choice: &Choice,
    progress: &ProgressBar,
) -> Result<Regret, StudyError> {
    let steps = usual_settings(scene);
    let usual = &steps[0].scene;
    let reference = with_tolerance(usual, 2.0)
        .with_solver(|solver| *solver = Solver { energy_error: 0.0, ..solver.refined(2) });
    let tolerances = TOLERANCES.map(|factor| {
        let scene = with_tolerance(usual, factor);
        Setting::plain(Lever::Tolerance, format!("tolerance {:.1e}", scene.solver().tolerance), scene)
    });
    let reference = Setting::plain(Lever::Tolerance, "a quarter of the steps", reference);
    let all = std::iter::once(&reference).chain(&steps).chain(&tolerances);
    let jobs: Vec<_> = all
        .map(|setting| Job {
            what: format!("{name}: keeping the promise, {}", setting.label),
            setting,
            needed: std::ptr::eq(setting, &reference),
        })
        .collect();
    let run = |setting: &Setting| played(&setting.scene, &choice.interrupted);
    let mut runs = pool::run_all(&jobs, choice, progress, run)?.into_iter();
    let (reference, _) = runs.next().unwrap_or(Err(StudyError::Interrupted))?;
    let judged = |(job, run): (&Job<'_>, Result<(Run, u64), StudyError>)| Tried {
        label: job.setting.label.clone(),
        tolerance: job.setting.scene.solver().tolerance,
        result: run
            .map(|(run, evaluations)| Judged::of(&run, evaluations, &reference))
            .map_err(|why| why.to_string()),
    };
    let mut tried: Vec<_> = jobs[1..].iter().zip(runs).map(judged).collect();
    let tolerances = tried.split_off(steps.len());
    Ok(Regret { steps: tried, tolerances })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tried(label: &str, tolerance: f64, over: f64, evaluations: u64) -> Tried {
        let judged = Judged { over, torque: 0.1, evaluations };
        Tried { label: label.into(), tolerance, result: Ok(judged) }
    }

    #[test]
    fn every_case_has_its_words_and_the_cheapest_is_the_cheapest_that_keeps_the_promise() {
        let said = |steps: Tried, tolerances: Vec<Tried>| {
            let regret = Regret { steps: vec![steps], tolerances };
            regret.sentences().join("")
        };
        let ladder = |over: [f64; 3]| -> Vec<Tried> {
            let costs = [100, 400, 300];
            (0..3).map(|i| tried("", [1e-5, 1e-6, 1e-7][i], over[i], costs[i])).collect()
        };
        let [keeps, breaks] = [1.0, 1.01].map(|over| tried("default steps", 5e-9, over, 600));
        assert_eq!(
            said(keeps.clone(), ladder([1.1, 0.9, 0.8])),
            "default steps: 2.00 times the cost of the cheapest tolerance that keeps 1 % of means and 2 % of histories (1.0e-7)."
        );
        assert_eq!(
            said(keeps, ladder([1.1, 1.2, 1.3])),
            "default steps keep 1 % of means and 2 % of histories, and no tolerance alone that was tried does."
        );
        let broken = "default steps do NOT keep 1 % of means and 2 % of histories here: errors are up to 1.01 times that";
        assert_eq!(
            said(breaks.clone(), ladder([1.1, 0.9, 1.3])),
            format!("{broken}; the cheapest tolerance that does (1.0e-6) costs 0.67 times as much.")
        );
        assert_eq!(
            said(breaks, ladder([1.1, f64::NAN, 1.3])),
            format!("{broken}, and no tolerance alone that was tried does.")
        );
        let failed = Tried { result: Err("it diverged".into()), ..tried("default steps", 5e-9, 0.0, 0) };
        assert_eq!(said(failed, ladder([0.1; 3])), "default steps: failed: it diverged.");
    }
}
