//! Results of a run of a shaft with its housings: its table, its plots, its words.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use roulement::interface::variables::quoted;
use roulement::scene::system::SystemScene;
use roulement::scene::system::spring::SceneSpring;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::system::{HousingOutputs, PointOutput, ShaftOutputs, System, SystemOutputs};

use super::acceleration;
use super::figures::Shown;
use super::plots::{Curve, Panel, figure};
use super::style::PlotError;
use crate::watch::{BearingSeen, Life};

/// Names of all points of shafts whose motion is known, with that of their shaft before them: bearings, loads, points.
pub fn places(scene: &SystemScene) -> Vec<String> {
    let bearings = scene.bearings.iter().map(|bearing| (&scene.shafts[bearing.shaft], &bearing.name));
    let loads = scene.shafts.iter().flat_map(|shaft| shaft.load.iter().map(move |load| (shaft, &load.name)));
    let points =
        scene.shafts.iter().flat_map(|shaft| shaft.point.iter().map(move |point| (shaft, &point.name)));
    bearings.chain(loads).chain(points).map(|(shaft, name)| format!("{}.{name}", shaft.name)).collect()
}

/// Motion at all of these points.
fn points(outputs: &SystemOutputs) -> impl Iterator<Item = &PointOutput> {
    outputs.seats.iter().chain(&outputs.loads).chain(&outputs.points)
}

/// Names of all points of a housing whose motion is known: bearings, loads, points.
fn places_of_housing(scene: &SystemScene, index: usize) -> impl Iterator<Item = &String> {
    let housing = &scene.housings[index];
    let bearings = scene.bearings_in(index).map(|bearing| &scene.bearings[bearing].name);
    let loads = housing.load.iter().map(|load| &load.name);
    bearings.chain(loads).chain(housing.point.iter().map(|point| &point.name))
}

/// Motion at all of these points.
fn points_of_housing(outputs: &HousingOutputs) -> impl Iterator<Item = &PointOutput> {
    outputs.seats.iter().chain(&outputs.loads).chain(&outputs.points)
}

/// Names and units of the columns of the table of shafts and its housings, the time first.
pub fn columns(scene: &SystemScene) -> Vec<(String, &'static str)> {
    let mut columns = vec![("time".to_string(), "s")];
    for shaft in &scene.shafts {
        let own = [("angle", "rad"), ("speed", "rad/s"), ("torque", "N m")];
        columns.extend(own.map(|(quantity, unit)| (format!("{}.{quantity}", shaft.name), unit)));
    }
    for place in places(scene) {
        let of = [("x", "m"), ("y", "m"), ("z", "m"), ("ry", "rad"), ("rz", "rad")];
        columns.extend(of.map(|(component, unit)| (format!("{place}.{component}"), unit)));
    }
    for (index, housing) in scene.housings.iter().enumerate() {
        for place in places_of_housing(scene, index) {
            let of = [("x", "m"), ("y", "m"), ("z", "m"), ("rx", "rad"), ("ry", "rad"), ("rz", "rad")];
            let housing = &housing.name;
            columns.extend(of.map(|(component, unit)| (format!("{housing}.{place}.{component}"), unit)));
        }
    }
    for (index, name) in scene.link_names().enumerate() {
        let forces = ["force.x", "force.y", "force.z"].map(|quantity| (quantity, "N"));
        let others = match index < scene.meshes.len() {
            true => vec![("normal_force", "N"), ("misalignment", "rad"), ("friction_power", "W")],
            false if couples(scene, index) => {
                vec![("moment.x", "N m"), ("moment.y", "N m"), ("moment.z", "N m"), ("twist", "rad")]
            }
            false => {
                let mut others = vec![("moment.y", "N m"), ("moment.z", "N m")];
                if rolls(scene, index) {
                    others.extend([("largest_load", "N"), ("peak_pressure", "Pa"), ("loaded_rollers", "")]);
                    if spring(scene, index).is_some_and(SceneSpring::rubs) {
                        others.extend([("friction_torque", "N m"), ("loss.total", "W"), ("film.ratio", "")]);
                    }
                }
                others
            }
        };
        columns.extend(
            forces.into_iter().chain(others).map(|(quantity, unit)| (format!("{name}.{quantity}"), unit)),
        );
    }
    columns.extend(scene.motions().map(|(load, (_, component, _))| {
        let (what, unit) = if component < 3 { ("force", "N") } else { ("moment", "N m") };
        (format!("{}.{what}.{}", load.name, ["x", "y", "z"][component % 3]), unit)
    }));
    let velocities = all_places(scene)
        .flat_map(|place| ["x", "y", "z"].map(|axis| (format!("{place}.velocity.{axis}"), "m/s")));
    columns.extend(velocities);
    columns
}

/// These columns, then the accelerations of all places.
pub fn columns_with_accelerations(scene: &SystemScene) -> Vec<(String, &'static str)> {
    let accelerations = all_places(scene)
        .flat_map(|place| ["x", "y", "z"].map(|axis| (acceleration::name(&place, axis), acceleration::UNIT)));
    columns(scene).into_iter().chain(accelerations).collect()
}

/// All places of shafts and housings whose motion is known.
fn all_places(scene: &SystemScene) -> impl Iterator<Item = String> {
    let of_housing = |index: usize| {
        let housing = &scene.housings[index].name;
        places_of_housing(scene, index).map(move |place| format!("{housing}.{place}"))
    };
    places(scene).into_iter().chain((0..scene.housings.len()).flat_map(of_housing))
}

/// Velocities [m/s] of these places.
pub fn velocities(outputs: &SystemOutputs) -> impl Iterator<Item = f64> {
    let places = points(outputs).chain(outputs.housings.iter().flat_map(points_of_housing));
    places.flat_map(|point| [point.velocity.x, point.velocity.y, point.velocity.z])
}

/// A bearing by its stiffness or by rollers, or a coupling; none of a mesh.
fn spring(scene: &SystemScene, link: usize) -> Option<&SceneSpring> {
    link.checked_sub(scene.meshes.len()).and_then(|own| scene.springs.get(own))
}

/// Is a link a coupling?
fn couples(scene: &SystemScene, link: usize) -> bool {
    spring(scene, link).is_some_and(SceneSpring::is_coupling)
}

/// Is a link a bearing by rollers?
fn rolls(scene: &SystemScene, link: usize) -> bool {
    spring(scene, link).is_some_and(|spring| spring.rollers.is_some())
}

/// What bearings by rollers do not know, in a sentence each.
pub fn unknown_to_rollers(scene: &SystemScene) -> impl Iterator<Item = String> + '_ {
    let of = scene.springs.iter().filter(|spring| spring.rollers.is_some());
    of.map(|spring| {
        let losses = match spring.rubs() {
            true => "slip and its losses, friction of the cage, churning of a sump",
            false => "friction and losses (rollers.film gives them oil), slip",
        };
        format!(
            "bearing {}: rollers in balance wherever the rings are (level \"equilibrium\"); not simulated: {losses}, skew, a cage that moves by \
             itself, the weight of rollers, growth by heat and fits, waves and spalls",
            spring.name
        )
    })
}

/// Values of these columns: forces of a mesh are those on its first gear, of a bearing by its stiffness those on the shaft, of a coupling those on its first shaft.
pub fn row(scene: &SystemScene, outputs: &SystemOutputs) -> Vec<f64> {
    let mut row = vec![outputs.time];
    row.extend(outputs.shafts.iter().flat_map(|own| [own.spin.angle, own.spin.speed, own.torque]));
    for PointOutput { displacement: d, tilt, .. } in points(outputs) {
        row.extend([d.x, d.y, d.z, tilt.y, tilt.z]);
    }
    for PointOutput { displacement, tilt, .. } in outputs.housings.iter().flat_map(points_of_housing) {
        row.extend(displacement.iter().chain(tilt.iter()));
    }
    for (index, link) in outputs.links.iter().enumerate() {
        let force = &link.state.force;
        row.extend(force.fixed_rows::<3>(0).iter());
        match index < scene.meshes.len() {
            true => {
                row.extend([link.teeth.normal_force, link.teeth.misalignment, link.teeth.friction_power]);
            }
            false if couples(scene, index) => {
                row.extend(force.fixed_rows::<3>(3).iter());
                row.push(link.state.displacement[3]);
            }
            false => {
                row.extend(force.fixed_rows::<2>(4).iter());
                if let Some(rollers) = link.rollers() {
                    row.extend([rollers.largest_load, rollers.peak_pressure, rollers.loaded as f64]);
                    let friction = rollers.friction.iter();
                    row.extend(friction.flat_map(|of| [of.torque(), of.loss, of.film_ratio]));
                }
            }
        }
    }
    row.extend(&outputs.holding);
    row.extend(velocities(outputs));
    row
}

/// Curves of a plot: as many as there are colours for.
const CURVES: usize = 7;

/// Value in a row.
type Get = Box<dyn Fn(&SystemOutputs) -> f64>;

/// Quantity over time of parts with their names.
fn over_time(
    rows: &[SystemOutputs],
    y_label: &'static str,
    parts: impl Iterator<Item = (String, Get)>,
) -> Panel {
    let curve = |(name, get): (String, Get)| Curve {
        name,
        points: rows.iter().map(|row| (row.time * 1e3, get(row))).collect(),
        band: vec![],
    };
    Panel { x_label: "time [ms]", y_label, curves: parts.take(CURVES).map(curve).collect(), least: 1e-3 }
}

/// Draws the shaft's motion at its bearings over time, its path there, and the motion of housings at their bearings.
///
/// # Errors
/// If the file cannot be written.
pub fn write_plot(
    scene: &SystemScene,
    rows: &[SystemOutputs],
    directory: &Path,
) -> Result<PathBuf, PlotError> {
    let names = || scene.bearings.iter().map(|bearing| bearing.name.clone()).enumerate();
    let of_seats = |y_label, get: fn(&PointOutput) -> f64| {
        let seat = |k| -> Get { Box::new(move |row| get(&row.seats[k])) };
        over_time(rows, y_label, names().map(|(k, name)| (name, seat(k))))
    };
    let of_shafts = |y_label, get: fn(&ShaftOutputs) -> f64| {
        let shaft = |k| -> Get { Box::new(move |row| get(&row.shafts[k])) };
        let shafts = scene.shafts.iter().enumerate();
        over_time(rows, y_label, shafts.map(|(k, own)| (own.name.clone(), shaft(k))))
    };
    // In the second half, about its mean: bearings lie apart by more than they move, and a start goes further than an orbit.
    let later = &rows[rows.len() / 2..];
    let path = |(k, name): (usize, String)| {
        let mean =
            later.iter().map(|row| row.seats[k].displacement).sum::<Vector3<f64>>() / later.len() as f64;
        let points = later.iter().map(|row| (row.seats[k].displacement - mean) * 1e6);
        Curve { name, points: points.map(|d| (d.y, d.z)).collect(), band: vec![] }
    };
    let mut panels = vec![
        Panel {
            x_label: "y [um]",
            y_label: "path of the shaft at its bearings about its mean: z [um]",
            curves: names().take(CURVES).map(path).collect(),
            least: 1e-3,
        },
        of_seats("along the axis, x [um]", |point| point.displacement.x * 1e6),
        of_seats("displacement y [um]", |point| point.displacement.y * 1e6),
        of_seats("displacement z [um]", |point| point.displacement.z * 1e6),
        of_seats("tilt about y [urad]", |point| point.tilt.y * 1e6),
        of_seats("tilt about z [urad]", |point| point.tilt.z * 1e6),
        of_shafts("speed [rad/s]", |row| row.spin.speed),
        of_shafts("torque that drives the shaft [N m]", |row| row.torque),
    ];
    panels.extend(of_housings(scene, rows));
    let path = directory.join("shaft.svg");
    let title = if scene.title.is_empty() { "shaft on its bearings" } else { &scene.title };
    figure(&path, title, panels)?;
    Ok(path)
}

/// Motion of the housings at their bearings over time.
fn of_housings(scene: &SystemScene, rows: &[SystemOutputs]) -> Vec<Panel> {
    let seats: Vec<(usize, usize, usize)> = (0..scene.housings.len())
        .flat_map(|housing| {
            let bearings = scene.bearings_in(housing).enumerate();
            bearings.map(move |(seat, bearing)| (housing, seat, bearing))
        })
        .collect();
    if seats.is_empty() {
        return vec![];
    }
    let of_seats = |y_label, get: fn(&PointOutput) -> f64| {
        let seats = seats.iter().map(|&(housing, seat, bearing)| {
            let name = format!("{} at {}", scene.housings[housing].name, scene.bearings[bearing].name);
            let get: Get = Box::new(move |row| get(&row.housings[housing].seats[seat]));
            (name, get)
        });
        over_time(rows, y_label, seats)
    };
    vec![
        of_seats("housing along the axis, x [um]", |point| point.displacement.x * 1e6),
        of_seats("housing, displacement y [um]", |point| point.displacement.y * 1e6),
        of_seats("housing, displacement z [um]", |point| point.displacement.z * 1e6),
        of_seats("housing, tilt about y [urad]", |point| point.tilt.y * 1e6),
        of_seats("housing, tilt about z [urad]", |point| point.tilt.z * 1e6),
    ]
}

/// Writes the summary of a shaft's run in words, with error bars where its figures and those of its bearings have them: of the shaft, and of
/// its bearings some lines each.
///
/// # Errors
/// If it cannot be written.
pub fn write_summary<'a>(
    out: &mut String,
    system: &System,
    shaft: &Shown,
    bearings: impl Iterator<Item = (&'a Shown, &'a BearingSeen)>,
) -> std::fmt::Result {
    let (scene, outputs) = (system.scene(), system.outputs());
    if !scene.title.is_empty() {
        writeln!(out, "{}", scene.title)?;
    }
    writeln!(out, "at {:.3} ms", outputs.time * 1e3)?;
    for (section, carrier) in scene.shafts.iter().zip(system.shafts()) {
        let name = &section.name;
        let at_end = |what: &str, digits| shaft.text(&format!("end {}.{what}", quoted(name)), 1.0, digits);
        let (speed, torque) = (at_end("speed", 4), at_end("torque", 5));
        writeln!(out, "{name:<16} {speed} rad/s, driven by {torque} N m")?;
        if let [first, .., last] = carrier.modes.as_slice() {
            let (modes, count) = (format!("{name} modes"), carrier.modes.len());
            writeln!(out, "{modes:<16} {count} between held stations, {first:.0} to {last:.0} Hz")?;
        }
    }
    for ((name, bearing), (shown, seen)) in system.bearings().zip(bearings) {
        let direction = scene.bearings.iter().find(|mounted| mounted.name == name);
        let sign = direction.map_or(1.0, |mounted| mounted.mounting.direction.sign());
        // What the shaft does to the bearing, in the shaft's axes.
        let force = bearing.outputs().inner.wrench.force;
        let (axial, radial) = (-sign * force.x, force.y.hypot(force.z));
        let seat = |axis: &str| {
            let name = format!("end {}.seat.displacement.{axis}", quoted(name));
            shaft.text(&name, 1e6, 3)
        };
        writeln!(
            out,
            "{name:<16} shaft at x {} y {} z {} um; it presses with {radial:.1} N across, {axial:.1} N along x",
            seat("x"),
            seat("y"),
            seat("z")
        )?;
        let loads = bearing.outputs().balls.iter().map(|ball| ball.inner.load);
        let (least, most) =
            loads.fold((f64::INFINITY, 0.0f64), |(low, high), load| (low.min(load), high.max(load)));
        let has_means = !shown.figures.get(LOSSES[0].name).is_nan();
        let power = has_means.then(|| {
            let [power, torque] = [(LOSSES[0].name, 3), ("friction torque", 5)]
                .map(|(name, digits)| shown.text(name, 1.0, digits));
            format!("; mean losses {power} W, friction torque {torque} N m")
        });
        writeln!(out, "{:<16} ball loads {least:.1} to {most:.1} N{}", "", power.unwrap_or_default())?;
        if let Some(Life { life, hours: Some(hours), .. }) = &seen.life {
            writeln!(out, "{:<16} life L10r {hours:.0} h, static safety {:.2}", "", life.static_safety)?;
        }
    }
    for (name, link) in scene.link_names().zip(&outputs.links) {
        if let Some(rollers) = link.rollers() {
            let force = &link.state.force;
            let hours = link.hours().map_or(String::new(), |hours| format!(", L10r {hours:.0} h"));
            let friction = rollers.friction.map_or("no friction".to_owned(), |of| {
                format!("friction torque {:.5} N m, {:.3} W", of.torque(), of.loss)
            });
            writeln!(
                out,
                "{name:<16} the shaft presses with {:.1} N across, {:.1} N along x; {} rollers loaded, up to {:.1} N, {:.0} MPa{hours}; {friction}",
                force[1].hypot(force[2]),
                -force[0],
                rollers.loaded,
                rollers.largest_load,
                rollers.peak_pressure * 1e-6
            )?;
        }
    }
    let housings = scene.housings.iter().zip(&outputs.housings);
    for (housing, outputs) in housings.clone() {
        let at = |point: &PointOutput| {
            let (d, r) = (point.displacement * 1e6, point.tilt * 1e6);
            format!(
                "x {:.3} y {:.3} z {:.3} um, turned by {:.2} {:.2} {:.2} urad",
                d.x, d.y, d.z, r.x, r.y, r.z
            )
        };
        let first = outputs.seats.first().map_or_else(String::new, at);
        writeln!(out, "{:<16} at its first bearing {first}", housing.name)?;
    }
    let one = scene.shafts.len() == 1;
    let of_shafts = scene.shafts.iter().zip(&outputs.shafts);
    let energies = of_shafts.map(|(shaft, own)| (if one { "energy" } else { &shaft.name }, &own.energies));
    let of_housings = housings.map(|(housing, o)| (housing.name.as_str(), &o.energies));
    let of_rings = outputs.ground.iter().map(|own| ("sliding rings", own));
    for (name, energies) in energies.chain(of_housings).chain(of_rings) {
        writeln!(
            out,
            "{:<16} put in {:.5} J, to bearings {:.5} J, damped {:.5} J, balance {:.2e} J",
            name,
            energies.input,
            energies.bearings,
            energies.damping,
            energies.unaccounted()
        )?;
    }
    Ok(())
}
