//! Parts of a sweep for machines that share no more than a disc: each runs every n-th case into a folder of its own, and one command
//! joins them (docs/sweeps.md).

use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use roulement::schema::regular;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::SweepError;
use super::all::{Sweep, on_threads, threads};
use super::case::Wanted;
use super::cases::Cases;
use super::store::{PROGRAM, Store, aside, hex};

/// Folder of all shards in the directory of the sweep.
pub const SHARDS: &str = "shards";
/// What a shard says about itself.
const RECORD: &str = "shard.json";
/// [-] most shards of a sweep: more would be a slip of the pen.
const MOST: usize = 1_000_000;

/// A part of the cases: every `of`-th, from `number` on, so that all shards have cases of all kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shard {
    /// From 1 to `of`.
    pub number: usize,
    /// How many there are.
    pub of: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers =
            text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        let (number, of): (usize, usize) =
            numbers.ok_or("a shard is its number and how many there are, as 7/64")?;
        if !(1..=MOST).contains(&of) {
            return Err(format!("there are 1 to {MOST} shards, not {of}"));
        }
        if !(1..=of).contains(&number) {
            return Err(format!("shards of {of} have the numbers 1 to {of}, not {number}"));
        }
        Ok(Self { number, of })
    }
}

impl Shard {
    /// Does a case, counted from 0, belong to it?
    pub fn has(self, case: usize) -> bool {
        case % self.of == self.number - 1
    }

    /// Its folder in the directory of the sweep.
    pub fn folder(self, directory: &Path) -> PathBuf {
        directory.join(SHARDS).join(format!("{}-of-{}", self.number, self.of))
    }

    /// The shard of a folder's name; none if it is no such name.
    fn of_folder(name: &str) -> Option<Self> {
        let (number, of) = name.split_once("-of-")?;
        format!("{number}/{of}").parse().ok()
    }
}

/// What the rows of a sweep follow from, and in which order they stand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// Version of the program.
    program: String,
    /// [-] cases of the whole sweep.
    cases: usize,
    /// Hash of the scene, of all cases and of what is wanted of them.
    sweep: String,
}

impl Identity {
    /// Of cases that have not been divided.
    pub fn new(cases: &Cases, base: &str, wanted: &Wanted) -> Self {
        let mut hash = Sha256::new();
        let mut take = |text: &str| {
            hash.update(text.len().to_le_bytes());
            hash.update(text);
        };
        take(base);
        take(&format!("{:?} {:?} {}", wanted.columns, wanted.tables, wanted.growth));
        take(&format!("{:?} {:?}", cases.common, cases.keys));
        for row in &cases.rows {
            take(&format!("{row:?}"));
        }
        Self { program: PROGRAM.to_string(), cases: cases.rows.len(), sweep: hex(&hash.finalize()) }
    }

    /// Writes it into the folder of a shard.
    ///
    /// # Errors
    /// If the folder or the file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), SweepError> {
        let path = folder.join(RECORD);
        let text =
            format!("{:#}\n", json!({ "program": self.program, "cases": self.cases, "sweep": self.sweep }));
        let aside = aside(&path);
        let written = fs::create_dir_all(folder)
            .and_then(|()| fs::write(&aside, text))
            .and_then(|()| fs::rename(&aside, &path));
        written.map_err(|why| SweepError::file("write", &path, &why))
    }

    fn of_text(text: &str) -> Option<Self> {
        let record: Value = serde_json::from_str(text).ok()?;
        let text = |key: &str| record[key].as_str().map(str::to_string);
        let cases = usize::try_from(record["cases"].as_u64()?).ok()?;
        Some(Self { program: text("program")?, cases, sweep: text("sweep")? })
    }

    /// Is it that of a shard in a folder? A folder without a whole record has not begun.
    fn is_of(&self, folder: &Path) -> Result<bool, SweepError> {
        let path = folder.join(RECORD);
        if !path.is_file() {
            return Ok(false);
        }
        let text = regular::text(&path)
            .map_err(|why| SweepError::Files(format!("cannot read {}: {why}", path.display())))?;
        let found = Self::of_text(&text)
            .ok_or_else(|| SweepError::Files(format!("{} is no record of a shard", path.display())))?;
        let place = folder.display();
        if found.program != self.program {
            return Err(SweepError::Files(format!(
                "{place} is by roulement {}, and this is {}: run all shards and --collect by one version",
                found.program, self.program
            )));
        }
        if found != *self {
            return Err(SweepError::Files(format!(
                "{place} is of another sweep ({} cases, here {}): the table of cases, the scene, --columns, --tables and --growth must be those of the shards",
                found.cases, self.cases
            )));
        }
        Ok(true)
    }
}

/// What a shard has not done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Left {
    /// Which one.
    pub shard: Shard,
    /// Has it begun?
    pub is_begun: bool,
    /// [-] its cases that are not done, and all of them.
    pub cases: (usize, usize),
}

/// Takes what the shards in the directory of a sweep have done into the sweep, and tells what is not done.
///
/// # Errors
/// If there are no shards, or some of another sweep or another division, or files cannot be read or written.
pub fn collect(sweep: &Sweep, identity: &Identity, directory: &Path) -> Result<Vec<Left>, SweepError> {
    let shards = found(directory)?;
    let count = shards[0].of;
    let mut begun = vec![None; count];
    for shard in shards {
        let folder = shard.folder(directory);
        if identity.is_of(&folder)? {
            begun[shard.number - 1] = Some(Store::new(&folder)?);
        }
    }
    let tables = sweep.wanted.tables.as_deref();
    let taken = on_threads(sweep.names.len(), threads(), |case| {
        let Ok(name) = &sweep.names[case] else { return Ok(true) };
        let there = sweep.store.has(name, tables);
        let from = begun[case % count].as_ref();
        if !there && from.is_none_or(|from| !from.has(name, tables)) {
            return Ok(false);
        }
        from.map_or(Ok(()), |from| sweep.store.take(from, name, tables, !there)).map(|()| true)
    });
    let mut done = taken.into_iter().collect::<Result<Vec<bool>, SweepError>>()?;
    for (done, name) in done.iter_mut().zip(&sweep.names) {
        // Another shard may have the same case.
        *done = *done || name.as_ref().is_ok_and(|name| sweep.store.has(name, tables));
    }
    let left = |number: usize| {
        let own = || (number - 1..done.len()).step_by(count);
        let cases = (own().filter(|case| !done[*case]).count(), own().count());
        let is_begun = begun[number - 1].is_some();
        (cases.0 > 0).then_some(Left { shard: Shard { number, of: count }, is_begun, cases })
    };
    Ok((1..=count).filter_map(left).collect())
}

/// Shards whose folders are there, all of one division.
fn found(directory: &Path) -> Result<Vec<Shard>, SweepError> {
    let folder = directory.join(SHARDS);
    let none =
        || SweepError::Files(format!("{} has no shards: --shard 1/N runs the first of N", folder.display()));
    let entries = match fs::read_dir(&folder) {
        Ok(entries) => entries,
        Err(why) if why.kind() == std::io::ErrorKind::NotFound => return Err(none()),
        Err(why) => return Err(SweepError::file("read", &folder, &why)),
    };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut shards: Vec<Shard> = names.filter_map(|name| Shard::of_folder(&name)).collect();
    shards.sort_unstable();
    let first = shards.first().ok_or_else(none)?;
    if let Some(other) = shards.iter().find(|shard| shard.of != first.of) {
        return Err(SweepError::Files(format!(
            "{} has shards of {} and of {}: remove those of one division",
            folder.display(),
            first.of,
            other.of
        )));
    }
    Ok(shards)
}

/// Shards in few words, by whether they have begun: `missing: 3, 7 to 9 of 64`.
pub fn told(left: &[Left]) -> Vec<String> {
    let Some(of) = left.first().map(|left| left.shard.of) else { return vec![] };
    let missing: Vec<usize> =
        left.iter().filter(|left| !left.is_begun).map(|left| left.shard.number).collect();
    let mut said = vec![];
    if !missing.is_empty() {
        said.push(format!("missing shards: {} of {of}", ranges(&missing)));
    }
    let unfinished = left.iter().filter(|left| left.is_begun);
    said.extend(unfinished.map(|Left { shard, cases, .. }| {
        format!(
            "unfinished shard: {} of {of}, {} of its {} cases are not done",
            shard.number, cases.0, cases.1
        )
    }));
    said
}

/// Numbers in growing order with neighbours as ranges.
fn ranges(numbers: &[usize]) -> String {
    let mut parts: Vec<(usize, usize)> = vec![];
    for number in numbers {
        match parts.last_mut() {
            Some((_, last)) if *last + 1 == *number => *last = *number,
            _ => parts.push((*number, *number)),
        }
    }
    let text = |(first, last): &(usize, usize)| match last - first {
        0 => first.to_string(),
        1 => format!("{first}, {last}"),
        _ => format!("{first} to {last}"),
    };
    parts.iter().map(text).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_every_case_has_one_shard() {
        for (cases, of) in [(10, 3), (3, 10), (64, 64), (1, 1)] {
            for case in 0..cases {
                let own = (1..=of).filter(|number| Shard { number: *number, of }.has(case));
                assert_eq!(own.count(), 1, "{case} of {cases} in {of}");
            }
        }
    }

    #[test]
    fn folders_are_named_after_shards() {
        let shard: Shard = "7/64".parse().unwrap_or_else(|why| panic!("{why}"));
        let folder = shard.folder(Path::new("sweep"));
        let name = folder.file_name().map(|name| name.to_string_lossy().into_owned());
        assert_eq!(name.as_deref().and_then(Shard::of_folder), Some(shard));
        assert_eq!(Shard::of_folder("7-of-6"), None);
        assert_eq!(ranges(&[1, 2, 4, 7, 8, 9]), "1, 2, 4, 7 to 9");
    }
}
