//! The list of tests in CONTRIBUTING.md, from the first paragraph of every file of tests. `scripts/tables` writes it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::tables::{Row, compare, row};

/// What a folder of tests has in it, by name.
fn inside(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

/// A file of tests as the list names it, and the first paragraph that it says of itself.
fn entry(name: &Path, file: &Path) -> Row {
    let text = fs::read_to_string(file).unwrap();
    let paragraph: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("//! ")).collect();
    let purpose = paragraph.join(" ");
    assert!(!purpose.is_empty() && !purpose.contains('|'), "{}: {purpose:?}", file.display());
    let name = name.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap();
    row(format!("`{}` | {}", name.display(), purpose.trim_end_matches('.')), vec![], "")
}

/// A room: its program, then the files in it that have tests.
fn room(folder: &Path) -> Vec<Row> {
    let mut rows = vec![entry(folder, &folder.join("main.rs"))];
    for path in inside(folder) {
        let part = path.join("mod.rs");
        if part.exists() {
            rows.push(entry(&path, &part));
        } else if !path.ends_with("main.rs")
            && fs::read_to_string(&path).is_ok_and(|text| text.contains("#[test]"))
        {
            rows.push(entry(&path, &path));
        }
    }
    rows
}

#[test]
fn contributing_lists_all_files_of_tests() {
    let mut rows = vec![];
    for tests in ["tests", "cli/tests"] {
        for path in inside(&Path::new(env!("CARGO_MANIFEST_DIR")).join(tests)) {
            if path.join("main.rs").exists() {
                rows.extend(room(&path));
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                rows.push(entry(&path, &path));
            }
        }
    }
    compare("CONTRIBUTING.md", "tests", "file | what it tests", &rows);
}
