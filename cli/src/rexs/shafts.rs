//! Shafts of a REXS model: where they are, their sections, materials and loads.

use super::frame::{Axes, Frame};
use super::gearbox::{Load, Material, STEEL, Section, Shaft};
use super::model::{Component, Model};
use super::names::Names;

/// Cylinders that a cone is cut into.
const STEPS: usize = 5;

/// All shafts, and the axes that they have in common.
///
/// # Errors
/// Names the component, and what is wrong with it.
pub fn shafts(
    model: &Model,
    names: &mut Names,
    notes: &mut Vec<String>,
) -> Result<(Vec<Shaft>, Axes), String> {
    let mut found: Vec<Shaft> = vec![];
    let mut axes = None;
    for component in model.of_kind("shaft") {
        if let Some(carrier) = model.assembly_of(component.id, "planet_carrier") {
            notes.push(format!("{component}: a part of {carrier}"));
            continue;
        }
        let frame = Frame::of(component, model)?.unwrap_or_default();
        let axes = *axes.get_or_insert_with(|| Axes::along(&frame.axes.column(0).into_owned()));
        let way = axes.way(component, &frame)?;
        let mut shaft = Shaft {
            id: component.id,
            name: names.of(component, "shaft"),
            origin: axes.turned(&frame.origin).into(),
            way,
            material: material(model, component)?,
            ..Shaft::default()
        };
        let sections = sections(model, component, notes)?;
        if way < 0.0 {
            // Positions count from its left end all the same.
            shaft.begin = sections.iter().map(|of| of.to).fold(f64::NEG_INFINITY, f64::max);
            shaft.origin[0] -= shaft.begin;
        }
        shaft.sections = placed(sections, &shaft);
        shaft.loads = loads(model, component, &shaft, &frame, &axes, names)?;
        found.push(shaft);
    }
    match axes {
        Some(axes) => Ok((found, axes)),
        None => Err("the model has no shaft".into()),
    }
}

/// Sections at positions of the file; a cone is cut into cylinders.
fn sections(model: &Model, shaft: &Component, notes: &mut Vec<String>) -> Result<Vec<Section>, String> {
    let mut found = vec![];
    let mut cones = 0;
    for part in model.parts(shaft.id, "shaft_section") {
        let (from, length) = (part.needed("u_coordinate_on_shaft")?, part.needed("length")?);
        let ends = |name: &str| -> Result<Option<[f64; 2]>, String> {
            let [begin, end] = ["begin", "end"].map(|end| part.number(&format!("{name}_{end}")));
            let (begin, end) = (begin?, end?);
            Ok(begin.or(end).map(|usual| [begin.unwrap_or(usual), end.unwrap_or(usual)]))
        };
        let outer =
            ends("outer_diameter")?.ok_or_else(|| format!("{part}: outer_diameter_begin is missing"))?;
        let inner = ends("inner_diameter")?.unwrap_or_default();
        let is_cone = [outer, inner].iter().any(|[begin, end]| (begin - end).abs() > 1e-9);
        let pieces = if is_cone { STEPS } else { 1 };
        cones += usize::from(is_cone);
        for piece in 0..pieces {
            let [from, to] = [piece, piece + 1].map(|of| from + length * of as f64 / pieces as f64);
            let middle = (piece as f64 + 0.5) / pieces as f64;
            let between = |[begin, end]: [f64; 2]| begin + (end - begin) * middle;
            found.push(Section { from, to, outer: between(outer), inner: between(inner) });
        }
    }
    if found.is_empty() {
        return Err(format!("{shaft}: it has no sections (shaft_section)"));
    }
    if cones > 0 {
        notes.push(format!("{shaft}: cones, {cones} of its sections, are {STEPS} cylinders each"));
    }
    Ok(found)
}

/// Sections by growing position in the machine; those whose ends meet to the digits of a file meet exactly.
fn placed(mut sections: Vec<Section>, shaft: &Shaft) -> Vec<Section> {
    for of in &mut sections {
        let [one, other] = [of.from, of.to].map(|own| shaft.position(own));
        (of.from, of.to) = (one.min(other), one.max(other));
    }
    sections.sort_by(|one, other| one.from.total_cmp(&other.from));
    for index in 1..sections.len() {
        let before = sections[index - 1].to;
        if (sections[index].from - before).abs() < 1e-7 {
            sections[index].from = before;
        }
    }
    sections
}

/// Material of a shaft; none where the file has none, or has steel.
fn material(model: &Model, shaft: &Component) -> Result<Option<Material>, String> {
    let Some(of) = model.referenced(shaft.id, "material") else { return Ok(None) };
    let found = Material {
        youngs_modulus: of.number("elastic_modulus")?.unwrap_or(STEEL.youngs_modulus),
        poisson_ratio: of.number("poisson_ratio")?.unwrap_or(STEEL.poisson_ratio),
        density: of.number("density")?.unwrap_or(STEEL.density),
    };
    Ok((found != STEEL).then_some(found))
}

/// Forces and moments on a shaft; those of a load case may come where the file itself has none.
fn loads(
    model: &Model,
    component: &Component,
    shaft: &Shaft,
    frame: &Frame,
    axes: &Axes,
    names: &mut Names,
) -> Result<Vec<Load>, String> {
    let mut found = vec![];
    for part in model.parts(component.id, "external_load") {
        let (force, moment) = wrench(part, frame, axes)?;
        let in_cases = model.cases.iter().flatten().filter(|of| of.id == part.id);
        let mut acts = force.iter().chain(&moment).any(|component| *component != 0.0);
        for case in in_cases {
            let (force, moment) = wrench(case, frame, axes)?;
            acts |= force.iter().chain(&moment).any(|component| *component != 0.0);
        }
        if acts {
            let position = shaft.position(part.needed("u_coordinate_on_shaft")?);
            found.push(Load { id: part.id, name: names.of(part, "load"), position, force, moment });
        }
    }
    Ok(found)
}

/// Force and moment across the axis of a load, in the axes of the machine.
pub fn wrench(load: &Component, frame: &Frame, axes: &Axes) -> Result<([f64; 3], [f64; 3]), String> {
    let number = |key: &str| load.number(key).map(Option::unwrap_or_default);
    let force = [number("force_u_direction")?, number("force_v_direction")?, number("force_w_direction")?];
    let moment = [0.0, number("torque_around_v_axis")?, number("torque_around_w_axis")?];
    Ok([force, moment].map(|of| axes.turned(&(frame.axes * nalgebra::Vector3::from(of))).into()).into())
}
