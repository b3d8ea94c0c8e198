//! Help of every command and what shells complete by.

use super::*;

/// Names of all commands, as the help lists them.
fn commands() -> Vec<String> {
    let output = roulement(&["--help"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let list = text.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let name = |line: &str| {
        line.strip_prefix("  ").filter(|rest| !rest.starts_with(' '))?.split(' ').next().map(str::to_owned)
    };
    list.lines().filter_map(name).filter(|name| name != "help").collect()
}

#[test]
fn every_command_has_examples_whose_options_and_files_are_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let all = commands();
    assert!(all.len() > 20, "{all:?}");
    for name in all {
        let output = roulement(&[&name, "--help"]);
        let text = String::from_utf8(output.stdout).unwrap();
        let (help, examples) = text.split_once("Examples:\n").unwrap_or_else(|| panic!("{name}: {text}"));
        for line in examples.lines().filter(|line| !line.trim().is_empty()) {
            let given: Vec<&str> = line.split_whitespace().collect();
            assert_eq!(given[..2], ["roulement", name.as_str()], "{line}");
            for word in &given[2..] {
                if let Some(option) = word.strip_prefix("--") {
                    let option = option.split('=').next().unwrap();
                    assert!(help.contains(&format!("--{option}")), "{name}: --{option} of {line}");
                }
                let of_project = ["scenes/", "examples/"].iter().any(|folder| word.starts_with(folder));
                assert!(!of_project || root.join(word).exists(), "{line}");
            }
        }
    }
}

#[test]
fn shells_complete_all_commands_and_their_options() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let output = roulement(&["completions", shell]);
        assert!(output.status.success(), "{shell}");
        let script = String::from_utf8(output.stdout).unwrap();
        for word in commands().iter().map(String::as_str).chain(["steps-end-at-rows", "candidates"]) {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    let output = roulement(&["completions", "csh"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("possible values"), "{output:?}");
}
