//! The library stays loaded once it has been used: an importer may unload it while instances live, and start another one.
//! On Linux, a flag of the linker sees to that (`build.rs`).
#![allow(unsafe_code)]

/// Keeps the library in the process until that ends.
#[cfg(windows)]
pub fn stay_loaded() {
    use std::ffi::c_void;

    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn GetModuleHandleExW(flags: u32, address: *const c_void, module: *mut *mut c_void) -> i32;
    }
    const PIN: u32 = 1;
    const FROM_ADDRESS: u32 = 4;
    let mut module = std::ptr::null_mut();
    let here = stay_loaded as fn() as *const c_void;
    // SAFETY: an address within this library, as the flag says, and a place for the handle.
    unsafe { GetModuleHandleExW(PIN | FROM_ADDRESS, here, &mut module) };
}

/// Nothing to do.
#[cfg(not(windows))]
pub fn stay_loaded() {}
