//! One run, and what is taken from it.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::Vector3;
use roulement::effects::estimate::Changes;
use roulement::effects::rating::Sums;
use roulement::model::bodies::Race;
use roulement::scene::machine::MachineScene;
use roulement::simulation::Simulation;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::{Observer, Rows, play_observed};

use super::changed::Changed;
use crate::clock::ThreadTime;
use crate::report::means::Mean;
use crate::watch::{BearingSeen, Watch};

/// Quantities taken of a bearing in a run.
#[derive(Clone, Copy, Debug)]
pub struct Taken {
    /// \[W] mean of all losses over the second half, which are the torque times the speed, and half of its interval at 95 %.
    power: [f64; 2],
    /// \[N] largest load of a ball on the inner race at a step's end.
    largest_load: f64,
    /// [-] reference life by the whole run.
    life: f64,
    /// \[m] mean place of the loaded race over the second half, and half of its interval at 95 %.
    place: [Vector3<f64>; 2],
    /// \[s] CPU time of the run.
    cpu: f64,
}

/// Largest loads \[N] of every bearing.
struct Largest(Vec<f64>);

impl Largest {
    fn take<'a>(&mut self, bearings: impl Iterator<Item = &'a Simulation>) {
        for (most, bearing) in self.0.iter_mut().zip(bearings) {
            *most = bearing.state().rating.as_ref().map_or(0.0, Sums::load_now).max(*most);
        }
    }
}

impl Observer for Largest {
    fn step(&mut self, machine: &Machine) {
        self.take(machine.bearings().map(|(_, bearing)| bearing));
    }
}

/// Runs a scene to its end and takes what is asked for of every bearing.
///
/// # Errors
/// If it does not start, or does not come to its end.
pub fn run(scene: &MachineScene, interrupted: &AtomicBool) -> Result<Vec<Taken>, String> {
    let began = ThreadTime::now();
    let mut machine = Machine::new(scene).map_err(|why| why.to_string())?;
    let mut observers = (Watch::of(&machine), Largest(vec![0.0; machine.bearings().count()]));
    let ended = play_observed(&mut machine, Rows::of_scene(scene), &mut observers, |machine, (watch, _)| {
        watch.push(machine);
        if interrupted.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    match ended {
        Err(why) => return Err(why.to_string()),
        Ok(ControlFlow::Break(())) => return Err("interrupted".into()),
        Ok(ControlFlow::Continue(())) => {}
    }
    let cpu = began.elapsed().as_secs_f64();
    let (watch, Largest(largest)) = observers;
    let seen = watch.finish(&machine);
    let bearings = machine.bearings().zip(&seen.bearings).zip(largest);
    Ok(bearings.map(|(((_, bearing), seen), largest)| Taken::of(bearing, seen, largest, cpu)).collect())
}

impl Taken {
    fn of(bearing: &Simulation, seen: &BearingSeen, largest_load: f64, cpu: f64) -> Self {
        let mean = |name: &str| {
            let mean: Option<&Mean> = seen.part.means.as_ref().and_then(|means| means.find(name));
            mean.map_or([f64::NAN; 2], |mean| [mean.mean, mean.interval.unwrap_or(0.0)])
        };
        let race = if Race::loaded(bearing.scene()) == Race::Inner { "inner" } else { "outer" };
        let axes = ["x", "y", "z"].map(|axis| mean(&format!("position.{axis} of the {race} race")));
        let life = bearing.outputs().life.map_or(f64::NAN, |life| life.reference);
        Self {
            power: mean(LOSSES[0].name),
            largest_load,
            life,
            place: [0, 1].map(|which| Vector3::from(axes.map(|axis| axis[which]))),
            cpu,
        }
    }

    /// Changes from runs at the scene's steps and at half of them to others: values are those of the finer ones.
    pub fn change(without: &[Self; 2], with: &[Self; 2]) -> Changed {
        // Both values with their error bars.
        let relative = |get: &dyn Fn(&Self) -> [f64; 2]| {
            let [(before, uncertain), (after, uncertain_after)] = [without, with].map(|[coarse, fine]| {
                let ([rough, _], [value, interval]) = (get(coarse), get(fine));
                (value, interval.hypot(2.0 * (value - rough)))
            });
            let change = (after - before) / before;
            let bar = uncertain_after.hypot(uncertain * after / before) / before.abs();
            change.is_finite().then_some((change, bar))
        };
        let torque = relative(&|taken| taken.power);
        let largest_load = relative(&|taken| [taken.largest_load, 0.0]);
        let life = relative(&|taken| [taken.life, 0.0]);
        let [[rough, before], [rough_after, after]] =
            [without, with].map(|runs| runs.each_ref().map(|run| run.place));
        let size = before[0].norm();
        let bar = [
            before[1].norm(),
            after[1].norm(),
            2.0 * (before[0] - rough[0]).norm(),
            2.0 * (after[0] - rough_after[0]).norm(),
        ];
        let bar = bar.into_iter().fold(0.0, f64::hypot);
        let moved = (after[0] - before[0]).norm() / size;
        let displacement = moved.is_finite().then_some((moved, bar / size));
        let changes = |of: fn((f64, f64)) -> f64| Changes {
            torque: torque.map(of),
            largest_load: largest_load.map(of),
            life: life.map(of),
            displacement: displacement.map(of),
        };
        Changed {
            changes: changes(|(change, _)| change),
            bars: changes(|(_, bar)| bar),
            cpu: with[0].cpu / without[0].cpu - 1.0,
        }
    }
}
