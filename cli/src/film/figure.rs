//! The figure of a lubricated contact: its traction over the slip; film ratio, rolling force and drag over the speed.

use std::path::Path;

use plotters::prelude::*;
use roulement::effects::RESISTING;

use super::FilmPoint;
use crate::report::fine::{FINE, Key, LINE, MARGIN, axes, headed, picture};
use crate::report::style::{Area, COLOURS, Drawn, PlotError};

/// \[pixel] size of a panel.
const PANEL: (u32, u32) = (560, 320);

/// A curve of one load, or of one load and speed.
pub struct Curve {
    /// Contact that it is of.
    pub name: String,
    /// Its points.
    pub points: Vec<FilmPoint>,
}

type Get = fn(&FilmPoint) -> f64;

/// Draws curves over the slip and over the speed.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, title: &str, over_slip: &[Curve], over_speed: &[Curve]) -> Result<(), PlotError> {
    picture(path, (2 * PANEL.0, 2 * PANEL.1), title, |body| {
        let areas = body.split_evenly((2, 2));
        let slip: Get = |point| point.rolling.slide_to_roll.log10();
        let speed: Get = |point| point.rolling.speed;
        panel(
            &areas[0],
            "traction over load [1]",
            over_slip,
            ("slide-to-roll ratio, power of ten", slip),
            |p| p.traction,
        )?;
        let over = |area, heading, get| panel(area, heading, over_speed, ("rolling speed [m/s]", speed), get);
        over(&areas[1], "film ratio [1]", |p| p.ratio)?;
        over(&areas[2], "rolling force [N]", |p| p.rolling_force)?;
        if over_speed.iter().flat_map(|curve| &curve.points).any(|point| point.drag.is_some()) {
            // It is the same under every load.
            let first = over_speed.get(..1).unwrap_or_default();
            let speed = ("rolling speed [m/s]", speed);
            return panel(&areas[3], "drag of the ball [N]", first, speed, |p| p.drag.unwrap_or(0.0));
        }
        let heading = format!("rolling and {} power [W]", RESISTING.name);
        over(&areas[3], &heading, |p| p.rolling_power + p.resisting_power)
    })
}

fn panel(area: &Area<'_>, heading: &str, curves: &[Curve], (label, x): (&str, Get), y: Get) -> Drawn {
    let coloured = || curves.iter().zip(COLOURS.iter().cycle());
    let keys: Vec<_> = coloured().map(|(curve, colour)| (curve.name.as_str(), Key::Line, *colour)).collect();
    let rest = headed(area, heading, if curves.len() > 1 { &keys } else { &[] })?;
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let low = all().map(x).fold(f64::INFINITY, f64::min);
    let high = all().map(x).fold(low, f64::max);
    let most = all().map(y).fold(f64::MIN_POSITIVE, f64::max);
    let least = all().map(y).fold(0.0, f64::min);
    let mut chart = ChartBuilder::on(&rest)
        .margin(MARGIN)
        .x_label_area_size(40 * FINE)
        .y_label_area_size(64 * FINE)
        .build_cartesian_2d(low..high, 1.05 * least..1.05 * most)?;
    axes(&mut chart.configure_mesh(), label, "")
        .x_label_formatter(&rounded)
        .y_label_formatter(&rounded)
        .draw()?;
    for (curve, colour) in coloured() {
        let points = curve.points.iter().map(|point| (x(point), y(point)));
        chart.draw_series(LineSeries::new(points, colour.stroke_width(LINE)))?;
    }
    Ok(())
}

/// A number at an axis, without the digits that binary numbers add.
fn rounded(value: &f64) -> String {
    ((value * 1e6).round() / 1e6 + 0.0).to_string()
}
