//! Guard of the C functions of all versions: handle, phase, panics, log, status.

use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::handles;
use super::instance::Instance;
use super::log::Log;
use super::outcome::{Outcome, Status, error};
use super::state::Phase;
use super::state_machine::{Call, Rules};

/// What importers hold: an instance, perhaps with what only one version has; a stand-in in the tests of this layer, which Miri runs.
pub trait Held: Send + 'static {
    /// Its log and its phase.
    fn log_and_phase(&mut self) -> (&Log, &mut Phase);
}

impl Held for Instance {
    fn log_and_phase(&mut self) -> (&Log, &mut Phase) {
        (&self.log, &mut self.state.phase)
    }
}

/// Makes what an importer holds; a null handle, with the reason in the log, if that fails. `log` gives the log of the instance,
/// switched on or off.
pub fn make<T: Held>(
    log: impl Fn(bool) -> Log,
    on: bool,
    work: impl FnOnce(Log) -> Outcome<T>,
) -> *mut c_void {
    match catch_unwind(AssertUnwindSafe(|| work(log(on)))) {
        Ok(Ok(mut held)) => {
            held.log_and_phase().0.write(Status::Ok, "instantiated");
            handles::give(held)
        }
        Ok(Err((status, why))) => {
            log(true).write(status, &why);
            std::ptr::null_mut()
        }
        Err(_) => {
            log(true).write(Status::Fatal, "the model failed inside while it was instantiated");
            std::ptr::null_mut()
        }
    }
}

/// Ends what is behind a handle; null is ignored, and so is what has ended already.
pub fn free<T: Held>(handle: *mut c_void) {
    // A panic in a destructor must not cross the boundary either.
    let _ = catch_unwind(AssertUnwindSafe(|| drop(handles::take::<T>(handle))));
}

/// Runs a call on what is behind a handle; an error where there is nothing of this version.
pub fn guard<T: Held>(
    handle: *mut c_void,
    rules: &Rules,
    call: Call,
    work: impl FnOnce(&mut T) -> Outcome,
) -> Status {
    let mut work = Some(work);
    // Once per version and not once per function: the rest is the same for all.
    guarded(handle, rules, call, &mut |held| work.take().map_or(Ok(()), |work| work(held)))
}

fn guarded<T: Held>(
    handle: *mut c_void,
    rules: &Rules,
    call: Call,
    work: &mut dyn FnMut(&mut T) -> Outcome,
) -> Status {
    let checked = |held: &mut T| {
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            let phase = *held.log_and_phase().1;
            if !rules.allow(call, phase) {
                return error(format!("{call:?} is not allowed in phase {phase:?}"));
            }
            work(held)
        }));
        conclude(held.log_and_phase(), rules, call, outcome.ok())
    };
    handles::with(handle, checked).unwrap_or(Status::Error)
}

/// Status and phase after an outcome; there is none of a call that has failed inside.
fn conclude((log, phase): (&Log, &mut Phase), rules: &Rules, call: Call, outcome: Option<Outcome>) -> Status {
    let status = match outcome {
        Some(Ok(())) => Status::Ok,
        Some(Err((status, why))) => {
            log.write(status, &why);
            status
        }
        None => {
            let why = format!("{call:?} failed inside; this is a fault of the model");
            log.write(Status::Fatal, &why);
            Status::Fatal
        }
    };
    *phase = rules.after(call, status, *phase);
    status
}

/// Handles, pointers, phases and panics around a stand-in for an instance: quick enough for Miri (`scripts/miri`).
#[cfg(test)]
#[allow(unsafe_code)]
mod tests {
    use std::ffi::{CString, c_char};
    use std::ptr;
    use std::sync::{Arc, Mutex};

    use super::*;
    use crate::fmi::pointers::{list, list_mut, place, text, texts};

    struct Stub {
        log: Log,
        phase: Phase,
        values: Vec<f64>,
    }

    impl Held for Stub {
        fn log_and_phase(&mut self) -> (&Log, &mut Phase) {
            (&self.log, &mut self.phase)
        }
    }

    static RULES: Rules = Rules {
        allowed: &[
            (Call::Get, &[Phase::StepComplete, Phase::Terminated]),
            (Call::Set, &[Phase::StepComplete]),
            (Call::DoStep, &[Phase::StepComplete]),
        ],
        after_discarded_step: Phase::StepComplete,
    };

    type Lines = Arc<Mutex<Vec<String>>>;

    fn log(lines: &Lines) -> impl Fn(bool) -> Log {
        let lines = lines.clone();
        move |on| {
            let lines = lines.clone();
            let sink = move |status: Status, _: &std::ffi::CStr, text: &str| {
                lines.lock().unwrap().push(format!("{status:?}: {text}"));
            };
            Log::new(Box::new(sink), on)
        }
    }

    fn stub(lines: &Lines) -> *mut c_void {
        make(log(lines), false, |log| Ok(Stub { log, phase: Phase::StepComplete, values: vec![1.0, 2.0] }))
    }

    fn set(handle: *mut c_void, values: *const f64, n: usize) -> Status {
        guard::<Stub>(handle, &RULES, Call::Set, |stub| {
            // SAFETY: the pointers of these tests are null or valid for so many values.
            stub.values = unsafe { list(values, n) }?.to_vec();
            Ok(())
        })
    }

    fn get(handle: *mut c_void, values: *mut f64, n: usize) -> Status {
        guard::<Stub>(handle, &RULES, Call::Get, |stub| {
            // SAFETY: as above.
            let values = unsafe { list_mut(values, n) }?;
            values.iter_mut().zip(&stub.values).for_each(|(value, own)| *value = *own);
            Ok(())
        })
    }

    #[test]
    fn lists_behind_pointers_are_read_and_written() {
        let lines = Lines::default();
        let handle = stub(&lines);
        let mut found = [0.0; 3];
        assert_eq!(get(handle, found.as_mut_ptr(), 3), Status::Ok);
        assert_eq!(found, [1.0, 2.0, 0.0]);
        assert_eq!(set(handle, [4.0, 5.0, 6.0].as_ptr(), 3), Status::Ok);
        assert_eq!(get(handle, found.as_mut_ptr(), 2), Status::Ok);
        assert_eq!(found, [4.0, 5.0, 0.0]);
        // Nothing is looked at of a list without elements, wherever it is.
        assert_eq!(set(handle, ptr::dangling(), 0), Status::Ok);
        assert_eq!(set(handle, ptr::null(), 0), Status::Ok);
        assert_eq!(set(handle, ptr::null(), 1), Status::Error);
        assert_eq!(set(handle, found.as_ptr(), usize::MAX), Status::Error);
        assert_eq!(get(handle, ptr::null_mut(), 2), Status::Error);
        assert_eq!(lines.lock().unwrap().len(), 3);
        free::<Stub>(handle);
    }

    #[test]
    fn handles_of_nothing_are_refused() {
        let lines = Lines::default();
        let handle = stub(&lines);
        for other in [ptr::null_mut(), ptr::without_provenance_mut(0xdead_beef)] {
            assert_eq!(set(other, [1.0].as_ptr(), 1), Status::Error);
            free::<Stub>(other);
        }
        // It is in use while it is called.
        let within = guard::<Stub>(handle, &RULES, Call::Get, |_| {
            assert_eq!(set(handle, [1.0].as_ptr(), 1), Status::Error);
            free::<Stub>(handle);
            Ok(())
        });
        assert_eq!(within, Status::Ok);
        free::<Stub>(handle);
        free::<Stub>(handle);
        assert_eq!(get(handle, [0.0].as_mut_ptr(), 1), Status::Error);
        let none = make::<Stub>(log(&lines), false, |_| error("no scene"));
        assert!(none.is_null());
        let panics: *mut c_void = make::<Stub>(log(&lines), false, |_| panic!("on purpose"));
        assert!(panics.is_null());
        let told = lines.lock().unwrap();
        assert!(told[0] == "Error: no scene" && told[1].starts_with("Fatal"), "{told:?}");
    }

    #[test]
    fn a_panic_is_fatal_and_goes_no_further() {
        let lines = Lines::default();
        let handle = stub(&lines);
        let status = guard::<Stub>(handle, &RULES, Call::Get, |_| panic!("on purpose"));
        assert_eq!(status, Status::Fatal);
        assert_eq!(get(handle, [0.0].as_mut_ptr(), 1), Status::Error);
        let told = lines.lock().unwrap();
        assert!(
            told[0].contains("fault of the model") && told[1].contains("not allowed in phase Fatal"),
            "{told:?}"
        );
        free::<Stub>(handle);
    }

    #[test]
    fn a_step_that_is_refused_ends_the_instance_and_a_discarded_one_does_not() {
        let lines = Lines::default();
        let handle = stub(&lines);
        let step =
            |how: Status| guard::<Stub>(handle, &RULES, Call::DoStep, |_| Err((how, "as told".into())));
        assert_eq!(step(Status::Discard), Status::Discard);
        assert_eq!(get(handle, [0.0].as_mut_ptr(), 1), Status::Ok);
        assert_eq!(step(Status::Error), Status::Error);
        assert_eq!(get(handle, [0.0].as_mut_ptr(), 1), Status::Error);
        free::<Stub>(handle);
    }

    #[test]
    fn texts_behind_pointers_are_copied() {
        let (own, odd) = (CString::new("logStatusError").unwrap(), CString::new(vec![0xff, b'x']).unwrap());
        let all: [*const c_char; 3] = [own.as_ptr(), ptr::null(), odd.as_ptr()];
        // SAFETY: null, or C strings that live through the calls.
        unsafe {
            assert_eq!(texts(all.as_ptr(), 3), Ok(vec!["logStatusError".into(), "\u{fffd}x".into()]));
            assert_eq!(texts(ptr::null(), 0), Ok(vec![]));
            assert!(texts(ptr::null(), 2).is_err());
            assert!(text(ptr::null()).is_none());
        }
        let mut value = 1;
        *place(Some(&mut value), "a number").unwrap() = 2;
        assert_eq!(value, 2);
        assert!(place::<i32>(None, "a number").unwrap_err().1.contains("a number is a null pointer"));
    }
}
