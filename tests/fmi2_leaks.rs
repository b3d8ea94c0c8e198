//! Memory of long runs and many instances. A file, hence a process, of its own: it looks at what the process takes.
#![cfg(all(target_os = "linux", target_env = "gnu"))]
#![allow(clippy::unwrap_used, unsafe_code)]
#![allow(clippy::undocumented_unsafe_blocks)] // every pointer in here lives through its call

mod fmi2_abi;

use std::ptr;

use fmi2_abi::*;
use roulement::fmi::v2::Status;

unsafe extern "C" {
    /// glibc: gives free memory back to the system.
    fn malloc_trim(pad: usize) -> i32;
}

/// [kB] memory that this process has for itself: pages of its files come and go with the machine, and free memory that the
/// allocator keeps goes to and fro by half a megabyte.
fn resident() -> f64 {
    unsafe { malloc_trim(0) };
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("RssAnon:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// Grows by how many kB over these numbers of steps and of instances.
fn growth(n_steps: u32, n_instances: u32) -> f64 {
    let package = Package::new("leaks", &scene_text("wrench"));
    let c = package.start();
    let (force, applied) = (package.reference("inner.force.x"), package.reference("inner.applied_force.x"));
    let mut derivative = 0.0;
    let mut time = 0.0;
    let mut steps = |n: u32| {
        for k in 0..n {
            unsafe {
                assert_eq!(fmi2DoStep(c, time, 1e-6, 0), Status::Ok);
                if k % 100 == 0 {
                    let status =
                        fmi2GetDirectionalDerivative(c, &force, 1, &applied, 1, &1.0, &mut derivative);
                    assert_eq!(status, Status::Ok);
                }
            }
            time += 1e-6;
        }
    };
    let cycles = |n: u32| {
        for _ in 0..n {
            let c = package.start();
            let bytes = state_bytes(c);
            let mut state = ptr::null_mut();
            unsafe {
                assert_eq!(fmi2DeSerializeFMUstate(c, bytes.as_ptr(), bytes.len(), &mut state), Status::Ok);
                assert_eq!(fmi2SetFMUstate(c, state), Status::Ok);
                assert_eq!(fmi2FreeFMUstate(c, &mut state), Status::Ok);
                fmi2FreeInstance(c);
            }
        }
    };
    // What the allocator keeps for itself it has after the first few.
    steps(10_000);
    cycles(10);
    let before = resident();
    steps(n_steps);
    cycles(n_instances);
    let grown = resident() - before;
    unsafe { fmi2FreeInstance(c) };
    println!("{grown} kB more after {n_steps} steps and {n_instances} instances");
    grown
}

#[test]
fn invariant_neither_steps_nor_instances_nor_states_leak() {
    // One leaked state of 6 kB per instance would be 0.3 MB, one leaked vector of 32 bytes per step 3 MB.
    let grown = growth(100_000, 50);
    assert!(grown < 250.0, "{grown} kB more");
}

#[test]
#[ignore = "takes minutes; scripts/soak runs it"]
fn invariant_a_thousand_instances_do_not_leak() {
    let grown = growth(1000, 1000);
    assert!(grown < 500.0, "{grown} kB more");
}
