//! The picture of fields: one row per contact, tractions against their bound on the left, slip on the right.

use std::path::Path;

use plotters::prelude::*;
use roulement::analysis::stick_slip::{Field, FieldPoint};

use crate::report::fine::{FINE, LABEL, MARGIN, axes, headed, picture};
use crate::report::style::{Area, COLOURS, Drawn, PlotError};

/// \[pixel] size of a panel.
const PANEL: (u32, u32) = (620, 400);
/// Most contacts of a picture.
pub const MOST: usize = 12;
/// Arrows along the longer side of an ellipse, about.
const ARROWS: f64 = 14.0;

/// A contact's name, its friction coefficient and its field.
pub type Named = (String, f64, Field);

/// Draws the fields of at most [`MOST`] contacts, slip over the speed of rolling.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, title: &str, fields: &[Named]) -> Result<(), PlotError> {
    let shown = &fields[..fields.len().min(MOST)];
    picture(path, (2 * PANEL.0, shown.len() as u32 * PANEL.1), title, |body| {
        let areas = body.split_evenly((shown.len(), 2));
        for ((name, friction, field), panels) in shown.iter().zip(areas.chunks(2)) {
            let heading = format!("{name}: traction over its bound, {:.1} % sticks", 100.0 * field.stick);
            let used = |point: &FieldPoint| {
                let bound = friction * point.pressure;
                if bound > 0.0 { point.traction.map(|traction| traction / bound) } else { [0.0; 2] }
            };
            map(&panels[0], &heading, field, 1.0, used)?;
            let slip = |point: &FieldPoint| if point.sticks { [0.0; 2] } else { point.slip };
            let most = field.points.iter().map(slip).map(size).fold(0.0, f64::max);
            map(&panels[1], &format!("{name}: slip over the speed of rolling [1]"), field, most, slip)?;
        }
        Ok(())
    })
}

fn size([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// A vector over an ellipse: its size by shade, with the scale beside, and its direction by arrows.
fn map(
    area: &Area<'_>,
    heading: &str,
    field: &Field,
    most: f64,
    vector: impl Fn(&FieldPoint) -> [f64; 2],
) -> Drawn {
    let rest = headed(area, heading, &[])?;
    let (width, height) = rest.dim_in_pixel();
    let (labels, scale) = ((40 * FINE, 60 * FINE), 90 * FINE);
    // Both axes have one scale, so that the ellipse is what it is; the room beside it is left.
    let room = (f64::from(width - labels.1 - scale - 2 * MARGIN), f64::from(height - labels.0 - 2 * MARGIN));
    let [a, b] = field.semi_axes.map(|axis| 1.1e6 * axis);
    let per_unit = (2.0 * a / room.0).max(2.0 * b / room.1);
    let (x, y) = (0.5 * per_unit * room.0, 0.5 * per_unit * room.1);
    let (chart_area, scale_area) = rest.split_horizontally((width - scale) as i32);
    let mut chart = ChartBuilder::on(&chart_area)
        .margin(MARGIN)
        .x_label_area_size(labels.0)
        .y_label_area_size(labels.1)
        .build_cartesian_2d(-x..x, -y..y)?;
    axes(&mut chart.configure_mesh(), "x [um]", "y [um]").disable_mesh().draw()?;
    let wide = width_of_cells(field);
    let shade_of = |value: f64| shade(if most > 0.0 { value / most } else { 0.0 });
    chart.draw_series(field.points.iter().map(|point| {
        let [x, y] = point.place.map(|place| 1e6 * place);
        let (along, across) = (0.5 * wide, 0.5e12 * point.area / wide);
        let corners = [(x - along, y - across), (x + along, y + across)];
        Rectangle::new(corners, shade_of(size(vector(point))).filled())
    }))?;
    // Every so many cells one arrow, from the cell on; that of the largest vector is as long as arrows are apart.
    let apart = 2.0 * a.max(b) / ARROWS;
    let mut taken: Vec<[f64; 2]> = vec![];
    for point in &field.points {
        let from = point.place.map(|place| 1e6 * place);
        let far = |other: &[f64; 2]| size([from[0] - other[0], from[1] - other[1]]) >= 0.98 * apart;
        let value = vector(point);
        if size(value) <= 1e-3 * most || !taken.iter().all(far) {
            continue;
        }
        taken.push(from);
        let [dx, dy] = value.map(|component| apart * component / most);
        let tip = (from[0] + dx, from[1] + dy);
        let barb = |turn: f64| {
            let (sin, cos) = turn.sin_cos();
            (tip.0 + 0.3 * (cos * dx - sin * dy), tip.1 + 0.3 * (sin * dx + cos * dy))
        };
        let line = vec![(from[0], from[1]), tip, barb(2.6), tip, barb(-2.6)];
        chart.draw_series([PathElement::new(line, COLOURS[1].stroke_width(FINE))])?;
    }
    let edge = (0..=180).map(|k| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 180.0).sin_cos();
        (1e6 * field.semi_axes[0] * cos, 1e6 * field.semi_axes[1] * sin)
    });
    chart.draw_series(LineSeries::new(edge, BLACK.stroke_width(FINE)))?;
    let (top, step) = ((30 * FINE) as i32, (28 * FINE) as i32);
    for k in 0..=4 {
        let part = 1.0 - 0.25 * f64::from(k);
        let (y, box_size) = (top + k * step, (16 * FINE) as i32);
        scale_area.draw(&Rectangle::new([(0, y), (box_size, y + box_size)], shade(part).filled()))?;
        let text = rounded(part * most);
        scale_area.draw(&Text::new(text, (box_size + (6 * FINE) as i32, y + (2 * FINE) as i32), LABEL))?;
    }
    Ok(())
}

/// \[um] width of the cells of a field, which stand in a regular grid.
fn width_of_cells(field: &Field) -> f64 {
    let mut places: Vec<f64> = field.points.iter().map(|point| 1e6 * point.place[0]).collect();
    places.sort_by(f64::total_cmp);
    let steps = places.windows(2).map(|pair| pair[1] - pair[0]);
    let least = steps.filter(|step| *step > 1e-6 * field.semi_axes[0] * 1e6).fold(f64::INFINITY, f64::min);
    // A single column is as wide as the ellipse.
    if least.is_finite() { least } else { 2e6 * field.semi_axes[0] }
}

/// A number of three digits beside a scale.
fn rounded(value: f64) -> String {
    if value == 0.0 || (0.01..1000.0).contains(&value) {
        format!("{value:.3}")
    } else {
        format!("{value:.2e}")
    }
}

/// Colour of a part of the largest value: from light at 0 to dark at 1.
pub fn shade(fraction: f64) -> RGBColor {
    let mix = |light: f64, dark: f64| (light + (dark - light) * fraction.min(1.0)) as u8;
    RGBColor(mix(240.0, 0.0), mix(245.0, 60.0), mix(255.0, 140.0))
}
