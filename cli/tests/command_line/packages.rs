//! Packages with the library that cargo built together with the program.

use std::fs;
use std::path::PathBuf;

use roulement::fmi::BUILD;
use roulement_cli::package::library_beside;

use super::*;

const LIBRARY: &str = if cfg!(windows) {
    "roulement.dll"
} else if cfg!(target_os = "macos") {
    "libroulement.dylib"
} else {
    "libroulement.so"
};

/// Packs the thrust case with the library that the program finds.
fn packed(scratch: &Scratch, name: &str) -> Vec<u8> {
    let package = scratch.path(name);
    let output = roulement(&["fmu", &scene("thrust"), "-o", &package, "--name", "thrust"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    fs::read(package).unwrap()
}

/// The library in a package of this machine.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn library(scratch: &Scratch, name: &str) -> Vec<u8> {
    packed(scratch, name);
    system::unzipped(&scratch.path(name), "binaries/linux64/thrust.so")
}

/// As root a package put in the place of `/dev/null` would take that away from the machine.
#[test]
#[cfg(unix)]
fn regression_what_is_no_file_is_left_alone() {
    let scratch = Scratch::new("socket");
    let socket = scratch.path("socket");
    let _there = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    let output = roulement(&["fmu", &scene("thrust"), "-o", &socket]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && said.contains("is no file") && said.contains("socket"), "{said}");
    assert!(!fs::metadata(&socket).unwrap().is_file(), "it is what it was");
}

#[test]
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn the_packed_library_has_no_symbols_and_no_folders_of_the_machine() {
    let scratch = Scratch::new("packed");
    let library = library(&scratch, "a.fmu");
    let sections = object::File::parse(library.as_slice()).unwrap();
    for name in [".symtab", ".debug_info", ".debug_str"] {
        assert!(object::Object::section_by_name(&sections, name).is_none(), "{name}");
    }

    let program = PathBuf::from(env!("CARGO_BIN_EXE_roulement"));
    let variable = |name| std::env::var_os(name).map(PathBuf::from);
    let folders = [
        variable("HOME"),
        variable("CARGO_HOME"),
        variable("RUSTUP_HOME"),
        Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf),
        program.parent().map(Path::to_path_buf),
        Some("registry/src".into()),
    ];
    let folders: Vec<String> =
        folders.into_iter().flatten().map(|folder| folder.display().to_string()).collect();
    let found = |library: &[u8], folder: &str| memchr::memmem::find(library, folder.as_bytes()).is_some();
    for folder in folders.iter().filter(|folder| folder.len() > 1) {
        assert!(!found(&library, folder), "{folder}");
    }
    // They were there to be found.
    let whole = fs::read(library_beside(&program).unwrap()).unwrap();
    assert!(found(&whole, "registry/src") && library.len() < whole.len());
}

#[test]
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn readers_of_libraries_have_no_complaint() {
    let scratch = Scratch::new("readelf");
    fs::write(scratch.path("a.so"), library(&scratch, "a.fmu")).unwrap();
    let Ok(output) = Command::new("readelf").args(["--all", "--wide", &scratch.path("a.so")]).output() else {
        println!("readelf is not installed");
        return;
    };
    assert!(output.status.success());
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

/// What a wheel has: the program with libraries of several platforms beside it.
#[test]
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn libraries_of_all_platforms_beside_the_program_are_packed() {
    let scratch = Scratch::new("beside");
    let program = scratch.path("roulement");
    fs::copy(env!("CARGO_BIN_EXE_roulement"), &program).unwrap();
    fs::write(scratch.path(LIBRARY), library(&scratch, "a.fmu")).unwrap();
    fs::write(scratch.path("libroulement-aarch64.so"), refusals::elf(183)).unwrap();
    fs::write(scratch.path("notes.txt"), "no library").unwrap();
    let package = scratch.path("all.fmu");
    let output = Command::new(&program)
        .args(["fmu", &scene("thrust"), "-o", &package, "--all-platforms"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let archive = fs::read(&package).unwrap();
    for name in ["binaries/linux64/all.so", "binaries/aarch64-linux/all.so"] {
        assert!(memchr::memmem::find(&archive, name.as_bytes()).is_some(), "{name}");
    }
    assert!(system::unzipped(&package, "binaries/linux64/all.so").len() > 1_000_000);
}

#[test]
fn invariant_the_same_scene_and_library_give_the_same_bytes() {
    let scratch = Scratch::new("same");
    assert!(packed(&scratch, "a.fmu") == packed(&scratch, "b.fmu"));
}

/// Elements of a model description by their name and these attributes, in its order.
fn elements(description: &str, element: &str, attributes: &[&str]) -> Vec<Vec<String>> {
    let opening = format!("<{element} ");
    let lines = description.lines().filter(|line| line.trim_start().starts_with(&opening));
    let value = |line: &str, attribute: &str| {
        let rest = line.split(&format!(" {attribute}=\"")).nth(1).unwrap_or_default();
        rest.split('"').next().unwrap_or_default().to_string()
    };
    lines.map(|line| attributes.iter().map(|attribute| value(line, attribute)).collect()).collect()
}

#[test]
fn a_package_of_chosen_outputs_has_these_alone_under_the_same_references() {
    let scratch = Scratch::new("chosen");
    let fmu = |scene: &str, name: &str, columns: &[&str]| {
        let package = scratch.path(name);
        let output = roulement(&[&["fmu", scene, "-o", &package, "--name", "chosen"], columns].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(system::unzipped(&package, "modelDescription.xml")).unwrap()
    };
    for (scene, columns, expected) in [
        (scene("shafts/pinion"), "left.inner.force.*,shaft.torque,*.friction_power", 6),
        (scene("thrust"), "inner.force.*,cage.speed", 4),
    ] {
        let all = fmu(&scene, "all.fmu", &[]);
        let chosen = fmu(&scene, "chosen.fmu", &["--columns", columns]);
        let of = |text: &str| elements(text, "ScalarVariable", &["name", "valueReference", "causality"]);
        let (before, after) = (of(&all), of(&chosen));
        let outputs = |all: &[Vec<String>]| all.iter().filter(|row| row[2] == "output").count();
        assert_eq!(outputs(&after), expected, "{after:?}");
        assert!(outputs(&before) > 4 * expected);
        // What it tells of has the same names and references, and nothing but outputs is missing.
        assert!(after.iter().all(|row| before.contains(row)));
        let inputs =
            |all: &[Vec<String>]| all.iter().filter(|row| row[2] != "output").cloned().collect::<Vec<_>>();
        assert_eq!(inputs(&before), inputs(&after));
        // Places of outputs are those among the variables that it has.
        let unknowns = elements(&chosen, "Unknown", &["index"]);
        assert_eq!(unknowns.len(), 2 * expected);
        for index in unknowns {
            let place: usize = index[0].parse().unwrap();
            assert_eq!(after[place - 1][2], "output");
        }
        // The library takes the identifier of both.
        let guid = |text: &str| text.split(" guid=\"").nth(1).unwrap().split('"').next().unwrap().to_string();
        assert_eq!(guid(&all), guid(&chosen));
        let told = ["all.fmu", "chosen.fmu"].map(|package| {
            let page = system::unzipped(&scratch.path(package), "documentation/index.html");
            String::from_utf8(page).unwrap().contains("inner.moment.x</code>")
        });
        assert_eq!(told, [true, false]);
    }
    let refused = roulement(&[
        "fmu",
        &scene("thrust"),
        "-o",
        &scratch.path("no.fmu"),
        "--columns",
        "cage.speed,innr.*",
    ]);
    assert!(!refused.status.success());
    let message = String::from_utf8_lossy(&refused.stderr);
    assert!(message.contains("--columns innr.*") && message.contains("no output"), "{message}");
    assert!(!Path::new(&scratch.path("no.fmu")).exists());
}

#[test]
fn the_library_of_the_same_build_is_found() {
    let scratch = Scratch::new("beside");
    fs::create_dir(scratch.path("deps")).unwrap();
    let (program, beside, deps) =
        (scratch.path("roulement"), scratch.path(LIBRARY), scratch.path(&format!("deps/{LIBRARY}")));
    let found = || match library_beside(Path::new(&program)) {
        Ok(path) => path.display().to_string(),
        Err(why) => why.to_string(),
    };
    let ours = format!("library\0{BUILD}\0");
    assert!(found().contains(&format!("{beside} is missing")), "{}", found());
    // As after an earlier build of everything.
    fs::write(&beside, "library\0roulement build of yesterday\0").unwrap();
    assert!(found().contains(&format!("{beside} is of another build")), "{}", found());
    // And one of the program alone.
    fs::write(&deps, &ours).unwrap();
    assert_eq!(found(), deps);
    // A folder in which nothing is built.
    fs::write(&beside, &ours).unwrap();
    fs::remove_file(&deps).unwrap();
    assert_eq!(found(), beside);
}

#[test]
fn a_package_that_cannot_take_its_place_leaves_nothing() {
    let scratch = Scratch::new("in-the-way");
    let package = scratch.path("x.fmu");
    fs::create_dir_all(Path::new(&package).join("in the way")).unwrap();
    let output = roulement(&["fmu", &scene("thrust"), "-o", &package]);
    assert!(!output.status.success());
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write"));
    assert!(!Path::new(&scratch.path("x.fmu.part")).exists());
}

#[test]
#[cfg(unix)]
fn a_full_disk_leaves_nothing() {
    let scratch = Scratch::new("full");
    let package = scratch.path("x.fmu");
    fs::write(&package, "an earlier package").unwrap();
    // No file may have more than some kilobytes, which is an error instead of a signal.
    let output = Command::new("sh")
        .args(["-c", "trap '' XFSZ; ulimit -f 8; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_roulement")])
        .args(["fmu", &scene("thrust"), "-o", &package])
        .output()
        .unwrap();
    assert!(!output.status.success());
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.contains("cannot write") && message.contains("x.fmu.part"), "{message}");
    assert!(!Path::new(&scratch.path("x.fmu.part")).exists());
    assert_eq!(fs::read_to_string(&package).unwrap(), "an earlier package");
}
