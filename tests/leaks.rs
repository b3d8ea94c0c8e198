//! Memory of long runs and many instances. A file, hence a process, of its own: it looks at what the process takes.
#![cfg(all(target_os = "linux", target_env = "gnu"))]
#![allow(clippy::unwrap_used, unsafe_code)]
#![allow(clippy::undocumented_unsafe_blocks)] // every pointer in here lives through its call

mod fmi2_abi;

use std::ptr;

use fmi2_abi::*;
use roulement::fmi::v2::Status;

/// glibc's `struct mallinfo2`: what its allocator has handed out and keeps.
#[repr(C)]
struct AllocatorInfo {
    /// In the order of the manual: `arena`, `ordblks`, `smblks`, `hblks`.
    _kept: [usize; 4],
    /// [B] `hblkhd`: handed out as pages of their own.
    large: usize,
    /// `usmblks`, `fsmblks`.
    _unused: [usize; 2],
    /// [B] `uordblks`: handed out.
    small: usize,
    /// `fordblks`, `keepcost`.
    _free: [usize; 2],
}

unsafe extern "C" {
    /// Sums over all arenas.
    fn mallinfo2() -> AllocatorInfo;
}

/// [kB] memory that has been asked for and not been given back. Pages of the process say less: the allocator keeps free ones,
/// which come and go by half a megabyte from run to run. What a thread keeps for its next requests counts here, some 80 kB.
fn in_use() -> f64 {
    let info = unsafe { mallinfo2() };
    (info.large + info.small) as f64 / 1024.0
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
    let before = in_use();
    steps(n_steps);
    cycles(n_instances);
    let grown = in_use() - before;
    unsafe { fmi2FreeInstance(c) };
    println!("{grown} kB more after {n_steps} steps and {n_instances} instances");
    grown
}

#[test]
fn invariant_neither_steps_nor_instances_nor_states_leak() {
    // One leaked state of 6 kB per instance would be 300 kB, one leaked vector of 32 bytes per step 3 MB.
    let grown = growth(100_000, 50);
    assert!(grown < 200.0, "{grown} kB more");
}

#[test]
#[ignore = "takes minutes; scripts/soak runs it"]
fn invariant_a_thousand_instances_do_not_leak() {
    // One leaked vector of 256 bytes per instance would be 250 kB.
    let grown = growth(1000, 1000);
    assert!(grown < 200.0, "{grown} kB more");
}
