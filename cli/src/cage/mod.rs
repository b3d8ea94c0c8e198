//! How the cage of a bearing moves when it is pushed (`roulement cage`): is it stable, does it rattle, or does it whirl?
//!
//! A cage that nothing pushes stays where it starts: in a symmetric bearing at the centre, for ever. So the scene is run once for each of a
//! few pushes.

mod figure;
mod orbit;
mod pushes;
mod report;
mod run;

use std::sync::atomic::AtomicBool;

use roulement::effects::cage::{Guidance, Settings};
use roulement::model::Model;
use roulement::scene::Level;
use roulement::scene::machine::MachineScene;

use crate::sweep::all::on_threads;
pub use figure::write as write_figure;
pub use orbit::{Kind, Orbit};
pub use pushes::Push;
pub use report::{to_json, to_text};
use run::run;

/// The cage of a bearing under all pushes.
#[derive(Clone, Debug)]
pub struct Cage {
    /// Name of the bearing; empty of a bearing alone.
    pub bearing: String,
    /// Its guidance.
    pub guided_by: Guidance,
    /// \[m] how far its centre moves from the middle before it is held, by lands or, without them, by the balls.
    pub play: f64,
    /// \[kg] its mass.
    pub mass: f64,
    /// Its motion under each push, or why that run did not come to its end.
    pub pushed: Vec<(Push, Result<Orbit, String>)>,
}

impl Cage {
    /// The motion under the push that does most: one that is not stable before one that is, then that which takes most power, then the
    /// widest. None where no run came to its end.
    pub fn worst(&self) -> Option<(Push, &Orbit)> {
        let done = self.pushed.iter().filter_map(|(push, orbit)| Some((*push, orbit.as_ref().ok()?)));
        let rank = |orbit: &Orbit| (orbit.kind != Kind::Stable, orbit.power, orbit.reach);
        done.reduce(|most, other| if rank(other.1) > rank(most.1) { other } else { most })
    }
}

/// Runs a scene under each push on some threads; `done` is told of each run, of so many.
///
/// # Errors
/// If there is no cage that moves, or if it was interrupted.
pub fn pushed(
    scene: &MachineScene,
    threads: usize,
    interrupted: &AtomicBool,
    done: impl Fn(usize) + Sync,
) -> Result<Vec<Cage>, String> {
    check(scene)?;
    let pushes = Push::of(scene);
    let runs = on_threads(pushes.len(), threads, |index| {
        let orbits = run(scene, pushes[index], interrupted);
        done(pushes.len());
        orbits
    });
    if interrupted.load(std::sync::atomic::Ordering::Relaxed) {
        return Err("interrupted".into());
    }
    let mut cages = vec![];
    for (index, (name, own)) in scene.bearings().into_iter().enumerate() {
        let Some(section) = &own.effects.cage.section else { continue };
        let model = Model::new(own).map_err(|why| why.to_string())?;
        let of_run = |(push, run): (&Push, &Result<Vec<Option<Orbit>>, String>)| {
            let orbit = run.clone().and_then(|mut all| {
                all[index].take().ok_or_else(|| "too few steps to judge a motion by".to_string())
            });
            (*push, orbit)
        };
        cages.push(Cage {
            bearing: name.to_string(),
            guided_by: section.guided_by,
            play: run::play(&model),
            mass: section.mass.0,
            pushed: pushes.iter().zip(&runs).map(of_run).collect(),
        });
    }
    Ok(cages)
}

/// Is there a cage, in motion?
fn check(scene: &MachineScene) -> Result<(), String> {
    let bearings = scene.bearings();
    let any = |is: fn(&Settings) -> bool| bearings.iter().any(|(_, own)| is(&own.effects.cage));
    if !any(Settings::is_body) {
        let what = match any(Settings::is_ideal) {
            true => "the cage of this scene is ideal: without mass and play it has no motion of its own",
            false => "there is no cage in this scene",
        };
        return Err(format!(
            "{what}: write [effects] cage = true, and [cage] with mass, inertia, pocket_clearance and guided_by (`roulement scene --keys cage` \
             explains them, `roulement bearing --cage estimated` has them of a catalogue bearing)"
        ));
    }
    if scene.solver().level == Level::Equilibrium {
        return Err(
            "a cage does not move from equilibrium to equilibrium: solver.level = \"dynamic\" has its motion"
                .into(),
        );
    }
    Ok(())
}
