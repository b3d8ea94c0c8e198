//! A gearbox as the file of a machine.

use std::fmt::Write;

use super::gearbox::{Bearing, Coupling, Gearbox, Kind, Mesh, Oil, Shaft, Springs};

/// A number with ten digits, without zeros at its end.
fn digits(number: f64) -> String {
    if number == 0.0 {
        return "0".into();
    }
    let places = (9 - number.abs().log10().floor() as i32).clamp(0, 15) as usize;
    let text = format!("{number:.places$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// A value with a unit, as a file has it: of lengths in mm, of speeds in rpm, of angles in degrees.
pub fn quantity(number: f64, unit: &str) -> String {
    let (number, unit) = match unit {
        "m" => (number * 1e3, "mm"),
        "rad/s" => (number * 60.0 / std::f64::consts::TAU, "rpm"),
        "rad" => (number.to_degrees(), "deg"),
        "Pa" => (number * 1e-9, "GPa"),
        _ => (number, unit),
    };
    if number == 0.0 { "0".into() } else { format!("\"{} {unit}\"", digits(number)) }
}

/// A list of values with a unit.
pub fn list(numbers: &[f64], unit: &str) -> String {
    let parts: Vec<String> = numbers.iter().map(|number| quantity(*number, unit)).collect();
    format!("[{}]", parts.join(", "))
}

/// Text in quotes.
fn quoted(text: &str) -> String {
    toml::Value::String(text.into()).to_string()
}

/// A comment behind a line.
fn behind(text: &str) -> String {
    let plain: String = text.chars().map(|char| if char.is_control() { ' ' } else { char }).collect();
    if plain.is_empty() { plain } else { format!("    # {plain}") }
}

/// Lines of a file.
#[derive(Default)]
struct File(String);

impl File {
    /// A head of a section, with an empty line before it.
    fn section(&mut self, name: &str) {
        self.0 += &format!("\n[[{name}]]\n");
    }

    /// A key and its value.
    fn key(&mut self, name: &str, value: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.0, "{name} = {value}");
    }
}

/// The file of a machine; `head` are lines of comment at its start.
pub fn file(gearbox: &Gearbox, head: &[String]) -> String {
    let mut file = File::default();
    file.key("title", &quoted(&gearbox.title));
    file.0.push('\n');
    for line in head {
        file.0 += format!("# {}", behind(line).trim_start_matches([' ', '#'])).trim_end();
        file.0.push('\n');
    }
    if let Some(gravity) = gearbox.gravity {
        file.0.push('\n');
        file.key("gravity", &list(&gravity, "m/s^2"));
    }
    gearbox.shafts.iter().for_each(|of| shaft(&mut file, of));
    gearbox.meshes.iter().for_each(|of| mesh(&mut file, of, gearbox));
    gearbox.bearings.iter().for_each(|of| bearing(&mut file, of, gearbox));
    gearbox.couplings.iter().for_each(|of| coupling(&mut file, of, gearbox));
    for of in &gearbox.duty {
        file.section("duty");
        file.key("name", &quoted(&of.name));
        file.key("share", &digits(of.share));
        if of.set.is_empty() {
            continue;
        }
        let set: Vec<String> =
            of.set.iter().map(|(key, value)| format!("{} = {value}", quoted(key))).collect();
        file.key("set", &format!("{{ {} }}", set.join(", ")));
    }
    file.0 += "\n[load]\nduration = \"5 ms\"\noutput_interval = \"50 us\"\n";
    file.0
}

fn shaft(file: &mut File, of: &Shaft) {
    file.section("shaft");
    file.key("name", &quoted(&of.name));
    if of.origin != [0.0; 3] {
        file.key("origin", &list(&of.origin, "m"));
    }
    if let Some(speed) = of.speed {
        file.key("speed", &quantity(speed, "rad/s"));
    }
    if let Some(torque) = of.torque {
        file.key("torque", &quantity(torque, "N m"));
    }
    if let Some(position) = of.drive_position {
        file.key("drive_position", &quantity(position, "m"));
    }
    file.key("retardation_time", "\"0.3 us\"    # 1 % of critical at 10 kHz");
    file.key("modes_up_to", "\"10 kHz\"");
    if let Some(material) = of.material {
        file.key(
            "material",
            &format!(
                "{{ youngs_modulus = {}, poisson_ratio = {}, density = {} }}",
                quantity(material.youngs_modulus, "Pa"),
                digits(material.poisson_ratio),
                quantity(material.density, "kg/m^3")
            ),
        );
    }
    for section in &of.sections {
        file.section("shaft.section");
        file.key("from", &quantity(section.from, "m"));
        file.key("to", &quantity(section.to, "m"));
        file.key("outer_diameter", &quantity(section.outer, "m"));
        if section.inner > 0.0 {
            file.key("inner_diameter", &quantity(section.inner, "m"));
        }
    }
    for disc in &of.discs {
        file.section("shaft.disc");
        file.key(
            "position",
            &format!(
                "{}    # body of the gear, up to its reference cylinder, of {} kg/m3",
                quantity(disc.position, "m"),
                digits(of.gear_density())
            ),
        );
        file.key("mass", &quantity(disc.mass, "kg"));
        file.key("polar_inertia", &quantity(disc.polar, "kg m^2"));
        file.key("transverse_inertia", &quantity(disc.transverse, "kg m^2"));
    }
    for load in &of.loads {
        file.section("shaft.load");
        file.key("name", &quoted(&load.name));
        file.key("position", &quantity(load.position, "m"));
        file.key("force", &list(&load.force, "N"));
        file.key("moment", &list(&load.moment, "N m"));
    }
}

fn mesh(file: &mut File, of: &Mesh, gearbox: &Gearbox) {
    file.section("mesh");
    file.key("name", &quoted(&of.name));
    file.key("normal_module", &quantity(of.module, "m"));
    file.key("pressure_angle", &quantity(of.pressure_angle, "rad"));
    file.key("helix_angle", &quantity(of.helix_angle, "rad"));
    file.0 += "gears = [\n";
    for gear in &of.gears {
        let inside = if gear.inside { ", inside = true" } else { "" };
        // Writing to a string cannot fail.
        let _ = writeln!(
            file.0,
            "    {{ shaft = {}, position = {}, teeth = {}, face_width = {}, profile_shift = {}{inside} }},",
            quoted(&gearbox.shafts[gear.shaft].name),
            quantity(gear.position, "m"),
            gear.teeth,
            quantity(gear.face_width, "m"),
            digits(gear.profile_shift)
        );
    }
    file.0 += "]\n";
}

/// Springs in one line.
fn springs(of: &Springs) -> String {
    let mut parts = vec![];
    for (name, number, unit) in [
        ("radial", of.radial, "N/m"),
        ("axial", of.axial, "N/m"),
        ("tilt", of.tilt, "N m/rad"),
        ("torsion", of.torsion, "N m/rad"),
    ] {
        if number > 0.0 {
            parts.push(format!("{name} = {}", quantity(number, unit)));
        }
    }
    if of.axial > 0.0 && of.way != 0.0 {
        parts.push(format!("axial_way = \"{}\"", if of.way > 0.0 { "+x" } else { "-x" }));
    }
    format!("{{ {} }}", parts.join(", "))
}

/// Viscosity of an oil at its temperature.
pub fn viscosity(of: &Oil) -> String {
    format!("\"{} mPa s\"", digits((of.dynamic_viscosity() * 1e7).round() / 1e4))
}

/// Oil as it is at its temperature.
fn oil(of: &Oil) -> String {
    format!(
        "{{ viscosity = {}, density = \"{} kg/m^3\" }}    # {} and {} mm2/s at 40 and 100 degC, at {} degC",
        viscosity(of),
        digits(of.density),
        digits(of.viscosity[0] * 1e6),
        digits(of.viscosity[1] * 1e6),
        digits(of.temperature)
    )
}

impl Oil {
    /// [Pa s] dynamic viscosity at its temperature: straight in log log over log (Ubbelohde, Walther; DIN 51563, ASTM D341), its density less by 6.4e-4 of it a kelvin.
    pub fn dynamic_viscosity(&self) -> f64 {
        let double = |viscosity: f64| (viscosity * 1e6 + 0.7).log10().log10();
        let absolute = |celsius: f64| (celsius + 273.15).log10();
        let [cold, warm] = self.viscosity.map(double);
        let slope = (warm - cold) / (absolute(100.0) - absolute(40.0));
        let now = cold + slope * (absolute(self.temperature) - absolute(40.0));
        let kinematic = (10_f64.powf(10_f64.powf(now)) - 0.7) * 1e-6;
        kinematic * self.density * (1.0 - 6.4e-4 * (self.temperature - 15.0))
    }
}

fn bearing(file: &mut File, of: &Bearing, gearbox: &Gearbox) {
    file.section("bearing");
    file.key("name", &format!("{}{}", quoted(&of.name), behind(&of.comment)));
    file.key("shaft", &quoted(&gearbox.shafts[of.shaft].name));
    match &of.kind {
        Kind::Catalogue(name) | Kind::Rollers(name) => file.key("catalogue", &quoted(name)),
        Kind::Scene(scene) => file.key("scene", scene),
        Kind::Springs(of) => file.key("stiffness", &springs(of)),
    }
    let mut mounting = vec![format!("position = {}", quantity(of.position, "m"))];
    if let Some(outer) = of.outer_shaft {
        mounting.push(format!("outer_shaft = {}", quoted(&gearbox.shafts[outer].name)));
    }
    if of.reversed {
        mounting.push("direction = \"-x\"".into());
    }
    if of.kind.has_balls() && !of.held && of.outer_shaft.is_none() {
        mounting.push("axial = \"free\"".into());
    }
    let is_tapered = of.kind.is_tapered();
    if of.preload != 0.0 && !is_tapered {
        mounting.push(format!("preload = {{ displacement = {} }}", quantity(of.preload, "m")));
    }
    if of.outer_shaft.is_none() {
        for (name, keys, numbers, unit) in
            [("offset", ["y", "z"], of.offset, "m"), ("misalignment", ["ry", "rz"], of.misalignment, "rad")]
        {
            if numbers != [0.0; 2] {
                let [one, other] = numbers.map(|number| quantity(number, unit));
                mounting.push(format!("{name} = {{ {} = {one}, {} = {other} }}", keys[0], keys[1]));
            }
        }
    }
    file.key("mounting", &format!("{{ {} }}", mounting.join(", ")));
    let found = gearbox.oil.as_ref().zip(of.film());
    let pressed = Some(of.preload).filter(|way| is_tapered && *way != 0.0);
    if found.is_some() || of.clearance.is_some() || pressed.is_some() {
        file.0 += "[bearing.set]\n";
    }
    if let Some(way) = pressed {
        file.key("rollers.axial_clearance", &quantity(-way, "m"));
    }
    if let Some(clearance) = of.clearance {
        file.key("bearing", &format!("{{ diametral_clearance = {} }}", quantity(clearance, "m")));
    }
    if let Some((found, key)) = found {
        file.key(key, &oil(found));
    }
}

fn coupling(file: &mut File, of: &Coupling, gearbox: &Gearbox) {
    file.section("coupling");
    file.key("name", &format!("{}{}", quoted(&of.name), behind(&of.comment)));
    let [one, other] = of.shafts.map(|shaft| quoted(&gearbox.shafts[shaft].name));
    file.key("shafts", &format!("[{one}, {other}]"));
    file.key("position", &quantity(of.position, "m"));
    file.key("stiffness", &springs(&of.springs));
}
