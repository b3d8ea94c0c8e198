//! Reference cases of the equilibrium (tests/data/bearing/README.md).

use serde_json::Value;

/// The 20 cases.
pub fn cases() -> Vec<Value> {
    let data: Value = serde_json::from_str(include_str!("../data/bearing/equilibrium.json")).unwrap();
    let cases = data["cases"].as_array().unwrap().clone();
    assert_eq!(cases.len(), 20);
    cases
}

/// A number of the data; not every test asks.
#[allow(dead_code)]
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

/// Scene text of a reference case, as a user would write it; further sections can be added in front.
pub fn scene_text(case: &Value) -> String {
    let bearing = &case["bearing"];
    let mut text = String::from("[bearing]\n");
    for (key, value) in bearing.as_object().unwrap() {
        if !value.is_object() {
            text += &format!("{key} = {value}\n");
        }
    }
    for section in ["ball", "race"] {
        text += &format!("[{section}]\n");
        for (key, value) in bearing[section].as_object().unwrap() {
            text += &format!("{key} = {value}\n");
        }
    }
    text +=
        &format!("[load]\ninner_speed = {}\nouter_speed = {}\n", case["inner_speed"], case["outer_speed"]);
    for (key, condition) in case["conditions"].as_object().unwrap() {
        let (kind, value) = condition.as_object().unwrap().iter().next().unwrap();
        text += &format!("{key} = {{ {kind} = {value} }}\n");
    }
    text
}
