//! The report: one page of a run, of several runs, or of a sweep, that needs nothing beside itself.
//!
//! `roulement run` leaves a [`record`] beside its table; `roulement report` joins records, tables and the page's program, which is
//! built from `report/` and is part of this one.

pub mod bearing;
pub mod fields;
pub mod grid;
pub mod history;
pub mod html;
pub mod record;
pub mod shaft;
pub mod sweep;
pub mod table;
