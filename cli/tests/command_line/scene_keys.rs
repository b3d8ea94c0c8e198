//! `roulement scene`: what may stand in a scene file.

use crate::common::roulement;

fn printed(arguments: &[&str]) -> String {
    let output = roulement(arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn keys_of_a_word_are_those_with_it_in_their_names() {
    let all = printed(&["scene", "--keys"]);
    assert!(all.contains("## `bearing`") && all.contains("| `ball_diameter` |"));
    // A section as a whole, and keys of others.
    let film = printed(&["scene", "--keys", "Film"]);
    assert!(film.contains("## `film`") && film.contains("| `iso_vg` |") && !film.contains("## `bearing`"));
    let conformity = printed(&["scene", "--keys", "conformity"]);
    let keys: Vec<&str> = conformity.lines().filter(|line| line.starts_with("| `")).collect();
    assert_eq!(keys.len(), 2, "{conformity}");
    assert!(conformity.starts_with("## `bearing`") && keys[1].contains("| 0.53 |"), "{conformity}");
    let none = roulement(&["scene", "--keys", "xyzzy"]);
    assert!(!none.status.success() && String::from_utf8_lossy(&none.stderr).contains("xyzzy"));
    // Nothing asked for is told with what there is to ask for.
    let nothing = roulement(&["scene"]);
    assert!(!nothing.status.success() && String::from_utf8_lossy(&nothing.stderr).contains("--schema"));
}

#[test]
fn the_schema_is_json_and_knows_words_and_units() {
    let schema: serde_json::Value = serde_json::from_str(&printed(&["scene", "--schema"])).unwrap();
    let bearing = &schema["properties"]["bearing"];
    assert_eq!(bearing["additionalProperties"], false);
    assert_eq!(bearing["properties"]["ball_diameter"]["type"], serde_json::json!(["number", "string"]));
    let drives = schema["properties"]["inner"]["properties"]["drive"]["enum"].as_array().unwrap();
    assert!(drives.contains(&"wrench".into()) && drives.contains(&"pose".into()), "{drives:?}");
}

#[test]
fn units_are_printed_by_dimension_and_with_their_sizes() {
    let units = printed(&["scene", "--units"]);
    for part in
        ["| a length | m | m, micron, in, ft,", "`9.525 mm`", "| lbf |  | 4.4482216152605 N |", "micro, 1e-6"]
    {
        assert!(units.contains(part), "{part}: {units}");
    }
    assert!(!units.contains("<!--") && !units.contains("`bearing`"), "{units}");
}
