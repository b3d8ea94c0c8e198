//! README and documents as their readers use them: every command of the program runs, every part of a scene is read.
//! What it works on are small copies of the project's files, so that this takes seconds.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use roulement::catalogue::Shelf;
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement_cli::system::Description;
use toml::{Table, Value};

use crate::common::{self, Scratch};

/// Commands that take long, by words in them, and what is added: of the first the arguments are read alone, the others look at two speeds.
const LONG: [(&[&str], &[&str]); 3] = [
    (&["cost"], &["--help"]),
    (&["modes", "--up-to"], &["--speeds", "2"]),
    (&["modes", "examples/gearbox/three_stage.toml"], &["--speeds", "2"]),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// README and documents: name and text.
fn documents() -> Vec<(String, String)> {
    let read = |path: PathBuf| {
        (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read_to_string(path).unwrap())
    };
    let folders = ["docs", "docs/masters"].map(|folder| fs::read_dir(root().join(folder)).unwrap());
    let pages = folders.into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut all: Vec<_> =
        pages.filter(|path| path.extension().is_some_and(|of| of == "md")).map(read).collect();
    all.push(read(root().join("README.md")));
    all.sort();
    all
}

/// Blocks of a language in a document.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let begin = format!("```{language}\n");
    let mut rest = text;
    let mut found = vec![];
    while let Some((_, after)) = rest.split_once(&begin) {
        let (block, behind) = after.split_once("```").unwrap();
        found.push(block);
        rest = behind;
    }
    found
}

/// Words of a command as a shell has them, without its comment.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![];
    let (mut word, mut quote, mut begun) = (String::new(), None, false);
    for letter in line.chars() {
        match (quote, letter) {
            (None, '#') if !begun => break,
            (None, '"' | '\'') => (quote, begun) = (Some(letter), true),
            (Some(end), letter) if letter == end => quote = None,
            (None, ' ') => {
                if begun {
                    words.push(std::mem::take(&mut word));
                }
                begun = false;
            }
            (_, letter) => {
                word.push(letter);
                begun = true;
            }
        }
    }
    if begun {
        words.push(word);
    }
    words
}

/// Copies a folder.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if from.is_dir() {
            copy(&from, &to);
        } else {
            fs::copy(from, to).unwrap();
        }
    }
}

/// A folder with what commands of the documents work on.
fn workplace() -> Scratch {
    let scratch = Scratch::new("documents");
    let write = |name: &str, text: &str| {
        let path = scratch.path(name);
        fs::create_dir_all(Path::new(&path).parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    for scene in ["thrust", "radial", "cage", "misalignment"] {
        let text = fs::read_to_string(common::scene(scene)).unwrap();
        write(&format!("scenes/{scene}.toml"), &text);
        for copy in ["scene.toml", "SCENE.toml", "thrust.toml"].into_iter().filter(|_| scene == "thrust") {
            write(copy, &text);
        }
    }
    let shaft = fs::read_to_string(root().join("scenes/shafts/pinion.toml")).unwrap();
    write("scenes/shafts/pinion.toml", &shaft);
    let gearbox = fs::read_to_string(root().join("examples/gearbox/three_stage.toml")).unwrap();
    write("examples/gearbox/three_stage.toml", &gearbox.replace("\"5 ms\"", "\"0.2 ms\""));
    let planetary = fs::read_to_string(root().join("examples/gearbox/planetary.toml")).unwrap();
    write("examples/gearbox/planetary.toml", &planetary.replace("\"20 ms\"", "\"0.2 ms\""));
    let rexs = "examples/gearbox/two_shafts.rexsj";
    write(rexs, &fs::read_to_string(root().join(rexs)).unwrap());
    for scene in ["whirl/one", "whirl/two", "effects/loss_of_lubrication"] {
        write(&format!("scenes/{scene}.toml"), &fs::read_to_string(common::scene(scene)).unwrap());
    }
    let coupled = fs::read_to_string(root().join("examples/coupling/bearing.toml")).unwrap();
    write("examples/coupling/bearing.toml", &coupled);
    for (sweep, duration) in [("dry_running", "\"400 ms\""), ("smearing", "\"100 ms\"")] {
        let name = format!("examples/sweeps/{sweep}.toml");
        let text = fs::read_to_string(root().join(&name)).unwrap();
        assert!(text.contains(duration), "{text}");
        write(&name, &text.replace(duration, "\"0.5 ms\""));
    }
    let misaligned = fs::read_to_string(root().join("examples/sweeps/misalignment.toml")).unwrap();
    assert!(misaligned.contains("cases = 1000"), "{misaligned}");
    let few = misaligned.replace("cases = 1000", "cases = 2").replace("\"20 ms\"", "\"1 ms\"");
    write("examples/sweeps/misalignment.toml", &few);
    fs::create_dir(scratch.path("build")).unwrap();
    write(
        "system.toml",
        "name = \"one\"\nstep = 1e-5\nstop = 1\n[components.bearing]\nscene = \"thrust.toml\"\n",
    );
    write("cases.csv", "friction.ball_race,load.duration\n0.05,0.001\n0.1,0.001\n");
    write("loads.csv", "share,load.inner_speed [rpm],load.y.force [N]\n0.6,3000,1000\n0.4,6000,2000\n");
    let packaging = fs::read_to_string(root().join("docs/packaging.md")).unwrap();
    let system = blocks(&packaging, "toml").into_iter().find(|block| block.contains("[shaft]")).unwrap();
    write("gear.toml", system);
    let contacts = fs::read_to_string(root().join("tests/data/contact/random.csv")).unwrap();
    let few: Vec<&str> = contacts.lines().take(3).collect();
    for name in ["CASES.csv", "tests/data/contact/random.csv"] {
        write(name, &(few.join("\n") + "\n"));
    }
    // Results that a document begins with.
    let short = common::edited("thrust", &[("load.duration", "\"1 ms\"")]);
    for results in ["results", "other-results"] {
        assert!(scratch.run(&short, results, &[]).status.success());
    }
    let cases = scratch.path("cases.csv");
    let sweep = ["sweep", &cases, "--scene", &scratch.path("scene.toml"), "-o", &scratch.path("sweep")];
    assert!(common::roulement(&sweep).status.success());
    write("scene.toml", &fs::read_to_string(common::scene("thrust")).unwrap());
    scratch
}

#[test]
fn every_command_of_the_documents_runs() {
    let program = Path::new(env!("CARGO_BIN_EXE_roulement"));
    let is_command = |words: &Vec<String>| {
        words.first().is_some_and(|first| ["roulement", "target/release/roulement"].contains(&first.as_str()))
    };
    let place = workplace();
    let mut ran = 0;
    for (document, text) in documents() {
        let scratch = Scratch::new(&format!("documents-{document}"));
        let lines = blocks(&text, "sh").into_iter().flat_map(str::lines);
        for (line, words) in lines.map(|line| (line, words(line))).filter(|(_, words)| is_command(words)) {
            let arguments = &words[1..];
            if !Path::new(&scratch.path("scenes")).exists() {
                copy(Path::new(&place.path("")), Path::new(&scratch.path("")));
            }
            let added = LONG
                .iter()
                .filter(|(marks, _)| marks.iter().all(|mark| arguments.iter().any(|word| word == mark)));
            let begun = Instant::now();
            let output = Command::new(program)
                .args(arguments)
                .args(added.flat_map(|(_, more)| *more))
                .current_dir(scratch.path(""))
                .env("XDG_CACHE_HOME", scratch.path("cache"))
                .output()
                .unwrap();
            let error = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{document}: {line}\n{error}");
            println!("{:5.1} s  {document}: {line}", begun.elapsed().as_secs_f64());
            ran += 1;
        }
    }
    assert!(ran > 15, "{ran}");
}

/// Shafts with two bearings each and a short run, where they come without any.
fn with_bearings(part: &str, table: &Table) -> String {
    let mut text = part.to_string();
    if let (Some(shafts), None) = (table.get("shaft").and_then(Value::as_array), table.get("bearing")) {
        for shaft in shafts.iter().filter_map(|shaft| shaft.get("name")?.as_str()) {
            for (side, position) in [("left", -30), ("right", 30)] {
                text += &format!(
                    "\n[[bearing]]\nname = \"{shaft}_{side}\"\nshaft = \"{shaft}\"\ncatalogue = \"6204\"\n\
                     mounting = {{ position = \"{position} mm\" }}\n"
                );
            }
        }
        text += "\n[load]\nduration = \"1 ms\"\noutput_interval = \"0.1 ms\"\n";
    }
    text
}

/// Puts a table into another.
fn merge(into: &mut Table, from: Table) {
    for (key, value) in from {
        match (into.get_mut(&key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => merge(old, new),
            (_, value) => drop(into.insert(key, value)),
        }
    }
}

#[test]
fn every_part_of_a_scene_in_the_documents_is_read() {
    let thrust = fs::read_to_string(common::scene("thrust")).unwrap();
    let place = workplace();
    let mut read = 0;
    let scratch = Scratch::new("documents-scenes");
    let measured = root().join("scenes/effects/measured_shock.csv");
    fs::copy(measured, scratch.path("measured_shock.csv")).unwrap();
    for (document, text) in documents() {
        for block in blocks(&text, "toml") {
            // A block of several ways to write the same has them in paragraphs.
            let parts: Vec<&str> = match block.parse::<Table>() {
                Ok(_) => vec![block],
                Err(_) => block.split("\n\n").collect(),
            };
            for part in parts {
                let table: Table = part.parse().unwrap_or_else(|why| panic!("{document}: {part}\n{why}"));
                if ["grid", "case", "latin_hypercube"].iter().any(|key| table.contains_key(*key)) {
                    sweep(&place, &document, part);
                    read += 1;
                    continue;
                }
                if table.contains_key("components") {
                    Description::read(part).unwrap_or_else(|why| panic!("{document}: {part}\n{why}"));
                    read += 1;
                    continue;
                }
                let of_shelf =
                    |bearings: &Vec<Value>| bearings.iter().any(|one| one.get("designation").is_some());
                if table.get("bearing").and_then(Value::as_array).is_some_and(of_shelf) {
                    Shelf::parse(part, &document).unwrap_or_else(|why| panic!("{document}: {part}\n{why}"));
                    read += 1;
                    continue;
                }
                // Forces that turn are added to the shaft that is shipped.
                if let (Some(shaft), None) =
                    (table.get("shaft").and_then(Value::as_table), table.get("bearing"))
                {
                    let pinion = fs::read_to_string(common::scene("shafts/pinion")).unwrap();
                    let mut system: Table = pinion.parse().unwrap();
                    merge(&mut system, Table::from_iter([("shaft".into(), shaft.clone().into())]));
                    SystemScene::parse(&system.to_string(), None, &root())
                        .unwrap_or_else(|why| panic!("{document}: {part}\n{why}"));
                    read += 1;
                    continue;
                }
                if SystemScene::is_system(part) || table.get("shaft").is_some_and(Value::is_array) {
                    SystemScene::parse(&with_bearings(part, &table), None, &root())
                        .unwrap_or_else(|why| panic!("{document}: {part}\n{why}"));
                    read += 1;
                    continue;
                }
                // A housing is added to the shaft that is shipped, bearings take the place of those with their names.
                let of_shaft =
                    ["housing", "bearing", "mesh"].map(|key| table.get(key).is_some_and(Value::is_array));
                if of_shaft.contains(&true) || table.contains_key("frame") {
                    // Bearings that name their shaft are of a file with several.
                    let named = |bearings: &Vec<Value>| bearings.iter().any(|one| one.get("shaft").is_some());
                    let several =
                        of_shaft[2] || table.get("bearing").and_then(Value::as_array).is_some_and(named);
                    let base = if several { "examples/gearbox/three_stage" } else { "scenes/shafts/pinion" };
                    let base = fs::read_to_string(root().join(format!("{base}.toml"))).unwrap();
                    let mut system: Table = base.parse().unwrap();
                    for (key, value) in table {
                        match system.get_mut(&key).and_then(Value::as_array_mut) {
                            Some(there) => {
                                let new = value.as_array().unwrap();
                                there.retain(|old| new.iter().all(|new| new["name"] != old["name"]));
                                there.extend(new.iter().cloned());
                            }
                            None => drop(system.insert(key, value)),
                        }
                    }
                    SystemScene::parse(&system.to_string(), None, &root())
                        .unwrap_or_else(|why| panic!("{document}: {part}\n{why}"));
                    read += 1;
                    continue;
                }
                // With a bearing it is a whole scene, without one it is added to another.
                let whole = table.contains_key("bearing");
                let mut scene: Table = if whole { Table::new() } else { thrust.parse().unwrap() };
                for key in ["solver", "effects"] {
                    // Words in place of a section, and settings that exclude each other.
                    if table.contains_key(key) {
                        scene.remove(key);
                    }
                }
                merge(&mut scene, table);
                fs::write(scratch.path("scene.toml"), scene.to_string()).unwrap();
                if let Err(why) = Scene::load(Path::new(&scratch.path("scene.toml"))) {
                    panic!("{document}: {part}\n{why}");
                }
                read += 1;
            }
        }
    }
    assert!(read > 6, "{read}");
}

/// A sweep of a few short cases of a document.
fn sweep(place: &Scratch, document: &str, cases: &str) {
    let scratch = Scratch::new(&format!("documents-sweep-{document}"));
    copy(Path::new(&place.path("")), Path::new(&scratch.path("")));
    let few = cases.replace("cases = 50", "cases = 2").replace("\"20 ms\"", "\"1 ms\"");
    fs::write(scratch.path("cases.toml"), few).unwrap();
    let output = common::roulement(&["sweep", &scratch.path("cases.toml"), "-o", &scratch.path("out")]);
    assert!(output.status.success(), "{document}: {}", String::from_utf8_lossy(&output.stderr));
}
