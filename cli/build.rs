//! Records revision and platform for `roulement --version`.

use std::path::Path;
use std::process::Command;

/// What git says, without the line's end; nothing if there is no git or no repository, as in a source archive.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("rev-parse").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
    Some(text.trim().to_string())
}

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // A commit changes the log, not the file HEAD. Elsewhere than in .git for a second work tree; a file that is not there would mean
    // a new build every time.
    for name in ["HEAD", "logs/HEAD"] {
        if let Some(path) = git(&["--git-path", name]).filter(|path| Path::new(path).exists()) {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    let revision = git(&["--short", "HEAD"]).unwrap_or_else(|| "unknown revision".to_string());
    let platform = std::env::var("TARGET").unwrap_or_default();
    let version = std::env::var("CARGO_PKG_VERSION").unwrap_or_default();
    println!("cargo::rustc-env=ROULEMENT_VERSION={version} ({revision}, {platform})");
}
