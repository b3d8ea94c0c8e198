//! Log-log plots: error against CPU time, one curve per lever, and the Pareto front.

use std::path::Path;

use plotters::prelude::*;
use strum::VariantArray;

use super::levers::{CreepModel, Level, Lever, ReferenceKind, STEPS_OF_SCENE};
use super::norms::{Errors, Norm};
use super::{Point, SceneStudy};
use crate::report::fine::{CAPTION, DESCRIPTION, FINE, LINE, MARGIN, axes, picture};
use crate::report::style::{Area, COLOURS, Drawn, PlotError};
use roulement::scene::CreepLaw;

/// \[pixel] size of a panel.
const PANEL: (u32, u32) = (500, 460);
/// \[pixel] width of the column with the meaning of the marks.
const LEGEND_WIDTH: u32 = 245;
/// \[unit] of a pixel, for places.
const PIXEL: i32 = FINE as i32;
/// [-] errors below this are rounding and drawn here.
const LEAST_ERROR: f64 = 1e-12;
/// [-] a quantity whose errors are all below this is given, not computed: the displacement of a driven race.
const WORTH_SHOWING: f64 = 1e-6;
const FRONT: ShapeStyle =
    ShapeStyle { color: RGBAColor(0, 0, 0, 1.0), filled: false, stroke_width: 2 * FINE };
/// \[unit] dash and gap.
const FRONT_DASH: (i32, i32) = (6 * PIXEL, 4 * PIXEL);
/// \[unit] dash and gap.
const BAR_DASH: (i32, i32) = (2 * PIXEL, 3 * PIXEL);
const BAR: ShapeStyle = ShapeStyle { color: RGBAColor(90, 90, 90, 1.0), filled: false, stroke_width: FINE };

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

/// Draws the norms of one kind of error of a scene.
///
/// # Errors
/// If the file cannot be written.
pub fn write_norms(study: &SceneStudy, kind: ReferenceKind, path: &Path) -> Result<(), PlotError> {
    // Those of single contacts tell models apart.
    let panels: Vec<_> = Norm::VARIANTS
        .iter()
        .filter(|norm| kind == ReferenceKind::Model || !norm.is_of_contacts())
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
    let kinds: Vec<_> = kinds.into_iter().filter(|&kind| study.has(kind)).collect();
    let panel = |kind| {
        let caption = format!("{}, largest of all quantities", kind_name(kind));
        Panel { study, kind, norm: None, caption }
    };
    write(
        path,
        &format!("{}: what accuracy costs", study.title()),
        &kinds.iter().copied().map(panel).collect::<Vec<_>>(),
        &kinds,
    )
}

fn kind_name(kind: ReferenceKind) -> &'static str {
    match kind {
        ReferenceKind::Numerical => "numerical error",
        ReferenceKind::Model => "model error",
    }
}

fn write(path: &Path, title: &str, panels: &[Panel<'_>], kinds: &[ReferenceKind]) -> Result<(), PlotError> {
    let columns = 2;
    // Where every error is too small to be shown the legend stands alone.
    let rows = panels.len().div_ceil(columns).max(1);
    let width = PANEL.0 * columns as u32;
    picture(path, (width + LEGEND_WIDTH, PANEL.1 * rows as u32), title, |body| {
        let (grid, key) = body.split_horizontally(width * FINE);
        for (panel, area) in panels.iter().zip(grid.split_evenly((rows, columns))) {
            draw(panel, &area)?;
        }
        legend(kinds, &key)
    })
}

/// Shape of a mark.
#[derive(Clone, Copy)]
enum Shape {
    Circle,
    Square,
    Triangle,
}

/// How the points of a curve look.
#[derive(Clone, Copy)]
struct Look {
    shape: Shape,
    colour: RGBColor,
    filled: bool,
}

impl Look {
    fn of_lever(lever: Lever) -> Self {
        let circle = |colour: usize, filled| Self { shape: Shape::Circle, colour: COLOURS[colour], filled };
        match lever {
            Lever::Default => Self { shape: Shape::Triangle, colour: BLACK, filled: true },
            Lever::Goal => Self { shape: Shape::Square, colour: BLACK, filled: true },
            Lever::FixedStep => circle(0, true),
            Lever::Tolerance => circle(1, true),
            Lever::Method => circle(5, true),
            Lever::StepCap => circle(2, true),
            Lever::AlphaF => circle(3, true),
            Lever::MatrixReuse => circle(4, true),
            Lever::CommunicationHeld => circle(0, false),
            Lever::CommunicationDerivatives => circle(1, false),
            Lever::CommunicationAhead => circle(2, false),
            Lever::Level | Lever::CreepLaw => circle(6, true),
        }
    }

    /// Triangles are the polynomials; filled is with the slip of bent grooves.
    fn of_model(model: CreepModel, level: Level) -> Self {
        let (shape, colour) = match (level, model.law) {
            (Level::Equilibrium, _) => (Shape::Square, COLOURS[6]),
            (_, CreepLaw::Frictionless) => (Shape::Circle, COLOURS[6]),
            (_, CreepLaw::Linear) => (Shape::Circle, COLOURS[5]),
            (_, CreepLaw::Regularised) => (Shape::Circle, COLOURS[4]),
            (_, CreepLaw::Uncoupled) => (Shape::Circle, COLOURS[3]),
            (_, CreepLaw::Saturated) => (Shape::Circle, COLOURS[1]),
            (_, CreepLaw::Kalker) => {
                (Shape::Triangle, COLOURS[[0, 2, 3, 5][model.degree.unwrap_or(1) / 2 % 4]])
            }
            (_, CreepLaw::KalkerTable) => (Shape::Square, BLACK),
        };
        Self { shape, colour, filled: model.heathcote_slip && level == Level::Dynamic }
    }

    fn of(point: &Point) -> Self {
        match point.lever.reference() {
            ReferenceKind::Numerical => {
                let look = Self::of_lever(point.lever);
                Self { filled: look.filled && point.label != STEPS_OF_SCENE, ..look }
            }
            ReferenceKind::Model => Self::of_model(point.creep, point.level),
        }
    }

    /// Draws a mark at a place \[unit] of the area.
    fn draw(self, area: &Area<'_>, (x, y): (i32, i32)) -> Drawn {
        let style = if self.filled { self.colour.filled() } else { self.colour.stroke_width(2 * FINE) };
        let corners: &[(i32, i32)] = match self.shape {
            Shape::Circle => return Ok(area.draw(&Circle::new((x, y), 4 * FINE, style))?),
            Shape::Square => &[(-4, -4), (4, -4), (4, 4), (-4, 4), (-4, -4)],
            Shape::Triangle => &[(-5, 4), (0, -5), (5, 4), (-5, 4)],
        };
        let corners: Vec<_> =
            corners.iter().map(|(right, down)| (x + right * PIXEL, y + down * PIXEL)).collect();
        if self.filled {
            area.draw(&Polygon::new(corners, style))?;
        } else {
            area.draw(&PathElement::new(corners, style))?;
        }
        Ok(())
    }
}

/// Meaning of the marks of one kind of error.
fn key(kind: ReferenceKind) -> Vec<(String, Option<Look>)> {
    let heading = (kind_name(kind).to_string(), None);
    let entries: Vec<_> = match kind {
        ReferenceKind::Numerical => levers_of(kind)
            .map(|lever| {
                let more = match lever {
                    Lever::Default => " (open: steps of the scene)",
                    Lever::Goal => ": fast, balanced, reference",
                    _ => "",
                };
                (format!("{}{more}", lever.name()), Some(Look::of_lever(lever)))
            })
            .collect(),
        ReferenceKind::Model => {
            let flat = CreepModel::studied().into_iter().filter(|model| !model.heathcote_slip);
            let laws = flat.map(|model| (model.name(), Some(Look::of_model(model, Level::Dynamic))));
            let equilibrium = Look::of_model(CreepModel::RICHEST, Level::Equilibrium);
            let filled = ("filled: with Heathcote slip".to_string(), None);
            std::iter::once(("equilibrium".to_string(), Some(equilibrium)))
                .chain(laws)
                .chain([filled])
                .collect()
        }
    };
    std::iter::once(heading).chain(entries).collect()
}

fn levers_of(kind: ReferenceKind) -> impl Iterator<Item = Lever> {
    Lever::VARIANTS.iter().copied().filter(move |lever| lever.reference() == kind)
}

fn legend(kinds: &[ReferenceKind], area: &Area<'_>) -> Drawn {
    const ROW: i32 = 18 * PIXEL;
    // Clear of the last label of the panel beside.
    const LEFT: i32 = 16 * PIXEL;
    const NAME: i32 = LEFT + 24 * PIXEL;
    let text = |words: &str, at| Text::new(words.to_string(), at, DESCRIPTION);
    let mut y = 20 * PIXEL;
    for &kind in kinds {
        for (words, look) in key(kind) {
            if let Some(look) = look {
                look.draw(area, (LEFT + 10 * PIXEL, y + 6 * PIXEL))?;
            }
            area.draw(&text(&words, (if look.is_some() { NAME } else { LEFT }, y)))?;
            y += ROW;
        }
        y += ROW / 2;
    }
    for (words, style, (dash, gap)) in
        [("Pareto front", FRONT, FRONT_DASH), ("error bar of the reference", BAR, BAR_DASH)]
    {
        for x in (LEFT..LEFT + 22 * PIXEL - dash).step_by((dash + gap) as usize) {
            area.draw(&PathElement::new([(x, y + 6 * PIXEL), (x + dash, y + 6 * PIXEL)], style))?;
        }
        area.draw(&text(words, (NAME, y)))?;
        y += ROW;
    }
    Ok(())
}

/// Whole decades around values.
fn decades(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return 0.1..10.0;
    }
    // A little beyond, so that the first decade has its label.
    0.999 * 10f64.powf((low.log10() - 0.05).floor())..1.001 * 10f64.powf((high.log10() + 0.05).ceil())
}

fn draw(panel: &Panel<'_>, area: &Area<'_>) -> Drawn {
    let (study, kind) = (panel.study, panel.kind);
    let bar = panel.error(study.error_bar(kind)).filter(|&bar| bar > LEAST_ERROR);
    let x = decades(panel.places().map(|place| place.0));
    let y = decades(panel.places().map(|place| place.1).chain(bar));
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .caption(&panel.caption, CAPTION)
        .x_label_area_size(38 * FINE)
        .y_label_area_size(64 * FINE)
        .build_cartesian_2d(x.clone().log_scale(), y.log_scale())?;
    axes(&mut chart.configure_mesh(), "CPU seconds per simulated second [s/s]", "relative error [-]")
        .x_label_formatter(&|value| format!("{}", (value * 1e6).round() / 1e6))
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .draw()?;
    // Defaults and goals last, on top of the others.
    let mut levers: Vec<_> = levers_of(kind).collect();
    levers.sort_by_key(|lever| [Lever::Goal, Lever::Default].iter().position(|last| last == lever));
    for lever in levers {
        let points = study.points_of(kind).filter(|point| point.lever == lever);
        let places: Vec<_> =
            points.filter_map(|point| Some((Look::of(point), panel.place(point)?))).collect();
        // Models and defaults are no scale: no line joins them.
        if let (ReferenceKind::Numerical, Some((look, _))) = (kind, places.first())
            && lever != Lever::Default
        {
            let line = places.iter().map(|(_, place)| *place);
            chart.draw_series(LineSeries::new(line, look.colour.stroke_width(LINE)))?;
        }
        let (left, top) = area.get_base_pixel();
        for (look, place) in places {
            let (x, y) = chart.plotting_area().map_coordinate(&place);
            look.draw(area, (x - left, y - top))?;
        }
    }
    let front = study.pareto(kind, panel.norm).into_iter().filter_map(|(point, _, _)| panel.place(point));
    chart.draw_series(DashedLineSeries::new(front.collect::<Vec<_>>(), FRONT_DASH.0, FRONT_DASH.1, FRONT))?;
    if let Some(bar) = bar {
        chart.draw_series(DashedLineSeries::new(
            [(x.start, bar), (x.end, bar)],
            BAR_DASH.0,
            BAR_DASH.1,
            BAR,
        ))?;
    }
    Ok(())
}
