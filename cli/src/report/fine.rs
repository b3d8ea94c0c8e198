//! Pictures whose curves are finer than pixels: the library draws at whole units, so a picture has ten of them in a pixel.

use std::path::Path;

use plotters::chart::MeshStyle;
use plotters::coord::ranged1d::Ranged;
use plotters::prelude::*;

use super::style::{self, Area, Drawn, Font, GRID, PlotError, TITLE_HEIGHT};

/// [-] units in a pixel.
pub const FINE: u32 = 10;
/// Heading of a panel.
pub const CAPTION: Font = (style::CAPTION.0, style::CAPTION.1 * FINE);
/// Numbers at the axes, names of curves.
pub const LABEL: Font = (style::LABEL.0, style::LABEL.1 * FINE);
/// Quantities of the axes, and words beside panels.
pub const DESCRIPTION: Font = (style::DESCRIPTION.0, style::DESCRIPTION.1 * FINE);
const TITLE: Font = (style::TITLE.0, style::TITLE.1 * FINE);
/// \[unit] around a panel.
pub const MARGIN: u32 = style::MARGIN * FINE;
/// \[unit] width of a curve.
pub const LINE: u32 = 15;
/// \[unit] width of a letter of a curve's name, about.
const LETTER: f64 = 0.56 * (style::LABEL.1 * FINE) as f64;
/// \[unit] height of the strip above a panel that has its heading, and the names of its curves.
const STRIP: i32 = 24 * FINE as i32;

/// Draws a picture of `size` \[pixel] below its title.
///
/// # Errors
/// If the file cannot be written.
pub fn picture(
    path: &Path,
    size: (u32, u32),
    title: &str,
    draw: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<(), PlotError> {
    let size = (size.0, size.1 + TITLE_HEIGHT);
    let units = (size.0 * FINE, size.1 * FINE);
    let mut text = String::new();
    let drawn = || -> Drawn {
        {
            let root = SVGBackend::with_string(&mut text, units).into_drawing_area();
            root.fill(&WHITE)?;
            let (head, body) = root.split_vertically((TITLE_HEIGHT * FINE) as i32);
            head.draw(&Text::new(title.to_string(), (MARGIN as i32, MARGIN as i32), TITLE))?;
            draw(&body)?;
            root.present()?;
        }
        // Its view stays as fine as it is drawn.
        let [drawn, shown] =
            [units, size].map(|(width, height)| format!("<svg width=\"{width}\" height=\"{height}\""));
        Ok(std::fs::write(path, text.replacen(&drawn, &shown, 1))?)
    };
    drawn().map_err(|why| PlotError::new(path, why.as_ref()))
}

/// Gives a chart its axes and grid; the caller draws it.
pub fn axes<'m, 'a, 'b, 'c, X: Ranged, Y: Ranged>(
    mesh: &'m mut MeshStyle<'a, 'b, X, Y, SVGBackend<'c>>,
    x: &str,
    y: &str,
) -> &'m mut MeshStyle<'a, 'b, X, Y, SVGBackend<'c>> {
    // Lines between those with a label would be most of the file.
    mesh.max_light_lines(0)
        .x_desc(x)
        .y_desc(y)
        .bold_line_style(GRID.stroke_width(FINE))
        .axis_style(BLACK.stroke_width(FINE))
        .set_all_tick_mark_size(5 * FINE)
        .axis_desc_style(DESCRIPTION)
        .label_style(LABEL)
}

/// How a curve is named beside others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// By a line.
    Line,
    /// By a dot.
    Dot,
    /// By a pale field.
    Band,
}

/// Writes the heading of a panel and the names of its curves above it, outside the data; gives the rest of the panel.
///
/// # Errors
/// If the picture cannot be drawn.
pub fn headed<'a>(
    area: &Area<'a>,
    heading: &str,
    keys: &[(&str, Key, RGBColor)],
) -> Result<Area<'a>, Box<dyn std::error::Error>> {
    let (strip, rest) = area.split_vertically(STRIP);
    let left = MARGIN as i32;
    strip.draw(&Text::new(heading.to_string(), (left, 7 * FINE as i32), CAPTION))?;
    // From the right, so that they stand where the eye looks for them.
    let mut x = strip.dim_in_pixel().0 as i32 - left;
    for (name, key, colour) in keys.iter().rev() {
        x -= (name.chars().count() as f64 * LETTER) as i32;
        let (middle, fine) = (14 * FINE as i32, FINE as i32);
        strip.draw(&Text::new((*name).to_string(), (x, middle - 6 * fine), LABEL))?;
        x -= 24 * fine;
        let (from, to) = (x, x + 18 * fine);
        match key {
            Key::Line => {
                let line = [(from, middle), (to, middle)];
                strip.draw(&PathElement::new(line, colour.stroke_width(LINE)))?;
            }
            Key::Dot => {
                strip.draw(&Circle::new((from + 10 * fine, middle), 4 * fine, colour.filled()))?;
            }
            Key::Band => {
                let field = [(from, middle - 4 * fine), (to, middle + 4 * fine)];
                strip.draw(&Rectangle::new(field, colour.mix(BAND).filled()))?;
            }
        }
        x -= 12 * fine;
    }
    Ok(rest)
}

/// [-] how much of its colour a band has.
pub const BAND: f64 = 0.22;
