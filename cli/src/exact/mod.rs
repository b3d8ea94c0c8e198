//! Rolling contacts by the half-space reference solver, kept between calls (`roulement contact --exact`).
//!
//! A table over the creepages of one ellipse that rolls obliquely would have twice the nodes of one that rolls along an axis, some
//! six thousand, each as dear as a contact. So contacts are computed one by one, and no interpolation adds its error.

pub mod cache;

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use roulement::analysis::single_contact::ScaledContact;
use roulement::kalker::half_space::{HalfSpaceError, Refined};

use crate::progress::ProgressBar;
use cache::{Cache, key};

/// Time after which new answers are saved, so that an interrupted call is not lost.
const SAVE: Duration = Duration::from_secs(10);

/// Answers to contacts.
pub struct Answers {
    /// One for each contact; none where it was interrupted before.
    pub answers: Vec<Option<Result<Refined, HalfSpaceError>>>,
    /// How many were computed; equal contacts are computed once.
    pub computed: usize,
    /// Why what was computed could not be saved.
    pub unsaved: Option<String>,
}

/// Answers contacts from a cache, and computes on all cores what is not there. What a contact gives does not depend on the
/// others, nor on the cache.
pub fn answer(
    contacts: &[ScaledContact],
    cache: &mut Cache,
    interrupted: &AtomicBool,
    progress: &ProgressBar,
) -> Answers {
    let kept: Vec<Option<Refined>> = contacts.iter().map(|contact| cache.get(contact)).collect();
    let mut missing: Vec<&ScaledContact> = vec![];
    let mut place = HashMap::new();
    for (contact, _) in contacts.iter().zip(&kept).filter(|(_, kept)| kept.is_none()) {
        place.entry(key(contact)).or_insert_with(|| {
            missing.push(contact);
            missing.len() - 1
        });
    }
    progress.set_length(missing.len() as u64);
    let (results, unsaved) = compute(&missing, cache, interrupted, progress);
    let found = |(contact, kept): (&ScaledContact, Option<Refined>)| match kept {
        Some(answer) => Some(Ok(answer)),
        None => results[place[&key(contact)]],
    };
    let answers = contacts.iter().zip(kept).map(found).collect();
    Answers { answers, computed: results.iter().flatten().count(), unsaved }
}

/// Computes contacts on all cores, and keeps their answers. Says why they could not be saved, if so.
fn compute(
    contacts: &[&ScaledContact],
    cache: &mut Cache,
    interrupted: &AtomicBool,
    progress: &ProgressBar,
) -> (Vec<Option<Result<Refined, HalfSpaceError>>>, Option<String>) {
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(contacts.len());
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    let mut results = vec![None; contacts.len()];
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                while !interrupted.load(Ordering::Relaxed) {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(contact) = contacts.get(index) else { break };
                    if sender.send((index, contact.exact())).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut saved = Instant::now();
        for (index, result) in receiver {
            if let Ok(answer) = &result {
                cache.put(contacts[index], answer);
            }
            results[index] = Some(result);
            progress.inc(1);
            if saved.elapsed() > SAVE {
                // Exported at the end, if it fails there too.
                let _ = cache.save();
                saved = Instant::now();
            }
        }
    });
    (results, cache.save().err())
}
