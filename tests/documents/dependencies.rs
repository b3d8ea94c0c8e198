//! Crates that the library of a package is linked from.

use std::process::Command;

/// Crates that the command line needs and a package does not.
const OF_THE_COMMAND_LINE: [&str; 9] =
    ["clap", "plotters", "zip", "csv", "indicatif", "perf-event", "cpu-time", "rustfft", "parquet"];

/// Crates that a package of the workspace is linked from on this platform.
fn linked(package: &str) -> Vec<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args([
            "tree",
            "--locked",
            "--offline",
            "--edges",
            "normal",
            "--prefix",
            "none",
            "--package",
            package,
        ])
        .current_dir(roulement_tests::ROOT)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let tree = String::from_utf8(output.stdout).unwrap();
    tree.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_string).collect()
}

#[test]
fn the_library_is_linked_without_the_crates_of_the_command_line() {
    let library = linked("roulement");
    assert!(library.iter().any(|name| name == "nalgebra"), "{library:?}");
    let program = linked("roulement-cli");
    for name in OF_THE_COMMAND_LINE {
        assert!(!library.iter().any(|other| other == name), "{name}");
        // The name is right, and so is the list that it is looked for in.
        assert!(
            name == "perf-event" && !cfg!(target_os = "linux") || program.iter().any(|n| n == name),
            "{name}"
        );
    }
}
