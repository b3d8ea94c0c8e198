//! Quantities of all balls over their azimuth, as polar plots.

use std::f64::consts::TAU;
use std::path::Path;

use plotters::prelude::*;
use roulement::simulation::outputs::{BallOutput, ContactOutput, Outputs};

use super::fine::{FINE, Key, LABEL, LINE, headed, picture};
use super::style::{Area, COLOURS, Drawn, GRID, PlotError};

const PANEL: (u32, u32) = (480, 440);
/// [-] rings of the grid.
const RINGS: u32 = 4;
/// \[pixel] around the largest ring, for the azimuths.
const AIR: i32 = 34;

type Contact = fn(&BallOutput) -> &ContactOutput;
const RACES: [(&str, Contact); 2] = [("inner race", |ball| &ball.inner), ("outer race", |ball| &ball.outer)];

/// A panel: heading, and the quantity of a contact.
type Quantity = (&'static str, fn(&ContactOutput) -> f64);
const QUANTITIES: [Quantity; 4] = [
    ("load [N]", |c| c.load),
    ("contact angle [deg]", |c| c.contact_angle.to_degrees()),
    ("peak pressure [MPa]", |c| c.peak_pressure * 1e-6),
    ("friction power [W]", |c| c.power),
];

/// Draws all balls of a row; quantities that are 0 for all of them are left out.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, title: &str, row: &Outputs) -> Result<(), PlotError> {
    let is_something =
        |(_, get): &Quantity| row.balls.iter().any(|ball| RACES.iter().any(|(_, of)| get(of(ball)) != 0.0));
    let shown: Vec<_> = QUANTITIES.into_iter().filter(is_something).collect();
    let columns = 2;
    let rows = shown.len().div_ceil(columns).max(1);
    picture(path, (PANEL.0 * columns as u32, PANEL.1 * rows as u32), title, |body| {
        let areas = body.split_evenly((rows, columns));
        shown.iter().zip(&areas).try_for_each(|(quantity, area)| panel(row, quantity, area))
    })
}

/// A round number at or above one.
fn round(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let steps = [1.0, 1.2, 1.6, 2.0, 2.4, 3.2, 4.0, 5.0, 6.0, 8.0, 10.0];
    steps
        .into_iter()
        .map(|step| step * power)
        .find(|step| *step >= value * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

fn panel(row: &Outputs, (heading, get): &Quantity, area: &Area<'_>) -> Drawn {
    let keys: Vec<_> =
        RACES.iter().zip(COLOURS).map(|((name, _), colour)| (*name, Key::Dot, colour)).collect();
    let area = headed(area, &format!("{heading} over azimuth [deg]"), &keys)?;
    let (width, height) = area.dim_in_pixel();
    let fine = FINE as i32;
    let middle = (width as i32 / 2, height as i32 / 2);
    let reach = f64::from(middle.0.min(middle.1) - AIR * fine);
    let values = || row.balls.iter().flat_map(|ball| RACES.map(|(_, of)| get(of(ball))));
    let most = round(values().fold(0.0, f64::max).max(f64::MIN_POSITIVE));
    // Below 0 the middle of the picture lies below 0, too.
    let least = values().fold(0.0, f64::min);
    let least = if least < 0.0 { -round(-least) } else { 0.0 };
    let place = |azimuth: f64, value: f64| {
        let radius = reach * (value - least) / (most - least);
        (middle.0 + (radius * azimuth.cos()) as i32, middle.1 - (radius * azimuth.sin()) as i32)
    };
    for ring in 1..=RINGS {
        let value = least + (most - least) * f64::from(ring) / f64::from(RINGS);
        let circle = (0..=180).map(|k| place(TAU * f64::from(k) / 180.0, value));
        area.draw(&PathElement::new(circle.collect::<Vec<_>>(), GRID.stroke_width(FINE)))?;
        let (x, y) = place(TAU / 4.0, value);
        let digits = if most - least < 4.0 {
            2
        } else if most - least < 40.0 {
            1
        } else {
            0
        };
        area.draw(&Text::new(format!("{value:.digits$}"), (x + 4 * fine, y + 3 * fine), LABEL))?;
    }
    for degrees in (0..360).step_by(30) {
        let azimuth = f64::from(degrees).to_radians();
        area.draw(&PathElement::new([middle, place(azimuth, most)], GRID.stroke_width(FINE)))?;
        let text = match degrees {
            0 => "0 (+y)".to_string(),
            90 => "90 (+z)".to_string(),
            _ => degrees.to_string(),
        };
        let beside = (reach + 16.0 * f64::from(FINE)) / reach;
        let (x, y) = (
            middle.0 + (beside * reach * azimuth.cos()) as i32,
            middle.1 - (beside * reach * azimuth.sin()) as i32,
        );
        let wide = text.chars().count() as i32 * 3 * fine;
        area.draw(&Text::new(text, (x - wide, y - 6 * fine), LABEL))?;
    }
    for ((_, of), colour) in RACES.iter().zip(COLOURS) {
        let mut balls: Vec<_> = row.balls.iter().map(|ball| (ball.azimuth, get(of(ball)))).collect();
        balls.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut line: Vec<_> = balls.iter().map(|(azimuth, value)| place(*azimuth, *value)).collect();
        for point in &line {
            area.draw(&Circle::new(*point, 4 * fine, colour.filled()))?;
        }
        line.extend(line.first().copied());
        area.draw(&PathElement::new(line, colour.stroke_width(LINE)))?;
    }
    Ok(())
}
