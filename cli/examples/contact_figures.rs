//! Draws the rolling contact laws as the paper's figures 1 to 4 and 8 to 10, with independent data as points:
//! `cargo run --release --example contact_figures [DIRECTORY]`.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;
use roulement::analysis::single_contact::{Law, RollingContact, RollingForces, ScaledContact};
use roulement::contact::identification::{Identification, identify_by_table};
use roulement::kalker::Patch;
use roulement::kalker::half_space::{HalfSpace, cells};
use roulement::kalker::linear::Scales;
use roulement::kalker::nonlinear::Kalker;
use roulement::scene::CreepLaw;
use roulement_cli::field::figure::shade;
use roulement_cli::report::fine::{FINE, Key, LABEL, LINE, MARGIN, axes, headed, picture};
use roulement_cli::report::style::{Area, COLOURS, Drawn};
use serde::Deserialize;

const PANEL: (u32, u32) = (620, 380);
/// [-] forces beyond this are not drawn: linear theory has no limit.
const HIGHEST: f64 = 1.6;
/// [-] strips of half a contact for strip theory.
const STRIPS: u32 = 200;
/// [m] radius of the paper's ball on a plane.
const BALL_RADIUS: f64 = 6.35e-3;

type OfLaw = fn(&RollingForces) -> f64;
type OfCase = fn(&Case) -> f64;
/// Label of an axis, a case's place on it, and how a contact is put there.
type Axis = (&'static str, OfCase, fn(&mut RollingContact, f64));
/// Name of a force, and what a law and the data say of it.
type Quantity = (&'static str, OfLaw, OfCase);

/// A case of the independent data.
#[derive(Clone)]
struct Case {
    contact: RollingContact,
    result: Reference,
}

/// Result of the boundary elements for it.
#[derive(Clone, Deserialize)]
struct Reference {
    kind: String,
    fx: f64,
    fy: f64,
    mz: f64,
}

fn read_cases(path: &str) -> Result<Vec<Case>, csv::Error> {
    let mut table = csv::Reader::from_path(path)?;
    let headers = table.headers()?.clone();
    let case = |record: csv::StringRecord| -> Result<Case, csv::Error> {
        Ok(Case { contact: record.deserialize(Some(&headers))?, result: record.deserialize(Some(&headers))? })
    };
    table.records().map(|record| record.and_then(case)).collect()
}

struct Curve {
    name: String,
    points: Vec<(f64, f64)>,
    /// Independent data are drawn as points.
    data: bool,
    colour: RGBColor,
}

struct Panel {
    title: String,
    x: &'static str,
    y: &'static str,
    curves: Vec<Curve>,
}

fn chart(panel: &Panel, area: &Area<'_>) -> Drawn {
    let points = || panel.curves.iter().flat_map(|curve| &curve.points);
    let extent = |get: fn(&(f64, f64)) -> f64| {
        points().map(get).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
    };
    let area = &named(panel, area)?;
    let ((x0, x1), (y0, y1)) = (extent(|p| p.0), extent(|p| p.1));
    let air = 0.06 * (y1 - y0);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(36 * FINE)
        .y_label_area_size(60 * FINE)
        .build_cartesian_2d(x0..x1, y0 - air..y1 + air)?;
    axes(&mut chart.configure_mesh(), panel.x, panel.y).draw()?;
    for curve in &panel.curves {
        let colour = curve.colour;
        if curve.data {
            let ring = colour.stroke_width(FINE);
            chart.draw_series(curve.points.iter().map(|&point| Circle::new(point, 3 * FINE, ring)))?;
        } else {
            chart.draw_series(LineSeries::new(curve.points.iter().copied(), colour.stroke_width(LINE)))?;
        }
    }
    Ok(())
}

/// Heading of a panel, and below it the names of its curves, outside the data; gives the rest of the panel.
fn named<'a>(panel: &Panel, area: &Area<'a>) -> Result<Area<'a>, Box<dyn Error>> {
    let mut area = headed(area, &panel.title, &[])?;
    let keys: Vec<_> = panel
        .curves
        .iter()
        .map(|curve| (curve.name.as_str(), if curve.data { Key::Dot } else { Key::Line }, curve.colour))
        .collect();
    // As many in a row as there is room for.
    for row in keys.chunks(3) {
        area = headed(&area, "", row)?;
    }
    Ok(area)
}

/// [-] F_x over mu F_n by strip theory (Haines and Ollerton 1963: each strip along rolling is a line contact after Carter, and strips
/// do not know of each other), of the creepage over 2 mu p_0 (1 - nu) / G.
fn strip_theory(creepage: f64) -> f64 {
    let strip = |k: u32| {
        // Length of a strip over that of the middle one; its pressure is to the middle one's as its length is.
        let y = (f64::from(k) + 0.5) / f64::from(STRIPS);
        let length = (1.0 - y * y).sqrt();
        let adhesion = (1.0 - creepage / length).max(0.0);
        length * length * (1.0 - adhesion * adhesion)
    };
    1.5 * (0..STRIPS).map(strip).sum::<f64>() / f64::from(STRIPS)
}

/// Force over mu F_n where the whole ellipse slides and nothing deforms (complete slip, Johnson 1985): traction mu p against the rigid
/// slip of creepages and spin, summed over rings and directions of the ellipse.
fn complete_slip(contact: &RollingContact) -> [f64; 2] {
    const RINGS: u32 = 200;
    const DIRECTIONS: u32 = 400;
    let mut force = [0.0; 2];
    for ring in 0..RINGS {
        let r = (f64::from(ring) + 0.5) / f64::from(RINGS);
        // Part of the load on this ring's share of a direction.
        let load = 3.0 * r * (1.0 - r * r).sqrt() / f64::from(RINGS * DIRECTIONS);
        for direction in 0..DIRECTIONS {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(direction) / f64::from(DIRECTIONS)).sin_cos();
            let (x, y) = (contact.semi_axis_x * r * cos, contact.semi_axis_y * r * sin);
            let slip = [contact.creep_x - contact.spin * y, contact.creep_y + contact.spin * x];
            let size = slip[0].hypot(slip[1]).max(f64::MIN_POSITIVE);
            force[0] += load * slip[0] / size;
            force[1] += load * slip[1] / size;
        }
    }
    force
}

/// Traction over its bound on the ellipse: 1 where the contact slides.
fn adhesion_map(case: &Case, area: &Area<'_>) -> Drawn {
    let contact = &case.contact;
    let a = contact.semi_axis_x;
    let creep = 0.8 * contact.friction * a / BALL_RADIUS;
    let pure = RollingContact { creep_x: creep, creep_y: 0.0, spin: 0.0, curvature: 0.0, ..contact.clone() };
    let ScaledContact { patch, creepage } = pure.scaled()?;
    let kalker = Kalker::new(patch, 7)?;
    let solution = kalker.solve(&creepage, None)?;
    let grid = HalfSpace::with_cells(&patch, cells(&patch, 48))?;
    let exact = grid.solve(&creepage, None)?;
    let title = format!(
        "1b  |f|/(mu p_z) at c_x R/(mu a) = 0.8, polynomials of degree 7: {:.0} % stick",
        100.0 * solution.stick
    );
    let area = headed(area, &title, &[])?;
    let edge = format!("edge of adhesion by the half-space: {:.0} % stick", 100.0 * exact.stick);
    let area = headed(&area, "", &[(&edge, Key::Line, COLOURS[1])])?;
    let mut chart = ChartBuilder::on(&area)
        .margin(MARGIN)
        .x_label_area_size(36 * FINE)
        .y_label_area_size(60 * FINE)
        .build_cartesian_2d(-1.75f64..1.75, -1.05f64..1.05)?;
    axes(&mut chart.configure_mesh(), "x/a (rolling to the right)", "y/b").disable_mesh().draw()?;
    chart.draw_series(kalker.local_states(&solution, &creepage).iter().map(|state| {
        let fraction = state.traction[0].hypot(state.traction[1]) / state.bound;
        let colour = shade(fraction);
        Circle::new((state.place[0], state.place[1]), 12 * FINE, colour.filled())
    }))?;
    // In every row of cells the last one that sticks, seen from the leading edge; cells count from the middle in equal distances.
    let states = grid.states(&creepage, &exact);
    let mut rows: Vec<(f64, f64)> = vec![];
    for cell in states.iter().filter(|cell| cell.sticks) {
        let [x, y] = cell.place;
        match rows.iter_mut().find(|row| (row.1 - y).abs() < 1e-6) {
            Some(row) => row.0 = row.0.min(x),
            None => rows.push((x, y)),
        }
    }
    rows.sort_by(|one, other| one.1.total_cmp(&other.1));
    chart.draw_series(LineSeries::new(rows, COLOURS[1].stroke_width(2 * LINE)))?;
    for (k, fraction) in [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
        let y = -0.6 + 0.3 * k as f64;
        let colour = shade(fraction);
        chart.draw_series([Rectangle::new([(1.35, y - 0.1), (1.45, y + 0.1)], colour.filled())])?;
        chart.draw_series([Text::new(format!("{fraction}"), (1.5, y + 0.04), LABEL)])?;
    }
    Ok(())
}

/// One quantity over one creepage: laws as lines, data as points.
fn compare(
    title: &str,
    cases: &[Case],
    x: Axis,
    quantities: &[Quantity],
    laws: &[(&str, Law)],
) -> Result<Panel, Box<dyn Error>> {
    let (label, place, set) = x;
    let mut curves = vec![];
    let last = cases.iter().map(place).fold(0.0, f64::max);
    for (number, (name, of_law, of_case)) in quantities.iter().enumerate() {
        for (k, (law_name, law)) in laws.iter().enumerate() {
            let mut points = vec![];
            for step in 0..=60 {
                let at = last * f64::from(step) / 60.0;
                let mut contact = cases[0].contact.clone();
                set(&mut contact, at);
                let force = of_law(&contact.evaluate(*law)?);
                if force.abs() <= HIGHEST {
                    points.push((at, force));
                }
            }
            let colour = COLOURS[(number * laws.len() + k) % COLOURS.len()];
            curves.push(Curve { name: format!("{name} {law_name}"), points, data: false, colour });
        }
        curves.push(Curve {
            name: format!("{name} boundary elements"),
            points: cases.iter().map(|case| (place(case), of_case(case))).collect(),
            data: true,
            colour: BLACK,
        });
    }
    Ok(Panel { title: title.into(), x: label, y: "force over mu Q", curves })
}

/// Forces of complete slip over the spin.
fn sliding(cases: &[Case], (_, place, set): Axis) -> [Curve; 2] {
    let last = cases.iter().map(place).fold(0.0, f64::max);
    let forces: Vec<(f64, [f64; 2])> = (0..=60)
        .map(|step| {
            let at = last * f64::from(step) / 60.0;
            let mut contact = cases[0].contact.clone();
            set(&mut contact, at);
            (at, complete_slip(&contact))
        })
        .collect();
    [("F_x", 0), ("F_y", 1)].map(|(name, k)| Curve {
        name: format!("{name} complete slip"),
        points: forces.iter().map(|(at, force)| (*at, force[k])).collect(),
        data: false,
        colour: COLOURS[4 + k],
    })
}

/// A function of the spin coupling: theory and fit, data as points.
fn fitted(
    title: &str,
    found: &Identification,
    which: usize,
    data: Vec<(f64, f64)>,
    x: &'static str,
) -> Panel {
    let samples = &found.samples[which];
    let curve = |name: &str, k: usize, colour| Curve {
        name: name.into(),
        points: samples.iter().map(|sample| (sample[0], sample[k])).collect(),
        data: false,
        colour,
    };
    let last = samples.iter().map(|sample| sample[0]).fold(0.0, f64::max);
    let curves = vec![
        curve("Kalker, table", 1, COLOURS[0]),
        curve("identified", 2, COLOURS[1]),
        Curve {
            name: "boundary elements".into(),
            points: data.into_iter().filter(|point| point.0 <= last).collect(),
            data: true,
            colour: BLACK,
        },
    ];
    Panel { title: title.into(), x, y: "[-]", curves }
}

/// Strip theory over the creepages of a ball on a plane.
fn strips(cases: &[Case]) -> Curve {
    let place =
        |case: &Case| case.contact.creep_x * BALL_RADIUS / (case.contact.friction * case.contact.semi_axis_x);
    let last = cases.iter().map(place).fold(0.0, f64::max);
    let contact = &cases[0].contact;
    let scale = contact.semi_axis_x * contact.shear_modulus
        / (2.0 * contact.peak_pressure * (1.0 - contact.poisson_ratio) * BALL_RADIUS);
    let point = |step: u32| {
        let at = last * f64::from(step) / 60.0;
        (at, strip_theory(at * scale))
    };
    Curve {
        name: "F_x strip theory".into(),
        points: (0..=60).map(point).collect(),
        data: false,
        colour: COLOURS[4],
    }
}

fn main() -> Drawn {
    let directory = std::env::args().nth(1).unwrap_or_else(|| "docs/figures".into());
    let cases = read_cases("tests/data/contact/curves.csv")?;
    let of = |kind: &str| -> Vec<Case> {
        let mut chosen: Vec<Case> = cases.iter().filter(|case| case.result.kind == kind).cloned().collect();
        chosen.sort_by(|one, other| {
            let key = |case: &Case| case.contact.creep_x + case.contact.creep_y + case.contact.spin;
            key(one).total_cmp(&key(other))
        });
        chosen
    };
    let (kalker3, kalker5) = (("Kalker, degree 3", Law::Kalker(3)), ("Kalker, degree 5", Law::Kalker(5)));
    let regularised = ("regularised", Law::Simulated(CreepLaw::Regularised));
    let table_law = ("table", Law::Simulated(CreepLaw::KalkerTable));
    let saturated = ("saturated", Law::Simulated(CreepLaw::Saturated));
    let fx: Quantity = ("F_x", |f| f.fx, |case| case.result.fx);
    let fy: Quantity = ("F_y", |f| f.fy, |case| case.result.fy);
    let mz: Quantity = ("M_z/c", |f| f.mz, |case| case.result.mz);
    let linear = ("linear", Law::Simulated(CreepLaw::Linear));
    // As the paper's: 1a and 2 over c_x R / (mu a).
    let by_x: Axis = (
        "c_x R / (mu a)",
        |case| case.contact.creep_x * BALL_RADIUS / (case.contact.friction * case.contact.semi_axis_x),
        |contact, x| contact.creep_x = x * contact.friction * contact.semi_axis_x / BALL_RADIUS,
    );
    let by_y: Axis = (
        "lateral creepage c_y, with c_x = 5e-4",
        |case| case.contact.creep_y,
        |contact, x| contact.creep_y = x,
    );
    let by_spin: Axis = (
        "spin [1/m], with c_x = 5e-4 and c_y = 2e-4",
        |case| case.contact.spin,
        |contact, x| contact.spin = x,
    );
    let (fig1, fig3, fig4) = (of("fig1"), of("fig3"), of("fig4"));

    // spin coupling of a ball on a plane (axis ratio 1)
    let patch = Patch { axis_ratio: 1.0, poisson_ratio: 0.3, rolling_angle: 0.0 };
    let found = identify_by_table(&patch)?;
    let scales = Scales::new(&patch)?;
    let mut sweeps = csv::Reader::from_path("tests/data/contact/identification.csv")?;
    let rows = sweeps.deserialize().collect::<Result<Vec<(f64, f64, String, f64, f64, f64, f64)>, _>>()?;
    let sweep = |creep: &str, get: &dyn Fn(f64, f64, f64) -> (f64, f64)| -> Vec<(f64, f64)> {
        let chosen = rows.iter().filter(|row| row.0 == 1.0 && row.2 == creep);
        chosen.map(|row| get(row.3, row.5, row.6)).collect()
    };
    let Scales { c23, c33, moment, .. } = scales;
    let mut first =
        compare("1a  net traction, longitudinal creepage", &fig1, by_x, &[fx], &[kalker3, kalker5, linear])?;
    first.curves.push(strips(&fig1));
    let mut fourth = compare("4  growing spin", &fig4, by_spin, &[fx, fy], &[kalker5, regularised])?;
    fourth.curves.extend(sliding(&fig4, by_spin));
    let panels = [
        first,
        compare(
            "2  the same: laws of simulations",
            &fig1,
            by_x,
            &[fx],
            &[table_law, regularised, saturated],
        )?,
        compare("3  growing lateral creepage", &fig3, by_y, &[fx, fy], &[kalker5, regularised, linear])?,
        fourth,
        compare("4  growing spin: moment", &fig4, by_spin, &[mz], &[kalker5, regularised, table_law])?,
        fitted(
            "8  phi_yz: lateral force by spin, axis ratio 1",
            &found,
            0,
            sweep("spin", &|h, fy, _| (0.5 * h * c23, fy)),
            "spin over eps_yz",
        ),
        fitted(
            "9  phi_z: spin moment by spin",
            &found,
            1,
            sweep("spin", &|h, _, mz| (h * c33 / moment, mz / moment)),
            "spin over eps_z",
        ),
        fitted(
            "10  phi_zy: spin moment by lateral creepage",
            &found,
            2,
            sweep("lateral", &|h, _, mz| (h * c23 / moment, -mz / moment)),
            "lateral creepage over eps_zy",
        ),
    ];
    let path = Path::new(&directory).join("rolling-contact.svg");
    let (columns, rows) = (3, 3);
    let title = "Rolling contact: figures 1 to 4 and 8 to 10 of the paper";
    picture(&path, (columns * PANEL.0, rows * PANEL.1), title, |body| {
        let areas = body.split_evenly((rows as usize, columns as usize));
        let order = [0, 2, 3, 4, 5, 6, 7, 8];
        for (panel, place) in panels.iter().zip(order) {
            chart(panel, &areas[place])?;
        }
        adhesion_map(&fig1[0], &areas[1])
    })?;
    println!("{}", path.display());
    Ok(())
}
