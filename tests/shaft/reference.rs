//! The keys of a system in docs/shaft.md, from the structs that it is read by; `scripts/tables` writes them.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::sources::{Section, Source, sources};

/// Structs, and the section that each is in a file.
const SECTIONS: &[(&str, &str)] = &[
    ("Written", ""),
    ("FrameSection", "frame"),
    ("ShaftSection", "shaft"),
    ("BeamSection", "shaft.section"),
    ("Disc", "shaft.disc"),
    ("PointLoad", "shaft.load"),
    ("PointDisplacement", "shaft.load.displacement"),
    ("PointRotation", "shaft.load.rotation"),
    ("GearSection", "shaft.gear"),
    ("RotatingSection", "shaft.rotating"),
    ("Point", "shaft.point"),
    ("HousingSection", "housing"),
    ("Foot", "housing.foot"),
    ("HousingLoad", "housing.load"),
    ("PointDisplacement", "housing.load.displacement"),
    ("HousingRotation", "housing.load.rotation"),
    ("HousingPoint", "housing.point"),
    ("MeshSection", "mesh"),
    ("MeshGear", "mesh.gears"),
    ("Varies", "mesh.stiffness_variation"),
    ("WrittenBearing", "bearing"),
    ("StiffnessSection", "bearing.stiffness"),
    ("RollersSection", "bearing.rollers"),
    ("RollerFilm", "bearing.rollers.film"),
    ("RollerAmbient", "bearing.rollers.ambient"),
    ("CouplingSection", "coupling"),
    ("Mounting", "bearing.mounting"),
    ("BoreTilt", "bearing.mounting.misalignment"),
    ("BoreOffset", "bearing.mounting.offset"),
    ("Preload", "bearing.mounting.preload"),
    ("SystemLoad", "load"),
];

fn section<'a>(sources: &'a [Source], name: &str) -> &'a Section {
    let of = |source: &&Source| {
        [
            "schema/shaft.rs",
            "effects/frame.rs",
            "schema/housing.rs",
            "schema/machine.rs",
            "schema/mesh.rs",
            "schema/rollers.rs",
            "scene/system/mod.rs",
            "scene/system/read.rs",
            "scene/system/bearing.rs",
        ]
        .iter()
        .any(|file| source.path.ends_with(file))
    };
    let mut found = sources.iter().filter(of).filter_map(|source| source.sections.get(name));
    found.next().unwrap_or_else(|| panic!("there is no struct {name}"))
}

fn tables() -> String {
    let sources = sources();
    let mut text = String::from("| key | meaning |\n|---|---|\n");
    for (name, path) in SECTIONS {
        for field in &section(&sources, name).fields {
            let nested = SECTIONS.iter().any(|(_, other)| {
                let key = if path.is_empty() { field.name.clone() } else { format!("{path}.{}", field.name) };
                *other == key
            });
            let doc = field.doc.replace("\\[", "[").replace('|', "\\|");
            assert!(!doc.is_empty(), "{name}.{} has no documentation", field.name);
            if !nested && !field.skipped {
                let key = if path.is_empty() { field.name.clone() } else { format!("{path}.{}", field.name) };
                writeln!(text, "| `{key}` | {doc} |").unwrap();
            }
        }
    }
    text
}

/// Compares a part of docs/shaft.md with what it should be, or renews it.
fn compare_part(name: &str, table: &str, script: &str) {
    let path = Path::new(roulement_tests::ROOT).join("docs/shaft.md");
    let text = fs::read_to_string(&path).unwrap();
    let (begin, end) = (format!("<!-- begin {name} -->\n"), format!("<!-- end {name} -->"));
    let (before, rest) = text.split_once(&begin).unwrap();
    let (written, after) = rest.split_once(&end).unwrap();
    let table = format!("\n{table}\n");
    if std::env::var("ROULEMENT_RENEW").is_ok() {
        fs::write(&path, format!("{before}{begin}{table}{end}{after}")).unwrap();
    } else {
        assert_eq!(written, table, "docs/shaft.md is stale: {script}");
    }
}

#[test]
fn the_document_has_the_keys_of_the_sources_and_the_costs_of_the_record() {
    // One after the other: both renew one file.
    compare_part("keys", &tables(), "scripts/tables");
    let record =
        fs::read_to_string(Path::new(roulement_tests::ROOT).join("docs/figures/shaft-cost.csv")).unwrap();
    let rows: Vec<Vec<&str>> = record.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let mut table = String::from(
        "| bearings | coordinates of the beams | rigid shaft, plain | beams, plain | rigid shaft, caged | beams, caged |\n|---|---|---|---|---|---|\n",
    );
    let row = |shaft: &str, bearing: &str, bearings: &str| {
        rows.iter().find(|row| row[..3] == [shaft, bearing, bearings]).unwrap()
    };
    for bearings in ["2", "5", "10", "20"] {
        write!(table, "| {bearings} | {} |", row("beams", "plain", bearings)[3]).unwrap();
        for bearing in ["plain", "caged"] {
            let [rigid, beams] = ["rigid", "beams"].map(|shaft| row(shaft, bearing, bearings)[4]);
            write!(table, " {rigid} | {beams} |").unwrap();
        }
        table.push('\n');
    }
    compare_part("costs", &table, "scripts/measure shaft-cost");
    let record =
        fs::read_to_string(Path::new(roulement_tests::ROOT).join("docs/figures/mesh-cost.csv")).unwrap();
    let mut table = String::from(
        "| meshes | bearings | a step without meshes | a step with them | of it a bearing | a mesh |\n|---|---|---|---|---|---|\n",
    );
    for line in record.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let [meshes, bearings, apart, meshed] = row[..] else { panic!("{line}") };
        let [of_bearing, of_mesh] = [apart / bearings, (meshed - apart) / meshes];
        writeln!(table, "| {meshes} | {bearings} | {apart} | {meshed} | {of_bearing:.0} | {of_mesh:.0} |")
            .unwrap();
    }
    compare_part("mesh costs", &table, "scripts/measure mesh-cost");
}

#[test]
fn the_example_of_the_document_and_the_shipped_shaft_are_read_and_start() {
    let folder = Path::new(roulement_tests::ROOT);
    let document = fs::read_to_string(folder.join("docs/shaft.md")).unwrap();
    let example = document.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let shipped = ["pinion", "housing"]
        .map(|name| fs::read_to_string(folder.join(format!("scenes/shafts/{name}.toml"))).unwrap());
    for text in [example.to_string()].into_iter().chain(shipped) {
        let system = crate::common::system(&text);
        assert_eq!(system.bearings().count(), 2);
    }
}

#[test]
fn refusals_name_key_value_and_allowed_range() {
    for (from, to, parts) in [
        ("mass = \"1.8 kg\"", "mass = \"-1 kg\"", &["shaft.mass = -1 kg", "(0,"][..]),
        ("mass = \"1.8 kg\"\n", "", &["shaft.mass", "[[shaft.section]]"]),
        ("speed = \"6000 rpm\"\n", "", &["shaft", "exactly one of speed and torque"]),
        ("\"7206 B\"", "\"99999\"", &["bearing \"left\"", "99999"]),
        ("\"+x\"", "\"x\"", &["line 19", "+x", "-x"]),
        ("\"right\"", "\"left\"", &["left", "names of their own"]),
        ("position = \"-50 mm\"", "position = \"-50 kg\"", &["position", "-50 kg"]),
        ("catalogue = \"7206 B\"\n", "", &["exactly one of scene", "catalogue"]),
        ("[load]", "[laod]", &["laod"]),
        (
            "[load]",
            "[bearing.set.effects.frame]\nangular_velocity = [1, 0, 0]\n[load]",
            &["\"right\": effects.frame"],
        ),
        (
            "[load]",
            "[bearing.set.outer]\ndrive = \"wrench\"\nmass = 0.1\ninertia = [1e-4, 1e-4, 1e-4]\n[load]",
            &["bearing \"right\"", "outer.drive"],
        ),
    ] {
        let text = crate::common::GEARBOX.replacen(from, to, 1);
        assert_ne!(text, crate::common::GEARBOX, "{from}");
        let refusal =
            roulement::scene::system::SystemScene::parse(&text, None, Path::new("")).unwrap_err().to_string();
        for part in parts {
            assert!(refusal.contains(part), "{refusal}\nshould name {part}");
        }
    }
}
