//! Style of all plots: fonts, colours, grid.

use std::error::Error;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use thiserror::Error;

/// Why a plot could not be written.
#[derive(Debug, Error)]
#[error("cannot draw {path}: {why}")]
pub struct PlotError {
    path: String,
    why: String,
}

impl PlotError {
    /// Error about a file.
    pub fn new(path: &Path, why: &dyn Error) -> Self {
        Self { path: path.display().to_string(), why: why.to_string() }
    }
}

/// A part of a picture.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Outcome of drawing.
pub type Drawn = Result<(), Box<dyn Error>>;
/// A font: family and size \[pixel].
pub type Font = (&'static str, u32);

const FAMILY: &str = "sans-serif";
/// Title of a picture.
pub const TITLE: Font = (FAMILY, 20);
/// Heading of a panel.
pub const CAPTION: Font = (FAMILY, 15);
/// Quantities of the axes, and words beside panels.
pub const DESCRIPTION: Font = (FAMILY, 13);
/// Numbers at the axes, names of curves.
pub const LABEL: Font = (FAMILY, 12);
/// \[pixel] height of a picture's title.
pub const TITLE_HEIGHT: u32 = 40;
/// \[pixel] around a panel.
pub const MARGIN: u32 = 10;

/// Colour-blind safe colours (Okabe and Ito).
pub const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(120, 120, 120),
];
/// Colour of grids.
pub const GRID: RGBColor = RGBColor(215, 215, 215);
