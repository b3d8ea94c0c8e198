//! Log-log plots: error against CPU time, one curve per lever, and the Pareto front.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use strum::VariantArray;

use super::levers::{Lever, ReferenceKind};
use super::norms::{Errors, Norm};
use super::{Point, SceneStudy};
use crate::plots::{COLOURS, PlotError};

const PANEL: (u32, u32) = (500, 360);
const LEGEND_WIDTH: u32 = 230;
/// [-] errors below this are rounding and drawn here.
const LEAST_ERROR: f64 = 1e-12;
/// [-] a quantity whose errors are all below this is given, not computed: the displacement of a driven race.
const WORTH_SHOWING: f64 = 1e-6;
const FRONT: ShapeStyle = ShapeStyle { color: RGBAColor(0, 0, 0, 1.0), filled: false, stroke_width: 2 };
const BAR: ShapeStyle = ShapeStyle { color: RGBAColor(90, 90, 90, 1.0), filled: false, stroke_width: 1 };

/// A panel: the errors of one norm, or the largest of all.
struct Panel<'a> {
    study: &'a SceneStudy,
    kind: ReferenceKind,
    norm: Option<Norm>,
    caption: String,
}

impl Panel<'_> {
    fn error(&self, errors: &Errors) -> Option<f64> {
        match self.norm {
            Some(norm) => errors.get(norm),
            None => errors.worst(),
        }
    }

    /// CPU time and error of a run. The reference itself, of no error, is drawn at its error bar.
    fn place(&self, point: &Point) -> Option<(f64, f64)> {
        let measured = point.result.as_ref().ok()?;
        let error = self.error(&measured.errors)?;
        let error = if error > 0.0 { error } else { self.error(self.study.error_bar(self.kind))? };
        Some((measured.cpu, error.max(LEAST_ERROR)))
    }

    fn places(&self) -> impl Iterator<Item = (f64, f64)> {
        self.study.points_of(self.kind).filter_map(|point| self.place(point))
    }
}

/// Draws all norms of one kind of error of a scene.
///
/// # Errors
/// If the file cannot be written.
pub fn write_norms(study: &SceneStudy, kind: ReferenceKind, path: &Path) -> Result<(), PlotError> {
    let panels: Vec<_> = Norm::VARIANTS
        .iter()
        .map(|&norm| Panel { study, kind, norm: Some(norm), caption: norm.name().to_string() })
        .filter(|panel| panel.places().any(|(_, error)| error > WORTH_SHOWING))
        .collect();
    let title = format!("{}: {} against CPU time", study.title(), kind_name(kind));
    write(path, &title, &panels, &[kind])
}

/// Draws the largest error of a scene: numerical beside model.
///
/// # Errors
/// If the file cannot be written.
pub fn write_overview(study: &SceneStudy, path: &Path) -> Result<(), PlotError> {
    let kinds = [ReferenceKind::Numerical, ReferenceKind::Model];
    let panel = |kind| {
        let caption = format!("{}, largest of all quantities", kind_name(kind));
        Panel { study, kind, norm: None, caption }
    };
    write(path, &format!("{}: what accuracy costs", study.title()), &kinds.map(panel), &kinds)
}

fn kind_name(kind: ReferenceKind) -> &'static str {
    match kind {
        ReferenceKind::Numerical => "numerical error",
        ReferenceKind::Model => "model error",
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

fn write(path: &Path, title: &str, panels: &[Panel<'_>], kinds: &[ReferenceKind]) -> Result<(), PlotError> {
    let columns = 2;
    let rows = panels.len().div_ceil(columns);
    let width = PANEL.0 * columns as u32;
    let draw_all = || -> Drawn {
        let root =
            SVGBackend::new(path, (width + LEGEND_WIDTH, PANEL.1 * rows as u32 + 40)).into_drawing_area();
        root.fill(&WHITE)?;
        let (grid, key) = root.titled(title, ("sans-serif", 20))?.split_horizontally(width);
        for (panel, area) in panels.iter().zip(grid.split_evenly((rows, columns))) {
            draw(panel, &area)?;
        }
        legend(kinds, &key)?;
        Ok(root.present()?)
    };
    draw_all().map_err(|why| PlotError { path: path.display().to_string(), why: why.to_string() })
}

fn levers_of(kind: ReferenceKind) -> impl Iterator<Item = Lever> {
    Lever::VARIANTS.iter().copied().filter(move |lever| lever.reference() == kind)
}

/// A mark whose colour, and fill where colours run out, tells the lever by its place in [`levers_of`].
fn mark<C>(index: usize, at: C) -> Circle<C, i32> {
    let colour = colour(index);
    Circle::new(at, 4, if index < COLOURS.len() { colour.filled() } else { colour.stroke_width(2) })
}

fn colour(index: usize) -> RGBColor {
    COLOURS[index % COLOURS.len()]
}

fn legend(kinds: &[ReferenceKind], area: &Area<'_>) -> Drawn {
    let text = |words: &str, at| Text::new(words.to_string(), at, ("sans-serif", 13));
    let mut y = 30;
    for &kind in kinds {
        area.draw(&text(kind_name(kind), (4, y)))?;
        for (index, lever) in levers_of(kind).enumerate() {
            y += 20;
            area.draw(&mark(index, (14, y + 6)))?;
            area.draw(&text(lever.name(), (28, y)))?;
        }
        y += 34;
    }
    for (words, style) in [("Pareto front", FRONT), ("error bar of the reference", BAR)] {
        area.draw(&PathElement::new([(4, y + 6), (22, y + 6)], style))?;
        area.draw(&text(words, (28, y)))?;
        y += 20;
    }
    Ok(())
}

/// Whole decades around values.
fn decades(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return 0.1..10.0;
    }
    10f64.powf((low.log10() - 0.05).floor())..10f64.powf((high.log10() + 0.05).ceil())
}

fn draw(panel: &Panel<'_>, area: &Area<'_>) -> Drawn {
    let (study, kind) = (panel.study, panel.kind);
    let bar = panel.error(study.error_bar(kind)).filter(|&bar| bar > LEAST_ERROR);
    let x = decades(panel.places().map(|place| place.0));
    let y = decades(panel.places().map(|place| place.1).chain(bar));
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .caption(&panel.caption, ("sans-serif", 15))
        .x_label_area_size(38)
        .y_label_area_size(64)
        .build_cartesian_2d(x.clone().log_scale(), y.log_scale())?;
    chart
        .configure_mesh()
        // Decades are enough, and lines between them would be most of the file.
        .max_light_lines(0)
        .bold_line_style(RGBColor(215, 215, 215))
        .x_desc("CPU seconds per simulated second")
        .y_desc("relative error")
        .axis_desc_style(("sans-serif", 13))
        .label_style(("sans-serif", 12))
        .x_label_formatter(&|value| format!("{}", (value * 1e6).round() / 1e6))
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .draw()?;
    for (index, lever) in levers_of(kind).enumerate() {
        let points: Vec<_> = study.points_of(kind).filter(|point| point.lever == lever).collect();
        let places: Vec<_> = points.iter().filter_map(|point| panel.place(point)).collect();
        if kind == ReferenceKind::Numerical {
            chart.draw_series(LineSeries::new(places.iter().copied(), colour(index).stroke_width(1)))?;
        } else {
            // Models are no scale: no line joins them, each has its name.
            let named = points.iter().filter_map(|point| Some((point, panel.place(point)?)));
            // The richest law is also the dynamic level: names of the levers one above the other.
            let above = if lever == Lever::Level { -16 } else { -5 };
            let name = |(point, place): (&&Point, _)| {
                EmptyElement::at(place) + Text::new(point.label.clone(), (7, above), ("sans-serif", 12))
            };
            chart.draw_series(named.map(name))?;
        }
        chart.draw_series(places.into_iter().map(|place| mark(index, place)))?;
    }
    let front = study.pareto(kind, panel.norm).into_iter().filter_map(|(point, _, _)| panel.place(point));
    chart.draw_series(DashedLineSeries::new(front.collect::<Vec<_>>(), 6, 4, FRONT))?;
    if let Some(bar) = bar {
        chart.draw_series(DashedLineSeries::new([(x.start, bar), (x.end, bar)], 2, 3, BAR))?;
    }
    Ok(())
}
