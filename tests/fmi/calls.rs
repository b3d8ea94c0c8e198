//! The C interface under random and hostile calls, in many threads, and after steps that cannot be finished.

use std::ffi::{CStr, c_char, c_int};
use std::ptr;

use roulement::fmi::v2::Status;
use roulement::interface::variables::Causality;

use crate::fmi2_abi::*;
use crate::random::Random;
use crate::scenes::scene;

/// One importer that knows no manners.
struct Hooligan<'a> {
    package: &'a Package,
    random: Random,
    /// Instances, dead ones among them, null and nonsense.
    components: Vec<Component>,
    states: Vec<State>,
    blobs: Vec<Vec<u8>>,
    time: f64,
    calls: [u32; 34],
    statuses: [u32; 6],
}

impl Hooligan<'_> {
    fn references(&mut self) -> Vec<u32> {
        let n = self.random.below(5);
        let rows = &self.package.rows;
        let wild = [u32::MAX, 1_000_000, rows.len() as u32];
        (0..n)
            .map(|_| {
                loop {
                    if self.random.below(12) == 0 {
                        break self.random.pick(&wild);
                    }
                    // Parameters seldom: a new one means a new model, which takes a tenth of a second.
                    let reference = self.random.below(rows.len());
                    if rows[reference].causality != Causality::Parameter || self.random.below(50) == 0 {
                        break reference as u32;
                    }
                }
            })
            .collect()
    }

    /// Values near those that the variables have, or wild ones.
    fn values(&mut self, c: Component, references: &[u32]) -> Vec<f64> {
        references
            .iter()
            .map(|reference| {
                let mut now = 0.0;
                unsafe { fmi2GetReal(c, reference, 1, &mut now) };
                self.random.number(now)
            })
            .collect()
    }

    fn call(&mut self) {
        let function = self.random.below(34);
        // What takes a run forward comes more often than everything else.
        let function =
            if self.random.below(3) == 0 { self.random.pick(&[5, 6, 7, 10, 14, 27]) } else { function };
        self.calls[function] += 1;
        let i = self.random.below(self.components.len());
        // Mostly the newest instance.
        let i = if self.random.below(8) == 0 { i } else { self.components.len() - 1 };
        let c = self.components[i];
        let (references, null) = (self.references(), self.random.below(15) == 0);
        let n = references.len();
        let r = if null { ptr::null() } else { references.as_ptr() };
        let values = self.values(c, &references);
        let v = if self.random.below(15) == 0 { ptr::null() } else { values.as_ptr() };
        let mut results = vec![0.25; n];
        let orders: Vec<c_int> = (0..n).map(|_| self.random.pick(&[1, 1, 1, 1, 0, 2, -1])).collect();
        let integers = vec![1; n];
        let (mut integer_results, mut texts) = (vec![0; n], vec![ptr::null::<c_char>(); n]);
        let state = self.random.below(self.states.len());
        let kind = self.random.below(6) as c_int - 1;
        let status = unsafe {
            match function {
                0 => {
                    assert_eq!(CStr::from_ptr(fmi2GetTypesPlatform()), c"default");
                    Status::Ok
                }
                1 => {
                    assert_eq!(CStr::from_ptr(fmi2GetVersion()), c"2.0");
                    Status::Ok
                }
                2 => {
                    let p = self.package;
                    let names = [
                        c"bearing".as_ptr(),
                        c"bearing".as_ptr(),
                        c"bearing".as_ptr(),
                        c" ".as_ptr(),
                        ptr::null(),
                    ];
                    let guids =
                        [p.guid.as_ptr(), p.guid.as_ptr(), p.guid.as_ptr(), c"{}".as_ptr(), ptr::null()];
                    let places = [
                        p.location.as_ptr(),
                        p.location.as_ptr(),
                        p.location.as_ptr(),
                        c"http://x".as_ptr(),
                        ptr::null(),
                    ];
                    let name = self.random.pick(&names);
                    let guid = self.random.pick(&guids);
                    let place = self.random.pick(&places);
                    let callbacks =
                        self.random.pick(&[&raw const p.callbacks, &raw const p.callbacks, ptr::null()]);
                    let made =
                        fmi2Instantiate(name, self.random.pick(&[1, 1, 1, 0]), guid, place, callbacks, 0, 1);
                    if !made.is_null() {
                        self.time = 0.0;
                        self.components.push(made);
                    }
                    Status::Ok
                }
                3 => {
                    // Rarely, or nothing else would be tested; the dead handle stays in the list.
                    if self.random.below(30) == 0 {
                        fmi2FreeInstance(c);
                    }
                    Status::Ok
                }
                4 => {
                    let categories = [c"logStatusError".as_ptr(), c"nonsense".as_ptr(), ptr::null()];
                    let n = self.random.below(4);
                    fmi2SetDebugLogging(c, 1, n, if null { ptr::null() } else { categories.as_ptr() })
                }
                5 => {
                    let (start, stop) = (self.random.number(0.0), self.random.number(1.0));
                    let status = fmi2SetupExperiment(c, 0, 0.0, start, 1, stop);
                    if status == Status::Ok {
                        self.time = start;
                    }
                    status
                }
                6 => fmi2EnterInitializationMode(c),
                7 => fmi2ExitInitializationMode(c),
                8 => {
                    if self.random.below(6) == 0 {
                        fmi2Terminate(c)
                    } else {
                        Status::Ok
                    }
                }
                9 => {
                    self.time = 0.0;
                    fmi2Reset(c)
                }
                10 => {
                    let status =
                        fmi2GetReal(c, r, n, if null { ptr::null_mut() } else { results.as_mut_ptr() });
                    if status == Status::Ok {
                        assert!(results.iter().all(|value| value.is_finite()), "{references:?} {results:?}");
                    }
                    status
                }
                11 => fmi2GetInteger(c, r, n, integer_results.as_mut_ptr()),
                12 => fmi2GetBoolean(c, r, n, integer_results.as_mut_ptr()),
                13 => fmi2GetString(c, r, n, texts.as_mut_ptr()),
                14 => fmi2SetReal(c, r, n, v),
                15 => fmi2SetInteger(c, r, n, integers.as_ptr()),
                16 => fmi2SetBoolean(c, r, n, integers.as_ptr()),
                17 => fmi2SetString(c, r, n, texts.as_ptr()),
                18 => fmi2GetFMUstate(c, if null { ptr::null_mut() } else { &raw mut self.states[state] }),
                19 => fmi2SetFMUstate(c, self.states[state]),
                20 => fmi2FreeFMUstate(c, if null { ptr::null_mut() } else { &raw mut self.states[state] }),
                21 => {
                    let mut size = 0;
                    fmi2SerializedFMUstateSize(
                        c,
                        self.states[state],
                        if null { ptr::null_mut() } else { &raw mut size },
                    )
                }
                22 => {
                    let mut size = 0;
                    let status = fmi2SerializedFMUstateSize(c, self.states[state], &mut size);
                    let mut blob = vec![0; size];
                    if status == Status::Ok && self.blobs.len() < 10 {
                        let status = fmi2SerializeFMUstate(c, self.states[state], blob.as_mut_ptr(), size);
                        assert_eq!(status, Status::Ok);
                        self.blobs.push(blob);
                        status
                    } else {
                        fmi2SerializeFMUstate(c, self.states[state], blob.as_mut_ptr(), size / 2)
                    }
                }
                23 => {
                    let mut blob = self.blobs[self.random.below(self.blobs.len())].clone();
                    let bad = self.random.below(3) == 0 && !blob.is_empty();
                    if bad {
                        let byte = self.random.below(blob.len());
                        blob[byte] ^= 1 << self.random.below(8);
                    }
                    let mut made = ptr::null_mut();
                    let status = fmi2DeSerializeFMUstate(c, blob.as_ptr(), blob.len(), &mut made);
                    assert!(!(bad && status == Status::Ok), "an altered state was accepted");
                    if status == Status::Ok {
                        self.states.push(made);
                    }
                    status
                }
                24 => {
                    let knowns = self.references();
                    let changes = self.values(c, &knowns);
                    let status = fmi2GetDirectionalDerivative(
                        c,
                        r,
                        n,
                        knowns.as_ptr(),
                        knowns.len(),
                        changes.as_ptr(),
                        results.as_mut_ptr(),
                    );
                    if status == Status::Ok {
                        assert!(results.iter().all(|value| value.is_finite()));
                    }
                    status
                }
                25 => fmi2SetRealInputDerivatives(c, r, n, orders.as_ptr(), v),
                26 => fmi2GetRealOutputDerivatives(c, r, n, orders.as_ptr(), results.as_mut_ptr()),
                27 => {
                    let mut now = self.time;
                    fmi2GetRealStatus(c, LAST_SUCCESSFUL_TIME, &mut now);
                    let (time, size) = (self.random.number(now), self.random.pick(&[1e-6, 1e-5, 3e-5]));
                    // Wild steps would be honest work of hours.
                    let step =
                        self.random.pick(&[size, size, size, 0.0, -size, f64::NAN, f64::INFINITY, 1e-300]);
                    let time = if self.random.below(8) == 0 { time } else { now };
                    fmi2DoStep(c, time, step, 0)
                }
                28 => fmi2CancelStep(c),
                29 => {
                    let mut value = Status::Ok;
                    fmi2GetStatus(c, kind, if null { ptr::null_mut() } else { &raw mut value })
                }
                30 => {
                    let mut value = 0.0;
                    fmi2GetRealStatus(c, kind, if null { ptr::null_mut() } else { &raw mut value })
                }
                31 => {
                    let mut value = 0;
                    fmi2GetIntegerStatus(c, kind, &mut value)
                }
                32 => {
                    let mut value = 0;
                    fmi2GetBooleanStatus(c, kind, if null { ptr::null_mut() } else { &raw mut value })
                }
                _ => {
                    let mut value = ptr::null();
                    fmi2GetStringStatus(c, kind, &mut value)
                }
            }
        };
        assert!(status != Status::Fatal && status != Status::Pending, "function {function}: {status:?}");
        self.statuses[status as usize] += 1;
        // A refused step or start leaves little to do but a reset: go on from there, most of the time.
        if status == Status::Error && [7, 27].contains(&function) && self.random.below(4) > 0 {
            unsafe {
                if fmi2Reset(c) == Status::Ok {
                    initialise(c);
                    self.time = 0.0;
                }
            }
        }
    }
}

/// Random sequences of calls; returns how often each function was called and each status returned.
fn sequences(package: &Package, seeds: std::ops::Range<u64>) -> ([u32; 34], [u32; 6]) {
    let nonsense = ptr::without_provenance_mut(0xdead_beef);
    let mut hooligan = Hooligan {
        package,
        random: Random::new(0),
        components: vec![ptr::null_mut(), nonsense, package.instantiate()],
        states: vec![],
        blobs: vec![],
        time: 0.0,
        calls: [0; 34],
        statuses: [0; 6],
    };
    for seed in seeds {
        hooligan.random = Random::new(seed);
        hooligan.states = vec![ptr::null_mut(), nonsense, ptr::null_mut(), ptr::null_mut()];
        hooligan.blobs = vec![vec![], vec![0; 100]];
        hooligan.time = 0.0;
        // A fresh start: the last instance if it lives, another one if not. Dead ones stay in the list.
        let last = hooligan.components.len() - 1;
        unsafe {
            if fmi2Reset(hooligan.components[last]) != Status::Ok {
                hooligan.components.push(package.instantiate());
            }
        }
        for _ in 0..60 {
            hooligan.call();
        }
        let last = hooligan.components.len() - 1;
        for state in &mut hooligan.states {
            unsafe { fmi2FreeFMUstate(hooligan.components[last], state) };
        }
    }
    for c in hooligan.components {
        unsafe { fmi2FreeInstance(c) };
    }
    (hooligan.calls, hooligan.statuses)
}

#[test]
fn invariant_random_sequences_of_calls_do_no_harm() {
    // scripts/memory asks for fewer: they run under valgrind there.
    do_no_harm(std::env::var("ROULEMENT_SEQUENCES").map_or(50, |n| n.parse::<u64>().unwrap() / 2));
}

#[test]
#[ignore = "long"]
fn invariant_a_thousand_random_sequences_of_calls_do_no_harm() {
    do_no_harm(500);
}

/// Random sequences of calls on two kinds of packages, so many on each.
fn do_no_harm(half: u64) {
    let (pose, wrench) = (Package::new("p", &scene_text("pose")), Package::new("w", &scene_text("wrench")));
    let (calls, statuses) = sequences(&pose, 0..half);
    let (more_calls, more_statuses) = sequences(&wrench, half..2 * half);
    println!("calls {calls:?} {more_calls:?}, statuses {statuses:?} {more_statuses:?}");
    // The sequences reach everything: each function was called, and each kind of answer was given. In a few sequences how often is a
    // matter of chance, which another number of variables changes.
    let enough = if half < 100 { 0 } else { half };
    for (function, n) in calls.iter().zip(more_calls).map(|(a, b)| a + b).enumerate() {
        assert!(u64::from(n) > enough, "function {function} was called {n} times");
    }
    let total = |status: Status| u64::from(statuses[status as usize] + more_statuses[status as usize]);
    assert!(
        total(Status::Ok) > 20 * half
            && total(Status::Error) > 10 * half
            && 10 * total(Status::Discard) > half
    );
}

/// State after some steps with changing inputs.
fn run(package: &Package, steps: u32) -> Vec<u8> {
    let c = package.start();
    let force = package.reference("inner.applied_force.y");
    for k in 0..steps {
        let value = 10.0 * f64::from(k % 7);
        unsafe {
            assert_eq!(fmi2SetReal(c, &force, 1, &value), Status::Ok);
            assert_eq!(fmi2DoStep(c, f64::from(k) * 1e-4, 1e-4, 0), Status::Ok);
        }
    }
    let bytes = state_bytes(c);
    unsafe { fmi2FreeInstance(c) };
    bytes
}

#[test]
fn invariant_eight_instances_in_eight_threads_equal_serial_runs() {
    let package = Package::new("threads", &scene_text("wrench"));
    let serial: Vec<_> = (0..8).map(|k| run(&package, 20 + 5 * k)).collect();
    let parallel: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|k| {
                let package = &package;
                scope.spawn(move || run(package, 20 + 5 * k))
            })
            .collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert_eq!(serial, parallel);
    assert_ne!(serial[0], serial[1]);
}

#[test]
fn invariant_a_step_that_cannot_be_finished_is_left_at_the_last_time_reached() {
    // No step below 8 us is allowed.
    let steps =
        [("solver.initial_step", "\"10 us\""), ("solver.min_step", "\"8 us\""), ("solver.tolerance", "1e-3")];
    let package = Package::new("discard", &scene(&scene_text("wrench"), &steps).source);
    let c = package.start();
    let outputs: Vec<u32> = package
        .references(Causality::Output)
        .into_iter()
        .filter(|&r| !package.rows[r as usize].name.starts_with("integrator"))
        .collect();
    let force = package.reference("inner.applied_force.x");
    let mut saved = ptr::null_mut();
    unsafe {
        assert_eq!(fmi2DoStep(c, 0.0, 1e-4, 0), Status::Ok);
        assert_eq!(fmi2GetFMUstate(c, &mut saved), Status::Ok);
        // A force that grows too fast for that.
        assert_eq!(fmi2SetReal(c, &force, 1, &1e8), Status::Ok);
        assert_eq!(fmi2DoStep(c, 1e-4, 1e-2, 0), Status::Discard);
        let mut reached = 0.0;
        assert_eq!(fmi2GetRealStatus(c, LAST_SUCCESSFUL_TIME, &mut reached), Status::Ok);
        assert!((1e-4..1.01e-2).contains(&reached), "{reached}");
        let mut values = vec![f64::NAN; outputs.len()];
        assert_eq!(fmi2GetReal(c, outputs.as_ptr(), outputs.len(), values.as_mut_ptr()), Status::Ok);
        assert!(values.iter().all(|value| value.is_finite()));
        assert_eq!(fmi2DoStep(c, reached, 1e-5, 0), Status::Error);
        // An earlier state leads out of it, and goes on as if nothing had been.
        assert_eq!(fmi2SetFMUstate(c, saved), Status::Ok);
        assert_eq!(fmi2DoStep(c, 1e-4, 1e-4, 0), Status::Ok);
        let other = package.start();
        assert_eq!(fmi2DoStep(other, 0.0, 1e-4, 0), Status::Ok);
        assert_eq!(fmi2DoStep(other, 1e-4, 1e-4, 0), Status::Ok);
        assert_eq!(state_bytes(c), state_bytes(other));
        assert_eq!(fmi2FreeFMUstate(c, &mut saved), Status::Ok);
        fmi2FreeInstance(c);
        fmi2FreeInstance(other);
    }
}

unsafe extern "C" {
    fn setlocale(category: c_int, locale: *const c_char) -> *const c_char;
}

/// Control bits of the floating-point unit: rounding, exceptions, denormals.
#[cfg(target_arch = "x86_64")]
fn floating_point_control() -> u32 {
    let mut word = 0u32;
    unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &mut word) };
    // The lowest six bits say which exceptions have been seen, not what is done about them.
    word & !0x3f
}

#[test]
#[cfg(target_arch = "x86_64")]
fn invariant_the_host_keeps_its_rounding_locale_and_working_directory() {
    const LC_ALL: c_int = 6;
    let host = || {
        let locale = unsafe { CStr::from_ptr(setlocale(LC_ALL, ptr::null())) }.to_owned();
        (floating_point_control(), locale, std::env::current_dir().unwrap())
    };
    let before = host();
    let package = Package::new("host", &scene_text("wrench"));
    run(&package, 10);
    assert_eq!(host(), before);
    // A host that rounds differently finds its setting again, too.
    let mut word = before.0 | 0x6000;
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &word) };
    run(&package, 3);
    let kept = floating_point_control();
    word = before.0;
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &word) };
    assert_eq!(kept, before.0 | 0x6000);
}
