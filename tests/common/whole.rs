//! Documents that are written as a whole: compared with what is written, or written where that is asked for (`scripts/tables`).

use std::fs;
use std::path::Path;

/// Compares a file with what it should be, or writes it.
pub fn compare(file: &str, text: &str) {
    let path = Path::new(roulement_tests::ROOT).join(file);
    if std::env::var("ROULEMENT_RENEW").is_ok() {
        fs::write(path, text).unwrap();
        return;
    }
    let written = fs::read_to_string(path).unwrap();
    for (ours, theirs) in text.lines().zip(written.lines()) {
        assert_eq!(ours, theirs, "{file} is stale: scripts/tables");
    }
    assert_eq!(text.lines().count(), written.lines().count(), "{file} is stale: scripts/tables");
}
