//! Estimates of the effects of a scene, from settled states at time 0, or where its loads have a point at which a ball carries
//! load first, with every race at the largest speed of its script. An effect that does not matter then may do at another time of the
//! scripts, so that these are looked at, too.

use super::corners::{Corner, corners};
use super::looked_at::{fastest, under};
use super::settled::Settled;
use crate::effects::Effects;
use crate::effects::estimate::{Changes, Estimate, Verdict, digits};
use crate::effects::film::FILM;
use crate::effects::twin::{Switch, Twin};
use crate::equilibrium::{EquilibriumError, EquilibriumInput};
use crate::kalker::nonlinear::KalkerError;
use crate::model::Model;
use crate::model::bodies::Race;
use crate::scene::system::SystemScene;
use crate::scene::{Load, Machine, RaceLoad, Scene, Schedule, Start};
use crate::simulation::system::InBalance;
use crate::simulation::{Simulation, machine};

/// Why nothing is estimated.
#[derive(Clone, Debug, thiserror::Error)]
pub enum EstimateError {
    /// No creep coefficients for the bearing's contacts.
    #[error("no estimates of effects: {0}")]
    Creep(#[from] KalkerError),
    /// There is no equilibrium to look at.
    #[error("no estimates of effects: {0}")]
    Equilibrium(#[from] EquilibriumError),
    /// No ball carries load between the races.
    #[error("no estimates of effects: no ball is loaded at any point of the scene's loads")]
    Unloaded,
    /// The bearing does not start.
    #[error("no estimates of effects: {0}")]
    Start(String),
}

/// Verdicts of estimates, or why there are none.
pub type Verdicts = Result<Vec<Verdict>, EstimateError>;

/// [-] threshold with a cage over that without one: in scenes/cage.toml growth by 10 K changes the torque by -9.6 %, and the settled
/// state, where no ball pushes, by -0.84 %. No effect has less.
const CAGED: f64 = 0.1;
/// [-] less than the threshold is enough for what changes motions that a settled state does not have ([`Twin::unsettled`]): groove slip that
/// changes the settled torque by 0.2 % changed it by 1.3 % in runs (cli/tests/studies/effect_verdicts.rs).
const UNSETTLED: f64 = 0.01;
/// [-] threshold of what changes motions that a settled state does not have, by that of other effects.
pub fn unsettled(threshold: f64) -> f64 {
    (threshold - UNSETTLED).max(CAGED * threshold)
}

/// Most times of the scripts that are looked at.
const MOST_TIMES: usize = 24;
/// Most ranges, those that a scene gives among them, up to which those of scripts are looked at: of a bearing alone, and of a shaft, whose states
/// cost more.
const MOST_RANGES: usize = 6;
pub(super) const MOST_OF_SHAFT: usize = 3;
/// Times in a period of what swings.
const IN_A_PERIOD: u32 = 8;

/// Verdicts on all effects in a scene: that of the start, or of the first other time of its scripts at which the effect
/// matters.
///
/// # Errors
/// See [`EstimateError`].
pub fn verdicts(scene: &Scene, model: &Model) -> Verdicts {
    over_time(scene, model, &[])
}

/// The same, but for effects that are known to matter.
fn over_time(scene: &Scene, model: &Model, known: &[Verdict]) -> Verdicts {
    let fastest = [&scene.load.inner_speed, &scene.load.outer_speed].map(fastest);
    let judged = |time: f64, speeds: [f64; 2], known: [&[Verdict]; 2]| {
        let estimate = at(scene, model, time, speeds)?;
        let start = |switches: &[&Switch]| {
            let mut changed = judged_scene(scene);
            let [inner, outer] = speeds;
            changed.load.inner_speed = Schedule::Constant(inner);
            changed.load.outer_speed = Schedule::Constant(outer);
            switches.iter().for_each(|switch| switch(&mut changed.effects));
            let simulation = Simulation::starting_at(&changed, time).map_err(|why| why.to_string())?;
            Ok(Settled::of(&simulation))
        };
        judge(&scene.effects, estimate, known, &start)
    };
    let mut verdicts = judged(first_loaded(scene, model), fastest, [known, &[]])?;
    let speeds = |time: f64| [&scene.load.inner_speed, &scene.load.outer_speed].map(|speed| speed.at(time));
    // Where a bearing is slow, and what it carries is not what it has to carry when it is fast.
    let slow = times_of([&scene.load.inner_speed, &scene.load.outer_speed], scene.load.duration.0);
    let slow = slow.into_iter().map(|time| (time, speeds(time)));
    let points = times(scene).into_iter().map(|time| (time, fastest)).chain(slow);
    for (time, speeds) in points.filter(|(_, speeds)| speeds[0] != speeds[1]) {
        // Where there is no equilibrium, the other times tell.
        let Ok(there) = judged(time, speeds, [known, &verdicts]) else { continue };
        take_what_matters(&mut verdicts, there, &format!("at {} ms", digits(1e3 * time)));
    }
    Ok(verdicts)
}

/// The same, and at all corners of the ranges of what acts on the bearing, which may come together in any way: those that the scene gives, and those
/// of its scripts.
///
/// # Errors
/// See [`EstimateError`].
pub fn verdicts_in_ranges(scene: &Scene) -> Verdicts {
    let mut verdicts = verdicts(scene, &Model::new(scene)?)?;
    let read = |text: &str| Scene::edited(text, [("", ""); 0]);
    for Corner { scene, place } in corners((scene, &scene.source), (&scene.ranges, MOST_RANGES), read, acting)
    {
        // What cannot be has nothing to say.
        let judged = Model::new(&scene)
            .map_err(EstimateError::from)
            .and_then(|model| over_time(&scene, &model, &verdicts));
        if let Ok(there) = judged {
            take_what_matters(&mut verdicts, there, &place);
        }
    }
    Ok(verdicts)
}

/// Schedules of speeds, loads and motions.
fn acting(scene: &mut Scene) -> Vec<&mut Schedule> {
    let Load { inner_speed, outer_speed, x, y, z, ry, rz, outer, .. } = &mut scene.load;
    let (mut along, mut about) = (vec![x, y, z], vec![ry, rz]);
    if let Some(RaceLoad { x, y, z, ry, rz }) = outer {
        along.extend([x, y, z]);
        about.extend([ry, rz]);
    }
    let along = along.into_iter().flat_map(|one| [one.force.as_mut(), one.displacement.as_mut()]);
    let about = about.into_iter().flat_map(|one| [one.moment.as_mut(), one.rotation.as_mut()]);
    [inner_speed, outer_speed].into_iter().chain(along.flatten()).chain(about.flatten()).collect()
}

/// Verdicts on the effects of every bearing of a machine.
pub fn verdicts_of(machine: &machine::Machine) -> Vec<Verdicts> {
    match machine {
        machine::Machine::Bearing(bearing) => vec![verdicts(bearing.scene(), bearing.model())],
        machine::Machine::Shaft(system) => verdicts_of_shaft(system.scene()),
    }
}

/// Verdicts of every bearing of a shaft, where shaft and housings put its races: with the whole shaft in balance again.
pub fn verdicts_of_shaft(scene: &SystemScene) -> Vec<Verdicts> {
    shaft_over_time(scene, &[])
}

/// The same, but for effects that are known to matter.
fn shaft_over_time(scene: &SystemScene, known: &[Verdicts]) -> Vec<Verdicts> {
    let known = |index: usize| known.get(index).and_then(|own| own.as_deref().ok()).unwrap_or_default();
    let at = |system: &InBalance, index: usize, here: &[Verdict]| {
        let own = system.scene(index);
        let start = |switches: &[&Switch]| {
            let mut changed = judged_scene(own);
            switches.iter().for_each(|switch| switch(&mut changed.effects));
            let bearing = system.with(index, &changed).map_err(|why| why.to_string())?;
            Ok(Settled::of(&bearing))
        };
        let bearing = system.with(index, own).map_err(|why| EstimateError::Start(why.to_string()))?;
        judge(&own.effects, on_shaft(&bearing)?, [known(index), here], &start)
    };
    let first = InBalance::new(scene, 0.0).map_err(|why| EstimateError::Start(why.to_string()));
    let mut all: Vec<Verdicts> = (0..scene.bearings.len())
        .map(|index| first.as_ref().map_err(Clone::clone).and_then(|system| at(system, index, &[])))
        .collect();
    for time in times_of(scene.schedules(), scene.load.duration.0) {
        let Ok(system) = InBalance::new(scene, time) else { continue };
        for (index, verdicts) in all.iter_mut().enumerate() {
            let there = at(&system, index, verdicts.as_deref().unwrap_or_default());
            take_verdicts(verdicts, there, &format!("at {} ms", digits(1e3 * time)));
        }
    }
    all
}

/// Verdicts of a shaft whose inputs an importer may set: at all corners of the ranges of what acts on it, too.
pub fn verdicts_of_shaft_in_ranges(scene: &SystemScene) -> Vec<Verdicts> {
    let mut all = verdicts_of_shaft(scene);
    let read = |text: &str| {
        // Its source stands alone, as that of a package.
        let mut scene = SystemScene::of_package(text)?;
        scene.bearings.iter_mut().for_each(|mounted| mounted.scene.effects.auto.on = false);
        Ok(scene)
    };
    let ranges = (&scene.ranges, MOST_OF_SHAFT);
    for Corner { scene, place } in corners((scene, &scene.source), ranges, read, SystemScene::acting) {
        let there = shaft_over_time(&scene, &all);
        all.iter_mut().zip(there).for_each(|(verdicts, there)| take_verdicts(verdicts, there, &place));
    }
    all
}

/// Puts what matters elsewhere in the place of what did not, or of nothing.
fn take_verdicts(verdicts: &mut Verdicts, there: Verdicts, place: &str) {
    match (verdicts, there) {
        (Ok(verdicts), Ok(there)) => take_what_matters(verdicts, there, place),
        (verdicts @ Err(_), there @ Ok(_)) => *verdicts = there,
        _ => {}
    }
}

/// Input of closed forms, of a bearing of a shaft that was just started.
///
/// # Errors
/// See [`EstimateError`].
pub fn on_shaft(bearing: &Simulation) -> Result<Estimate, EstimateError> {
    let input = bearing.equilibrium_input();
    let problem = |gyroscopic| EquilibriumInput { gyroscopic, ..input.clone() };
    under(bearing.scene(), bearing.model(), problem)
}

/// A scene as it is judged: it starts in balance, and has a life.
pub(super) fn judged_scene(scene: &Scene) -> Scene {
    let mut judged = scene.clone();
    judged.start = Start::default();
    judged.effects.auto.on = false;
    judged.effects.rating.section.get_or_insert_default();
    judged
}

/// Verdicts on effects at one state, by settled states that some switches lead to; nothing of twins that are known to matter.
fn judge(
    effects: &Effects,
    mut estimate: Estimate,
    known: [&[Verdict]; 2],
    start: &dyn Fn(&[&Switch]) -> Result<Settled, String>,
) -> Verdicts {
    let scene = start(&[]).map_err(EstimateError::Start)?;
    estimate.power = scene.power;
    let is_known = |twin: &Twin| {
        let mut mattering = known.iter().copied().flatten().filter(|verdict| verdict.matters);
        mattering.any(|verdict| (verdict.key, verdict.subject) == (Some(twin.key), twin.subject))
    };
    let of = |twin: Twin| {
        // What changes contact angles or friction changes how balls push a cage, and that is no part of a settled state.
        let threshold = match (estimate.caged, twin.unsettled.is_some()) {
            (true, _) => CAGED * estimate.threshold,
            (false, true) => unsettled(estimate.threshold),
            (false, false) => estimate.threshold,
        };
        let mut changes = Changes::default();
        let mut film = None;
        for switch in &twin.switches {
            let both = match &twin.common {
                Some(common) => start(&[common]).and_then(|without| Ok((without, start(&[common, switch])?))),
                None if twin.on => start(&[switch]).map(|without| (without, scene)),
                None => start(&[switch]).map(|with| (scene, with)),
            };
            match both {
                Ok((without, with)) => {
                    changes = changes.or_larger(without.changes_to(&with));
                    film = with.film_ratio;
                }
                Err(why) => return Verdict::of_no_state(&twin, threshold, &why),
            }
        }
        if twin.passing {
            changes = Changes { torque: None, life: None, ..changes };
        }
        let tail = film.filter(|_| twin.subject == FILM).map_or(String::new(), |ratio| {
            format!("; film {} times the roughness at the most loaded ball", digits(ratio))
        });
        // What is said not to matter may do so beside that.
        let idle = !twin.always_matters && changes.largest().is_none_or(|(_, most)| most.abs() <= threshold);
        let tail = match twin.unsettled {
            Some(unseen) if idle => format!("{tail}; {unseen}"),
            _ => tail,
        };
        Verdict::of_twin(&twin, changes, threshold, &tail)
    };
    let mut verdicts: Vec<Verdict> =
        effects.twins(&estimate).into_iter().filter(|twin| !is_known(twin)).map(of).collect();
    verdicts.extend(effects.verdicts(&estimate));
    Ok(verdicts)
}

/// Puts what matters elsewhere in the place of what did not.
fn take_what_matters(verdicts: &mut [Verdict], there: Vec<Verdict>, place: &str) {
    for new in there.into_iter().filter(|new| new.matters) {
        let same = |old: &&mut Verdict| (old.key, old.subject) == (new.key, new.subject);
        if let Some(old) = verdicts.iter_mut().find(same).filter(|old| !old.matters) {
            *old = Verdict { sentence: format!("{}, {place}", new.sentence), ..new };
        }
    }
}

/// \[s] times at which what acts on the bearing has a kink or an extreme value.
fn times(scene: &Scene) -> Vec<f64> {
    times_of(schedules(scene), scene.load.duration.0)
}

/// \[s] times up to a last one at which schedules have a kink or an extreme value, growing: a selection that is even, with the least and
/// the largest value of each, where there are very many.
pub(super) fn times_of<'a>(schedules: impl IntoIterator<Item = &'a Schedule>, duration: f64) -> Vec<f64> {
    let (mut times, mut extremes) = (vec![], vec![]);
    for schedule in schedules {
        let swings = schedule.shortest_period(duration).into_iter();
        let swings = swings.flat_map(|period| {
            (1..=IN_A_PERIOD).map(move |part| period * f64::from(part) / f64::from(IN_A_PERIOD))
        });
        let mut own: Vec<f64> = schedule.knots(0.0, duration).chain(swings).collect();
        own.push(duration);
        own.retain(|time| *time <= duration);
        let by_value = |a: &&f64, b: &&f64| schedule.at(**a).total_cmp(&schedule.at(**b));
        if schedule.is_scripted() {
            extremes.extend(own.iter().min_by(by_value).into_iter().chain(own.iter().max_by(by_value)));
            times.extend(own);
        }
    }
    let stride = times.len().div_ceil(MOST_TIMES).max(1);
    times.sort_by(f64::total_cmp);
    let mut chosen: Vec<f64> = times.into_iter().step_by(stride).chain(extremes).collect();
    chosen.sort_by(f64::total_cmp);
    chosen.dedup();
    chosen
}

/// Scripts of what acts on the bearing, but for speeds, which are looked at where they are largest.
fn schedules(scene: &Scene) -> impl Iterator<Item = &Schedule> {
    let directions = Race::loaded(scene).directions(scene);
    let given = directions.into_iter().flat_map(|direction| [direction.load, direction.motion]).flatten();
    let machine = Race::loaded(scene).machine(scene);
    let machine = machine.into_iter().flat_map(Machine::schedules);
    let others = [Some(&scene.friction.ball_race), scene.effects.film.schedule()];
    given.chain(machine).chain(others.into_iter().flatten())
}

/// Input of closed forms.
///
/// # Errors
/// See [`EstimateError`].
pub fn of(scene: &Scene, model: &Model) -> Result<Estimate, EstimateError> {
    let speeds = [&scene.load.inner_speed, &scene.load.outer_speed].map(fastest);
    at(scene, model, first_loaded(scene, model), speeds)
}

/// \[s] time 0, or the first one of the scripts at which a ball carries load; time 0 where there is none.
fn first_loaded(scene: &Scene, model: &Model) -> f64 {
    let speeds = [&scene.load.inner_speed, &scene.load.outer_speed].map(fastest);
    let loaded = |time: &f64| !matches!(at(scene, model, *time, speeds), Err(EstimateError::Unloaded));
    [0.0].into_iter().chain(times(scene)).find(loaded).unwrap_or(0.0)
}

/// Input of closed forms at a time \[s] of the scene's loads and speeds [rad/s] of both races.
fn at(
    scene: &Scene,
    model: &Model,
    time: f64,
    [inner_speed, outer_speed]: [f64; 2],
) -> Result<Estimate, EstimateError> {
    let problem = |gyroscopic| EquilibriumInput {
        inner_speed,
        outer_speed,
        ..EquilibriumInput::at(scene, gyroscopic, time)
    };
    under(scene, model, problem)
}
