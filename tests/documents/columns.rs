//! Writes and checks docs/columns.md, the columns of results: names, units and meanings are those of the table of variables, for all
//! scenes of the project together. `scripts/tables` writes it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use roulement::interface::variables::Variables;
use roulement::scene::Scene;

use crate::whole;

const HEAD: &str = include_str!("columns/head.md");

/// A line of the page: one quantity with all its components, races and balls.
struct Line {
    /// Ends of its names, such as `x` and `y`; none where a name has none.
    components: Vec<String>,
    races: Vec<&'static str>,
    units: Vec<&'static str>,
    meaning: String,
    /// Scenes that have it.
    scenes: Vec<String>,
}

/// Scenes by the paths they are known by; runs of them are what the columns are of.
fn scenes() -> Vec<(String, Scene)> {
    let root = Path::new(roulement_tests::ROOT);
    let mut paths: Vec<String> = ["scenes", "scenes/effects"]
        .iter()
        .flat_map(|folder| {
            fs::read_dir(root.join(folder)).unwrap().map(move |entry| (folder, entry.unwrap().file_name()))
        })
        .map(|(folder, name)| format!("{folder}/{}", name.to_str().unwrap()))
        .filter(|path| path.ends_with(".toml"))
        .collect();
    // Short paths first: the plainest scene with a column is its example.
    paths.sort_by_key(|path| (path.matches('/').count(), path.clone()));
    paths.into_iter().map(|path| (path.clone(), Scene::load(&root.join(path)).unwrap())).collect()
}

/// Name of a quantity without ball, race and component; which race and component it is of.
fn split(name: &str) -> (String, Option<&'static str>, Option<String>) {
    let name = match (name.find('['), name.find(']')) {
        (Some(open), Some(close)) => format!("{}[j]{}", &name[..open], &name[close + 1..]),
        _ => name.to_string(),
    };
    let parts: Vec<&str> = name.split('.').collect();
    let is_component = |part: &str| ["w", "x", "y", "z", "rx", "ry", "rz"].contains(&part);
    let ends = parts.iter().rev().take_while(|part| is_component(part)).count();
    let (stem, ends) = parts.split_at(parts.len() - ends);
    let race = stem.iter().find_map(|part| ["inner", "outer"].into_iter().find(|race| race == part));
    let stem: Vec<&str> = stem.iter().map(|part| if race == Some(part) { "RACE" } else { part }).collect();
    (stem.join("."), race, (!ends.is_empty()).then(|| ends.join(".")))
}

/// What a quantity means, whatever its ball, race and component.
fn meaning(description: &str, race: Option<&str>, component: Option<&str>) -> String {
    let mut words = description.replace("of ball 1", "of ball j");
    if let Some(component) = component {
        words = words
            .replace(&format!(", {component} component, "), ", ")
            .replace(&format!(", {component} component"), "")
            .replace(&format!("{component} component along"), "along")
            .replace(&format!("quaternion component {component}"), "quaternion");
        // Of six by six: names of rows and columns.
        if let Some((row, column)) = component.split_once('.') {
            words = words
                .replace(&format!("force {row} "), "force or moment (first name) ")
                .replace(&format!("translation {column} "), "translation or rotation (second name) ")
                .replace(&format!("velocity {column} "), "rate of translation or rotation (second name) ");
        }
    }
    if let Some(race) = race {
        words = words
            .replace(&format!("{race} race"), "race")
            .replace(&format!("{race} ring"), "ring")
            .replace("its shaft", "its seat");
        words = words.strip_suffix(", race").unwrap_or(&words).to_string();
    }
    words
}

fn lines() -> Vec<(String, Line)> {
    let mut lines: Vec<(String, Line)> = vec![];
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for (path, scene) in scenes() {
        for row in Variables::moving(&scene, true).rows() {
            // All balls are like the first.
            if row.name.starts_with("ball[") && !row.name.starts_with("ball[1]") {
                continue;
            }
            let (key, race, component) = split(&row.name);
            let place = *places.entry(key.clone()).or_insert_with(|| {
                let meaning = meaning(&row.description, race, component.as_deref());
                lines.push((
                    key,
                    Line { components: vec![], races: vec![], units: vec![], meaning, scenes: vec![] },
                ));
                lines.len() - 1
            });
            let line = &mut lines[place].1;
            line.units.extend((!line.units.contains(&row.unit.name)).then_some(row.unit.name));
            line.components.extend(component.filter(|component| !line.components.contains(component)));
            line.races.extend(race.filter(|race| !line.races.contains(race)));
            if line.scenes.last() != Some(&path) {
                line.scenes.push(path.clone());
            }
        }
    }
    lines
}

/// The name of a line, for people.
fn name(key: &str, line: &Line) -> String {
    let key = key.replace("RACE", &line.races.join("/"));
    let components: Vec<&str> = line.components.iter().map(String::as_str).collect();
    match components.len() {
        0 => format!("`{key}`"),
        // Six by six.
        36 => format!("`{key}.x.x` to `{key}.rz.rz`"),
        _ => format!("`{key}.{}`", components.join("/")),
    }
}

fn page() -> String {
    let lines = lines();
    let all = scenes().len();
    // In the order of the parts that a user looks for.
    let parts = [("The races", "RACE."), ("A ball", "ball[j]."), ("The cage", "cage."), ("The bearing", "")];
    let mut text = HEAD.to_string();
    let mut left: Vec<&(String, Line)> = lines.iter().collect();
    for (title, start) in parts {
        let (here, rest): (Vec<_>, Vec<_>) = left.into_iter().partition(|(key, _)| key.starts_with(start));
        left = rest;
        text += &format!("\n## {title}\n\n| column | unit | meaning | in |\n| --- | --- | --- | --- |\n");
        for (key, line) in here {
            let places =
                if line.scenes.len() == all { "all".into() } else { format!("`{}`", line.scenes[0]) };
            text += &format!(
                "| {} | {} | {} | {places} |\n",
                name(key, line),
                line.units.join(", "),
                line.meaning.replace('|', "\\|")
            );
        }
    }
    text
}

#[test]
fn the_page_of_columns_is_that_of_the_table_of_variables() {
    whole::compare("docs/columns.md", &page());
}

#[test]
fn invariant_a_name_is_split_into_quantity_race_and_component() {
    let of = |name| {
        let (key, race, component) = split(name);
        (key, race.unwrap_or("none"), component.unwrap_or_default())
    };
    assert_eq!(of("inner.force.x"), ("RACE.force".into(), "inner", "x".into()));
    assert_eq!(of("ball[12].outer.load"), ("ball[j].RACE.load".into(), "outer", String::new()));
    assert_eq!(of("stiffness.rx.z"), ("stiffness".into(), "none", "rx.z".into()));
    assert_eq!(of("power.spin"), ("power.spin".into(), "none", String::new()));
}
