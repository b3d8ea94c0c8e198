//! `roulement system`: structures of both forms, same bytes, what is refused.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::process::Output;

use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use super::refusals::elf;
use super::*;

/// x86-64 as ELF libraries name it.
const X86_64: u8 = 62;
const UNITS: &str = "<Unit name='N'><BaseUnit kg='1' m='1' s='-2'/></Unit><Unit name='m'><BaseUnit m='1'/></Unit>\
                     <Unit name='rpm'><BaseUnit rad='1' s='-1' factor='0.5'/></Unit><Unit name='rad/s'><BaseUnit rad='1' s='-1'/></Unit>";
const SHAFT: &str = "mass parameter Real unit='kg' start='1';teeth parameter Integer start='20';on parameter Boolean start='true';\
                     left.position.x output Real unit='m';left.position.y output Real unit='m';left.speed output Real unit='rpm';\
                     left.force.x input Real unit='N' start='0';left.force.y input Real unit='N' start='0'";
const BEARING: &str = "inner.position.x input Real unit='m' start='2e-5';inner.position.y input Real unit='m' start='0';\
                       inner.speed input Real unit='rad/s' start='0';inner.force.x output Real unit='N';inner.force.y output Real unit='N';\
                       inner.force.z output Real unit='N';balls output Integer";
const DESCRIPTION: &str = r#"
name = "pair"
step = "10 us"
stop = "20 ms"
connections = ["shaft.left -> left.inner", "left.inner.force -> shaft.left.force"]
[components.shaft]
fmu = "shaft.fmu"
[components.left]
fmu = "bearing.fmu"
mounting = "-x"
[start]
shaft.mass = 2
shaft.teeth = 23
shaft.on = false
"left.inner.position.x" = "-50 um"
"#;

/// Writes a package whose variables are given as `name causality type attributes`.
fn package(file: &str, variables: &str) {
    let mut zip = ZipWriter::new(File::create(file).unwrap());
    zip.start_file("modelDescription.xml", SimpleFileOptions::default()).unwrap();
    let variable = |text: &str| {
        let [name, causality, of] = [0, 1, 2].map(|k| text.split(' ').nth(k).unwrap());
        let attributes = text.splitn(4, ' ').nth(3).unwrap_or_default();
        format!("<ScalarVariable name='{name}' causality='{causality}'><{of} {attributes}/></ScalarVariable>")
    };
    let variables: String = variables.split(';').map(variable).collect();
    let text = format!(
        "<fmiModelDescription fmiVersion='2.0'><CoSimulation/><UnitDefinitions>{UNITS}</UnitDefinitions>\
         <ModelVariables>{variables}</ModelVariables></fmiModelDescription>"
    );
    zip.write_all(text.as_bytes()).unwrap();
    zip.finish().unwrap();
}

/// A folder with both packages.
fn workplace(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    package(&scratch.path("shaft.fmu"), SHAFT);
    package(&scratch.path("bearing.fmu"), BEARING);
    scratch
}

/// Writes a described system into a folder `to`.
fn system(scratch: &Scratch, description: &str, to: &str) -> Output {
    fs::write(scratch.path("system.toml"), description).unwrap();
    fs::write(scratch.path("a.so"), elf(X86_64)).unwrap();
    roulement(&[
        "system",
        &scratch.path("system.toml"),
        "-o",
        &scratch.path(to),
        "--library",
        &scratch.path("a.so"),
    ])
}

fn message(output: Output) -> String {
    String::from_utf8(output.stderr).unwrap()
}

/// A file of a zip file.
pub fn unzipped(file: &str, name: &str) -> Vec<u8> {
    let mut bytes = vec![];
    ZipArchive::new(File::open(file).unwrap())
        .unwrap()
        .by_name(name)
        .unwrap()
        .read_to_end(&mut bytes)
        .unwrap();
    bytes
}

#[test]
fn both_structures_have_single_connections_with_signs_and_units() {
    let scratch = workplace("system");
    let output = system(&scratch, DESCRIPTION, "out");
    let said = message(output.clone());
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("left.inner.speed [rad/s] is -0.5 times shaft.left.speed [rpm] plus 0.0"),
        "{said}"
    );
    let ssd = String::from_utf8(unzipped(&scratch.path("out/pair.ssp"), "SystemStructure.ssd")).unwrap();
    let version = concat!("roulement ", env!("CARGO_PKG_VERSION"));
    assert_eq!(ssd.replace(version, "roulement VERSION"), include_str!("system.ssd"));
    assert_eq!(scratch.read("out/pair-osp/OspSystemStructure.xml"), include_str!("system-osp.xml"));
    for (component, file) in [("shaft", "shaft.fmu"), ("left", "bearing.fmu")] {
        let original = fs::read(scratch.path(file)).unwrap();
        assert!(unzipped(&scratch.path("out/pair.ssp"), &format!("resources/{component}.fmu")) == original);
        assert!(fs::read(scratch.path(&format!("out/pair-osp/{component}.fmu"))).unwrap() == original);
    }
}

const SCENES: &str = "[components.rear]\nscene = \"thrust.toml\"\n[components.front]\nscene = \"thrust.toml\"\nmounting = \"-x\"\n\
                      [components.slow]\nscene = \"thrust.toml\"\nchanges = { \"load.inner_speed\" = \"3000 rpm\" }\n";

#[test]
fn scenes_are_packed_as_by_the_command_for_one_and_shared() {
    let scratch = Scratch::new("system-scenes");
    fs::copy(scene("thrust"), scratch.path("thrust.toml")).unwrap();
    let text = format!("name = \"three\"\nstep = 1e-5\nstop = 1\n{SCENES}");
    for to in ["out", "again"] {
        let output = system(&scratch, &text, to);
        assert!(output.status.success(), "{}", message(output));
    }
    let package = scratch.path("front.fmu");
    let output =
        roulement(&["fmu", &scratch.path("thrust.toml"), "-o", &package, "--library", &scratch.path("a.so")]);
    assert!(output.status.success());
    let in_system = unzipped(&scratch.path("out/three.ssp"), "resources/front.fmu");
    assert!(in_system == fs::read(&package).unwrap());
    assert!(in_system != unzipped(&scratch.path("out/three.ssp"), "resources/slow.fmu"));
    // Both components of the same scene have the package of the first.
    let structure = scratch.read("out/three-osp/OspSystemStructure.xml");
    assert!(structure.contains("<Simulator name=\"rear\" source=\"front.fmu\"/>"), "{structure}");
    assert!(!Path::new(&scratch.path("out/three-osp/rear.fmu")).exists());
    for file in ["three.ssp", "three-osp/OspSystemStructure.xml", "three-osp/front.fmu"] {
        let [first, second] =
            ["out", "again"].map(|to| fs::read(scratch.path(&format!("{to}/{file}"))).unwrap());
        assert!(first == second, "{file} has other bytes");
    }
}

/// Files and changes that come to the same scene have one package, whose library is in the system once.
#[test]
fn scenes_that_say_the_same_share_a_package() {
    let scratch = Scratch::new("system-alike");
    let text = fs::read_to_string(scene("thrust")).unwrap();
    for name in ["left", "right"] {
        fs::write(scratch.path(&format!("{name}.toml")), &text).unwrap();
    }
    let text = "name = \"pair\"\nstep = 1e-5\nstop = 1\n[components.left]\nscene = \"left.toml\"\n\
                [components.right]\nscene = \"right.toml\"\nmounting = \"-x\"\n\
                [components.slow]\nscene = \"right.toml\"\nchanges = { \"load.inner_speed\" = \"3000 rpm\" }\n\
                [components.slower]\nscene = \"left.toml\"\nchanges = { \"load.inner_speed\" = \"3000 rpm\" }\n";
    let output = system(&scratch, text, "out");
    assert!(output.status.success(), "{}", message(output));
    let structure = unzipped(&scratch.path("out/pair.ssp"), "SystemStructure.ssd");
    let structure = String::from_utf8(structure).unwrap();
    for (name, file) in [("left", "left"), ("right", "left"), ("slow", "slow"), ("slower", "slow")] {
        let element =
            structure.lines().find(|line| line.contains(&format!("Component name=\"{name}\""))).unwrap();
        assert!(element.contains(&format!("source=\"resources/{file}.fmu\"")), "{element}");
    }
    assert!(!Path::new(&scratch.path("out/pair-osp/right.fmu")).exists());
}

#[test]
fn start_values_of_others_are_seen_by_their_component() {
    let scratch = workplace("system-start");
    let start = "[start]\n\"shaft.offset\" = { of = \"left.inner.position.x\" }\n";
    package(&scratch.path("shaft.fmu"), "offset parameter Real unit='m' start='0'");
    let head = DESCRIPTION.split("[start]").next().unwrap();
    let connections = head.lines().find(|line| line.starts_with("connections")).unwrap();
    let output = system(&scratch, &(head.replace(connections, "") + start), "out");
    assert!(output.status.success(), "{}", message(output));
    // The bearing is mounted the other way.
    let structure = scratch.read("out/pair-osp/OspSystemStructure.xml");
    assert!(structure.contains("<Real value=\"-2e-5\"/>"), "{structure}");
}

#[test]
fn wrong_systems_are_refused_with_connection_and_nearest_name() {
    let scratch = workplace("system-wrong");
    let forces = "left.inner.force -> shaft.left.force";
    for (from, to, parts) in [
        (
            forces,
            "left.inner.force.x -> shaft.left.forc.x",
            &[
                "connection \"left.inner.force.x -> shaft.left.forc.x\"",
                "shaft has no variable left.forc.x",
                "nearest name is left.force.x",
            ][..],
        ),
        (
            forces,
            "left.inner.forces -> shaft.left.force",
            &["left has no variable inner.forces.x", "nearest name is inner.force.x"],
        ),
        (forces, "left.inner.force -> shaft.lift", &["shaft has no variable lift", "nearest name is left"]),
        (forces, "left.inner.force -> shat.left.force", &["shat is no component", "nearest name is shaft"]),
        (
            forces,
            "left.inner.force",
            &["connection \"left.inner.force\"", "component.output -> component.input"],
        ),
        (forces, "left -> shaft.left.force", &["\"left\" has to be a component and a variable"]),
        (
            forces,
            "shaft.left.force.x -> left.inner.force.x",
            &["shaft.left.force.x is of causality input", "an output"],
        ),
        (forces, "left.inner -> shaft.mass", &["left has no variable inner"]),
        (forces, "left.inner.force.x -> shaft.mass", &["shaft.mass is of causality parameter", "an input"]),
        (
            forces,
            "shaft.left.force -> left.inner.force",
            &["no left.inner.force.* is an input", "causality output"],
        ),
        (forces, "shaft.left.position.x -> shaft.left.force.x", &["is in m,", "in N", "cannot be converted"]),
        (forces, "left.balls -> shaft.left.force.x", &["left.balls is of type Integer", "type Real"]),
        (
            forces,
            "shaft.left.position.x -> left.inner.position.x",
            &["left.inner.position.x is connected by \"shaft.left -> left.inner\", too"],
        ),
        ("shaft.mass = 2", "shaft.mas = 2", &["start.shaft.mas", "nearest name is mass"]),
        ("shaft.mass = 2", "shaft.mass = \"2 m\"", &["start.shaft.mass", "2 m", "a mass"]),
        ("shaft.teeth = 23", "shaft.teeth = 23.5", &["start.shaft.teeth", "23.5", "a whole number"]),
        (
            "shaft.mass = 2",
            "shaft.left.speed = 2",
            &["start.shaft.left.speed", "causality output", "inputs and parameters"],
        ),
        (
            "shaft.mass = 2",
            "shaft.mass = { of = \"left.inner.force.x\" }",
            &["left.inner.force.x has no start value"],
        ),
        ("shaft.mass = 2", "shaft.mass = { of = \"left.inner.speed\" }", &["in rad/s", "converted to kg"]),
        ("shaft.fmu", "nowhere.fmu", &["component shaft", "cannot read", "nowhere.fmu"]),
        ("shaft.fmu", "system.toml", &["component shaft", "no FMU"]),
        ("mounting = \"-x\"", "mounting = \"-y\"", &["components.left.mounting = \"-y\"", "\"x\" or \"-x\""]),
        ("stop = ", "sto = ", &["sto is no known key", "nearest name is stop"]),
    ] {
        assert!(DESCRIPTION.contains(from), "{from}");
        let output = system(&scratch, &DESCRIPTION.replacen(from, to, 1), "out");
        assert!(!output.status.success(), "{to}");
        let said = message(output);
        assert!(said.starts_with("error: "), "{said}");
        for part in parts {
            assert!(said.contains(part), "{said}\nshould say {part}");
        }
        assert!(!Path::new(&scratch.path("out/pair.ssp")).exists());
    }
}

#[test]
fn scenes_of_systems_are_refused_by_their_component() {
    let scratch = Scratch::new("system-scene-wrong");
    fs::copy(scene("thrust"), scratch.path("thrust.toml")).unwrap();
    let text =
        format!("name = \"three\"\nstep = 1e-5\nstop = 1\n{SCENES}").replace("inner_speed", "inner_sped");
    let said = message(system(&scratch, &text, "out"));
    for part in ["component slow", "load.inner_sped", "did you mean inner_speed?"] {
        assert!(said.contains(part), "{said}");
    }
}
