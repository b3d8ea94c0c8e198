//! Life over a duty: an equilibrium under each of its loads, or a run, and what all of them take of the life together. Everything that tells of a duty has it from here.
//!
//! | file | contents |
//! |---|---|
//! | `loads` | the loads: of a table, or the `[[duty]]` of a scene |
//! | `in_runs` | the same of a bearing over its run under one load |
//! | `rated` | life, safety and losses of a bearing under one load, and under all (Miner's sum) |
//! | `say` | as CSV, JSON and words |

mod in_runs;
pub mod loads;
pub mod rated;
pub mod say;

use roulement::effects::rating::life_of_all;
use roulement::scene::machine::MachineScene;
use thiserror::Error;

use crate::sweep::SweepError;
use crate::sweep::all::on_threads;
use loads::{Duty, Load};
use rated::{Rated, found, together, with_lives};

/// Why a duty has no rating.
#[derive(Debug, Error)]
pub enum DutyError {
    /// The table of loads.
    #[error(transparent)]
    Cases(#[from] SweepError),
    /// There are no loads.
    #[error(
        "there are no loads: give a table by --loads, or entries [[duty]] in the scene, each with name, share or hours, and the keys that it sets"
    )]
    NoLoads,
    /// A load, or the table that it is in; with the reason.
    #[error("{0}")]
    Load(String),
}

/// A load, with every bearing under it.
#[derive(Clone, Debug)]
pub struct UnderLoad {
    /// Its name, or the number of its row.
    pub name: String,
    /// [-] or \[h] its part of the whole.
    pub part: f64,
    /// Its bearings by their names; that of a bearing alone is empty.
    pub bearings: Vec<(String, Rated)>,
    /// Had the means of its run not settled?
    pub unsettled: bool,
}

/// Life over a duty.
#[derive(Clone, Debug)]
pub struct DutyRating {
    /// All loads.
    pub loads: Vec<UnderLoad>,
    /// Every bearing under all of them.
    pub together: Vec<(String, Rated)>,
    /// [-] or \[h] the whole of which loads are parts.
    pub whole: f64,
    /// Are their parts hours?
    pub by_hours: bool,
    /// Was every load run? Else they are in balance.
    pub by_runs: bool,
}

/// What all bearings come to.
#[derive(Clone, Copy, Debug)]
pub struct OfMachine {
    /// \[h] reference and modified life that nine of ten machines reach.
    pub hours: [Option<f64>; 2],
    /// [-] least static safety.
    pub safety: f64,
    /// \[W] losses of all bearings whose losses are known; none where there are no such bearings.
    pub loss: Option<f64>,
}

/// The load that takes most of a bearing's life.
#[derive(Clone, Debug)]
pub struct Worst<'a> {
    /// Its name.
    pub load: &'a str,
    /// [-] its part of all that is taken.
    pub taken: f64,
}

impl DutyRating {
    /// The rating of a scene's own `[[duty]]`; none where it has none.
    ///
    /// # Errors
    /// If a load has no equilibrium; names it.
    pub fn of_scene(scene: &MachineScene, threads: usize) -> Result<Option<Self>, DutyError> {
        if scene.duty().is_empty() {
            return Ok(None);
        }
        Self::of(&Duty::of_scene(scene)?, threads).map(Some)
    }

    /// The rating of a duty, its loads on some threads.
    ///
    /// # Errors
    /// If a load has no equilibrium; names it.
    pub fn of(duty: &Duty, threads: usize) -> Result<Self, DutyError> {
        Self::rated(duty, threads, false)
    }

    /// The rating of a duty of which every load is run, some at a time.
    ///
    /// # Errors
    /// If a load has no equilibrium or its run fails; names it.
    pub fn in_runs(duty: &Duty, threads: usize) -> Result<Self, DutyError> {
        Self::rated(duty, threads, true)
    }

    fn rated(duty: &Duty, threads: usize, by_runs: bool) -> Result<Self, DutyError> {
        let whole: f64 = duty.loads.iter().map(|load| load.part).sum();
        let under = |place: usize| under(&duty.loads[place], whole, &duty.from, by_runs);
        let loads =
            on_threads(duty.loads.len(), threads, under).into_iter().collect::<Result<Vec<_>, _>>()?;
        let names = loads.first().map_or(&[][..], |load| &load.bearings);
        let together = names.iter().map(|(name, _)| {
            (name.clone(), together(&of_bearing(&loads, name).cloned().collect::<Vec<_>>()))
        });
        Ok(Self { together: together.collect(), loads, whole, by_hours: duty.by_hours, by_runs })
    }

    /// \[h] the whole duty, where its parts are hours.
    pub fn hours(&self) -> Option<f64> {
        self.by_hours.then_some(self.whole)
    }

    /// [-] part of the life of a bearing that some hours take, where the duty has hours.
    pub fn damage(&self, rated: &Rated, part: f64) -> Option<f64> {
        self.by_hours.then(|| part * rated.used())
    }

    /// Do bearings have losses that are not known here?
    pub fn without_losses(&self) -> bool {
        self.together.iter().any(|(_, rated)| rated.loss.is_none())
    }

    /// Which load takes most of a bearing's life; none of one load, or where nothing is taken.
    pub fn worst<'a>(&'a self, bearing: &'a str) -> Option<Worst<'a>> {
        let taken = |of: &Rated| of.share * of.used();
        let whole: f64 = of_bearing(&self.loads, bearing).map(taken).sum();
        let (place, most) =
            of_bearing(&self.loads, bearing).map(taken).enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        (self.loads.len() > 1 && whole > 0.0)
            .then(|| Worst { load: &self.loads[place].name, taken: most / whole })
    }
}

/// A bearing under every load.
fn of_bearing<'a>(loads: &'a [UnderLoad], name: &'a str) -> impl Iterator<Item = &'a Rated> {
    let of =
        move |load: &'a UnderLoad| load.bearings.iter().find(|(own, _)| own == name).map(|(_, rated)| rated);
    loads.iter().filter_map(of)
}

/// All bearings of a machine together, where there are several.
pub fn of_machine(bearings: &[(String, Rated)]) -> Option<OfMachine> {
    let rated = || bearings.iter().map(|(_, rated)| rated);
    (bearings.len() > 1).then(|| OfMachine {
        hours: [0, 1].map(|which| life_of_all(rated().map(|of| of.hours()[which]))),
        safety: rated().map(|of| of.safety).fold(f64::INFINITY, f64::min),
        loss: rated().filter_map(|of| of.loss).reduce(|sum, loss| sum + loss),
    })
}

impl OfMachine {
    /// [1/h] part of the life that an hour takes, of the modified one where it is known.
    pub fn used(&self) -> Option<f64> {
        let [reference, modified] = self.hours;
        Some(1.0 / modified.or(reference)?)
    }
}

/// Every bearing under a load.
fn under(load: &Load, whole: f64, from: &str, by_runs: bool) -> Result<UnderLoad, DutyError> {
    let failed = |why: String| DutyError::Load(format!("{from}{}: {why}", load.name));
    let (scene, machine) = with_lives(load.scene.clone()).map_err(failed)?;
    let share = load.part / whole;
    let (bearings, settled) = match by_runs {
        true => in_runs::found(&scene, machine, share).map_err(failed)?,
        false => (found(&scene, &machine, share), true),
    };
    Ok(UnderLoad { name: load.name.clone(), part: load.part, bearings, unsettled: !settled })
}
