//! Picture of a spectrum: forces above moments, with the frequencies of cage and damage as lines.

use std::path::Path;

use plotters::prelude::*;

use super::lines::MULTIPLES;
use super::{SIGNALS, Spectrum};
use crate::report::fine::{FINE, Key, LABEL, LINE, MARGIN, axes, headed, picture};
use crate::report::style::{Area, COLOURS, Drawn, PlotError};

const SIZE: (u32, u32) = (1040, 640);
/// [-] places across a panel at most; each shows the largest amplitude of the frequencies under it.
const PLACES: usize = 1040;
/// [-] room to the right of the last marked line.
const AIR: f64 = 1.1;
/// [-] part of a panel above the largest amplitude, for the names of the lines.
const HEAD: f64 = 0.3;
/// \[unit] dash and gap of multiples.
const DASH: (i32, i32) = (4 * FINE as i32, 4 * FINE as i32);
/// The colour of a marked line is after those of the signals.
const FIRST_COLOUR: usize = 3;

/// Draws a spectrum into a file.
///
/// # Errors
/// If the file cannot be written.
pub fn write(spectrum: &Spectrum, title: &str, path: &Path) -> Result<(), PlotError> {
    let title = format!("{title}: spectrum");
    picture(path, SIZE, &title, |body| {
        let areas = body.split_evenly((2, 1));
        [(0, "force [N]"), (3, "moment [N m]")]
            .into_iter()
            .zip(&areas)
            .try_for_each(|((first, label), area)| panel(spectrum, first, label, area))
    })
}

/// The amplitude of a signal over order or frequency up to an end \[Hz], thinned to the largest of neighbours.
fn curve(spectrum: &Spectrum, signal: usize, end: f64, scale: f64) -> Vec<(f64, f64)> {
    let spacing = spectrum.spacing();
    let last = ((end / spacing) as usize).min(spectrum.amplitudes.at.len() - 1);
    let ks: Vec<usize> = (1..=last).collect();
    let at = |k: &usize| spectrum.amplitudes.at[*k][signal];
    let largest = |ks: &[usize]| ks.iter().copied().max_by(|one, other| at(one).total_cmp(&at(other)));
    let places = ks.chunks(last.div_ceil(PLACES).max(1)).filter_map(largest);
    places.map(|k| (k as f64 * spacing * scale, at(&k))).collect()
}

fn panel(spectrum: &Spectrum, first: usize, label: &str, area: &Area<'_>) -> Drawn {
    let highest = 0.5 / spectrum.interval;
    let fastest = spectrum.fastest().max(spectrum.shaft);
    let end = if fastest > spectrum.spacing() {
        highest.min(AIR * f64::from(MULTIPLES) * fastest)
    } else {
        highest
    };
    let (scale, x_label) = match spectrum.order(1.0) {
        Some(order) => (order, "order: frequency over turns of the shaft"),
        None => (1.0, "frequency [Hz]"),
    };
    let curves: Vec<_> = (first..first + 3).map(|signal| curve(spectrum, signal, end, scale)).collect();
    let largest = curves.iter().flatten().map(|point| point.1).fold(0.0, f64::max);
    let top = if largest > 0.0 { largest * (1.0 + HEAD) } else { 1.0 };
    let keys: Vec<_> = SIGNALS[first..first + 3]
        .iter()
        .zip(COLOURS)
        .map(|((name, _), colour)| (&name[name.len() - 1..], Key::Line, colour))
        .collect();
    let area = headed(area, label, &keys)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(MARGIN)
        .x_label_area_size(36 * FINE)
        .y_label_area_size(72 * FINE)
        .build_cartesian_2d(0.0..end * scale, 0.0..top)?;
    axes(&mut chart.configure_mesh(), x_label, "")
        .y_labels(6)
        .x_labels(12)
        .y_label_formatter(&|value| format!("{value:.3}"))
        .draw()?;
    let of_bearing =
        spectrum.marked.into_iter().enumerate().map(|(i, line)| (line, COLOURS[FIRST_COLOUR + i]));
    let of_meshes = spectrum.meshes.iter().map(|mesh| ((mesh.name.as_str(), mesh.frequency), BLACK));
    for (i, ((name, frequency), colour)) in of_bearing.chain(of_meshes).enumerate() {
        for multiple in 1..=MULTIPLES {
            let x = f64::from(multiple) * frequency * scale;
            if frequency <= 0.0 || x > end * scale {
                continue;
            }
            let ends = [(x, 0.0), (x, top)];
            if multiple == 1 {
                chart.draw_series(LineSeries::new(ends, colour.stroke_width(FINE)))?;
                let height = top * (1.0 - 0.05 * (1 + i) as f64);
                let style = LABEL.into_font().color(&colour);
                chart.draw_series([Text::new(format!(" {name}"), (x, height), style)])?;
            } else {
                chart.draw_series(DashedLineSeries::new(ends, DASH.0, DASH.1, colour.stroke_width(FINE)))?;
            }
        }
    }
    for (points, colour) in curves.into_iter().zip(COLOURS) {
        chart.draw_series(LineSeries::new(points, colour.stroke_width(LINE)))?;
    }
    Ok(())
}
