//! C types of the library against those that fmi-rs has of the standard: the files of the library themselves, compiled here.
#![allow(dead_code, clippy::unwrap_used)]

use std::mem::{align_of, offset_of, size_of};

use fmi_rs::fmi2::types::{fmi2Boolean, fmi2CallbackFunctions, fmi2Status};
use fmi_rs::fmi3::types::{fmi3IntermediateUpdateCallback, fmi3LogMessageCallback, fmi3Status};

#[path = "."]
mod fmi {
    #[path = "../../../src/fmi/outcome.rs"]
    pub mod outcome;
    #[path = "../../../src/fmi/v2/types.rs"]
    pub mod v2;
    #[path = "../../../src/fmi/v3/types.rs"]
    pub mod v3;
}
use fmi::outcome::Status;
use fmi::{v2, v3};

/// Is one type laid out as the other?
fn alike<A, B>() -> bool {
    (size_of::<A>(), align_of::<A>()) == (size_of::<B>(), align_of::<B>())
}

/// The same type but for its name: this compiles, or the signatures differ.
fn callback(ours: v3::IntermediateUpdate) -> fmi3IntermediateUpdateCallback {
    ours
}

const STATUSES: [Status; 5] = [Status::Ok, Status::Warning, Status::Discard, Status::Error, Status::Fatal];

#[test]
fn published_statuses_have_the_numbers_of_the_standard() {
    let second =
        [fmi2Status::Ok, fmi2Status::Warning, fmi2Status::Discard, fmi2Status::Error, fmi2Status::Fatal];
    let third =
        [fmi3Status::Ok, fmi3Status::Warning, fmi3Status::Discard, fmi3Status::Error, fmi3Status::Fatal];
    for ((own, second), third) in STATUSES.into_iter().zip(second).zip(third) {
        assert_eq!(v2::Status::from(own) as i32, second as i32, "{own:?}");
        assert_eq!(v3::Status::from(own) as i32, third as i32, "{own:?}");
    }
    assert_eq!(v2::Status::Pending as i32, fmi2Status::Pending as i32);
    assert!(alike::<v2::Status, fmi2Status>() && alike::<v3::Status, fmi3Status>());
}

#[test]
fn published_callbacks_are_laid_out_as_in_the_standard() {
    type Ours = v2::CallbackFunctions;
    type Theirs = fmi2CallbackFunctions;
    assert!(alike::<Ours, Theirs>() && alike::<v2::Boolean, fmi2Boolean>());
    for (ours, theirs) in [
        (offset_of!(Ours, logger), offset_of!(Theirs, logger)),
        (offset_of!(Ours, allocate_memory), offset_of!(Theirs, allocateMemory)),
        (offset_of!(Ours, free_memory), offset_of!(Theirs, freeMemory)),
        (offset_of!(Ours, step_finished), offset_of!(Theirs, stepFinished)),
        (offset_of!(Ours, component_environment), offset_of!(Theirs, componentEnvironment)),
    ] {
        assert_eq!(ours, theirs);
    }
    // Callbacks that an importer may leave out are null pointers.
    assert!(alike::<Option<v3::LogMessage>, fmi3LogMessageCallback>());
    assert!(alike::<Option<v3::IntermediateUpdate>, fmi3IntermediateUpdateCallback>());
    let _ = callback;
}
