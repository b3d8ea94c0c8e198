//! A load of a duty by its run: life, torque and losses are means over the window of the run's means, where statics know of no skidding, no
//! vibration and no temperatures that come of friction.

use std::convert::Infallible;
use std::ops::ControlFlow;

use roulement::model::bodies::Race;
use roulement::scene::machine::MachineScene;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::{Rows, play_observed};

use super::rated::{Rated, of_rollers};
use crate::report::means::Means;
use crate::watch::{BearingSeen, Watch};

/// All bearings of a machine over their run, balls first, with their share of the time; and had their means settled?
///
/// # Errors
/// If the run does not come to its end, or is too short for means; says why.
pub fn found(
    scene: &MachineScene,
    mut machine: Machine,
    share: f64,
) -> Result<(Vec<(String, Rated)>, bool), String> {
    let mut watch = Watch::of(&machine);
    let flow = play_observed(&mut machine, Rows::of_scene(scene), &mut watch, |machine, watch| {
        watch.push(machine);
        ControlFlow::<Infallible>::Continue(())
    });
    // Nothing breaks it off.
    let ControlFlow::Continue(()) = flow.map_err(|why| format!("at {:e} s: {why}", machine.time()))?;
    let seen = watch.finish(&machine);
    let mut settled = true;
    let mut all = vec![];
    for ((name, _), seen) in machine.bearings().zip(&seen.bearings) {
        let means =
            seen.part.means.as_ref().ok_or("its run has too few steps for means: longer load.duration")?;
        settled &= means.settled() == Some(true);
        all.extend(of_balls(seen, means, share).map(|rated| (name.to_owned(), rated)));
    }
    all.extend(of_rollers(scene, &machine, share));
    Ok((all, settled))
}

/// A ball bearing; none without a life.
fn of_balls(seen: &BearingSeen, means: &Means, share: f64) -> Option<Rated> {
    let life = &seen.life?.life;
    let spin = |race: Race| means.of(&format!("{} race speed", race.name()));
    Some(Rated {
        share,
        speed: (spin(Race::Inner) - spin(Race::Outer)).abs(),
        equivalent_load: life.equivalent_load,
        lives: [Some(life.reference), life.modified],
        safety: life.static_safety,
        exponent: 3.0,
        torque: Some(means.of("friction torque").abs()),
        loss: Some(means.of(LOSSES[0].name)),
    })
}
