//! The functional mock-up interface of the shared library.

#[allow(non_snake_case)]
pub mod v2;
