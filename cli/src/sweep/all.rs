//! All cases of a sweep on some threads. What a case gives does not depend on the others.

use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use roulement::SceneError;
use roulement::scene::machine::MachineScene;

use super::SweepError;
use super::case::{self, Wanted};
use super::cases::Cases;
use super::columns;
use super::setting::Setting;
use super::shard::{Identity, Shard};
use super::store::{Store, aside};

/// A sweep: cases of a scene, what is wanted of them, and where their rows are kept.
pub struct Sweep {
    /// Cases.
    pub cases: Cases,
    /// Text of the base scene.
    pub base: String,
    /// Wanted results of every case.
    pub wanted: Wanted,
    /// Rows that are there.
    pub store: Store,
    /// Names of the cases in the store, or why a case has no scene.
    pub names: Vec<Result<String, String>>,
    /// Which columns of the cases have plain numbers alone.
    pub(super) numeric: Vec<bool>,
}

impl Sweep {
    /// All cases.
    ///
    /// # Errors
    /// If there is a key that no case can be read with, or a column that is not there, or the directory cannot be made.
    pub fn new(cases: Cases, base: String, wanted: Wanted, directory: &Path) -> Result<Self, SweepError> {
        check(&cases, &base, &wanted)?;
        Self::checked(cases, base, wanted, directory)
    }

    /// The cases of a shard, which are kept in its folder of the directory; those of others are looked at as [`Self::new`] does.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_shard(
        mut cases: Cases,
        base: String,
        wanted: Wanted,
        directory: &Path,
        shard: Shard,
    ) -> Result<Self, SweepError> {
        check(&cases, &base, &wanted)?;
        let identity = Identity::new(&cases, &base, &wanted);
        cases.keep(shard);
        let folder = shard.folder(directory);
        identity.write(&folder)?;
        Self::checked(cases, base, wanted, &folder)
    }

    /// Names all cases. Their scenes are read when they are run.
    fn checked(cases: Cases, base: String, wanted: Wanted, directory: &Path) -> Result<Self, SweepError> {
        let name =
            |case| Ok(Store::name(&cases.text_of(&base, case).map_err(|why| why.to_string())?, &wanted));
        let names: Vec<Result<String, String>> = on_threads(cases.rows.len(), threads(), name);
        let store = Store::new(directory)?;
        let is_number = |setting: &Setting| setting.shown.parse::<f64>().is_ok();
        let of = |place: usize| cases.rows.iter().filter_map(move |row| row.get(place)?.as_ref());
        let numeric = (0..cases.keys.len()).map(|place| of(place).all(is_number)).collect();
        Ok(Self { cases, base, wanted, store, names, numeric })
    }

    /// Cases that are not done yet, or whose files are damaged, in their order.
    pub fn missing(&self) -> Vec<usize> {
        let is_missing = |case: usize| self.names[case].as_ref().is_ok_and(|name| !self.has(name));
        let missing = on_threads(self.names.len(), threads(), is_missing);
        (0..self.names.len()).filter(|case| missing[*case]).collect()
    }

    /// Was a case done, and its files damaged or changed since?
    pub fn is_damaged(&self, case: usize) -> bool {
        self.names[case].as_ref().is_ok_and(|name| self.store.has_file(name) && !self.has(name))
    }

    fn has(&self, name: &str) -> bool {
        self.store.has(name, self.wanted.tables.as_deref())
    }

    /// Runs a case, if it is not done yet, and keeps its row; false if it was interrupted.
    ///
    /// # Errors
    /// If files cannot be written.
    pub fn run_case(&self, case: usize, interrupted: &AtomicBool) -> Result<bool, SweepError> {
        let Ok(name) = &self.names[case] else { return Ok(true) };
        if self.has(name) {
            return Ok(true);
        }
        let text = self.cases.text_of(&self.base, case)?;
        let table = self.wanted.tables.as_ref().map(|ending| self.store.table(name, ending)).transpose()?;
        let part = table.as_deref().map(aside);
        let row = case::run_text(&text, &self.wanted, part.as_deref(), interrupted);
        let is_whole = matches!(&row, Ok(Some(row)) if row.len() > 2);
        if let (Some(table), Some(part)) = (&table, &part) {
            if is_whole {
                fs::rename(part, table).map_err(|why| SweepError::file("write", table, &why))?;
            } else {
                // It may not have been begun.
                let _ = fs::remove_file(part);
            }
        }
        match row? {
            Some(row) => self.store.put(name, &row, table.as_deref().filter(|_| is_whole)).map(|()| true),
            None => Ok(false),
        }
    }

    /// Runs some cases; `done` is told of each. Ends early when it is interrupted or a file cannot be written.
    ///
    /// # Errors
    /// If files cannot be written.
    pub fn run(
        &self,
        cases: &[usize],
        threads: usize,
        interrupted: &AtomicBool,
        done: impl Fn() + Sync,
    ) -> Result<(), SweepError> {
        let failed = Mutex::new(None);
        on_threads(cases.len(), threads, |index| {
            if interrupted.load(Ordering::Relaxed) {
                return;
            }
            match self.run_case(cases[index], interrupted) {
                Ok(true) => done(),
                Ok(false) => {}
                Err(why) => {
                    interrupted.store(true, Ordering::Relaxed);
                    if let Ok(mut failed) = failed.lock() {
                        failed.get_or_insert(why);
                    }
                }
            }
        });
        failed.into_inner().ok().flatten().map_or(Ok(()), Err)
    }
}

/// Reads as many scenes of cases as show that every key is one, and that columns are there.
fn check(cases: &Cases, base: &str, wanted: &Wanted) -> Result<(), SweepError> {
    let read = |case: usize| MachineScene::edited(&cases.text_of(base, case)?);
    let all = 0..cases.rows.len();
    // A misspelt key is no matter of single cases.
    for (place, key) in cases.keys.iter().enumerate() {
        let sets = |case: &usize| cases.rows[*case].get(place).is_some_and(Option::is_some);
        first_read(all.clone().filter(sets), read, &format!("no case that sets {}", key.name))?;
    }
    if let Some(scene) = first_read(all, read, "no case")? {
        columns::check(&scene, &wanted.columns)?;
    }
    Ok(())
}

/// The first of some cases whose scene can be read; none if there is no case.
fn first_read(
    cases: impl Iterator<Item = usize>,
    read: impl Fn(usize) -> Result<MachineScene, SceneError>,
    what: &str,
) -> Result<Option<MachineScene>, SweepError> {
    let mut first = None;
    for case in cases {
        match read(case) {
            Ok(scene) => return Ok(Some(scene)),
            Err(why) => {
                first.get_or_insert(why);
            }
        }
    }
    let none = |why: SceneError| SweepError::NoneRuns { what: what.to_string(), why: why.to_string() };
    first.map_or(Ok(None), |why| Err(none(why)))
}

/// [-] as many threads as there are cores.
pub fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Does work for 0 .. count on some threads and gives the results in this order.
pub(crate) fn on_threads<T: Send>(count: usize, threads: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let of_thread = || {
        let mut results = vec![];
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return results;
            }
            results.push((index, work(index)));
        }
    };
    let mut all: Vec<(usize, T)> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads.clamp(1, count.max(1))).map(|_| scope.spawn(of_thread)).collect();
        let mut all = of_thread();
        for other in others {
            // A panic there is one here.
            all.extend(other.join().unwrap_or_else(|why| std::panic::resume_unwind(why)));
        }
        all
    });
    all.sort_unstable_by_key(|(index, _)| *index);
    all.into_iter().map(|(_, result)| result).collect()
}
