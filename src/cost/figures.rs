//! Log-log plots: error against CPU time, one curve per lever, and the Pareto front.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use strum::VariantArray;

use super::SceneStudy;
use super::levers::{Lever, ReferenceKind};
use super::norms::Norm;
use crate::plots::{COLOURS, PlotError};

const PANEL: (u32, u32) = (560, 380);
/// [-] errors below this are rounding and drawn here.
const LEAST_ERROR: f64 = 1e-12;

/// A panel: the errors of one norm, or the largest of all.
struct Panel<'a> {
    study: &'a SceneStudy,
    kind: ReferenceKind,
    norm: Option<Norm>,
    caption: String,
}

/// Draws all norms of one kind of error of a scene.
///
/// # Errors
/// If the file cannot be written.
pub fn write_norms(study: &SceneStudy, kind: ReferenceKind, path: &Path) -> Result<(), PlotError> {
    let measured = |norm: Norm| {
        study.points_of(kind).any(|p| p.result.as_ref().is_ok_and(|m| m.errors.get(norm).is_some()))
    };
    let panels: Vec<_> = Norm::VARIANTS
        .iter()
        .filter(|&&norm| measured(norm))
        .map(|&norm| Panel { study, kind, norm: Some(norm), caption: norm.name().to_string() })
        .collect();
    let title = format!("{}: {} against CPU time", study.title(), kind_name(kind));
    write(path, &title, &panels)
}

/// Draws the largest error of a scene: numerical beside model.
///
/// # Errors
/// If the file cannot be written.
pub fn write_overview(study: &SceneStudy, path: &Path) -> Result<(), PlotError> {
    let panels = [ReferenceKind::Numerical, ReferenceKind::Model].map(|kind| Panel {
        study,
        kind,
        norm: None,
        caption: format!("{}, largest of all quantities", kind_name(kind)),
    });
    write(path, &format!("{}: what accuracy costs", study.title()), &panels)
}

fn kind_name(kind: ReferenceKind) -> &'static str {
    match kind {
        ReferenceKind::Numerical => "numerical error",
        ReferenceKind::Model => "model error",
    }
}

fn write(path: &Path, title: &str, panels: &[Panel<'_>]) -> Result<(), PlotError> {
    let columns = 2;
    let rows = panels.len().div_ceil(columns);
    let draw_all = || -> Result<(), Box<dyn std::error::Error>> {
        let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32 + 40);
        let root = SVGBackend::new(path, size).into_drawing_area();
        root.fill(&WHITE)?;
        let body = root.titled(title, ("sans-serif", 20))?;
        for (panel, area) in panels.iter().zip(body.split_evenly((rows, columns))) {
            draw(panel, &area)?;
        }
        Ok(root.present()?)
    };
    draw_all().map_err(|why| PlotError { path: path.display().to_string(), why: why.to_string() })
}

/// Whole decades around values.
fn decades(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return 0.1..10.0;
    }
    10f64.powf((low.log10() - 0.05).floor())..10f64.powf((high.log10() + 0.05).ceil())
}

fn draw(
    panel: &Panel<'_>,
    area: &DrawingArea<SVGBackend<'_>, Shift>,
) -> Result<(), Box<dyn std::error::Error>> {
    let (study, kind) = (panel.study, panel.kind);
    let error_of = |errors: &super::norms::Errors| match panel.norm {
        Some(norm) => errors.get(norm),
        None => errors.worst(),
    };
    let curve = |lever: Lever| -> Vec<(f64, f64)> {
        let points = study.points_of(kind).filter(|point| point.lever == lever);
        points
            .filter_map(|point| point.result.as_ref().ok())
            .filter_map(|measured| Some((measured.cpu, error_of(&measured.errors)?)))
            // The reference compared with itself has no error: no place on a logarithmic axis.
            .filter(|&(_, error)| error > 0.0)
            .map(|(cpu, error)| (cpu, error.max(LEAST_ERROR)))
            .collect()
    };
    let levers: Vec<_> = Lever::VARIANTS.iter().filter(|lever| lever.reference() == kind).collect();
    let curves: Vec<_> =
        levers.iter().map(|&&lever| (lever, curve(lever))).filter(|(_, c)| !c.is_empty()).collect();
    let all = || curves.iter().flat_map(|(_, curve)| curve.iter().copied());
    let bar = error_of(study.error_bar(kind)).filter(|&bar| bar > LEAST_ERROR);
    let x = decades(all().map(|point| point.0));
    let y = decades(all().map(|point| point.1).chain(bar));
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .caption(&panel.caption, ("sans-serif", 15))
        .x_label_area_size(38)
        .y_label_area_size(64)
        .build_cartesian_2d(x.clone().log_scale(), y.log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(RGBColor(242, 242, 242))
        .bold_line_style(RGBColor(215, 215, 215))
        .x_desc("CPU seconds per simulated second")
        .y_desc("relative error")
        .axis_desc_style(("sans-serif", 13))
        .label_style(("sans-serif", 12))
        .x_label_formatter(&|value| format!("{value}"))
        .y_label_formatter(&|value| format!("{value:e}"))
        .draw()?;
    for (index, (lever, points)) in curves.iter().enumerate() {
        let colour = COLOURS[index % COLOURS.len()];
        // Settings that are no scale have no line between them.
        if !matches!(lever, Lever::Level | Lever::CreepLaw) {
            chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(1)))?;
        }
        let marks = points.iter().map(|&point| mark(index, point, colour));
        chart.draw_series(marks)?.label(lever.name()).legend(move |(x, y)| mark(index, (x + 9, y), colour));
    }
    if kind == ReferenceKind::Model {
        for point in study.points_of(kind) {
            let place = point.result.as_ref().ok().and_then(|m| Some((m.cpu, error_of(&m.errors)?)));
            if let Some(place) = place.filter(|place| place.1 > 0.0) {
                let label = Text::new(point.label.clone(), (7, -5), ("sans-serif", 12));
                chart.draw_series([EmptyElement::at(place) + label])?;
            }
        }
    }
    let front = study.pareto(kind, panel.norm).into_iter().filter(|&(_, _, error)| error > 0.0);
    let front: Vec<_> = front.map(|(_, cpu, error)| (cpu, error.max(LEAST_ERROR))).collect();
    chart
        .draw_series(DashedLineSeries::new(front, 6, 4, BLACK.stroke_width(2)))?
        .label("Pareto front")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 18, y)], BLACK.stroke_width(2)));
    if let Some(bar) = bar {
        let grey = RGBColor(90, 90, 90);
        chart
            .draw_series(DashedLineSeries::new([(x.start, bar), (x.end, bar)], 2, 3, grey.stroke_width(1)))?
            .label("error bar of the reference")
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], grey.stroke_width(1)));
    }
    chart
        .configure_series_labels()
        .background_style(WHITE.mix(0.8))
        .label_font(("sans-serif", 11))
        .position(SeriesLabelPosition::UpperRight)
        .draw()?;
    Ok(())
}

/// A mark whose colour, and fill where colours run out, tells the lever.
fn mark<C>(index: usize, at: C, colour: RGBColor) -> Circle<C, i32> {
    Circle::new(at, 4, if index < COLOURS.len() { colour.filled() } else { colour.stroke_width(2) })
}
