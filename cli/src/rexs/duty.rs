//! The load spectrum of a REXS model as the duty of a machine.

use std::collections::BTreeSet;

use super::bearings::oil;
use super::frame::{Axes, Frame};
use super::gearbox::{Duty, Gearbox};
use super::model::{Component, Model};
use super::power::{Drives, drives};
use super::shafts::wrench;
use super::text::{list, quantity, viscosity};

/// The duty: of each load case its share, and the keys that differ from the machine's own.
///
/// # Errors
/// Names the component whose numbers cannot be read.
pub fn duty(
    model: &Model,
    gearbox: &Gearbox,
    axes: &Axes,
    own: &Drives,
    notes: &mut Vec<String>,
) -> Result<Vec<Duty>, String> {
    let mut found = vec![];
    not_read(model, notes);
    for (index, case) in model.cases.iter().enumerate() {
        let now = drives(model, case, &gearbox.shafts, &gearbox.meshes, &gearbox.couplings, notes)?;
        let mut set = vec![];
        for (at, shaft) in gearbox.shafts.iter().enumerate() {
            for (key, unit, is, was) in [
                ("speed", "rad/s", now.speeds[at], own.speeds[at]),
                ("torque", "N m", now.torques[at], own.torques[at]),
            ] {
                if let Some(is) = is.filter(|_| is != was) {
                    set.push((format!("shaft.{}.{key}", shaft.name), quantity(is, unit)));
                }
            }
            let frame = model.components.get(&shaft.id).map(|of| Frame::of(of, model)).transpose()?.flatten();
            for load in &shaft.loads {
                let Some(of) = case.iter().find(|of| of.id == load.id) else { continue };
                let (force, moment) = wrench(of, &frame.unwrap_or_default(), axes)?;
                let key = |name: &str| format!("shaft.{}.load.{}.{name}", shaft.name, load.name);
                if force != load.force {
                    set.push((key("force"), list(&force, "N")));
                }
                if moment != load.moment {
                    set.push((key("moment"), list(&moment, "N m")));
                }
            }
        }
        let oil = oil(model, case)?.filter(|oil| Some(*oil) != gearbox.oil);
        for (oil, bearing) in oil.iter().flat_map(|oil| gearbox.bearings.iter().map(move |of| (oil, of))) {
            let key = bearing.film().map(|film| format!("bearing.{}.set.{film}.viscosity", bearing.name));
            set.extend(key.map(|key| (key, viscosity(oil))));
        }
        let share = share(case)?.unwrap_or_else(|| {
            notes.push(format!("load case {}: no part of the time is given: as long as others", index + 1));
            1.0
        });
        if share > 0.0 {
            found.push(Duty { name: format!("case-{}", index + 1), share, set });
        }
    }
    Ok(found)
}

/// Attributes of load cases that are read, by the types of their components.
const READ: &[(&str, &[&str])] = &[
    ("gear_unit", &["load_duration_fraction", "operating_time_fraction", "operating_time"]),
    ("gear_casing", &["temperature_lubricant"]),
    ("shaft", &["rotational_speed"]),
    (
        "external_load",
        &[
            "torque_around_u_axis",
            "torque_around_v_axis",
            "torque_around_w_axis",
            "force_u_direction",
            "force_v_direction",
            "force_w_direction",
            "power",
        ],
    ),
];

/// Tells of what load cases change and a machine's duty does not.
fn not_read(model: &Model, notes: &mut Vec<String>) {
    let is_read = |kind: &str, attribute: &str| {
        READ.iter().any(|(of, attributes)| *of == kind && attributes.contains(&attribute))
    };
    let all =
        model.cases.iter().flatten().flat_map(|of| of.attributes.iter().map(move |own| (&of.kind, &own.id)));
    let others: BTreeSet<_> = all.filter(|(kind, id)| !is_read(kind, id)).collect();
    notes.extend(others.iter().map(|(kind, id)| format!("load cases: {id} of {kind} is not read")));
}

/// [-] part of the time of a load case.
fn share(case: &[Component]) -> Result<Option<f64>, String> {
    for of in case.iter().filter(|of| of.kind == "gear_unit") {
        for key in ["load_duration_fraction", "operating_time_fraction", "operating_time"] {
            if let Some(number) = of.number(key)? {
                return Ok(Some(number));
            }
        }
    }
    Ok(None)
}
