//! Links of the texts that are no part of the site (which checks its own): files and headings that they lead to are there.

use std::fs;
use std::path::Path;

/// Targets of links and pictures in a text, but for what stands in blocks of code, and addresses elsewhere.
fn targets(text: &str) -> Vec<String> {
    let prose: String = text.split("```").step_by(2).collect();
    let target = |rest: &str| rest.split_once(')').map(|(target, _)| target.to_string());
    let all = prose.split("](").skip(1).filter_map(target);
    all.filter(|target| !target.contains("://") && !target.contains(char::is_whitespace)).collect()
}

/// The name of a heading as links have it.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|letter| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_'));
    kept.map(|letter| if letter == ' ' { '-' } else { letter.to_ascii_lowercase() }).collect()
}

/// Why a link of a file in the root of the project leads nowhere.
fn broken(text: &str, target: &str) -> Option<String> {
    let (file, part) = target.split_once('#').unwrap_or((target, ""));
    let path = Path::new(roulement_tests::ROOT).join(file);
    if !file.is_empty() && !path.exists() {
        return Some(format!("there is no {file}"));
    }
    if part.is_empty() {
        return None;
    }
    let text = if file.is_empty() { text.to_string() } else { fs::read_to_string(path).unwrap() };
    let headings =
        text.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#').trim());
    let is_there = headings.map(anchor).any(|heading| heading == part);
    (!is_there).then(|| format!("{file} has no heading {part}"))
}

#[test]
fn links_of_the_readme_and_of_contributing_lead_somewhere() {
    for (name, least) in [("README.md", 40), ("CONTRIBUTING.md", 2), ("CHANGELOG.md", 5)] {
        let text = fs::read_to_string(Path::new(roulement_tests::ROOT).join(name)).unwrap();
        let targets = targets(&text);
        assert!(targets.len() >= least, "{name}: {}", targets.len());
        for target in targets {
            let why = broken(&text, &target);
            assert!(why.is_none(), "{name}: {}", why.unwrap());
        }
    }
    assert!(broken("", "docs/nothing.md").is_some() && broken("# A part\n", "#a-part").is_none());
    assert!(broken("# A part\n", "#another").is_some() && broken("", "docs/sweeps.md#nowhere").is_some());
}
