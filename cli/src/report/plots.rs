//! Pictures of a run, as SVG.

use std::path::{Path, PathBuf};

use plotters::prelude::*;
use roulement::model::Model;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::outputs::{BallOutput, ContactOutput, Outputs};

use super::style::{Area, COLOURS, Drawn, LINE, MARGIN, PlotError, axes, legend, picture};

const PANEL: (u32, u32) = (520, 270);

/// A curve: its name and points.
struct Curve {
    name: &'static str,
    points: Vec<(f64, f64)>,
}

/// One panel of a figure.
struct Panel {
    x_label: &'static str,
    y_label: &'static str,
    curves: Vec<Curve>,
    /// \[y] smallest range worth magnifying: less is rounding.
    least: f64,
    /// Points instead of lines.
    scattered: bool,
}

/// Title of the plots of a scene.
pub fn title(scene: &Scene) -> &str {
    if scene.title.is_empty() { "ball bearing" } else { &scene.title }
}

/// Draws the plots of a run into a directory and returns their paths.
///
/// # Errors
/// If a file cannot be written.
pub fn write_plots(
    scene: &Scene,
    model: &Model,
    history: &[Outputs],
    directory: &Path,
) -> Result<Vec<PathBuf>, PlotError> {
    let title = title(scene);
    let figures = [
        ("contacts.svg", format!("{title}: contacts of ball 1"), contact_panels(history)),
        ("bearing.svg", title.to_string(), bearing_panels(model, Race::loaded(scene), history)),
        ("balls.svg", format!("{title}: all balls at the end"), ball_panels(history)),
    ];
    figures
        .into_iter()
        .map(|(name, title, panels)| {
            let path = directory.join(name);
            figure(&path, &title, &panels)?;
            Ok(path)
        })
        .collect()
}

/// A quantity of both contacts of ball 1 over time: what figure 7 of the paper shows.
fn contact_panels(history: &[Outputs]) -> Vec<Panel> {
    let panel = |y_label, least, get: fn(&ContactOutput) -> f64| {
        let curve = |name, side: fn(&BallOutput) -> &ContactOutput| Curve {
            name,
            points: history.iter().map(|o| (o.time * 1e3, get(side(&o.balls[0])))).collect(),
        };
        let curves = vec![curve("inner race", |b| &b.inner), curve("outer race", |b| &b.outer)];
        Panel { x_label: "time [ms]", y_label, curves, least, scattered: false }
    };
    vec![
        panel("load [N]", 0.1, |c| c.load),
        panel("contact angle [deg]", 0.01, |c| c.contact_angle.to_degrees()),
        panel("longitudinal creepage [1e-3]", 0.001, |c| c.creepage_longitudinal * 1e3),
        panel("lateral creepage [1e-3]", 0.001, |c| c.creepage_lateral * 1e3),
        panel("spin creepage [1/m]", 0.01, |c| c.creepage_spin),
        panel("spin moment [N mm]", 0.001, |c| c.spin_moment * 1e3),
        panel("lateral creep force [N]", 0.01, |c| c.force_lateral),
        panel("friction power [W]", 0.0001, |c| c.power),
    ]
}

fn bearing_panels(model: &Model, race: Race, history: &[Outputs]) -> Vec<Panel> {
    let curve = |name, get: &dyn Fn(&Outputs) -> f64| Curve {
        name,
        points: history.iter().map(|o| (o.time * 1e3, get(o))).collect(),
    };
    let panel =
        |y_label, least, curves| Panel { x_label: "time [ms]", y_label, curves, least, scattered: false };
    let epicyclic = |o: &Outputs| {
        if o.cage_slip == 1.0 {
            model.bearing.epicyclic_speed(0.0, 0.0, 0.0)
        } else {
            o.cage_speed / (1.0 - o.cage_slip)
        }
    };
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
            vec![curve("simulated", &|o| o.cage_speed), curve("epicyclic", &epicyclic)],
        ),
        panel("friction torque [N mm]", 0.01, vec![curve("inner race", &|o| o.friction_torque * 1e3)]),
        panel("friction power [W]", 0.001, vec![curve("all contacts", &|o| o.friction_power)]),
    ]
}

fn ball_panels(history: &[Outputs]) -> Vec<Panel> {
    let Some(last) = history.last() else {
        return vec![];
    };
    let panel = |y_label, least, get: fn(&ContactOutput) -> f64| {
        let curve = |name, side: fn(&BallOutput) -> &ContactOutput| Curve {
            name,
            points: last.balls.iter().map(|b| (b.azimuth.to_degrees(), get(side(b)))).collect(),
        };
        let curves = vec![curve("inner race", |b| &b.inner), curve("outer race", |b| &b.outer)];
        Panel { x_label: "azimuth [deg]", y_label, curves, least, scattered: true }
    };
    vec![
        panel("load [N]", 0.1, |c| c.load),
        panel("contact angle [deg]", 0.01, |c| c.contact_angle.to_degrees()),
        panel("peak pressure [MPa]", 1.0, |c| c.peak_pressure * 1e-6),
        panel("friction power [W]", 0.0001, |c| c.power),
    ]
}

fn figure(path: &Path, title: &str, panels: &[Panel]) -> Result<(), PlotError> {
    let columns = 2;
    let rows = panels.len().div_ceil(columns);
    let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
    picture(path, size, title, |body| {
        let areas = body.split_evenly((rows, columns));
        panels.iter().zip(&areas).try_for_each(|(panel, area)| draw(panel, area))
    })
}

/// Range of values with some air; a constant gets a range that shows it as constant.
fn range(values: impl Iterator<Item = f64>, least: f64) -> std::ops::Range<f64> {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return 0.0..1.0;
    }
    let air = if high - low > least { 0.06 * (high - low) } else { (0.05 * high.abs()).max(least) };
    low - air..high + air
}

fn draw(panel: &Panel, area: &Area<'_>) -> Drawn {
    let points = || panel.curves.iter().flat_map(|curve| curve.points.iter());
    let x = if panel.scattered { -185.0..185.0 } else { range(points().map(|p| p.0), 1e-6) };
    // Air above the curves for the legend.
    let mut y = range(points().map(|p| p.1), panel.least);
    y.end += 0.25 * (y.end - y.start);
    let digits = digits(y.end - y.start);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(38)
        .y_label_area_size(72)
        .build_cartesian_2d(x, y)?;
    axes(&mut chart.configure_mesh(), panel.x_label, panel.y_label)
        .y_labels(6)
        .x_labels(8)
        .y_label_formatter(&move |value| format!("{value:.digits$}"))
        .draw()?;
    for (curve, colour) in panel.curves.iter().zip(COLOURS) {
        if panel.scattered {
            let dots = curve.points.iter().map(|&point| Circle::new(point, 4, colour.filled()));
            chart
                .draw_series(dots)?
                .label(curve.name)
                .legend(move |(x, y)| Circle::new((x + 9, y), 4, colour.filled()));
        } else {
            let line = LineSeries::new(curve.points.iter().copied(), colour.stroke_width(LINE));
            chart
                .draw_series(line)?
                .label(curve.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(LINE)));
        }
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

/// Decimals that tell adjacent tick labels of a range apart.
fn digits(span: f64) -> usize {
    if span > 0.0 { (1.5 - span.log10()).ceil().clamp(0.0, 9.0) as usize } else { 0 }
}
