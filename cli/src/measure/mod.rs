//! Changes by effects in runs (`roulement effects --measure`): the scene without each effect against the scene with it.
//!
//! Every scene is run with its own steps and with half of them. What both differ by, and how uncertain means are in the window, is the
//! error bar.

mod changed;
mod in_runs;
mod pairs;
mod report;
mod run;

use std::sync::atomic::AtomicBool;

use roulement::scene::machine::MachineScene;

use crate::error::finer;
use crate::sweep::all::on_threads;
pub use changed::Changed;
pub use pairs::{Pair, Pairs};
pub use report::{to_json, to_text};
use run::{Taken, run};

/// Changes by an effect.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The effect and its runs.
    pub pair: Pair,
    /// Changes, their error bars, and by what CPU time changes; or why a run did not come to its end.
    pub result: Result<Changed, String>,
}

/// Runs a scene with and without each of its effects on some threads; `done` is told of each run, of so many.
///
/// # Errors
/// If there are no estimates, which say how effects are taken in and out.
pub fn measure(
    scene: &MachineScene,
    threads: usize,
    interrupted: &AtomicBool,
    done: impl Fn(usize) + Sync,
) -> Result<Vec<Measured>, String> {
    measure_some(scene, |_| true, threads, interrupted, done)
}

/// Measures those effects alone whose subjects are wanted.
///
/// # Errors
/// See [`measure`].
pub fn measure_some(
    scene: &MachineScene,
    wanted: impl Fn(&str) -> bool,
    threads: usize,
    interrupted: &AtomicBool,
    done: impl Fn(usize) + Sync,
) -> Result<Vec<Measured>, String> {
    let Pairs { scenes, pairs } = Pairs::of(scene, wanted)?;
    let steps = scenes.iter().flat_map(|scene| [scene.clone(), finer(scene, 1)]).collect::<Vec<_>>();
    let runs: Vec<Result<Vec<Taken>, String>> = on_threads(steps.len(), threads, |index| {
        let taken = run(&steps[index], interrupted);
        done(steps.len());
        taken
    });
    let of = |pair: Pair| {
        let taken = |scene: usize| -> Result<[Taken; 2], String> {
            let of = |run: usize| runs[run].as_ref().map(|all| all[pair.bearing]).map_err(Clone::clone);
            Ok([of(2 * scene)?, of(2 * scene + 1)?])
        };
        let result = taken(pair.without)
            .map_err(|why| format!("without it: {why}"))
            .and_then(|without| Ok((without, taken(pair.with).map_err(|why| format!("with it: {why}"))?)))
            .map(|(without, with)| Taken::change(&without, &with));
        Measured { pair, result }
    };
    let mut measured: Vec<Measured> = pairs.into_iter().map(of).collect();
    let rank = |one: &Measured| {
        let largest = one.result.as_ref().ok().and_then(Changed::largest);
        (one.pair.bearing, -largest.map_or(f64::INFINITY, |(_, change, _)| change.abs()))
    };
    measured.sort_by(|a, b| {
        let (a, b) = (rank(a), rank(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    Ok(measured)
}
