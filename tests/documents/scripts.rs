//! Scripts of the project: what measures is one command with names, and every script that a text names is there.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> &'static Path {
    Path::new(roulement_tests::ROOT)
}

fn measure(arguments: &[&str]) -> Output {
    Command::new(root().join("scripts/measure")).args(arguments).output().unwrap()
}

/// Texts that name scripts: documents, scripts themselves, sources and tests.
fn texts() -> Vec<PathBuf> {
    fn enter(folder: &Path, found: &mut Vec<PathBuf>) {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                enter(&path, found);
            } else {
                found.push(path);
            }
        }
    }
    let mut found: Vec<PathBuf> =
        ["README.md", "CONTRIBUTING.md", "mkdocs.yml", ".ci/run"].map(|name| root().join(name)).into();
    for folder in [
        "docs",
        "scripts",
        "src",
        "cli/src",
        "cli/tests",
        "cli/examples",
        "tests",
        "examples",
        "python/tests",
        "benches",
    ] {
        enter(&root().join(folder), &mut found);
    }
    found
}

/// Names behind `scripts/` in a text, where the word begins with it.
fn named(text: &str) -> BTreeSet<String> {
    let is_of_name = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '-' | '_' | '.' | '/');
    let parts: Vec<(usize, &str)> = text.match_indices("scripts/").collect();
    let begins = |at: usize| !text[..at].ends_with(is_of_name) || text[..at].ends_with("../");
    let name = |at: usize| {
        let rest = &text[at + "scripts/".len()..];
        let end = rest.find(|letter| !is_of_name(letter)).unwrap_or(rest.len());
        rest[..end].trim_end_matches(['.', '/']).to_string()
    };
    parts
        .into_iter()
        .filter(|(at, _)| begins(*at))
        .map(|(at, _)| name(at))
        .filter(|name| !name.is_empty())
        .collect()
}

#[test]
fn every_script_that_a_text_names_is_there() {
    let mut seen = BTreeSet::new();
    for path in texts() {
        // Pictures and other data have no names.
        let Ok(text) = fs::read_to_string(&path) else { continue };
        for name in named(&text) {
            assert!(
                root().join("scripts").join(&name).exists(),
                "{}: there is no scripts/{name}",
                path.display()
            );
            seen.insert(name);
        }
    }
    assert!(seen.len() > 30 && seen.contains("measure"), "{seen:?}");
    // In parts, as this file is among the texts.
    let text = format!("see {0}nothing.py, `../{0}a`; java{0}b", "scripts/");
    assert_eq!(named(&text), BTreeSet::from(["a".into(), "nothing.py".into()]));
}

#[test]
fn measure_lists_all_that_measures_and_says_what() {
    let output = measure(&[]);
    assert!(output.status.success());
    let listed = String::from_utf8(output.stdout).unwrap();
    let files = fs::read_dir(root().join("scripts/measures")).unwrap();
    let files: BTreeSet<String> =
        files.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert!(files.len() >= 10, "{files:?}");
    let mut names = BTreeSet::new();
    for line in listed.lines() {
        let (name, what) = line.split_once(' ').unwrap();
        assert!(what.trim().len() > 20, "{line}");
        names.insert(name.to_string());
    }
    assert_eq!(names, files);
    // A name that is none is told with those that are; a path is none.
    for wrong in ["nothing", "../measure", ""] {
        let output = measure(&[wrong]);
        assert_eq!(output.status.code(), Some(2));
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(told.contains(&format!("nothing measures {wrong}")) && told.contains(&listed), "{told}");
    }
    // What is called is the file of the name, with its options: this one has none, and says so.
    let output = measure(&["mesh-cost", "--no-such-option"]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && told.contains("--no-such-option is no option"), "{told}");
}
