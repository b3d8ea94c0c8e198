//! Campbell's figure: frequencies over the speed, and how fast motions grow or decay.

use std::path::Path;

use plotters::prelude::*;

use super::table::rpm;
use super::{Modes, Row};
use crate::report::fine::{FINE, Key, LINE, MARGIN, axes, headed, picture};
use crate::report::style::{Area, COLOURS, Drawn, PlotError};

/// \[pixel] size of a panel.
const PANEL: (u32, u32) = (640, 340);
/// \[pixel] space for the numbers at the axes.
const NUMBERS: [u32; 2] = [70, 45];
/// \[unit] radius of a mark.
const MARK: i32 = 3 * FINE as i32;
/// [-] of the largest frequency of the turn, what is shown beyond it at least.
const HIGHEST: f64 = 3.0;

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
        let mark = move |motion: &roulement::simulation::motions::Motion| Mark {
            speed,
            frequency: motion.frequency,
            growth: motion.growth,
            grows: motion.grows(),
        };
        motions.map(mark).collect::<Vec<_>>()
    };
    modes.rows.iter().flat_map(of_row).collect()
}

/// \[Hz] highest frequency that is shown: beyond all that grows, the sixth at the lowest speed, and the turn.
fn highest(modes: &Modes, marks: &[Mark]) -> f64 {
    let turn = fastest(modes) / 60.0;
    let low = modes.rows.iter().find_map(|row| {
        let motions = row.motions.as_ref().ok()?;
        motions.iter().take(6).last().map(|motion| motion.frequency)
    });
    let growing = marks.iter().filter(|mark| mark.grows).map(|mark| mark.frequency);
    growing.chain(low).chain([HIGHEST * turn]).fold(1.0, f64::max) * 1.1
}

/// \[rpm] largest speed of the table.
fn fastest(modes: &Modes) -> f64 {
    modes.rows.last().map_or(1.0, |row| rpm(row.speed))
}

const DECAYS: RGBColor = COLOURS[0];
const GROWS: RGBColor = COLOURS[1];
const TURN: RGBColor = COLOURS[6];

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
    let fastest = fastest(modes);
    let of_speed = |row: &Row| {
        let own = marks.iter().filter(|mark| mark.speed == rpm(row.speed));
        own.max_by(|a, b| a.growth.total_cmp(&b.growth)).copied()
    };
    let largest: Vec<Mark> = modes.rows.iter().filter_map(of_speed).collect();
    let (least, most) = largest
        .iter()
        .fold((0.0f64, 0.0f64), |(least, most), mark| (least.min(mark.growth), most.max(mark.growth)));
    let room = 0.05 * (most - least).max(1.0);
    let mut chart = ChartBuilder::on(&rest)
        .margin(MARGIN)
        .x_label_area_size(NUMBERS[1] * FINE)
        .y_label_area_size(NUMBERS[0] * FINE)
        .build_cartesian_2d(0.0..1.02 * fastest, least - room..most + room)?;
    axes(&mut chart.configure_mesh(), "speed [rpm]", "growth [1/s]").draw()?;
    chart.draw_series(LineSeries::new([(0.0, 0.0), (1.02 * fastest, 0.0)], TURN.stroke_width(LINE)))?;
    let points = largest.iter().map(|mark| (mark.speed, mark.growth));
    chart.draw_series(LineSeries::new(points, BLACK.stroke_width(LINE)))?;
    chart.draw_series(largest.iter().map(|mark| {
        let colour = if mark.grows { GROWS } else { DECAYS };
        Circle::new((mark.speed, mark.growth), MARK, colour.filled())
    }))?;
    Ok(())
}
