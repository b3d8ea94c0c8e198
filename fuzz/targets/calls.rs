//! Bytes as calls of the C functions of both versions, with arrays and without: any order, any references, any numbers. Nothing is fatal, and no value
//! that is given out is none.
#![no_main]

use std::cell::OnceCell;
use std::ptr;

use libfuzzer_sys::fuzz_target;
use roulement::fmi::{v2, v3};

#[path = "../../tests/fmi2_abi/mod.rs"]
mod fmi2_abi;
#[path = "../../tests/fmi/fmi3_abi.rs"]
mod fmi3_abi;

use fmi2_abi::*;
use fmi3_abi::*;

/// [-] most calls of one input, most references and most values of a call.
const CALLS: usize = 60;
const REFERENCES: usize = 8;
const VALUES: usize = 64;

/// Bytes that calls are made of; zeros where they end.
struct Source<'a>(&'a [u8]);

impl Source<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        *first
    }

    fn number(&mut self) -> f64 {
        match self.byte() % 8 {
            0 => f64::from_le_bytes(std::array::from_fn(|_| self.byte())),
            1 => [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300, 1e-300, -0.0, 1e9][usize::from(self.byte() % 8)],
            2 => 1000.0 * f64::from(self.byte()),
            _ => 1e-7 * f64::from(self.byte()),
        }
    }

    /// Some references, and how many values the call says that they have.
    fn references(&mut self, rows: usize) -> (Vec<u32>, usize) {
        let n = usize::from(self.byte()) % (REFERENCES + 1);
        let references = (0..n).map(|_| match self.byte() {
            255 => u32::MAX,
            // Behind the rows are time, rates and arrays.
            byte => (usize::from(byte) * (rows + 40) / 255) as u32,
        });
        let references: Vec<u32> = references.collect();
        let m = if self.byte() % 2 == 0 { n } else { usize::from(self.byte()) % (VALUES + 1) };
        (references, m)
    }

    fn numbers(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.number()).collect()
    }
}

/// Packages with an instance of each, made once; a reset begins every input.
struct Subject {
    second: (Package, Component),
    third: [(Package, Slave); 2],
}

impl Subject {
    fn new() -> Self {
        let package = Package::new("fuzz-2", &scene_text("wrench"));
        let component = package.instantiate();
        let third = [scene_text("wrench"), format!("{}\n[interface]\narrays = true\n", scene_text("pose"))];
        let third = third.map(|text| Package::new("fuzz-3", &text)).map(|package| {
            let slave = Slave::new(&package);
            (package, slave)
        });
        Self { second: (package, component), third }
    }
}

fn finite(ok: bool, values: &[f64]) {
    assert!(!ok || values.iter().all(|value| value.is_finite()), "{values:?}");
}

/// One call of FMI 3.0.
unsafe fn third(c: Handle, rows: usize, source: &mut Source<'_>, blob: &mut Vec<u8>) -> v3::Status {
    let choice = source.byte();
    let (references, m) = source.references(rows);
    let (r, n) = (references.as_ptr(), references.len());
    let mut found = vec![0.5; m];
    let f = found.as_mut_ptr();
    unsafe {
        match choice % 16 {
            0 | 1 => {
                let status = fmi3GetFloat64(c, r, n, f, m);
                finite(status == v3::Status::Ok, &found);
                status
            }
            2 | 3 => fmi3SetFloat64(c, r, n, source.numbers(m).as_ptr(), m),
            4 => fmi3EnterInitializationMode(c, false, 0.0, source.number(), choice > 127, source.number()),
            5 => fmi3ExitInitializationMode(c),
            6 => {
                fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0);
                fmi3ExitInitializationMode(c)
            }
            7 | 8 => {
                let mut now = source.number();
                if choice < 200 {
                    fmi3GetFloat64(c, &(rows as u32), 1, &mut now, 1);
                }
                // Longer steps would take the time of many calls.
                Slave(c).step(now, source.number().min(1e-4)).0
            }
            9 => {
                let (others, k) = source.references(rows);
                let seed = source.numbers(k);
                let (o, s) = (others.as_ptr(), seed.as_ptr());
                let status = fmi3GetDirectionalDerivative(c, r, n, o, others.len(), s, k, f, m);
                finite(status == v3::Status::Ok, &found);
                status
            }
            10 => {
                let (others, k) = source.references(rows);
                let seed = source.numbers(k);
                let (o, s) = (others.as_ptr(), seed.as_ptr());
                let status = fmi3GetAdjointDerivative(c, o, others.len(), r, n, s, k, f, m);
                finite(status == v3::Status::Ok, &found);
                status
            }
            11 => {
                let orders: Vec<i32> = (0..n).map(|_| i32::from(source.byte() % 3)).collect();
                let status = fmi3GetOutputDerivatives(c, r, n, orders.as_ptr(), f, m);
                finite(status == v3::Status::Ok, &found);
                status
            }
            12 => fmi3GetInt64(c, r, n, vec![0; m].as_mut_ptr(), m),
            13 => {
                let mut state = ptr::null_mut();
                if choice > 127 && !blob.is_empty() {
                    let at = usize::from(source.byte()) * blob.len() / 256;
                    blob[at] ^= source.byte();
                    let status = fmi3DeserializeFMUState(c, blob.as_ptr(), blob.len(), &mut state);
                    fmi3SetFMUState(c, state);
                    fmi3FreeFMUState(c, &mut state);
                    status
                } else {
                    let status = fmi3GetFMUState(c, &mut state);
                    if status == v3::Status::Ok {
                        fmi3FreeFMUState(c, &mut state);
                        *blob = Slave(c).state_bytes();
                    }
                    status
                }
            }
            14 if choice > 127 => fmi3Terminate(c),
            14 => fmi3Reset(c),
            _ => fmi3GetString(c, r, n, ptr::null_mut(), m),
        }
    }
}

/// One call of FMI 2.0.
unsafe fn second(c: Component, rows: usize, source: &mut Source<'_>) -> v2::Status {
    let choice = source.byte();
    let (references, _) = source.references(rows);
    let (r, n) = (references.as_ptr(), references.len());
    let mut found = vec![0.5; n];
    let f = found.as_mut_ptr();
    unsafe {
        match choice % 12 {
            0 | 1 => {
                let status = fmi2GetReal(c, r, n, f);
                finite(status == v2::Status::Ok, &found);
                status
            }
            2 | 3 => fmi2SetReal(c, r, n, source.numbers(n).as_ptr()),
            4 => fmi2SetupExperiment(c, 0, 0.0, source.number(), i32::from(choice > 127), source.number()),
            5 => fmi2EnterInitializationMode(c),
            6 => fmi2ExitInitializationMode(c),
            7 | 8 => {
                let mut now = source.number();
                if choice < 200 {
                    fmi2GetRealStatus(c, LAST_SUCCESSFUL_TIME, &mut now);
                }
                fmi2DoStep(c, now, source.number().min(1e-4), 0)
            }
            9 => {
                let (others, _) = source.references(rows);
                let seed = source.numbers(others.len());
                let status =
                    fmi2GetDirectionalDerivative(c, r, n, others.as_ptr(), others.len(), seed.as_ptr(), f);
                finite(status == v2::Status::Ok, &found);
                status
            }
            10 => fmi2SetRealInputDerivatives(c, r, n, vec![1; n].as_ptr(), source.numbers(n).as_ptr()),
            _ if choice > 200 => fmi2Terminate(c),
            _ => fmi2Reset(c),
        }
    }
}

thread_local! {
    static SUBJECT: OnceCell<Subject> = const { OnceCell::new() };
}

fuzz_target!(|bytes: &[u8]| {
    SUBJECT.with(|subject| {
        let Subject { second: (package, component), third: others } = subject.get_or_init(Subject::new);
        let mut source = Source(bytes);
        let version = source.byte() % 3;
        let mut blob = vec![];
        match version {
            0 => assert_eq!(unsafe { fmi2Reset(*component) }, v2::Status::Ok),
            other => assert_eq!(unsafe { fmi3Reset(others[usize::from(other) - 1].1.0) }, v3::Status::Ok),
        }
        for _ in 0..CALLS {
            if source.0.is_empty() {
                break;
            }
            match version {
                0 => {
                    let status = unsafe { second(*component, package.rows.len(), &mut source) };
                    assert_ne!(status, v2::Status::Fatal);
                }
                other => {
                    let (package, slave) = &others[usize::from(other) - 1];
                    let status = unsafe { third(slave.0, package.rows.len(), &mut source, &mut blob) };
                    assert_ne!(status, v3::Status::Fatal);
                }
            }
        }
    });
});
