//! `roulement scene`: what may stand in a scene file, and in other files.

use std::error::Error;

use clap::{Args, ValueEnum};

use super::say;

/// The reference of scenes, written from the structs that read them.
const REFERENCE: &str = include_str!("../../../docs/scene.md");

/// Files that editors have a schema of.
#[derive(Clone, Copy, ValueEnum)]
enum File {
    /// The scene of one bearing.
    Bearing,
    /// Shafts with their bearings.
    Machine,
    /// A catalogue of one's own, catalogue.toml.
    Shelf,
    /// Cases of a scene.
    Sweep,
    /// Connected packages.
    System,
}

impl File {
    fn schema(self) -> &'static str {
        match self {
            Self::Bearing => include_str!("../../../docs/scene.schema.json"),
            Self::Machine => include_str!("../../../docs/machine.schema.json"),
            Self::Shelf => include_str!("../../../docs/shelf.schema.json"),
            Self::Sweep => include_str!("../../../docs/sweep.schema.json"),
            Self::System => include_str!("../../../docs/system.schema.json"),
        }
    }
}

/// Options of `roulement scene`.
#[derive(Args)]
#[group(required = true, multiple = false)]
pub struct Options {
    /// Print every key with its meaning, unit, values and default; of a word, those sections and keys that have it in their name.
    #[arg(long, num_args = 0..=1, default_missing_value = "", value_name = "WORD")]
    keys: Option<String>,
    /// Print a JSON schema, by which editors complete and check files: of the scene of a bearing, or of another kind of files.
    #[arg(long, num_args = 0..=1, default_missing_value = "bearing", value_name = "KIND")]
    schema: Option<File>,
    /// Print the units that numbers of a scene may have: of every dimension, and every known unit with its size in SI.
    #[arg(long)]
    units: bool,
}

/// Prints.
///
/// # Errors
/// If no key has the word in its name, or nothing can be printed.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    if options.units {
        return Ok(say(units())?);
    }
    if let Some(kind) = options.schema {
        return Ok(say(kind.schema())?);
    }
    match options.keys.as_ref() {
        // One of them is there.
        None => Ok(()),
        Some(word) if word.is_empty() => Ok(say(REFERENCE)?),
        Some(word) => match about(&word.to_lowercase()) {
            text if text.is_empty() => Err(format!(
                "no section and no key has {word:?} in its name: `roulement scene --keys` prints all"
            )
            .into()),
            text => Ok(say(&text)?),
        },
    }
}

/// The tables of units.
fn units() -> &'static str {
    let (_, tables) = REFERENCE.split_once("<!-- begin units -->\n").unwrap_or_default();
    tables.split_once("<!-- end -->").unwrap_or_default().0
}

/// Sections with a word in their names, and keys with it in others.
fn about(word: &str) -> String {
    let mut found = String::new();
    for section in REFERENCE.split("\n## ").skip(1) {
        let (title, _) = section.split_once('\n').unwrap_or((section, ""));
        if title.contains(word) {
            found += &format!("## {}\n\n", section.trim_end());
            continue;
        }
        let has_it = |line: &&str| {
            line.strip_prefix("| `")
                .and_then(|rest| rest.split_once('`'))
                .is_some_and(|(key, _)| key.contains(word))
        };
        let keys: Vec<&str> = section.lines().filter(has_it).collect();
        if !keys.is_empty() {
            let head = "| key | meaning | values | default |\n|---|---|---|---|";
            found += &format!("## {title}\n\n{head}\n{}\n\n", keys.join("\n"));
        }
    }
    found
}
