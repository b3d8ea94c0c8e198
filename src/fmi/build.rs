//! Which build a library is of: a program packs the one that was built together with it.
#![allow(unsafe_code)]

/// Text that is in the library, with a number of its sources and settings (`build.rs` of the crate).
pub const BUILD: &str = concat!("roulement build ", env!("ROULEMENT_BUILD"));

/// Keeps the text in the library.
#[unsafe(no_mangle)]
pub static ROULEMENT_BUILD: &str = BUILD;
