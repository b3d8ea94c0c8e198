//! Campbell's figure: frequencies over the speed, and how fast motions grow or decay.

use std::path::Path;

use plotters::prelude::*;

use super::lines::{Line, Source};
use super::table::rpm;
use super::{Found, Modes, Row};
use crate::report::fine::{FINE, Key, LABEL, LINE, MARGIN, axes, headed, picture};
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
const MESH: RGBColor = COLOURS[2];
const OF_BEARING: RGBColor = COLOURS[5];
/// [-] room beside the largest speed, over that, and above a panel's highest frequency, over that: for the names of lines.
const BESIDE: f64 = 0.16;
const ABOVE: f64 = 0.05;
/// [-] of the highest frequency, how far apart names beside a panel stand; of the largest speed, those above it.
const ROW: f64 = 0.05;
const COLUMN: f64 = 0.12;
/// \[unit] dash and gap of multiples.
const DASH: (i32, i32) = (4 * FINE as i32, 4 * FINE as i32);

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

/// \[Hz] highest frequency that is shown: beyond all that grows, the fourth at the lowest speed, the turn, and the teeth.
fn highest(modes: &Modes, marks: &[Mark]) -> f64 {
    let turn = fastest(modes) / 60.0;
    let low = modes.rows.iter().find_map(|row| {
        let motions = row.motions.as_ref().ok()?;
        motions.iter().take(LOW).next_back().map(|found| found.motion.frequency)
    });
    let growing = marks.iter().filter(|mark| mark.grows).map(|mark| mark.frequency);
    let teeth =
        modes.lines.iter().filter(|line| line.source == Source::Mesh).map(|line| line.per_turn * turn);
    growing.chain(low).chain(teeth).chain([HIGHEST * turn]).fold(1.0, f64::max) * 1.1
}

/// \[rpm] largest speed of the table.
fn fastest(modes: &Modes) -> f64 {
    modes.rows.last().map_or(1.0, |row| rpm(row.speed))
}

fn frequencies(area: &Area<'_>, modes: &Modes, marks: &[Mark]) -> Drawn {
    let has = |source| modes.lines.iter().any(|line| line.source == source);
    let mut keys = vec![("decays", Key::Dot, DECAYS), ("grows", Key::Dot, GROWS), ("turns", Key::Line, TURN)];
    if has(Source::Mesh) {
        keys.push(("teeth", Key::Line, MESH));
    }
    if has(Source::Bearing) {
        keys.push(("bearings", Key::Line, OF_BEARING));
    }
    let rest = headed(area, "frequency", &keys)?;
    let (fastest, highest) = (fastest(modes), highest(modes, marks));
    let mut chart = ChartBuilder::on(&rest)
        .margin(MARGIN)
        .x_label_area_size(NUMBERS[1] * FINE)
        .y_label_area_size(NUMBERS[0] * FINE)
        .build_cartesian_2d(0.0..(1.0 + BESIDE) * fastest, 0.0..(1.0 + ABOVE) * highest)?;
    axes(&mut chart.configure_mesh(), "speed [rpm]", "frequency [Hz]").draw()?;
    // Names from the steepest line on, each where there is room; lines whose names have none are in the text.
    let mut named: Vec<(f64, f64)> = vec![];
    for (line, multiple) in drawn(&modes.lines) {
        let (colour, width) = match line.source {
            Source::Turn => (TURN, LINE),
            Source::Mesh => (MESH, LINE),
            Source::Bearing => (OF_BEARING, FINE),
        };
        let slope = f64::from(multiple) * line.per_turn / 60.0;
        let end = fastest.min(highest / slope);
        let ends = [(0.0, 0.0), (end, slope * end)];
        if multiple > 1 {
            chart.draw_series(DashedLineSeries::new(ends, DASH.0, DASH.1, colour.stroke_width(FINE)))?;
        } else {
            chart.draw_series(LineSeries::new(ends, colour.stroke_width(width)))?;
        }
        let beside = |(x, y): &(f64, f64)| {
            (x - end).abs() < COLUMN * fastest && (y - slope * end).abs() < ROW * highest
        };
        if multiple == 1 && !named.iter().any(beside) {
            named.push((end, slope * end));
            let above = if end < fastest { 0.6 * ROW * highest } else { 0.4 * ROW * highest };
            let style = LABEL.into_font().color(&colour);
            chart.draw_series([Text::new(format!(" {}", line.name), (end, slope * end + above), style)])?;
        }
    }
    let shown = marks.iter().filter(|mark| mark.frequency <= highest);
    chart.draw_series(shown.map(|mark| {
        let colour = if mark.grows { GROWS } else { DECAYS };
        Circle::new((mark.speed, mark.frequency), MARK, colour.filled())
    }))?;
    Ok(())
}

/// Lines and their multiples, those of shafts and meshes first, the steepest ones of each first.
fn drawn(lines: &[Line]) -> Vec<(&Line, u32)> {
    let mut all: Vec<_> =
        lines.iter().flat_map(|line| (1..=line.multiples()).map(move |multiple| (line, multiple))).collect();
    all.sort_by(|(one, _), (other, _)| {
        let is_of_bearing = |line: &Line| line.source == Source::Bearing;
        is_of_bearing(one).cmp(&is_of_bearing(other)).then(other.per_turn.total_cmp(&one.per_turn))
    });
    all
}

fn growths(area: &Area<'_>, modes: &Modes, marks: &[Mark]) -> Drawn {
    let rest = headed(area, "growth of what grows fastest", &[])?;
    growth_chart(&rest, &[(BLACK, fastest_growing(modes, marks))])
}

/// [1/s] growth of a motion of balls below which it is not said to grow.
const SLIGHT: f64 = 30.0;

/// Motion that grows fastest at each speed, or decays slowest. What grows beyond [`SLIGHT`] and is not said to grow is of contacts that stick: none.
fn fastest_growing(modes: &Modes, marks: &[Mark]) -> Vec<Mark> {
    let of_speed = |row: &Row| {
        let own = marks.iter().filter(|mark| mark.speed == rpm(row.speed));
        let own = own.filter(|mark| mark.grows || mark.growth < SLIGHT);
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
