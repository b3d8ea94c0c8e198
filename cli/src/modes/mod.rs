//! Small motions of a machine about its running state, over the speed: which grow, which decay.

mod figure;
mod lines;
mod table;

use roulement::effects::cage::CageKind;
use roulement::scene::machine::MachineScene;
use roulement::scene::system::MountedScene;
use roulement::scene::{Level, Scene, Schedule};
use roulement::simulation::machine::{Machine, MachineError};
use roulement::simulation::motions::Motion;
use roulement::simulation::system::{at_speed, largest_speed};

use crate::sweep::all::{on_threads, threads};

pub use figure::{write as write_figure, write_growths};
pub use lines::{Line, Meeting, meetings};
pub use table::{to_csv, to_json, to_text};

/// [-] largest speed of the scene, that of the table.
const BEYOND: f64 = 1.5;

/// Moments that motions are looked at, over as long again as the machine ran before the first of them: while a state is not quite steady,
/// growth changes from one to the next.
const MOMENTS: usize = 5;
/// [-] of that time, an earlier look: what grows by more than `e` until then may have moved the state away that was asked about.
const EARLIER: f64 = 0.1;
/// Balls of a machine from which on it is looked at once where nothing grows then, as a look takes a second.
const MANY_BALLS: usize = 60;
/// [-] frequencies of one motion at two moments differ by less.
const SAME: f64 = 0.05;

/// A machine whose balls go along with rings that move by micrometres, as they do in pockets with play: without ideal cages, which hold them
/// and damp such motions many times too much (docs/model.md, section 19). None where there is no such cage about balls that have states.
fn in_pockets_with_play(scene: &MachineScene) -> Option<MachineScene> {
    let free = |own: &mut Scene| {
        if own.effects.cage.is_ideal() {
            own.effects.cage.kind = CageKind::None;
        }
    };
    has_ideal_cage(scene).then(|| scene.with(free))
}

fn has_ideal_cage(scene: &MachineScene) -> bool {
    match scene {
        MachineScene::Bearing(own) => own.effects.cage.is_ideal(),
        MachineScene::Shaft(scene) => {
            let matters = |mounted: &MountedScene| {
                mounted.level() != Level::Equilibrium && mounted.scene.effects.cage.is_ideal()
            };
            scene.bearings.iter().any(matters)
        }
    }
}

/// A motion, its growth the mean of some moments.
#[derive(Clone, Debug)]
pub struct Found {
    /// The motion.
    pub motion: Motion,
    /// [1/s] half the range of its growth over these moments; none where it was not there at one of them.
    pub spread: Option<f64>,
    /// Is it one of balls that ideal cages of the scene hold, as they do in a run? Others are of balls that are free.
    pub held: bool,
}

impl Found {
    /// Does it grow at all of these moments?
    pub fn grows(&self) -> bool {
        let least = |spread| Motion { growth: self.motion.growth - spread, ..self.motion.clone() };
        self.spread.is_some_and(|spread| least(spread).grows())
    }
}

/// For how long a machine ran \[s], and its motions, or why there are none.
type Looked = (f64, Result<Vec<Found>, String>);

/// Motions at a speed.
pub struct Row {
    /// [rad/s] speed of the shaft, or of the race that turns fastest.
    pub speed: f64,
    /// \[s] how long the machine ran before its motions were looked at first, and again until they were last.
    pub after: f64,
    /// By growing frequency; or why there are none.
    pub motions: Result<Vec<Found>, String>,
}

/// Motions over the speed.
pub struct Modes {
    /// Title of the scene.
    pub title: String,
    /// Are balls free that ideal cages of the scene keep apart?
    pub freed: bool,
    /// What grows at the speed of the scene where these cages hold them.
    pub held: Vec<Found>,
    /// At the speed of the scene.
    pub own: Row,
    /// At other speeds, by growing speed; none where nothing turns.
    pub rows: Vec<Row>,
    /// What goes with the speed: turns, teeth, cage and damage.
    pub lines: Vec<Line>,
}

/// Request.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// \[s] time of the scene's script.
    pub time: f64,
    /// \[s] how long it runs before motions are looked at.
    pub after: f64,
    /// [rad/s] speed that the table goes up to; 1.5 times that of the scene if not given.
    pub up_to: Option<f64>,
    /// Speeds of the table.
    pub speeds: usize,
}

impl Modes {
    /// Those of a scene.
    ///
    /// # Errors
    /// If the machine cannot start or run at its own speed.
    pub fn of(scene: &MachineScene, asked: &Asked) -> Result<Self, MachineError> {
        let free = in_pockets_with_play(scene);
        let freed = free.is_some();
        let held = if freed { growing_in_ideal_cages(scene, asked) } else { vec![] };
        let scene = free.as_ref().unwrap_or(scene);
        let own = speed_of(scene, asked.time);
        let (after, motions) = at(scene, asked)?;
        let lines = lines::of(&Machine::starting_at(scene, asked.time)?);
        let up_to = asked.up_to.unwrap_or(match scene {
            MachineScene::Bearing(_) => BEYOND * own,
            MachineScene::Shaft(scene) => largest_speed(scene),
        });
        let row = |speed: f64| {
            let found = at(&turning(scene, asked.time, speed), asked);
            let (after, motions) = found.unwrap_or_else(|why| (0.0, Err(why.to_string())));
            Row { speed, after, motions }
        };
        let speeds = if own > 0.0 { asked.speeds } else { 0 };
        let rows = (1..=speeds).map(|k| row(up_to * k as f64 / speeds as f64)).collect();
        let title = match scene {
            MachineScene::Bearing(scene) => scene.title.clone(),
            MachineScene::Shaft(scene) => scene.title.clone(),
        };
        Ok(Self { title, freed, held, own: Row { speed: own, after, motions }, rows, lines })
    }
}

/// \[s] how long a machine runs before it is judged, at most, and which part of its run.
const JUDGED_AFTER: (f64, f64) = (2e-3, 0.2);

/// Motions where the script of a scene is at a time \[s], the one that grows fastest first: of balls that are free in their pockets, and those
/// that grow where ideal cages of the scene hold the balls. None of a machine that cannot run, whose motions cannot be found, or whose level has none.
pub fn judged(scene: &MachineScene, time: f64) -> Option<Vec<Found>> {
    let duration = match scene {
        MachineScene::Bearing(scene) => scene.load.duration.0,
        MachineScene::Shaft(scene) => scene.load.duration.0,
    };
    if scene.solver().level == Level::Equilibrium {
        return None;
    }
    let after = JUDGED_AFTER.0.min(JUDGED_AFTER.1 * duration);
    let asked = Asked { time, after, up_to: None, speeds: 0 };
    let of = |scene: &MachineScene| at(scene, &asked).ok()?.1.ok();
    let mut motions = match in_pockets_with_play(scene) {
        None => of(scene)?,
        // Each runs a machine of its own.
        Some(free) => {
            let look =
                |index| if index == 0 { of(&free) } else { Some(growing_in_ideal_cages(scene, &asked)) };
            on_threads(2, threads(), look).into_iter().collect::<Option<Vec<_>>>()?.concat()
        }
    };
    motions.sort_by(|a, b| b.motion.growth.total_cmp(&a.motion.growth));
    Some(motions)
}

/// Motions that grow where ideal cages of a scene hold the balls. None of a machine that cannot run.
fn growing_in_ideal_cages(scene: &MachineScene, asked: &Asked) -> Vec<Found> {
    let held = at(scene, asked).ok().and_then(|(_, motions)| motions.ok()).unwrap_or_default();
    held.into_iter().filter(Found::grows).map(|found| Found { held: true, ..found }).collect()
}

/// Growth where the script of a scene is at a time \[s], in sentences: what whoever runs this machine should know. Nothing is said of a
/// machine that cannot run.
pub fn warnings(scene: &MachineScene, time: f64) -> Vec<String> {
    told(&judged(scene, time).unwrap_or_default(), scene)
}

/// Growth among the motions of a scene, the one that grows fastest first, in sentences: of balls that are free, and of those that ideal cages
/// hold.
pub fn told(motions: &[Found], scene: &MachineScene) -> Vec<String> {
    let [free, held] = [false, true]
        .map(|held| motions.iter().filter(|found| found.held == held && found.grows()).collect::<Vec<_>>());
    let sentence = |growing: &[&Found], more: &str| {
        let rest = growing.len().saturating_sub(1);
        let others = if rest > 0 { format!(" (and {rest} more)") } else { String::new() };
        let of = |Found { motion: Motion { frequency, growth, shape, .. }, .. }: &&Found| {
            format!("a motion grows: {shape}, {frequency:.2} Hz, by {growth:.1} 1/s{others}{more}")
        };
        growing.first().map(of)
    };
    let freed = match (has_ideal_cage(scene), held.is_empty()) {
        (false, _) => "",
        (true, true) => ", with balls that are free in their pockets (the scene's ideal cage damps it)",
        (true, false) => ", with balls that are free in their pockets",
    };
    let stops = "; `roulement modes` tells more, docs/holding-a-bearing.md what stops it";
    let alone = match free.is_empty() {
        true => ", and none does with balls that are free in their pockets: effects.cage = \"none\" has them",
        false => "",
    };
    let by_cage = ", as the scene's ideal cage holds the balls where they would go along with a ring";
    [sentence(&free, &format!("{freed}{stops}")), sentence(&held, &format!("{by_cage}{alone}"))]
        .into_iter()
        .flatten()
        .collect()
}

/// Motions of a scene that has run for a while, and for how long \[s] before they were looked at first.
fn at(scene: &MachineScene, asked: &Asked) -> Result<Looked, MachineError> {
    let mut machine = Machine::starting_at(scene, asked.time)?;
    // Nothing is free to move: nothing has to run.
    if matches!(&machine, Machine::Bearing(bearing) if bearing.is_held()) {
        return Ok((0.0, Ok(vec![])));
    }
    let early = look(&mut machine, asked.time, EARLIER * asked.after)?;
    if asked.after == 0.0 {
        return Ok((0.0, early));
    }
    let fast = |found: &Found| found.grows() && found.motion.growth * asked.after > 1.0;
    let grows_fast = early.as_ref().is_ok_and(|early| early.iter().any(fast));
    let late = look(&mut machine, asked.time, asked.after);
    let still_grows = matches!(&late, Ok(Ok(late)) if late.iter().any(Found::grows));
    if grows_fast && !still_grows {
        return Ok((EARLIER * asked.after, early));
    }
    Ok((asked.after, late?))
}

/// Motions of a machine at moments from `after` \[s] behind a time \[s] on, or why there are none.
fn look(machine: &mut Machine, time: f64, after: f64) -> Result<Result<Vec<Found>, String>, MachineError> {
    let balls: usize = machine.bearings().map(|(_, bearing)| bearing.state().balls.len()).sum();
    let mut moments = vec![];
    for moment in 0..if after > 0.0 { MOMENTS } else { 1 } {
        if balls >= MANY_BALLS
            && moments.first().is_some_and(|first: &Vec<Motion>| !first.iter().any(Motion::grows))
        {
            break;
        }
        let end = time + after * (1.0 + moment as f64 / (MOMENTS - 1) as f64);
        match machine {
            Machine::Bearing(bearing) if end > bearing.time() => bearing.advance_scripted(end)?,
            Machine::Shaft(system) if end > system.time() => system.advance(end)?,
            _ => {}
        }
        match machine.motions() {
            Some(motions) => moments.push(motions),
            None => return Ok(Err("no eigenvalues were found".into())),
        }
    }
    Ok(Ok(joined(&moments)))
}

/// The motions of the moment in the middle, with their mean growth.
fn joined(moments: &[Vec<Motion>]) -> Vec<Found> {
    let join = |motion: &Motion| {
        let same = |motions: &Vec<Motion>| {
            let away = |other: &Motion| (other.frequency - motion.frequency).abs();
            let nearest = motions.iter().min_by(|a, b| away(a).total_cmp(&away(b)))?;
            (away(nearest) < SAME * motion.frequency).then_some(nearest.growth)
        };
        let growths: Vec<f64> = moments.iter().filter_map(same).collect();
        let (least, most) =
            growths.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), growth| {
                (least.min(*growth), most.max(*growth))
            });
        let growth = growths.iter().sum::<f64>() / growths.len().max(1) as f64;
        let spread = (growths.len() == moments.len()).then_some(0.5 * (most - least));
        Found { motion: Motion { growth, ..motion.clone() }, spread, held: false }
    };
    moments[moments.len() / 2].iter().map(join).collect()
}

/// [rad/s] speed of a machine at a time \[s].
fn speed_of(scene: &MachineScene, time: f64) -> f64 {
    match scene {
        MachineScene::Bearing(scene) => {
            let load = &scene.load;
            load.inner_speed.at(time).abs().max(load.outer_speed.at(time).abs())
        }
        MachineScene::Shaft(scene) => {
            let shaft = &scene.shafts[0];
            let scripted = shaft.speed.as_ref().map(|speed| speed.at(time));
            scripted.or(shaft.start_speed.map(|speed| speed.0)).unwrap_or(0.0).abs()
        }
    }
}

/// The scene with another speed; both races of a bearing turn as fast against each other as before.
fn turning(scene: &MachineScene, time: f64, speed: f64) -> MachineScene {
    match scene {
        MachineScene::Bearing(own) => {
            let factor = speed / speed_of(scene, time);
            let mut scene = own.clone();
            for race in [&mut scene.load.inner_speed, &mut scene.load.outer_speed] {
                *race = Schedule::Constant(factor * race.at(time));
            }
            MachineScene::Bearing(scene)
        }
        MachineScene::Shaft(scene) => MachineScene::Shaft(Box::new(at_speed(scene, speed))),
    }
}
