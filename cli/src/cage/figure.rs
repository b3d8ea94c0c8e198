//! Orbits of the centre of a cage, a panel for each push.

use std::f64::consts::TAU;
use std::path::Path;

use plotters::prelude::*;

use super::{Cage, Orbit};
use crate::report::fine::{FINE, Key, LABEL, headed, picture};
use crate::report::style::{Area, COLOURS, Drawn, GRID, PlotError};

const PANEL: (u32, u32) = (340, 360);
/// \[pixel] around the play, for its name.
const AIR: i32 = 26;
/// \[unit] width of the way: thinner than a curve, as it crosses itself.
const WAY: u32 = 6;
const PLAY: RGBColor = COLOURS[6];

/// Draws the orbits of a cage.
///
/// # Errors
/// If the file cannot be written.
pub fn write(cage: &Cage, title: &str, path: &Path) -> Result<(), PlotError> {
    let done: Vec<_> =
        cage.pushed.iter().filter_map(|(push, orbit)| Some((push, orbit.as_ref().ok()?))).collect();
    let columns = done.len().clamp(1, 2);
    let rows = done.len().div_ceil(columns).max(1);
    let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
    picture(path, size, title, |body| {
        let areas = body.split_evenly((rows, columns));
        done.iter().zip(&areas).try_for_each(|((push, orbit), area)| {
            panel(area, &format!("{}: {}", push.name(), orbit.kind.name()), orbit)
        })
    })
}

fn panel(area: &Area<'_>, heading: &str, orbit: &Orbit) -> Drawn {
    let keys = [("centre", Key::Line, COLOURS[0]), ("play", Key::Line, PLAY)];
    let area = headed(area, heading, &keys)?;
    let (width, height) = area.dim_in_pixel();
    let middle = (width as i32 / 2, height as i32 / 2);
    let reach = f64::from(middle.0.min(middle.1) - AIR * FINE as i32);
    // A little beyond the play, where contacts give way.
    let most = orbit.eccentricity.max(1.0);
    let place =
        |[y, z]: [f64; 2]| (middle.0 + (reach * y / most) as i32, middle.1 - (reach * z / most) as i32);
    let circle: Vec<_> =
        (0..=180).map(|k| TAU * f64::from(k) / 180.0).map(|a| place([a.cos(), a.sin()])).collect();
    area.draw(&PathElement::new(vec![place([-most, 0.0]), place([most, 0.0])], GRID.stroke_width(FINE)))?;
    area.draw(&PathElement::new(vec![place([0.0, -most]), place([0.0, most])], GRID.stroke_width(FINE)))?;
    area.draw(&PathElement::new(circle, PLAY.stroke_width(FINE)))?;
    let way: Vec<_> = orbit.way.iter().copied().map(place).collect();
    if let Some(end) = way.last() {
        area.draw(&Circle::new(*end, 3 * FINE as i32, COLOURS[0].filled()))?;
    }
    area.draw(&PathElement::new(way, COLOURS[0].stroke_width(WAY)))?;
    let fine = FINE as i32;
    for (text, (x, y)) in [("+y", place([most, 0.0])), ("+z", place([0.0, most]))] {
        area.draw(&Text::new(text, (x + 4 * fine, y - 14 * fine), LABEL))?;
    }
    Ok(())
}
