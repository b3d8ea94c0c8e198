//! The list of tests in CONTRIBUTING.md, from the first paragraph of every file of tests. `scripts/tables` writes it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::tables::{Row, compare, row};

/// Files of Rust in a folder, and the folders of such in it, by name.
fn inside(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "rs") || head(path).is_some());
    paths.sort();
    paths
}

/// The file that names the others of a folder.
fn head(folder: &Path) -> Option<PathBuf> {
    ["main.rs", "mod.rs"].map(|name| folder.join(name)).into_iter().find(|file| file.exists())
}

/// A file of tests as the list names it, and the first paragraph that it says of itself.
fn entry(name: &Path, file: &Path) -> Row {
    let text = fs::read_to_string(file).unwrap();
    let paragraph: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("//! ")).collect();
    let purpose = paragraph.join(" ");
    assert!(!purpose.is_empty() && !purpose.contains('|'), "{}: {purpose:?}", file.display());
    let name = name.strip_prefix(roulement_tests::ROOT).unwrap();
    row(format!("`{}` | {}", name.display(), purpose.trim_end_matches('.')), vec![], "")
}

/// The files of a folder. One that nobody names is not compiled, and nobody would miss its tests.
fn named(folder: &Path) -> Vec<PathBuf> {
    let head = head(folder).unwrap();
    let text = fs::read_to_string(&head).unwrap();
    let mut files = inside(folder);
    files.retain(|file| *file != head);
    for file in &files {
        let name = file.file_stem().unwrap().to_str().unwrap();
        assert!(text.lines().any(|line| line == format!("mod {name};")), "{} has no {name}", head.display());
    }
    files
}

/// A room: its program, then the files in it that have tests.
fn room(folder: &Path) -> Vec<Row> {
    let mut rows = vec![entry(folder, &folder.join("main.rs"))];
    for path in named(folder) {
        if let Some(head) = head(&path) {
            named(&path);
            rows.push(entry(&path, &head));
        } else if fs::read_to_string(&path).unwrap().contains("#[test]") {
            rows.push(entry(&path, &path));
        }
    }
    rows
}

/// Does the manifest of the crate that a program of tests belongs to name it? One that it does not name is not compiled.
fn is_compiled(program: &Path) -> bool {
    let crate_of_tests = Path::new(roulement_tests::ROOT).join("tests");
    // Cargo finds those of others by itself.
    program.strip_prefix(&crate_of_tests).map_or(true, |file| {
        let manifest = fs::read_to_string(crate_of_tests.join("Cargo.toml")).unwrap();
        manifest.lines().any(|line| line == format!("path = \"{}\"", file.display()))
    })
}

#[test]
fn contributing_lists_all_files_of_tests() {
    let mut rows = vec![];
    for tests in ["tests", "cli/tests"] {
        for path in inside(&Path::new(roulement_tests::ROOT).join(tests)) {
            let head = path.join("main.rs");
            if head.exists() {
                assert!(is_compiled(&head), "tests/Cargo.toml does not name {}", head.display());
                rows.extend(room(&path));
            } else if path.is_file() {
                assert!(is_compiled(&path), "tests/Cargo.toml does not name {}", path.display());
                rows.push(entry(&path, &path));
            }
        }
    }
    compare("CONTRIBUTING.md", "tests", "file | what it tests", &rows);
}
