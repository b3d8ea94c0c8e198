//! States of instances: saved, restored, and written as bytes.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::instance::Instance;
use super::outcome::{Outcome, Status, error};
use super::state::State;
use crate::simulation::driven::MachineSnapshot;

/// First bytes of a serialised state: what it is, and the version of its form.
const MAGIC: &[u8; 8] = b"rlmtFM18";
/// Bytes of the checksum.
const CHECKSUM: usize = 32;

/// A saved instance.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FmuState {
    state: State,
    unit: MachineSnapshot,
    /// Identifier of the package that it is of; as bytes it stands before the content.
    #[serde(skip)]
    guid: String,
}

impl Instance {
    /// The instance as it is.
    pub fn save(&self) -> FmuState {
        FmuState { state: self.state.clone(), unit: self.unit.snapshot(), guid: self.guid.clone() }
    }

    /// Refuses a state of another scene, which the library of this one may have given out, too.
    fn check_origin(&self, saved: &FmuState) -> Outcome {
        if saved.guid == self.guid {
            return Ok(());
        }
        let (other, own) = (&saved.guid, &self.guid);
        error(format!("the FMU state is of another scene: its package is {other}, this instance's is {own}"))
    }

    /// Goes back to a state of this package.
    ///
    /// # Errors
    /// If the state is of another scene.
    pub fn restore(&mut self, saved: &FmuState) -> Outcome {
        self.check_origin(saved)?;
        let FmuState { state, unit: snapshot, .. } = saved;
        if !state.fits(&self.state) {
            return error("the FMU state is of another scene");
        }
        // To the bit: derivatives go from one point to the other, however far apart they are said to be.
        let leads_here = |before: &MachineSnapshot| snapshot.time() - before.time() == state.last_step;
        if !state.before.as_ref().is_none_or(leads_here) {
            return error(
                "the FMU state contradicts itself: its last step does not lead from one point to the other",
            );
        }
        let no_number = "the FMU state holds a value that is not a number";
        if !state.is_finite() {
            return error(no_number);
        }
        let mut rebuilt = None;
        if self.unit.parameters_differ(&state.applied, &self.state.applied) {
            let mut unit = self.unit.clone();
            unit.start_at(0.0, &state.applied)?;
            rebuilt = Some(unit);
        }
        let unit = rebuilt.as_mut().unwrap_or(&mut self.unit);
        let here = unit.snapshot();
        if !unit.restore(snapshot) {
            return error("the FMU state is of another scene");
        }
        if !unit.values().iter().all(|value| value.is_finite()) {
            let restored = unit.restore(&here);
            debug_assert!(restored, "a snapshot of this very unit fits it");
            return error(no_number);
        }
        if let Some(rebuilt) = rebuilt {
            self.unit = rebuilt;
        }
        self.state = state.clone();
        self.present = None;
        self.previous = None;
        self.forget_columns();
        Ok(())
    }

    /// A state as bytes: magic, guid, length of the content, checksum, content.
    ///
    /// # Errors
    /// If the state is of another scene, or the content cannot be written, which would be a fault of this library.
    pub fn serialise(&self, state: &FmuState) -> Outcome<Vec<u8>> {
        self.check_origin(state)?;
        let content = postcard::to_allocvec(state).map_err(|why| (Status::Error, why.to_string()))?;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(self.guid.as_bytes());
        bytes.extend((content.len() as u64).to_le_bytes());
        bytes.extend(Sha256::digest(&content));
        bytes.extend(content);
        Ok(bytes)
    }

    /// A state from bytes.
    ///
    /// # Errors
    /// If the bytes are not a whole and unaltered state of this very package.
    pub fn deserialise(&self, bytes: &[u8]) -> Outcome<FmuState> {
        let refuse = |why: &str| error(format!("the serialised FMU state is refused: {why}"));
        let Some(rest) = bytes.strip_prefix(MAGIC) else {
            return refuse("it was not written by this version of roulement");
        };
        let Some(rest) = rest.strip_prefix(self.guid.as_bytes()) else {
            return refuse("it is of another package");
        };
        let Some((length, rest)) = rest.split_first_chunk::<8>() else {
            return refuse("it is cut off");
        };
        let Some((checksum, content)) = rest.split_first_chunk::<CHECKSUM>() else {
            return refuse("it is cut off");
        };
        // Before the content is looked at: the importer's size may be wrong.
        if content.len() as u64 != u64::from_le_bytes(*length) {
            return refuse("its length is wrong");
        }
        if Sha256::digest(content).as_slice() != checksum {
            return refuse("its checksum is wrong");
        }
        let read = postcard::from_bytes::<FmuState>(content).or_else(|why| refuse(&why.to_string()))?;
        Ok(FmuState { guid: self.guid.clone(), ..read })
    }
}
