//! Pictures of a run, as SVG.

use std::path::{Path, PathBuf};

use plotters::prelude::*;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::outputs::{BallOutput, ContactOutput, Outputs};

use super::fine::{BAND, FINE, Key, LINE, MARGIN, axes, headed, picture};
use super::polar;
use super::style::{Area, COLOURS, Drawn, PlotError};

const PANEL: (u32, u32) = (560, 250);
/// [-] part of a run at its start that does not set the scale of a panel alone.
const START: f64 = 0.02;
/// [-] by how much the start has to be larger than all that follows before it is left out of the scale.
const JUMP: f64 = 5.0;

/// [-] share of the largest load of a race that a ball carries whose creepages are drawn.
const LOADED: f64 = 0.01;

/// A curve: its name, points, and where it is one of several balls the least and largest values of all of them.
pub(super) struct Curve {
    pub name: String,
    pub points: Vec<(f64, f64)>,
    pub band: Vec<(f64, f64)>,
}

/// One panel of a figure.
pub(super) struct Panel {
    pub x_label: &'static str,
    pub y_label: &'static str,
    pub curves: Vec<Curve>,
    /// \[y] smallest range worth magnifying: less is rounding.
    pub least: f64,
}

impl Panel {
    /// Is it 0 throughout, as far as can be seen?
    fn is_nothing(&self) -> bool {
        let values = || {
            self.curves.iter().flat_map(|curve| {
                curve.points.iter().map(|point| point.1).chain(curve.band.iter().flat_map(|b| [b.0, b.1]))
            })
        };
        values().all(|value| !value.is_finite() || value.abs() < 0.01 * self.least)
    }
}

/// Title of the plots of a scene.
pub fn title(scene: &Scene) -> &str {
    if scene.title.is_empty() { "ball bearing" } else { &scene.title }
}

/// Draws the plots of a run into a directory and returns their paths.
///
/// # Errors
/// If a file cannot be written.
pub fn write_plots(scene: &Scene, history: &[Outputs], directory: &Path) -> Result<Vec<PathBuf>, PlotError> {
    let title = title(scene);
    let figures = [
        ("contacts.svg", format!("{title}: contacts of ball 1, and of all balls"), contact_panels(history)),
        ("bearing.svg", title.to_string(), bearing_panels(Race::loaded(scene), history)),
    ];
    let mut paths = vec![];
    for (name, title, panels) in figures {
        let path = directory.join(name);
        figure(&path, &title, panels)?;
        paths.push(path);
    }
    if let Some(last) = history.last() {
        let path = directory.join("balls.svg");
        polar::write(&path, &format!("{title}: all balls at {:.3} ms", last.time * 1e3), last)?;
        paths.push(path);
    }
    Ok(paths)
}

/// A quantity of both contacts of ball 1 over time, within the range of all balls: what figure 7 of the paper shows.
fn contact_panels(history: &[Outputs]) -> Vec<Panel> {
    let panel_of = |y_label, least, get: fn(&ContactOutput) -> f64, share: f64| {
        let curve = |name: &str, side: fn(&BallOutput) -> &ContactOutput| {
            // Not a number where a ball hardly carries anything: its creepage would set the scale of all.
            let values = |o: &Outputs| -> Vec<f64> {
                let most = o.balls.iter().map(|ball| side(ball).load).fold(0.0, f64::max);
                let value = |contact: &ContactOutput| {
                    if contact.load >= share * most { get(contact) } else { f64::NAN }
                };
                o.balls.iter().map(|ball| value(side(ball))).collect()
            };
            let rows: Vec<Vec<f64>> = history.iter().map(values).collect();
            let points = history.iter().zip(&rows).map(|(o, row)| (o.time * 1e3, row[0]));
            Curve {
                name: name.into(),
                points: points.collect(),
                band: rows.iter().map(|row| extremes(row.iter().copied())).collect(),
            }
        };
        let curves = vec![curve("inner race", |b| &b.inner), curve("outer race", |b| &b.outer)];
        Panel { x_label: "time [ms]", y_label, curves, least }
    };
    let panel = |y_label, least, get| panel_of(y_label, least, get, 0.0);
    let creepage = |y_label, least, get| panel_of(y_label, least, get, LOADED);
    vec![
        panel("load [N]", 0.1, |c| c.load),
        panel("contact angle [deg]", 0.01, |c| c.contact_angle.to_degrees()),
        creepage("longitudinal creepage [1e-3]", 0.001, |c| c.creepage_longitudinal * 1e3),
        creepage("lateral creepage [1e-3]", 0.001, |c| c.creepage_lateral * 1e3),
        creepage("spin creepage [1/m]", 0.01, |c| c.creepage_spin),
        panel("spin moment [N mm]", 0.001, |c| c.spin_moment * 1e3),
        panel("longitudinal creep force [N]", 0.01, |c| c.force_longitudinal),
        panel("lateral creep force [N]", 0.01, |c| c.force_lateral),
        panel("peak pressure [MPa]", 1.0, |c| c.peak_pressure * 1e-6),
        panel("friction power [W]", 0.0001, |c| c.power),
    ]
}

fn bearing_panels(race: Race, history: &[Outputs]) -> Vec<Panel> {
    let curve = |name: &str, get: &dyn Fn(&Outputs) -> f64| Curve {
        name: name.into(),
        points: history.iter().map(|o| (o.time * 1e3, get(o))).collect(),
        band: vec![],
    };
    let panel = |y_label, least, curves| Panel { x_label: "time [ms]", y_label, curves, least };
    let [position, force, moment] = match race {
        Race::Inner => [
            "inner race position [um]",
            "force of the bearing on inner race [N]",
            "moment of the bearing on inner race [N m]",
        ],
        Race::Outer => [
            "outer race position [um]",
            "force of the bearing on outer race [N]",
            "moment of the bearing on outer race [N m]",
        ],
    };
    vec![
        panel(
            position,
            0.01,
            vec![
                curve("x", &|o| o[race].pose.position.x * 1e6),
                curve("y", &|o| o[race].pose.position.y * 1e6),
                curve("z", &|o| o[race].pose.position.z * 1e6),
            ],
        ),
        panel(
            force,
            1.0,
            vec![
                curve("x", &|o| o[race].wrench.force.x),
                curve("y", &|o| o[race].wrench.force.y),
                curve("z", &|o| o[race].wrench.force.z),
            ],
        ),
        panel(
            moment,
            0.001,
            vec![curve("y", &|o| o[race].wrench.moment.y), curve("z", &|o| o[race].wrench.moment.z)],
        ),
        panel(
            "cage speed [rad/s]",
            0.01,
            vec![curve("simulated", &|o| o.cage_speed), curve("epicyclic", &|o| o.rolling_speed)],
        ),
        panel("friction torque [N mm]", 0.01, vec![curve("inner race", &|o| o.friction_torque * 1e3)]),
        panel("friction power [W]", 0.001, vec![curve("all contacts", &|o| o.friction_power)]),
    ]
}

/// Least and largest of some values.
fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

pub(super) fn figure(path: &Path, title: &str, mut panels: Vec<Panel>) -> Result<(), PlotError> {
    panels.retain(|panel| !panel.is_nothing());
    let columns = 2;
    let rows = panels.len().div_ceil(columns).max(1);
    let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
    picture(path, size, title, |body| {
        let areas = body.split_evenly((rows, columns));
        panels.iter().zip(&areas).try_for_each(|(panel, area)| draw(panel, area))
    })
}

/// Range of values with some air; a constant gets a range that shows it as constant.
fn range((low, high): (f64, f64), least: f64) -> std::ops::Range<f64> {
    if low > high {
        return 0.0..1.0;
    }
    let air = if high - low > least { 0.06 * (high - low) } else { (0.05 * high.abs()).max(least) };
    low - air..high + air
}

/// Range of a panel's values. A jump at the start that is much larger than all that follows is cut off, so that this can be seen.
fn heights(panel: &Panel) -> std::ops::Range<f64> {
    let from = panel.curves.first().and_then(|curve| Some((curve.points.first()?.0, curve.points.last()?.0)));
    let from = from.map_or(f64::NEG_INFINITY, |(first, last)| first + START * (last - first));
    let values = |later: bool| {
        extremes(panel.curves.iter().flat_map(move |curve| {
            let bands = curve.band.iter().copied().chain(std::iter::repeat((f64::NAN, f64::NAN)));
            let rows = curve.points.iter().zip(bands).filter(move |(point, _)| !later || point.0 >= from);
            rows.flat_map(|(point, band)| [point.1, band.0, band.1])
        }))
    };
    let (all, after) = (values(false), values(true));
    let (whole, rest) = (range(all, panel.least), range(after, panel.least));
    if after.1 > after.0 && whole.end - whole.start > JUMP * (rest.end - rest.start) { rest } else { whole }
}

fn draw(panel: &Panel, area: &Area<'_>) -> Drawn {
    let mut keys = vec![];
    for (curve, colour) in panel.curves.iter().zip(COLOURS) {
        keys.push((curve.name.as_str(), Key::Line, colour));
    }
    // Where balls do not differ there is no band to be seen.
    let has_band = |curve: &Curve| curve.band.iter().any(|(low, high)| high - low > 0.01 * panel.least);
    if panel.curves.iter().any(has_band) {
        keys.push(("all balls", Key::Band, COLOURS[6]));
    }
    let area = headed(area, panel.y_label, &keys)?;
    let x =
        range(extremes(panel.curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.0))), 1e-6);
    let y = heights(panel);
    let digits = digits(y.end - y.start);
    let (low, high) = (y.start, y.end);
    let mut chart = ChartBuilder::on(&area)
        .margin(MARGIN)
        .x_label_area_size(34 * FINE)
        .y_label_area_size(64 * FINE)
        .build_cartesian_2d(x, y)?;
    axes(&mut chart.configure_mesh(), panel.x_label, "")
        .y_labels(6)
        .x_labels(8)
        .y_label_formatter(&move |value| format!("{value:.digits$}"))
        .draw()?;
    for (curve, colour) in panel.curves.iter().zip(COLOURS) {
        if has_band(curve) {
            let edge = |of: fn(&(f64, f64)) -> f64| {
                curve
                    .points
                    .iter()
                    .zip(&curve.band)
                    .filter(|(_, band)| band.0 <= band.1)
                    .map(move |(point, band)| (point.0, of(band).clamp(low, high)))
            };
            let mut outline: Vec<_> = edge(|band| band.0).collect();
            outline.extend(edge(|band| band.1).collect::<Vec<_>>().into_iter().rev());
            chart.draw_series([Polygon::new(outline, colour.mix(BAND).filled())])?;
        }
        // What is cut off is left out, not drawn along the frame.
        let inside = |point: &(f64, f64)| point.1 >= low && point.1 <= high;
        for points in curve.points.split(|point| !inside(point)) {
            chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(LINE)))?;
        }
    }
    Ok(())
}

/// Decimals that tell adjacent tick labels of a range apart.
fn digits(span: f64) -> usize {
    if span > 0.0 { (1.5 - span.log10()).ceil().clamp(0.0, 9.0) as usize } else { 0 }
}
