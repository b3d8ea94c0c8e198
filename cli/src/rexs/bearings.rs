//! Bearings and couplings of a REXS model: by the catalogue, by dimensions and load ratings, by their inner geometry, or by their stiffness.

use roulement::catalogue::{Request, rollers_of, rows_of, scene_of};
use toml::{Table, Value};

use super::frame::{Axes, Frame};
use super::gearbox::{Bearing, Coupling, Kind, Oil, Shaft, Springs};
use super::model::{Component, Model};
use super::names::Names;

/// [N/m] stiffness along or across the axis that a file's rigid one is taken for.
const RIGID: f64 = 1e9;
/// [N m/rad] stiffness of a tilt or twist that a file's rigid one is taken for.
const RIGID_TILT: f64 = 1e6;

/// Bearings between shafts and the casing, or between two shafts, and couplings.
///
/// # Errors
/// Names the component, and what is wrong with it.
pub fn bearings(
    model: &Model,
    shafts: &[Shaft],
    axes: &Axes,
    names: &mut Names,
    notes: &mut Vec<String>,
) -> Result<(Vec<Bearing>, Vec<Coupling>), String> {
    let (mut found, mut couplings) = (vec![], vec![]);
    for relation in model.related("side") {
        let part = |role: &str| relation.role(role).and_then(|id| model.components.get(&id));
        let (Some(of), Some(inner), Some(outer)) = (part("assembly"), part("inner_part"), part("outer_part"))
        else {
            continue;
        };
        let is_bearing = of.kind == "concept_bearing" || of.kind.starts_with("rolling_bearing_with");
        let index = |of: &Component| shafts.iter().position(|shaft| shaft.id == of.id);
        let sides = [index(inner), index(outer)];
        let place = |side: &str, shaft: usize| -> Result<f64, String> {
            Ok(shafts[shaft].position(of.needed(&format!("u_coordinate_on_shaft_{side}_side"))?))
        };
        let (shaft, other, position, kind) = match sides {
            [Some(shaft), other] if is_bearing => {
                let kind = kind(model, of, shafts[shaft].way, notes)?;
                (shaft, other, place("inner", shaft)?, kind)
            }
            [None, Some(shaft)] if is_bearing => {
                let kind = by_stiffness(of, shafts[shaft].way, "its inner ring stands still", notes)?;
                (shaft, None, place("outer", shaft)?, kind)
            }
            [Some(shaft), Some(other)] if is_coupling(of) => {
                let kind = by_stiffness(of, shafts[shaft].way, "", notes)?;
                (shaft, Some(other), place("inner", shaft)?, kind)
            }
            _ => {
                notes.push(format!("{of}: not simulated, between {inner} and {outer}"));
                continue;
            }
        };
        match (kind, other) {
            (Kind::Springs(springs), Some(other)) => {
                let name = names.of(of, "coupling");
                let comment = comment(of, &name);
                couplings.push(Coupling { name, shafts: [shaft, other], position, springs, comment });
            }
            (kind, other) => {
                let mut of = bearing(model, of, &shafts[shaft], kind, axes, names, notes)?;
                (of.shaft, of.outer_shaft, of.position) = (shaft, other, position);
                found.push(of);
            }
        }
    }
    Ok((found, couplings))
}

/// What the file calls a bearing.
fn designation(of: &Component) -> Option<&str> {
    of.text("catalogue_designation").or_else(|| of.text("name"))
}

/// Maker, name and type of a bearing, which is called by a name in the machine.
fn comment(of: &Component, called: &str) -> String {
    let parts = [
        of.text("manufacturer"),
        designation(of),
        of.text("bearing_type").or(Some(&of.kind)),
        Some(&of.name),
    ];
    let mut found: Vec<String> = vec![];
    for part in parts.into_iter().flatten().map(|part| part.replace('_', " ")) {
        if !part.is_empty() && part != called && !found.contains(&part) {
            found.push(part);
        }
    }
    found.join(", ")
}

/// A bearing on a shaft, but for where it is.
fn bearing(
    model: &Model,
    of: &Component,
    shaft: &Shaft,
    kind: Kind,
    axes: &Axes,
    names: &mut Names,
    notes: &mut Vec<String>,
) -> Result<Bearing, String> {
    let way = shaft.way;
    let frame = Frame::of(of, model)?.unwrap_or_default();
    let across = |keys: [&str; 2]| -> Result<[f64; 2], String> {
        let [v, w] = keys.map(|key| of.number(key).map(Option::unwrap_or_default));
        let turned = axes.turned(&(frame.axes * nalgebra::Vector3::new(0.0, v?, w?)));
        Ok([turned.y, turned.z])
    };
    let takes = of.text("axial_force_absorption");
    let has_balls = kind.has_balls();
    let one_way = takes.map_or(0.0, |takes| one_way(takes, way));
    let is_angular = of.text("bearing_type") == Some("angular_contact_ball_bearing");
    if has_balls && one_way != 0.0 && !is_angular {
        notes
            .push(format!("{of}: it takes axial force one way in the file; its ring is held both ways here"));
    }
    let is_tapered = kind.is_tapered();
    if matches!(kind, Kind::Rollers(_)) && takes == Some("no_direction") {
        let what = if is_tapered { "its rollers do here" } else { "its ribs, if it has some, do here" };
        notes.push(format!("{of}: it takes no axial force in the file; {what}"));
    }
    if is_tapered && one_way == 0.0 && takes != Some("no_direction") {
        notes.push(format!(
            "{of}: the file does not say which axial force it takes; here those of the shaft along +x"
        ));
    }
    let preload = of.number("preload_distance")?.unwrap_or(0.0);
    let name = names.of(of, "bearing");
    Ok(Bearing {
        comment: comment(of, &name),
        name,
        held: takes != Some("no_direction"),
        reversed: (has_balls && is_angular || is_tapered) && one_way < 0.0,
        preload: if has_balls && is_angular || is_tapered { preload } else { 0.0 },
        offset: across(["misalignment_in_v_direction", "misalignment_in_w_direction"])?,
        misalignment: across(["angular_misalignment_around_v_axis", "angular_misalignment_around_w_axis"])?,
        clearance: match &kind {
            Kind::Catalogue(name) if !is_angular && rows_of(name).is_none() => clearance(of)?,
            _ => None,
        },
        kind,
        ..Bearing::default()
    })
}

/// A bearing or coupling by its stiffness, and why.
fn by_stiffness(of: &Component, way: f64, why: &str, notes: &mut Vec<String>) -> Result<Kind, String> {
    let mut told = vec![];
    let mut springs = springs(of, way, &mut told)?;
    if is_coupling(of) {
        springs.torsion = stiffness(of, "rotational_stiffness", RIGID_TILT, &mut told)?;
    }
    if !why.is_empty() {
        told.insert(0, format!("by its stiffness ({why})"));
    }
    if !told.is_empty() {
        notes.push(format!("{of}: {}; in N/m and N m/rad", told.join("; ")));
    }
    Ok(Kind::Springs(springs))
}

/// Is it a coupling that is closed?
fn is_coupling(of: &Component) -> bool {
    of.kind == "coupling" || (of.kind == "switchable_coupling" && of.is("is_engaged"))
}

/// What a bearing is: by the catalogue, by what the file says of it, or by its stiffness.
fn kind(model: &Model, of: &Component, way: f64, notes: &mut Vec<String>) -> Result<Kind, String> {
    if of.kind == "concept_bearing" {
        let has_none = of.number("radial_stiffness")?.is_none_or(|number| number == 0.0);
        let Some(named) = named_in(&of.name).filter(|_| has_none) else {
            return by_stiffness(of, way, "a bearing without a type", notes);
        };
        notes.push(format!(
            "{of}: it has neither a type nor a stiffness across the axis: simulated as the {} of its name",
            named.name()
        ));
        return Ok(named);
    }
    let rows = of.number("number_of_bearing_rows")?.unwrap_or(1.0);
    let type_ = of.text("bearing_type").unwrap_or_default();
    if let Some(name) = designation(of).filter(|_| rows <= 1.0)
        && let Some(Ok(_)) = rollers_of(name)
    {
        return Ok(Kind::Rollers(name.to_owned()));
    }
    // Both rows slide as one or not at all: those that take no axial force are springs.
    let held = of.text("axial_force_absorption") != Some("no_direction");
    if let Some(name) = designation(of).filter(|name| held && matches!(rows_of(name), Some(Ok(_)))) {
        return Ok(Kind::Catalogue(name.to_owned()));
    }
    if rows > 1.0 || !matches!(type_, "" | "radial_grooved_ball_bearing" | "angular_contact_ball_bearing") {
        let why = if rows > 1.0 { format!("{rows} rows") } else { type_.replace('_', " ") };
        return by_stiffness(of, way, &why, notes);
    }
    if let Some(scene) = own_geometry(model, of)? {
        return Ok(Kind::Scene(scene));
    }
    let class =
        of.text("radial_clearance_class").map(|class| class.trim_start_matches("group_").to_uppercase());
    let class = class.filter(|class| matches!(class.as_str(), "C2" | "C3" | "C4" | "C5")).unwrap_or_default();
    if let Some(name) = designation(of) {
        let name = format!("{name} {class}").trim().to_owned();
        if scene_of(&name, None).is_ok() {
            return Ok(Kind::Catalogue(name));
        }
    }
    match by_ratings(of)? {
        Some(scene) => {
            notes.push(format!(
                "{of}: not in the catalogue: its balls are estimated from its dimensions and load ratings"
            ));
            Ok(Kind::Scene(scene))
        }
        None => {
            by_stiffness(of, way, "neither in the catalogue, nor with dimensions and load ratings", notes)
        }
    }
}

/// The bearing of the catalogue whose designation is a part of a name, of one or two words.
fn named_in(name: &str) -> Option<Kind> {
    let words: Vec<&str> =
        name.split([' ', ':', '(', ')', '[', ']']).filter(|word| !word.is_empty()).collect();
    let pairs = words.windows(2).map(|pair| pair.join(" "));
    words.iter().map(ToString::to_string).chain(pairs).find_map(|name| {
        if matches!(rollers_of(&name), Some(Ok(_))) {
            return Some(Kind::Rollers(name));
        }
        scene_of(&name, None).is_ok().then_some(Kind::Catalogue(name))
    })
}

/// Scene of a bearing by its dimensions and load ratings, in one line.
fn by_ratings(of: &Component) -> Result<Option<String>, String> {
    let mut text = Table::new();
    let keys = [
        ("bore", &["inner_diameter"][..]),
        ("outside", &["outer_diameter"]),
        ("width", &["width"]),
        ("dynamic_load_rating", &["radial_dynamic_load_rating", "dynamic_capacity"]),
        ("static_load_rating", &["radial_static_load_rating", "static_capacity"]),
    ];
    for (key, names) in keys {
        let mut number = None;
        for name in names {
            number = number.or(of.number(name)?);
        }
        let Some(number) = number.filter(|number| *number > 0.0) else { return Ok(None) };
        text.insert(key.into(), Value::Float(number));
    }
    if of.text("bearing_type") == Some("angular_contact_ball_bearing") {
        let Some(angle) = of.number("pressure_angle")?.or(of.number("nominal_pressure_angle")?) else {
            return Ok(None);
        };
        text.insert("contact_angle".into(), Value::Float(angle));
    }
    let told = |why: String| format!("{of}: {why}");
    let scene = Request::parse(&text.to_string())
        .and_then(|request| request.bearing()?.scene(1))
        .map_err(|why| told(why.to_string()))?;
    let table: Table = scene.parse().map_err(|why: toml::de::Error| told(why.to_string()))?;
    Ok(Some(Value::Table(table).to_string()))
}

/// Scene of a bearing whose balls and grooves the file has, in one line.
fn own_geometry(model: &Model, of: &Component) -> Result<Option<String>, String> {
    let Some(row) = model.parts(of.id, "rolling_bearing_row").next() else { return Ok(None) };
    let Some(ball) = model.parts(row.id, "rolling_element").next() else { return Ok(None) };
    let numbers = [
        row.number("number_of_rolling_elements")?,
        ball.number("diameter_of_rolling_element")?,
        row.number("reference_diameter")?,
        row.number("raceway_radius_of_inner_ring")?,
        row.number("raceway_radius_of_outer_ring")?,
    ];
    let [Some(count), Some(diameter), Some(pitch), Some(inner), Some(outer)] = numbers else {
        return Ok(None);
    };
    let mut bearing = Table::new();
    bearing.insert("balls".into(), Value::Integer(count as i64));
    for (key, number) in [
        ("ball_diameter", diameter),
        ("pitch_diameter", pitch),
        ("inner_conformity", inner / diameter),
        ("outer_conformity", outer / diameter),
    ] {
        bearing.insert(key.into(), Value::Float(number));
    }
    match row.number("pressure_angle")?.filter(|angle| *angle > 0.0) {
        Some(angle) => bearing.insert("contact_angle".into(), Value::Float(angle)),
        None => bearing.insert("diametral_clearance".into(), Value::Float(clearance(of)?.unwrap_or(0.0))),
    };
    let scene = Table::from_iter([("bearing".to_owned(), Value::Table(bearing))]);
    Ok(Some(Value::Table(scene).to_string()))
}

/// \[m] play across the axis that the file has; 0 is none of its own.
fn clearance(of: &Component) -> Result<Option<f64>, String> {
    for key in
        ["operating_radial_bearing_clearance", "mounted_radial_bearing_clearance", "radial_bearing_clearance"]
    {
        if let Some(number) = of.number(key)?.filter(|number| *number != 0.0) {
            return Ok(Some(number));
        }
    }
    Ok(None)
}

/// A stiffness of the file, with what is said of one that is rigid; 0 if the file has none.
fn stiffness(of: &Component, key: &str, rigid: f64, told: &mut Vec<String>) -> Result<f64, String> {
    match of.number(key)? {
        Some(number) if number < 0.0 => Err(format!("{of}: {key} {number:e}: allowed is 0 or more")),
        Some(number) if number > rigid => {
            told.push(format!("{key} {number:e} is as good as rigid, {rigid:e} here"));
            Ok(rigid)
        }
        found => Ok(found.unwrap_or(0.0)),
    }
}

/// Springs of a bearing that is not simulated, or of a coupling, with what the file does not say of them.
fn springs(of: &Component, way: f64, told: &mut Vec<String>) -> Result<Springs, String> {
    let mut found = Springs {
        radial: stiffness(of, "radial_stiffness", RIGID, told)?,
        axial: stiffness(of, "axial_stiffness", RIGID, told)?,
        tilt: stiffness(of, "bending_stiffness", RIGID_TILT, told)?,
        ..Springs::default()
    };
    if found.radial == 0.0 && of.text("radial_force_absorption") != Some("false") {
        told.push(format!("radial_stiffness is not given, {RIGID:e} here"));
        found.radial = RIGID;
    }
    match of.text("axial_force_absorption") {
        Some("no_direction") => found.axial = 0.0,
        Some(takes) => {
            if found.axial == 0.0 {
                told.push(format!("axial_stiffness is not given, {RIGID:e} here"));
                found.axial = RIGID;
            }
            found.way = one_way(takes, way);
        }
        None => {}
    }
    Ok(found)
}

/// Which forces along x a bearing takes: both (0), along it (1), against it (-1).
fn one_way(takes: &str, way: f64) -> f64 {
    match takes {
        "positive" => way,
        "negative" => -way,
        _ => 0.0,
    }
}

/// Oil of the casing, where the file has its viscosities and a temperature; in a load case (none: the file itself).
pub fn oil(model: &Model, case: &[Component]) -> Result<Option<Oil>, String> {
    let Some(casing) = model.of_kind("gear_casing").next() else { return Ok(None) };
    let Some(lubricant) = model.referenced(casing.id, "lubricant") else { return Ok(None) };
    let at = |temperature: u32| lubricant.number(&format!("viscosity_at_{temperature}_degree_celsius"));
    let now = case.iter().find(|of| of.id == casing.id).unwrap_or(casing);
    let (Some(cold), Some(warm), Some(temperature)) =
        (at(40)?, at(100)?, now.number("temperature_lubricant")?.or(casing.number("temperature_lubricant")?))
    else {
        return Ok(None);
    };
    let density = lubricant.number("density_at_15_degree_celsius")?.unwrap_or(880.0);
    Ok(Some(Oil { viscosity: [cold, warm], density, temperature }))
}
