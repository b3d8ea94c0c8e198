//! Scene files and serialised states that nobody should write: how they are altered, and what they may and may not do.
#![allow(dead_code, clippy::unwrap_used, unsafe_code)]
#![allow(clippy::undocumented_unsafe_blocks)] // every pointer in here lives through its call

use std::ptr;

use roulement::fmi::v2::Status;
use roulement::interface::documentation;
use roulement::interface::model_description::render;
use roulement::interface::variables::{Causality, Variables};
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use sha2::{Digest, Sha256};

use crate::fmi2_abi::*;
use crate::random::Random;

/// [s] communication step that shows whether a bearing still runs.
const STEP: f64 = 1e-6;

/// Text pieces at the edge of what a scene may hold.
const EXTREMES: [&str; 24] = [
    "0",
    "-0.0",
    "-1",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551616",
    "200",
    "1e-15",
    "\"1e300 mm\"",
    "\"1/0 m\"",
    "\"10^10^10 N\"",
    "\"-5 deg\"",
    "[]",
    "[[0, 1], [1, 1e300]]",
    "{}",
    "true",
];

/// One random alteration of bytes: a bit, a piece left out, a piece twice, a cut, or nonsense in between.
pub fn alter(random: &mut Random, bytes: &mut Vec<u8>) {
    if bytes.is_empty() {
        bytes.push(random.byte());
        return;
    }
    let at = random.below(bytes.len());
    let longest = random.pick(&[1, 8, 64]);
    let end = (at + 1 + random.below(longest)).min(bytes.len());
    match random.below(8) {
        0..=2 => bytes[at] ^= 1 << random.below(8),
        3 => drop(bytes.drain(at..end)),
        4 => {
            let piece = bytes[at..end].to_vec();
            let to = random.below(bytes.len() + 1);
            bytes.splice(to..to, piece);
        }
        5 => bytes.truncate(at),
        6 => bytes[at..end].fill(random.pick(&[0, 1, 0x7f, 0x80, 0xff])),
        _ => {
            let nonsense: Vec<u8> = (0..end - at).map(|_| random.byte()).collect();
            bytes.splice(at..at, nonsense);
        }
    }
}

/// Begin and end of the numbers in a text.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let inside = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | 'e');
    let mut found = vec![];
    let mut begin = None;
    for (i, c) in text.char_indices() {
        match (begin, inside(c)) {
            (None, true) if c.is_ascii_digit() => begin = Some(i),
            (Some(from), false) => {
                found.push((from, i));
                begin = None;
            }
            _ => {}
        }
    }
    found
}

/// One random alteration of a scene's text: a number, a line, or bytes.
pub fn alter_scene(random: &mut Random, text: &str, other: &str) -> String {
    match random.below(6) {
        0..=2 => {
            let numbers = numbers(text);
            if numbers.is_empty() {
                return other.to_string();
            }
            let (from, to) = random.pick(&numbers);
            let scaled =
                text[from..to].parse::<f64>().map_or(0.0, |x| x * random.pick(&[-1.0, 0.1, 3.0, 1e6]));
            let scaled = scaled.to_string();
            let new = if random.below(3) == 0 { scaled.as_str() } else { random.pick(&EXTREMES) };
            format!("{}{new}{}", &text[..from], &text[to..])
        }
        3 | 4 => {
            let mut lines: Vec<&str> = text.lines().collect();
            if lines.is_empty() {
                return other.to_string();
            }
            let at = random.below(lines.len());
            let others: Vec<&str> = other.lines().collect();
            match random.below(4) {
                0 => drop(lines.remove(at)),
                1 => lines.insert(at, lines[random.below(lines.len())]),
                2 => lines.swap(at, random.below(text.lines().count())),
                _ => lines.insert(at, others[random.below(others.len())]),
            }
            lines.join("\n")
        }
        _ => {
            let mut bytes = text.as_bytes().to_vec();
            alter(random, &mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        }
    }
}

/// A text is a scene or is refused.
pub fn read_scene(text: &str) -> Option<Scene> {
    match Scene::parse(text) {
        Ok(scene) => Some(scene),
        Err(why) => {
            assert!(!why.to_string().is_empty());
            None
        }
    }
}

/// A scene starts or is refused; one that starts can be described and stepped, to numbers or a refusal.
pub fn start_scene(scene: &Scene) -> bool {
    documentation::page(scene, &|_| true);
    let Ok(mut simulation) = Simulation::new(scene) else { return false };
    render(&simulation, "bearing", &|_| true).unwrap();
    if simulation.advance(STEP).is_ok() {
        let values = Variables::new(scene).values(simulation.inputs(), simulation.outputs());
        assert!(values.iter().all(|value| value.is_finite()), "{values:?}");
    }
    true
}

/// An instance, a true state of it, and what it does from there.
pub struct StateReader {
    package: Package,
    component: Component,
    outputs: Vec<u32>,
    input: u32,
    blob: Vec<u8>,
    next: Vec<u8>,
}

impl StateReader {
    /// `name` tells the folders of tests that run at the same time apart.
    pub fn new(name: &str, drive: &str) -> Self {
        let package = Package::new(name, &scene_text(drive));
        let component = package.start();
        for k in 0..20 {
            assert_eq!(unsafe { fmi2DoStep(component, f64::from(k) * STEP, STEP, 0) }, Status::Ok);
        }
        let outputs = package.references(Causality::Output);
        let input = package.references(Causality::Input)[0];
        let blob = state_bytes(component);
        let mut reader = Self { package, component, outputs, input, blob, next: vec![] };
        assert_eq!(reader.read(&reader.blob), Status::Ok);
        reader.next = state_bytes(component);
        reader
    }

    /// The true state.
    pub fn blob(&self) -> &[u8] {
        &self.blob
    }

    /// The true state without what is before its content.
    pub fn content(&self) -> &[u8] {
        &self.blob[self.blob.len() - self.content_length()..]
    }

    /// [s] duration of its last communication step, as the instance counts it.
    pub fn last_step(&self) -> f64 {
        (19.0 * STEP + STEP) - (18.0 * STEP + STEP)
    }

    fn content_length(&self) -> usize {
        let at = 8 + self.package.guid.as_bytes().len();
        u64::from_le_bytes(self.blob[at..at + 8].try_into().unwrap()) as usize
    }

    /// A content with a head that vouches for it: as only a forger makes, for the checks behind the checksum.
    pub fn forge(&self, content: &[u8]) -> Vec<u8> {
        let mut bytes = self.blob[..8 + self.package.guid.as_bytes().len()].to_vec();
        bytes.extend((content.len() as u64).to_le_bytes());
        bytes.extend(Sha256::digest(content));
        bytes.extend(content);
        bytes
    }

    /// Reads a state and uses it; afterwards the true state still leads where it led.
    pub fn check(&self, bytes: &[u8]) -> Status {
        let status = self.read(bytes);
        assert_eq!(self.read(&self.blob), Status::Ok);
        assert_eq!(state_bytes(self.component), self.next, "the instance is not what it was");
        status
    }

    /// Reads a state, goes to it and one step on from it; the status says whether it was accepted.
    fn read(&self, bytes: &[u8]) -> Status {
        let c = self.component;
        let mut state = ptr::null_mut();
        unsafe {
            let status = fmi2DeSerializeFMUstate(c, bytes.as_ptr(), bytes.len(), &mut state);
            assert!(matches!(status, Status::Ok | Status::Error), "{status:?}");
            assert_eq!(state.is_null(), status == Status::Error);
            if status == Status::Error {
                return status;
            }
            let status = fmi2SetFMUstate(c, state);
            assert!(matches!(status, Status::Ok | Status::Error), "{status:?}");
            if status == Status::Ok {
                self.use_state();
            }
            assert_eq!(fmi2FreeFMUstate(c, &mut state), Status::Ok);
            status
        }
    }

    fn use_state(&self) {
        let (c, r, n) = (self.component, self.outputs.as_ptr(), self.outputs.len());
        let mut values = vec![0.0; n];
        let orders = vec![1; n];
        let mut time = 0.0;
        unsafe {
            if fmi2GetReal(c, r, n, values.as_mut_ptr()) == Status::Ok {
                assert!(values.iter().all(|value| value.is_finite()), "{values:?}");
            }
            for status in [
                fmi2GetRealOutputDerivatives(c, r, n, orders.as_ptr(), values.as_mut_ptr()),
                fmi2GetDirectionalDerivative(c, r, 3, &self.input, 1, &1.0, values.as_mut_ptr()),
                fmi2GetRealStatus(c, LAST_SUCCESSFUL_TIME, &mut time),
                fmi2DoStep(c, time, STEP, 0),
                fmi2GetReal(c, r, n, values.as_mut_ptr()),
            ] {
                assert!(status != Status::Fatal, "a panic inside");
            }
            assert!(values.iter().all(|value| value.is_finite()), "{values:?}");
        }
    }
}

impl Drop for StateReader {
    fn drop(&mut self) {
        unsafe { fmi2FreeInstance(self.component) };
    }
}
