//! Campbell's figure: frequencies over the speed, and how fast motions grow or decay.

use std::path::Path;

use plotters::prelude::*;

use super::table::rpm;
use super::{Found, Modes, Row};
use crate::report::fine::{FINE, Key, LINE, MARGIN, axes, headed, picture};
use crate::report::style::{Area, COLOURS, Drawn, PlotError};

/// \[pixel] size of a panel.
const PANEL: (u32, u32) = (640, 340);
/// \[pixel] space for the numbers at the axes.
const NUMBERS: [u32; 2] = [70, 45];
/// \[unit] radius of a mark.
const MARK: i32 = 3 * FINE as i32;
/// [-] of the largest frequency of the turn, what is shown at least.
const HIGHEST: f64 = 3.0;
/// [-] decay that is shown over the largest growth.
const DEEPEST: f64 = 0.3;
/// Motions at the lowest speed that are shown, from the lowest on.
const LOW: usize = 4;

const DECAYS: RGBColor = COLOURS[0];
const GROWS: RGBColor = COLOURS[1];
const TURN: RGBColor = COLOURS[6];

/// Draws the motions of a machine over its speed.
///
/// # Errors
/// If the file cannot be written.
pub fn write(modes: &Modes, path: &Path) -> Result<(), PlotError> {
    let title = if modes.title.is_empty() { "motions over the speed" } else { &modes.title };
    picture(path, (PANEL.0, 2 * PANEL.1), title, |body| {
        let (above, below) = body.split_vertically(PANEL.1 * FINE);
        let marks = marks(modes);
        frequencies(&above, modes, &marks)?;
        growths(&below, modes, &marks)
    })
}

/// A motion in the figure.
#[derive(Clone, Copy)]
struct Mark {
    /// \[rpm] speed.
    speed: f64,
    /// \[Hz] frequency.
    frequency: f64,
    /// [1/s] growth.
    growth: f64,
    grows: bool,
}

fn marks(modes: &Modes) -> Vec<Mark> {
    let of_row = |row: &Row| {
        let speed = rpm(row.speed);
        let motions = row.motions.as_ref().map_or(&[][..], Vec::as_slice).iter();
        let mark = move |found: &Found| Mark {
            speed,
            frequency: found.motion.frequency,
            growth: found.motion.growth,
            grows: found.grows(),
        };
        motions.map(mark).collect::<Vec<_>>()
    };
    modes.rows.iter().flat_map(of_row).collect()
}

/// \[Hz] highest frequency that is shown: beyond all that grows, the fourth at the lowest speed, and the turn.
fn highest(modes: &Modes, marks: &[Mark]) -> f64 {
    let turn = fastest(modes) / 60.0;
    let low = modes.rows.iter().find_map(|row| {
        let motions = row.motions.as_ref().ok()?;
        motions.iter().take(LOW).next_back().map(|found| found.motion.frequency)
    });
    let growing = marks.iter().filter(|mark| mark.grows).map(|mark| mark.frequency);
    growing.chain(low).chain([HIGHEST * turn]).fold(1.0, f64::max) * 1.1
}

/// \[rpm] largest speed of the table.
fn fastest(modes: &Modes) -> f64 {
    modes.rows.last().map_or(1.0, |row| rpm(row.speed))
}

fn frequencies(area: &Area<'_>, modes: &Modes, marks: &[Mark]) -> Drawn {
    let keys = [("decays", Key::Dot, DECAYS), ("grows", Key::Dot, GROWS), ("the turn", Key::Line, TURN)];
    let rest = headed(area, "frequency", &keys)?;
    let (fastest, highest) = (fastest(modes), highest(modes, marks));
    let mut chart = ChartBuilder::on(&rest)
        .margin(MARGIN)
        .x_label_area_size(NUMBERS[1] * FINE)
        .y_label_area_size(NUMBERS[0] * FINE)
        .build_cartesian_2d(0.0..1.02 * fastest, 0.0..highest)?;
    axes(&mut chart.configure_mesh(), "speed [rpm]", "frequency [Hz]").draw()?;
    let turn = [(0.0, 0.0), (fastest, fastest / 60.0)];
    chart.draw_series(LineSeries::new(turn, TURN.stroke_width(LINE)))?;
    let shown = marks.iter().filter(|mark| mark.frequency <= highest);
    chart.draw_series(shown.map(|mark| {
        let colour = if mark.grows { GROWS } else { DECAYS };
        Circle::new((mark.speed, mark.frequency), MARK, colour.filled())
    }))?;
    Ok(())
}

fn growths(area: &Area<'_>, modes: &Modes, marks: &[Mark]) -> Drawn {
    let rest = headed(area, "growth of what grows fastest", &[])?;
    growth_chart(&rest, &[(BLACK, fastest_growing(modes, marks))])
}

/// Motion that grows fastest at each speed, or decays slowest.
fn fastest_growing(modes: &Modes, marks: &[Mark]) -> Vec<Mark> {
    let of_speed = |row: &Row| {
        let own = marks.iter().filter(|mark| mark.speed == rpm(row.speed));
        own.max_by(|a, b| a.growth.total_cmp(&b.growth)).copied()
    };
    modes.rows.iter().filter_map(of_speed).collect()
}

fn growth_chart(area: &Area<'_>, curves: &[(RGBColor, Vec<Mark>)]) -> Drawn {
    let all = || curves.iter().flat_map(|(_, marks)| marks);
    let fastest = all().map(|mark| mark.speed).fold(1.0, f64::max);
    let most = all().map(|mark| mark.growth).fold(0.0, f64::max);
    let least = all().map(|mark| mark.growth).fold(0.0, f64::min);
    // What decays fast is at the lower edge: how fast is of no account beside what grows.
    let least = if most > 0.0 { least.max(-DEEPEST * most) } else { least };
    let place = |mark: &Mark| (mark.speed, mark.growth.max(least));
    let room = 0.05 * (most - least).max(1.0);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(NUMBERS[1] * FINE)
        .y_label_area_size(NUMBERS[0] * FINE)
        .build_cartesian_2d(0.0..1.02 * fastest, least - room..most + room)?;
    axes(&mut chart.configure_mesh(), "speed [rpm]", "growth [1/s]").draw()?;
    chart.draw_series(LineSeries::new([(0.0, 0.0), (1.02 * fastest, 0.0)], TURN.stroke_width(LINE)))?;
    for (colour, marks) in curves {
        let points = marks.iter().map(place);
        chart.draw_series(LineSeries::new(points, colour.stroke_width(LINE)))?;
        let filled = |mark: &Mark| match curves.len() {
            1 if mark.grows => GROWS,
            1 => DECAYS,
            _ => *colour,
        };
        chart.draw_series(marks.iter().map(|mark| Circle::new(place(mark), MARK, filled(mark).filled())))?;
    }
    Ok(())
}

/// Draws what grows fastest in several machines over their speed, a curve for each under its title.
///
/// # Errors
/// If the file cannot be written.
pub fn write_growths(all: &[Modes], path: &Path) -> Result<(), PlotError> {
    let coloured = || all.iter().zip(COLOURS.iter().cycle());
    let curves: Vec<_> =
        coloured().map(|(modes, colour)| (*colour, fastest_growing(modes, &marks(modes)))).collect();
    let keys: Vec<_> = coloured().map(|(modes, colour)| (modes.title.as_str(), Key::Line, *colour)).collect();
    picture(path, (PANEL.0 + 160, PANEL.1), "growth of what grows fastest", |body| {
        let rest = headed(body, "", &keys)?;
        growth_chart(&rest, &curves)
    })
}
