//! One run of a scene whose cages are pushed.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::{Vector2, Vector3};
use roulement::model::Model;
use roulement::model::cage::CageModel;
use roulement::scene::machine::MachineScene;
use roulement::simulation::Simulation;
use roulement::simulation::cage_push::CagePush;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::{Observer, Rows, play_observed};

use super::Push;
use super::orbit::{Orbit, Place};

/// \[rad] azimuth towards which cages are pushed: neither an axis nor, of balls in usual numbers, a plane of symmetry.
const TOWARDS: f64 = 1.0;

/// \[m] play of the cage; 0 without one.
pub fn play(model: &Model) -> f64 {
    model.cage.as_ref().map_or(0.0, CageModel::play)
}

/// Places of the cage of every bearing in the second half of a run; empty without one.
struct Places {
    from: f64,
    all: Vec<Vec<Place>>,
}

impl Places {
    fn take<'a>(&mut self, bearings: impl Iterator<Item = &'a Simulation>) {
        for (places, bearing) in self.all.iter_mut().zip(bearings) {
            let (Some(cage), true) = (bearing.state().cage(), bearing.time() >= self.from) else { continue };
            let (turned, instant) = (cage.turned, bearing.instant());
            let Some(own) = instant.cage else { continue };
            places.push(Place {
                time: instant.time,
                centre: Vector2::from(own.centre),
                turned,
                pocket_load: own.pocket_load,
                land_load: own.land_load,
                power: own.pocket_power + own.land_power,
                losses: instant.losses.total(),
            });
        }
    }
}

impl Observer for Places {
    fn step(&mut self, machine: &Machine) {
        self.take(machine.bearings().map(|(_, bearing)| bearing));
    }
}

/// Runs a scene under a push; the motion of every bearing's cage, none where there is none.
///
/// # Errors
/// If it does not start, or does not come to its end.
pub fn run(scene: &MachineScene, push: Push, interrupted: &AtomicBool) -> Result<Vec<Option<Orbit>>, String> {
    let scene = push.scene(scene);
    let mut machine = Machine::new(&scene).map_err(|why| why.to_string())?;
    machine.push_cages(|bearing| start(bearing, push));
    let mut places = Places { from: 0.5 * scene.duration(), all: vec![vec![]; machine.bearings().count()] };
    let rows = Rows::of_scene(&scene);
    let ended = play_observed(&mut machine, rows, &mut places, |_, _| {
        if interrupted.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    match ended {
        Err(why) => return Err(why.to_string()),
        Ok(ControlFlow::Break(())) => return Err("interrupted".into()),
        Ok(ControlFlow::Continue(())) => {}
    }
    let models = machine.bearings().map(|(_, bearing)| bearing.model());
    Ok(places.all.into_iter().zip(models).map(|(places, model)| Orbit::of(&places, play(model))).collect())
}

/// Push of a cage at the start.
fn start(bearing: &Simulation, push: Push) -> CagePush {
    let model = bearing.model();
    let Some(cage) = &model.cage else { return CagePush::default() };
    let play = play(model);
    // It has to be free there: pockets may hold it before its guide does.
    let free = play.min(cage.pocket.half_clearance);
    let towards = Vector3::new(0.0, TOWARDS.cos(), TOWARDS.sin());
    match push {
        Push::AsItIs | Push::Weight | Push::Unbalance => CagePush::default(),
        Push::Offset => CagePush { offset: towards * (0.5 * free), velocity: Vector3::zeros() },
        Push::Kick => {
            let velocity = towards * (play * bearing.state().cage_speed().abs());
            CagePush { offset: Vector3::zeros(), velocity }
        }
    }
}
