//! A gearbox as a REXS file, version 1.4, in XML.

use toml::Table;

use super::document::{Document, Part, text};
use super::gearbox::{Bearing, Gearbox, Kind, Shaft, Springs};

/// Number of the gear unit, and of the casing.
const UNIT: u64 = 1;
const CASING: u64 = 2;

/// Text of the file: a gearbox, and its duty with the gearbox in each load.
///
/// # Errors
/// If the text cannot be written.
pub fn file(gearbox: &Gearbox, cases: &[Gearbox]) -> Result<String, Box<dyn std::error::Error>> {
    let mut document = Document::default();
    unit(&mut document, gearbox);
    let shafts: Vec<u64> = gearbox.shafts.iter().map(|of| shaft(&mut document, of)).collect();
    let loads: Vec<[Vec<u64>; 2]> = gearbox
        .shafts
        .iter()
        .zip(&shafts)
        .map(|(of, id)| shaft_loads(&mut document, of, *id, cases))
        .collect();
    meshes(&mut document, gearbox, &shafts);
    gearbox.bearings.iter().for_each(|of| bearing(&mut document, of, gearbox, &shafts));
    for of in &gearbox.couplings {
        let part = document.add("coupling", &of.name);
        part.number("u_coordinate_on_shaft_inner_side", "mm", of.position);
        springs(part, &of.springs);
        part.number("rotational_stiffness", "N mm / rad", of.springs.torsion);
        let id = part.id;
        side(&mut document, ("coupling", id), shafts[of.shafts[0]], ("shaft", shafts[of.shafts[1]]));
    }
    let cases: Vec<Vec<Part>> = gearbox
        .duty
        .iter()
        .zip(cases)
        .map(|(duty, case)| load_case(duty.share, case, &shafts, &loads))
        .collect();
    text(&document, &cases)
}

fn unit(document: &mut Document, gearbox: &Gearbox) {
    let part = document.add("gear_unit", "Gear unit");
    part.text("model_name", &gearbox.title);
    part.place([0.0; 3]);
    part.text("account_for_gravity", if gearbox.gravity.is_some() { "true" } else { "false" });
    if let Some(gravity) = gearbox.gravity {
        let size = gravity.iter().map(|of| of * of).sum::<f64>().sqrt();
        part.number("gravitational_acceleration", "m / s^2", size);
        for (name, of) in
            ["direction_vector_gravity_u", "direction_vector_gravity_v", "direction_vector_gravity_w"]
                .into_iter()
                .zip(gravity)
        {
            part.number(name, "none", of / size);
        }
    }
    document.add("gear_casing", "Casing");
    document.part_of(("gear_unit", UNIT), ("gear_casing", CASING));
}

fn shaft(document: &mut Document, of: &Shaft) -> u64 {
    let part = document.add("shaft", &of.name);
    part.place(of.origin);
    if let Some(speed) = of.speed {
        part.number("rotational_speed", "1 / min", speed);
    }
    part.text("defines_speed", if of.speed.is_some() { "true" } else { "false" });
    let id = part.id;
    document.part_of(("gear_unit", UNIT), ("shaft", id));
    for section in &of.sections {
        let part = document.add("shaft_section", "");
        part.number("u_coordinate_on_shaft", "mm", section.from);
        part.number("length", "mm", section.to - section.from);
        for (begin, end, of) in [
            ("outer_diameter_begin", "outer_diameter_end", section.outer),
            ("inner_diameter_begin", "inner_diameter_end", section.inner),
        ] {
            part.number(begin, "mm", of);
            part.number(end, "mm", of);
        }
        let section = part.id;
        document.part_of(("shaft", id), ("shaft_section", section));
    }
    if let Some(material) = of.material {
        let part = document.add("material", &format!("material of {}", of.name));
        part.number("elastic_modulus", "N / mm^2", material.youngs_modulus);
        part.number("poisson_ratio", "none", material.poisson_ratio);
        part.number("density", "kg / dm^3", material.density);
        let material = part.id;
        document.relate("reference", &[("origin", "shaft", id), ("referenced", "material", material)]);
    }
    id
}

/// Torque and loads of a shaft: numbers of the components that transmit torque, and of its forces.
fn shaft_loads(document: &mut Document, of: &Shaft, shaft: u64, cases: &[Gearbox]) -> [Vec<u64>; 2] {
    let (mut drives, mut loads) = (vec![], vec![]);
    let torque = of
        .torque
        .or_else(|| cases.iter().flat_map(|case| &case.shafts).find(|other| other.name == of.name)?.torque);
    if of.speed.is_some() || torque.is_some() {
        let part = document.add("external_load", &format!("torque of {}", of.name));
        part.number(
            "u_coordinate_on_shaft",
            "mm",
            of.drive_position.unwrap_or_else(|| of.sections.first().map_or(0.0, |of| of.from)),
        );
        part.text("transmits_torque", "true");
        part.text("defines_torque", if torque.is_some() { "true" } else { "false" });
        if let Some(torque) = of.torque {
            part.number("torque_around_u_axis", "N m", torque);
        }
        drives.push(part.id);
    }
    for load in &of.loads {
        let part = document.add("external_load", &load.name);
        part.number("u_coordinate_on_shaft", "mm", load.position);
        part.text("transmits_torque", "false");
        wrench(part, load.force, load.moment);
        loads.push(part.id);
    }
    for id in drives.iter().chain(&loads) {
        document.part_of(("shaft", shaft), ("external_load", *id));
    }
    [drives, loads]
}

fn wrench(part: &mut Part, force: [f64; 3], moment: [f64; 3]) {
    for (name, of) in ["force_u_direction", "force_v_direction", "force_w_direction"].into_iter().zip(force) {
        part.number(name, "N", of);
    }
    for (name, of) in ["torque_around_v_axis", "torque_around_w_axis"].into_iter().zip(&moment[1..]) {
        part.number(name, "N m", *of);
    }
}

fn meshes(document: &mut Document, gearbox: &Gearbox, shafts: &[u64]) {
    let mut written: Vec<(usize, f64, u32, u64)> = vec![];
    for of in &gearbox.meshes {
        let mut gears = [0; 2];
        for (index, gear) in of.gears.iter().enumerate() {
            let is_same = |(shaft, at, teeth, _): &&(usize, f64, u32, u64)| {
                *shaft == gear.shaft && (at - gear.position).abs() < 1e-9 && *teeth == gear.teeth
            };
            if let Some((.., id)) = written.iter().find(is_same) {
                gears[index] = *id;
                continue;
            }
            let kind = if gear.inside { "ring_gear" } else { "cylindrical_gear" };
            let shaft = &gearbox.shafts[gear.shaft];
            let part = document.add(kind, &format!("gear of {} on {}", of.name, shaft.name));
            let [x, y, z] = shaft.origin;
            part.place([x + gear.position, y, z]);
            part.number("u_coordinate_on_shaft", "mm", gear.position);
            part.number("number_of_teeth", "none", f64::from(gear.teeth));
            part.number("normal_module", "mm", of.module);
            part.number("face_width", "mm", gear.face_width);
            let hand = if index == 0 || gear.inside { 1.0 } else { -1.0 };
            part.number("helix_angle_reference_diameter", "deg", hand * of.helix_angle);
            let id = part.id;
            document.part_of(("shaft", shafts[gear.shaft]), (kind, id));
            let flanks = ["left", "right"].map(|side| {
                let part = document.add("cylindrical_gear_flank", &format!("{side} flank"));
                part.number("normal_pressure_angle", "deg", of.pressure_angle);
                part.number("addendum_modification_coefficient", "none", gear.profile_shift);
                part.id
            });
            let [left, right] = flanks.map(|id| ("cylindrical_gear_flank", id));
            document.relate(
                "flank",
                &[("gear", kind, id), ("left", left.0, left.1), ("right", right.0, right.1)],
            );
            written.push((gear.shaft, gear.position, gear.teeth, id));
            gears[index] = id;
        }
        let [from, to] = of.gears.map(|gear| gearbox.shafts[gear.shaft].origin);
        let part = document.add("cylindrical_stage", &of.name);
        part.number("center_distance", "mm", (to[1] - from[1]).hypot(to[2] - from[2]));
        let id = part.id;
        document.part_of(("gear_unit", UNIT), ("cylindrical_stage", id));
        let second = if of.gears[1].inside { "ring_gear" } else { "cylindrical_gear" };
        document.relate(
            "stage",
            &[
                ("stage", "cylindrical_stage", id),
                ("gear_1", "cylindrical_gear", gears[0]),
                ("gear_2", second, gears[1]),
            ],
        );
    }
}

fn springs(part: &mut Part, of: &Springs) {
    part.number("radial_stiffness", "N / m", of.radial);
    part.number("axial_stiffness", "N / m", of.axial);
    part.number("bending_stiffness", "N mm / rad", of.tilt);
    let takes = match of.way {
        _ if of.axial == 0.0 => "no_direction",
        way if way > 0.0 => "positive",
        way if way < 0.0 => "negative",
        _ => "both_directions",
    };
    part.text("axial_force_absorption", takes);
    part.text("radial_force_absorption", if of.radial > 0.0 { "true" } else { "false" });
}

fn side(document: &mut Document, of: (&'static str, u64), inner: u64, outer: (&'static str, u64)) {
    document.relate(
        "side",
        &[("assembly", of.0, of.1), ("inner_part", "shaft", inner), ("outer_part", outer.0, outer.1)],
    );
}

fn bearing(document: &mut Document, of: &Bearing, gearbox: &Gearbox, shafts: &[u64]) {
    let kind = match &of.kind {
        Kind::Catalogue(_) | Kind::Rollers(_) => "rolling_bearing_with_catalog_geometry",
        Kind::Scene(_) => "rolling_bearing_with_detailed_geometry",
        Kind::Springs(_) => "concept_bearing",
    };
    let part = document.add(kind, &of.name);
    let id = part.id;
    let [x, y, z] = gearbox.shafts[of.shaft].origin;
    part.place([x + of.position, y, z]);
    part.number("u_coordinate_on_shaft_inner_side", "mm", of.position);
    if let Some(outer) = of.outer_shaft {
        part.number(
            "u_coordinate_on_shaft_outer_side",
            "mm",
            x + of.position - gearbox.shafts[outer].origin[0],
        );
    }
    for (name, unit, number) in [
        ("misalignment_in_v_direction", "mum", of.offset[0]),
        ("misalignment_in_w_direction", "mum", of.offset[1]),
        ("angular_misalignment_around_v_axis", "deg", of.misalignment[0]),
        ("angular_misalignment_around_w_axis", "deg", of.misalignment[1]),
        ("preload_distance", "mum", of.preload),
    ] {
        part.number(name, unit, number);
    }
    let is_tapered = of.kind.is_tapered();
    match &of.kind {
        Kind::Springs(of) => springs(part, of),
        Kind::Rollers(name) => {
            part.text("catalogue_designation", name);
            if is_tapered {
                part.text("bearing_type", "radial_tapered_roller_bearing");
                part.text("axial_force_absorption", if of.reversed { "negative" } else { "positive" });
            } else {
                part.text("bearing_type", "radial_roller_bearing");
            }
        }
        Kind::Catalogue(name) => {
            part.text("catalogue_designation", name);
            if let Some(clearance) = of.clearance {
                part.number("radial_bearing_clearance", "mum", clearance);
            }
            let digits: String = name.chars().filter(char::is_ascii_digit).collect();
            ball_bearing(part, of, digits.starts_with('7'));
        }
        Kind::Scene(geometry) => {
            let geometry: Table = geometry.parse().unwrap_or_default();
            let number = |key: &str| geometry.get(key).and_then(toml::Value::as_float).unwrap_or_default();
            let (diameter, angle) = (number("ball_diameter"), number("contact_angle"));
            ball_bearing(part, of, geometry.contains_key("contact_angle"));
            if geometry.contains_key("diametral_clearance") {
                part.number("radial_bearing_clearance", "mum", number("diametral_clearance"));
            }
            let row = document.add("rolling_bearing_row", "");
            row.number("number_of_rolling_elements", "none", number("balls"));
            row.number("reference_diameter", "mm", number("pitch_diameter"));
            row.number("raceway_radius_of_inner_ring", "mm", number("inner_conformity") * diameter);
            row.number("raceway_radius_of_outer_ring", "mm", number("outer_conformity") * diameter);
            if angle > 0.0 {
                row.number("pressure_angle", "deg", angle);
            }
            let row = row.id;
            let ball = document.add("rolling_element", "");
            ball.number("diameter_of_rolling_element", "mm", diameter);
            let ball = ball.id;
            document.part_of((kind, id), ("rolling_bearing_row", row));
            document.part_of(("rolling_bearing_row", row), ("rolling_element", ball));
        }
    }
    let outer = of.outer_shaft.map_or(("gear_casing", CASING), |outer| ("shaft", shafts[outer]));
    side(document, (kind, id), shafts[of.shaft], outer);
}

fn ball_bearing(part: &mut Part, of: &Bearing, is_angular: bool) {
    part.text(
        "bearing_type",
        if is_angular { "angular_contact_ball_bearing" } else { "radial_grooved_ball_bearing" },
    );
    let takes = match (of.held, is_angular) {
        (false, _) => "no_direction",
        (true, false) => "both_directions",
        (true, true) if of.reversed => "negative",
        (true, true) => "positive",
    };
    part.text("axial_force_absorption", takes);
}

/// Components of a load case.
fn load_case(share: f64, case: &Gearbox, shafts: &[u64], loads: &[[Vec<u64>; 2]]) -> Vec<Part> {
    let mut found = vec![Part::of_case(UNIT, "gear_unit")];
    found[0].number("load_duration_fraction", "%", share);
    for ((shaft, id), [drives, forces]) in case.shafts.iter().zip(shafts).zip(loads) {
        if let Some(speed) = shaft.speed {
            let mut of = Part::of_case(*id, "shaft");
            of.number("rotational_speed", "1 / min", speed);
            found.push(of);
        }
        for (torque, id) in shaft.torque.iter().zip(drives) {
            let mut of = Part::of_case(*id, "external_load");
            of.number("torque_around_u_axis", "N m", *torque);
            found.push(of);
        }
        for (load, id) in shaft.loads.iter().zip(forces) {
            let mut of = Part::of_case(*id, "external_load");
            wrench(&mut of, load.force, load.moment);
            found.push(of);
        }
    }
    found
}
