//! Answers of the reference solver in a text file of the user's cache directory: a line each, which carries its own checksum.
//!
//! The first line names the version of the program: another version's answers are not used. Everything else that an answer
//! depends on stands in its line to the last bit: axis ratio, Poisson's ratio, direction of rolling and creepages.

use std::collections::HashMap;
use std::env;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use roulement::analysis::single_contact::ScaledContact;
use roulement::kalker::half_space::Refined;
use roulement::kalker::{Patch, ScaledCreepage, ScaledForces};

/// Numbers of a contact, and those of its answer.
const INPUTS: usize = 7;
const OUTPUTS: usize = 5;
/// Answers that a file keeps, some 25 MB: the oldest go first.
const MOST: usize = 100_000;

/// A contact to the last bit.
pub type Key = [u64; INPUTS];

fn inputs(contact: &ScaledContact) -> [f64; INPUTS] {
    let ScaledContact {
        patch: Patch { axis_ratio, poisson_ratio, rolling_angle },
        creepage: ScaledCreepage { x, y, spin, curvature },
    } = *contact;
    [axis_ratio, poisson_ratio, rolling_angle, x, y, spin, curvature]
}

/// A contact to the last bit.
pub fn key(contact: &ScaledContact) -> Key {
    inputs(contact).map(f64::to_bits)
}

/// Answers by contact, in the order in which they came.
#[derive(Debug, Default)]
struct Entries {
    answers: HashMap<Key, [f64; OUTPUTS]>,
    order: Vec<Key>,
}

impl Entries {
    fn put(&mut self, key: Key, answer: [f64; OUTPUTS]) {
        if self.answers.insert(key, answer).is_none() {
            self.order.push(key);
        }
    }
}

/// Answers of this call and of those before.
#[derive(Debug, Default)]
pub struct Cache {
    /// None where there is no place for it.
    path: Option<PathBuf>,
    /// First line of the file.
    title: String,
    entries: Entries,
    /// Answers that the file does not have yet.
    fresh: Vec<Key>,
}

/// Directory for files that can be made again, by the customs of the system; none if the environment does not say.
fn directory() -> Option<PathBuf> {
    let variable = |name: &str| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    if let Some(path) = variable("XDG_CACHE_HOME") {
        return Some(path);
    }
    if cfg!(windows) {
        return variable("LOCALAPPDATA");
    }
    variable("HOME")
        .map(|home| home.join(if cfg!(target_os = "macos") { "Library/Caches" } else { ".cache" }))
}

/// FNV-1a, 64 bits: a damaged line passes once in 2^64.
fn checksum(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// A line of the file: shortest decimals that give the same bits again.
fn line(key: &Key, answer: &[f64; OUTPUTS]) -> String {
    let numbers = key.iter().map(|bits| f64::from_bits(*bits)).chain(answer.iter().copied());
    let text = numbers.map(|number| format!("{number:e}")).collect::<Vec<_>>().join(",");
    format!("{text},{:016x}\n", checksum(&text))
}

/// Reads a line; none if it is damaged.
fn parse(line: &str) -> Option<(Key, [f64; OUTPUTS])> {
    let (text, sum) = line.rsplit_once(',')?;
    if u64::from_str_radix(sum, 16).ok()? != checksum(text) {
        return None;
    }
    let numbers = text.split(',').map(|number| number.parse().ok()).collect::<Option<Vec<f64>>>()?;
    let (inputs, answer) = numbers.split_at_checked(INPUTS)?;
    let inputs: [f64; INPUTS] = inputs.try_into().ok()?;
    Some((inputs.map(f64::to_bits), answer.try_into().ok()?))
}

/// Reads a file of this title. What cannot be used is told.
fn read(path: &Path, title: &str) -> (Entries, Option<String>) {
    let mut entries = Entries::default();
    let file = path.display();
    let bytes = match fs::read(path) {
        Ok(bytes) => bytes,
        Err(why) if why.kind() == ErrorKind::NotFound => return (entries, None),
        Err(why) => return (entries, Some(format!("cannot read {file}: {why}"))),
    };
    let text = String::from_utf8_lossy(&bytes);
    let mut lines = text.lines();
    if lines.next() != Some(title) {
        let note = format!(
            "{file} is damaged or of another version of this program: its contacts are computed anew"
        );
        return (entries, Some(note));
    }
    let mut damaged = 0;
    for line in lines {
        match parse(line) {
            Some((key, answer)) => entries.put(key, answer),
            None => damaged += 1,
        }
    }
    let note = match damaged {
        0 => None,
        1 => Some(format!("1 line of {file} is damaged: its contact is computed anew")),
        _ => Some(format!("{damaged} lines of {file} are damaged: their contacts are computed anew")),
    };
    (entries, note)
}

impl Cache {
    /// The user's cache for a version of the program, with what its reader should know.
    pub fn open(version: &str) -> (Self, Option<String>) {
        let title = format!("# rolling contacts of roulement {version}, form 1");
        let Some(path) = directory().map(|directory| directory.join("roulement").join("contacts.csv")) else {
            let note = "no directory for caches is known (XDG_CACHE_HOME, HOME): nothing is kept".to_string();
            return (Self::default(), Some(note));
        };
        let (entries, note) = read(&path, &title);
        (Self { path: Some(path), title, entries, fresh: vec![] }, note)
    }

    /// A cache that keeps nothing between calls.
    pub fn none() -> Self {
        Self::default()
    }

    /// Where it is.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// The answer to a contact.
    pub fn get(&self, contact: &ScaledContact) -> Option<Refined> {
        let [fx, fy, mz, second_moment, change] = *self.entries.answers.get(&key(contact))?;
        Some(Refined { forces: ScaledForces { fx, fy, mz, second_moment }, change })
    }

    /// Takes an answer.
    pub fn put(&mut self, contact: &ScaledContact, answer: &Refined) {
        let ScaledForces { fx, fy, mz, second_moment } = answer.forces;
        let key = key(contact);
        self.entries.put(key, [fx, fy, mz, second_moment, answer.change]);
        self.fresh.push(key);
    }

    /// Writes what is new, beside what others have written meanwhile: into a file of its own first, which then takes the place
    /// of the other one as a whole.
    ///
    /// # Errors
    /// If the file cannot be written, as a sentence.
    pub fn save(&mut self) -> Result<(), String> {
        let Some(path) = self.path.as_ref().filter(|_| !self.fresh.is_empty()) else {
            return Ok(());
        };
        let (mut entries, _) = read(path, &self.title);
        for key in &self.fresh {
            entries.put(*key, self.entries.answers[key]);
        }
        let oldest = entries.order.len().saturating_sub(MOST);
        let mut text = format!("{}\n", self.title);
        for key in &entries.order[oldest..] {
            text += &line(key, &entries.answers[key]);
        }
        let part = path.with_extension(format!("csv.{}", std::process::id()));
        path.parent()
            .map_or(Ok(()), fs::create_dir_all)
            .and_then(|()| fs::write(&part, text))
            .and_then(|()| fs::rename(&part, path))
            .map_err(|why| {
                // It may not be there.
                let _ = fs::remove_file(&part);
                format!("cannot write {}: {why}", path.display())
            })?;
        self.fresh.clear();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_lines_give_the_same_bits_and_every_damaged_character_is_found() {
        let key = [0.1f64, 0.3, -0.0, 1e-300, -2.5e7, f64::MIN_POSITIVE, 1.0 / 3.0].map(f64::to_bits);
        let answer = [0.1 + 0.2, -1.0, 0.0, 5e-324, 0.01];
        let written = line(&key, &answer);
        let text = written.trim_end();
        let bits = |answer: [f64; OUTPUTS]| answer.map(f64::to_bits);
        assert_eq!(parse(text).map(|(key, answer)| (key, bits(answer))), Some((key, bits(answer))));
        for place in 0..text.len() {
            let mut bytes = text.as_bytes().to_vec();
            bytes[place] = if bytes[place] == b'7' { b'3' } else { b'7' };
            assert_eq!(parse(&String::from_utf8(bytes).unwrap_or_default()), None, "{place}");
            assert_eq!(parse(&text[..place]), None, "{place}");
        }
    }
}
