//! Draws the figure of docs/believe.md: what the program gives against numbers that it was not made from.
//! `cargo run --release --example evidence_figures [DIRECTORY]`.
#![allow(clippy::unwrap_used)] // of shared code of the tests

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;
use roulement::analysis::single_contact::{Law, RollingContact};
use roulement::equilibrium::Gyroscopic;
use roulement::scene::CreepLaw;
use roulement_cli::report::fine::{FINE, Key, LINE, MARGIN, axes, headed, picture};
use roulement_cli::report::style::{Area, COLOURS, Drawn};
use serde_json::Value;

#[path = "../../tests/common/equilibria.rs"]
mod equilibria;
#[path = "../../tests/common/evidence.rs"]
mod evidence;
#[path = "../../tests/common/reference.rs"]
mod reference;

use equilibria::{difference, solve, whole};
use reference::cases;

const PANEL: (u32, u32) = (560, 400);

/// Points or a line of a panel.
struct Series {
    name: &'static str,
    key: Key,
    colour: RGBColor,
    points: Vec<(f64, f64)>,
}

/// Names its series below the heading and gives the rest of the panel.
fn titled<'a>(area: &Area<'a>, title: &str, all: &[Series]) -> Result<Area<'a>, Box<dyn Error>> {
    let keys: Vec<_> = all.iter().map(|series| (series.name, series.key, series.colour)).collect();
    headed(&headed(area, title, &[])?, "", &keys)
}

/// A chart with room for the numbers of its axes.
fn framed<'a, 'b>(area: &'a Area<'b>) -> ChartBuilder<'a, 'b, SVGBackend<'b>> {
    let mut chart = ChartBuilder::on(area);
    chart.margin(MARGIN).x_label_area_size(36 * FINE).y_label_area_size(60 * FINE);
    chart
}

/// Draws series into a chart, whatever its scales are.
macro_rules! draw {
    ($chart:expr, $all:expr) => {
        for Series { key, colour, points, .. } in $all {
            if *key == Key::Dot {
                let ring = colour.stroke_width(FINE);
                $chart.draw_series(points.iter().map(|&place| Circle::new(place, 3 * FINE, ring)))?;
            } else {
                $chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(LINE)))?;
            }
        }
    };
}

fn statics(area: &Area<'_>) -> Drawn {
    let of_case = |case: &Value| {
        let ours = solve(&whole(case), Gyroscopic::OuterRaceControl);
        let found = difference(&ours, &case["outer_race_control"]);
        [found.load, found.stiffness]
    };
    let all: Vec<[f64; 2]> = cases().iter().map(of_case).collect();
    let series = |name, colour, which: usize| Series {
        name,
        key: Key::Dot,
        colour,
        points: all.iter().enumerate().map(|(case, d)| ((case + 1) as f64, d[which].max(1e-9))).collect(),
    };
    let all = [series("loads of the balls", COLOURS[0], 0), series("stiffness", COLOURS[1], 1)];
    let area = titled(area, "a  20 equilibria against an independent solver", &all)?;
    let mut chart = framed(&area).build_cartesian_2d(0.0..21.0, (1e-9..1e-3f64).log_scale())?;
    axes(&mut chart.configure_mesh(), "case", "largest relative difference [-]")
        .x_label_formatter(&|value| format!("{value}"))
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .draw()?;
    draw!(chart, &all);
    Ok(())
}

fn contacts(area: &Area<'_>) -> Drawn {
    let mut both = [vec![], vec![]];
    for file in ["curves", "random"] {
        let mut table = csv::Reader::from_path(format!("tests/data/contact/{file}.csv"))?;
        let headers = table.headers()?.clone();
        let column =
            |name: &str| headers.iter().position(|header| header == name).ok_or("a column is missing");
        let places = [column("fx")?, column("fy")?, column("mz")?];
        for record in table.records() {
            let record = record?;
            let contact: RollingContact = record.deserialize(Some(&headers))?;
            let ours = contact.evaluate(Law::Simulated(CreepLaw::KalkerTable))?;
            for (place, value) in places.into_iter().zip([ours.fx, ours.fy, ours.mz]) {
                both[usize::from(contact.rolling_angle != 0.0)].push((record[place].parse::<f64>()?, value));
            }
        }
    }
    let mean =
        |points: &[(f64, f64)]| points.iter().map(|(x, y)| (x - y).abs()).sum::<f64>() / points.len() as f64;
    let title = format!(
        "b  {} rolling contacts against boundary elements: mean difference {:.3}, oblique {:.3}",
        (both[0].len() + both[1].len()) / 3,
        mean(&both[0]),
        mean(&both[1])
    );
    let largest = both.iter().flatten().map(|(x, y)| x.abs().max(y.abs())).fold(1.0, f64::max);
    let [straight, oblique] = both;
    let all = [
        Series {
            name: "equal",
            key: Key::Line,
            colour: COLOURS[6],
            points: vec![(-largest, -largest), (largest, largest)],
        },
        Series { name: "along an axis of the ellipse", key: Key::Dot, colour: COLOURS[0], points: straight },
        Series { name: "oblique", key: Key::Dot, colour: COLOURS[1], points: oblique },
    ];
    let area = titled(area, &title, &all)?;
    let mut chart =
        framed(&area).build_cartesian_2d(-1.05 * largest..1.05 * largest, -1.05 * largest..1.05 * largest)?;
    let [x, y] = ["boundary elements", "default law"].map(|of| format!("{of}: F/(mu Q), M/(mu Q c) [-]"));
    axes(&mut chart.configure_mesh(), &x, &y).draw()?;
    draw!(chart, &all);
    Ok(())
}

/// Loads \[N] and the program's and the published torques \[N mm] of a row of docs/evidence.md.
fn torques(head: &str) -> [Vec<(f64, f64)>; 2] {
    let loads: Vec<f64> = head.split(['/', ' ']).filter_map(|word| word.parse().ok()).collect();
    let figures = evidence::row(head);
    [0, 1].map(|which| loads.iter().copied().zip(figures[which * loads.len()..].iter().copied()).collect())
}

fn torque(area: &Area<'_>) -> Drawn {
    let [radial, radial_model] = torques("radial 300 / 1000 / 3000 N");
    let [axial, axial_model] = torques("axial 150 / 500 / 2000 N");
    let line = |name, colour, points| Series { name, key: Key::Line, colour, points };
    let dots = |name, colour, points| Series { name, key: Key::Dot, colour, points };
    let all = [
        line("SKF, radial", COLOURS[0], radial_model),
        dots("program", COLOURS[0], radial),
        line("SKF, axial", COLOURS[1], axial_model),
        dots("program", COLOURS[1], axial),
    ];
    let area = titled(area, "c  dry torque of a 6206 against SKF's model of sliding friction", &all)?;
    let mut chart =
        framed(&area).build_cartesian_2d((100.0..5000f64).log_scale(), (0.5..100f64).log_scale())?;
    axes(&mut chart.configure_mesh(), "load [N]", "friction torque [N mm]")
        .x_labels(4)
        .x_label_formatter(&|value| format!("{value}"))
        .y_label_formatter(&|value| format!("{value}"))
        .draw()?;
    draw!(chart, &all);
    Ok(())
}

fn spin(area: &Area<'_>) -> Drawn {
    let ratios = ["0.1", "0.3", "1", "3"];
    let laws = ["kalker_table (default)", "kalker, degree 5", "regularised", "saturated"];
    let all: Vec<Series> = laws
        .into_iter()
        .enumerate()
        .map(|(law, name)| Series {
            name,
            key: Key::Line,
            colour: COLOURS[law],
            points: ratios.map(|ratio| (ratio.parse().unwrap(), evidence::row(ratio)[law])).to_vec(),
        })
        .collect();
    let area = titled(area, "d  spin moment of complete sliding over its closed form", &all)?;
    let mut chart = framed(&area).build_cartesian_2d((0.1..3f64).log_scale(), 0.0..1.1)?;
    axes(
        &mut chart.configure_mesh(),
        "axis ratio, along over across rolling [-]",
        "moment over closed form [-]",
    )
    .x_label_formatter(&|value| format!("{value}"))
    .draw()?;
    draw!(chart, &all);
    Ok(())
}

fn main() -> Drawn {
    let directory = std::env::args().nth(1).unwrap_or_else(|| "docs/figures".into());
    let path = Path::new(&directory).join("evidence.svg");
    let (columns, rows) = (2, 2);
    let title = "The program against numbers that it was not made from";
    picture(&path, (columns * PANEL.0, rows * PANEL.1), title, |body| {
        let areas = body.split_evenly((rows as usize, columns as usize));
        statics(&areas[0])?;
        contacts(&areas[1])?;
        torque(&areas[2])?;
        spin(&areas[3])
    })?;
    println!("{}", path.display());
    Ok(())
}
