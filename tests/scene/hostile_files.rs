//! Altered scene files and serialised states: read or refused, never a panic, never a number that is none.

use std::time::{Duration, Instant};

use roulement::fmi::v2::Status;

use crate::hostile::*;
use crate::random::Random;

/// Scenes that ship, of every effect, drive and solver setting that they use.
const SCENES: [&str; 10] = [
    include_str!("../../scenes/thrust.toml"),
    include_str!("../../scenes/radial.toml"),
    include_str!("../../scenes/cage.toml"),
    include_str!("../../scenes/misalignment.toml"),
    include_str!("../../scenes/cost/load_zone.toml"),
    include_str!("../../scenes/cost/misalignment.toml"),
    include_str!("../../scenes/cost/reversal.toml"),
    include_str!("../../scenes/cost/shock.toml"),
    include_str!("../../scenes/cost/speed_ramp.toml"),
    include_str!("../../scenes/cost/thrust.toml"),
];

/// How long the long variants go on.
fn long_run() -> Duration {
    let minutes = std::env::var("ROULEMENT_FUZZ_MINUTES").map_or(3.0, |n| n.parse().unwrap());
    Duration::from_secs_f64(60.0 * minutes)
}

/// A scene altered in up to four places.
fn altered_scene(random: &mut Random) -> String {
    let mut text = random.pick(&SCENES).to_string();
    for _ in 0..1 + random.below(4) {
        let other = random.pick(&SCENES);
        text = alter_scene(random, &text, other);
    }
    text
}

/// Names the text that did harm.
struct Suspect<'a>(&'a str, u64);

impl Drop for Suspect<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("scene of seed {}:\n{}", self.1, self.0);
        }
    }
}

/// Altered scenes from these seeds, of which `n_starts` of those that are read are started; how many were read and started.
fn scenes(seeds: impl Iterator<Item = u64>, n_starts: u32) -> [u32; 3] {
    let mut counts = [0; 3];
    for seed in seeds {
        let text = altered_scene(&mut Random::new(seed));
        let _suspect = Suspect(&text, seed);
        counts[0] += 1;
        let Some(scene) = read_scene(&text) else { continue };
        counts[1] += 1;
        if counts[2] < n_starts {
            let begin = Instant::now();
            counts[2] += u32::from(start_scene(&scene));
            if begin.elapsed() > Duration::from_secs(10) {
                println!("seed {seed}: {} s to start\n{text}", begin.elapsed().as_secs_f64());
            }
        }
    }
    counts
}

#[test]
fn invariant_altered_scenes_are_read_or_refused() {
    let [tried, read, started] = scenes(0..4000, 10);
    // Both sides are reached.
    assert!(
        read > tried / 20 && read < tried / 2 && started == 10,
        "{tried} tried, {read} read, {started} started"
    );
}

#[test]
#[ignore = "takes minutes; scripts/soak runs it"]
fn invariant_altered_scenes_start_or_are_refused() {
    let (begin, time) = (Instant::now(), long_run());
    let [tried, read, started] = scenes((10_000..).take_while(|_| begin.elapsed() < time), u32::MAX);
    println!("{tried} altered scenes: {read} read, {started} started");
    assert!(started > 100);
}

/// Altered states from these seeds: how many were altered, refused as such, forged, and accepted when forged.
fn states(name: &str, drive: &str, seeds: impl Iterator<Item = u64>) -> [u32; 4] {
    let reader = StateReader::new(name, drive);
    let mut counts = [0; 4];
    for seed in seeds {
        let mut random = Random::new(seed);
        let forged = random.below(2) == 0;
        let mut bytes = if forged { reader.content() } else { reader.blob() }.to_vec();
        for _ in 0..1 + random.below(3) {
            alter(&mut random, &mut bytes);
        }
        if forged {
            bytes = reader.forge(&bytes);
        }
        if bytes == reader.blob() {
            continue;
        }
        let accepted = reader.check(&bytes) == Status::Ok;
        assert!(forged || !accepted, "seed {seed}: an altered state was accepted");
        counts[if forged { 2 } else { 0 }] += 1;
        counts[if forged { 3 } else { 1 }] += u32::from(accepted == forged);
    }
    counts
}

#[test]
fn invariant_altered_states_are_refused() {
    for drive in ["pose", "wrench"] {
        let [altered, refused, forged, accepted] = states(&format!("hostile-{drive}"), drive, 0..300);
        assert_eq!(altered, refused);
        // Those with a true head get to the checks behind it.
        assert!(altered > 100 && forged > 100 && accepted > 10, "{forged} forged, {accepted} accepted");
    }
}

#[test]
fn regression_a_state_whose_last_step_leads_nowhere_is_refused() {
    // A directional derivative goes from the point before to this one: it went on for hours.
    let reader = StateReader::new("hostile-step", "wrench");
    let step = reader.last_step().to_le_bytes();
    let content = reader.content();
    let places: Vec<usize> = (0..content.len() - 8).filter(|at| content[*at..at + 8] == step).collect();
    let forged = |at: usize| {
        let mut content = content.to_vec();
        content[at..at + 8].copy_from_slice(&1e3f64.to_le_bytes());
        reader.check(&reader.forge(&content))
    };
    // The step of the step control has the same number, perhaps.
    assert!(places.iter().any(|at| forged(*at) == Status::Error), "{places:?}");
}

#[test]
#[ignore = "takes minutes; scripts/soak runs it"]
fn invariant_altered_states_do_no_harm() {
    let time = long_run();
    for drive in ["pose", "wrench"] {
        let begin = Instant::now();
        let counts =
            states(&format!("soak-{drive}"), drive, (10_000..).take_while(|_| begin.elapsed() < time / 2));
        println!(
            "{drive}: {} altered, {} of them refused; {} forged, {} of them accepted",
            counts[0], counts[1], counts[2], counts[3]
        );
        assert_eq!(counts[0], counts[1]);
    }
}
