//! Schemas for editors of the other files that commands read: machines, shelves, sweeps and systems.

use serde_json::{Value, json};

use super::keys::Reference;

/// A kind of file by the word that `roulement scene --schema` takes, and its schema.
pub fn schemas(reference: &Reference, scene: &Value) -> [(&'static str, Value); 4] {
    [
        ("machine", machine(reference, scene)),
        ("shelf", shelf(reference)),
        ("sweep", sweep(scene)),
        ("system", system()),
    ]
}

fn shelf(reference: &Reference) -> Value {
    whole("A shelf of bearings for roulement", reference.object_of("Written", "catalogue/shelf.rs"))
}

/// A schema that stands alone.
fn whole(title: &str, mut schema: Value) -> Value {
    schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
    schema["title"] = title.into();
    schema
}

/// The schema of a scene, as a definition of another schema.
fn definition(scene: &Value) -> Value {
    let mut scene = scene.clone();
    for key in ["$schema", "title"] {
        scene.as_object_mut().unwrap().remove(key);
    }
    scene
}

/// A value of several kinds, with the description that the key has.
fn one_of(place: &mut Value, kinds: &Value) {
    let description = place["description"].take();
    *place = json!({ "anyOf": kinds, "description": description });
}

fn machine(reference: &Reference, scene: &Value) -> Value {
    let mut machine = whole("A machine of roulement", reference.object_of("Written", "scene/system/read.rs"));
    machine["definitions"] = json!({ "scene": definition(scene) });
    let keys = &mut machine["properties"];
    // One as a section, or several.
    let shaft = reference.object_of("ShaftSection", "schema/shaft.rs");
    one_of(&mut keys["shaft"], &json!([shaft, { "type": "array", "items": shaft }]));
    for varies in ["stiffness_variation", "transmission_error"] {
        // A list, or a column of a file.
        let values = &mut keys["mesh"]["items"]["properties"][varies]["items"]["properties"]["values"];
        one_of(values, &json!([{ "type": "array" }, { "type": "object" }]));
    }
    keys["solver"]["$ref"] = "#/definitions/scene/properties/solver".into();
    keys["ranges"] = scene["properties"]["ranges"].clone();
    let bearing = &mut keys["bearing"]["items"]["properties"];
    one_of(&mut bearing["scene"], &json!([{ "type": "string" }, { "$ref": "#/definitions/scene" }]));
    one_of(&mut bearing["set"], &json!([{ "$ref": "#/definitions/scene" }]));
    machine
}

fn sweep(scene: &Value) -> Value {
    // Keys of a scene are completed; parts of lists of a machine go by their names, which no schema knows.
    let keys = |meaning: &str| json!({ "anyOf": [{ "$ref": "#/definitions/scene" }, { "type": "object" }], "description": meaning });
    let open = |meaning: &str| json!({ "type": "object", "description": meaning });
    let mut hypercube = open(
        "Cases spread evenly at random: keys of the scene, each with the ends of its range, { from = 1, to = 2 }.",
    );
    hypercube["properties"] = json!({
        "cases": { "type": "integer", "minimum": 1, "description": "Number of cases." },
        "seed": { "type": "integer", "description": "Number that the spread follows from." },
    });
    let schema = json!({
        "type": "object",
        "additionalProperties": false,
        "definitions": { "scene": definition(scene) },
        "properties": {
            "scene": { "type": "string", "description": "The base scene or machine, a file beside this one." },
            "remove": {
                "type": "array",
                "items": { "type": "string" },
                "description": "Keys that are taken out of the scene first, such as \"load.y\".",
            },
            "set": keys("Keys of the scene that all cases have."),
            "case": { "type": "array", "items": keys("A case: keys of the scene."), "description": "Cases one by one." },
            "grid": open(
                "All combinations: keys of the scene, each with a list of values or a range, { from = 1, to = 2, steps = 3 }, with scale = \"log\" for equal ratios; the last key changes fastest.",
            ),
            "latin_hypercube": hypercube,
        },
    });
    whole("A sweep of roulement", schema)
}

fn system() -> Value {
    let name = json!({ "type": "string", "pattern": "^[A-Za-z_][A-Za-z0-9_]*$" });
    let described = |mut schema: Value, meaning: &str| {
        schema["description"] = meaning.into();
        schema
    };
    let time = |meaning: &str| described(json!({ "type": ["number", "string"] }), meaning);
    let text = |meaning: &str| described(json!({ "type": "string" }), meaning);
    let schema = json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["name", "step", "stop", "components"],
        "properties": {
            "name": described(name.clone(), "Name of the system and of its files."),
            "step": time("[s] communication step."),
            "stop": time("[s] end of the simulation."),
            "connections": described(
                json!({ "type": "array", "items": { "type": "string", "pattern": "->" } }),
                "Connections such as \"shaft.left -> left.inner\": every input left.inner.* from the output shaft.left.* of the same ending.",
            ),
            "components": {
                "type": "object",
                "description": "Packages by their names.",
                "propertyNames": { "pattern": name["pattern"] },
                "additionalProperties": {
                    "type": "object",
                    "additionalProperties": false,
                    "properties": {
                        "fmu": text("A package that is there, beside this file; or scene."),
                        "scene": text("A scene, which is packed as by `roulement fmu`; or fmu."),
                        "changes": described(json!({ "type": "object" }), "Keys of the scene that are changed, such as \"load.inner_speed\"."),
                        "mounting": described(json!({ "enum": ["x", "-x"] }), "Where its x axis points: along the system's, or against it (half a turn about z)."),
                    },
                },
            },
            "start": described(
                json!({ "type": "object" }),
                "Parameters and inputs, by their component and name: a value, or { of = \"left.inner.position.x\" }, the start value of another variable.",
            ),
        },
    });
    whole("A system of packages for roulement", schema)
}
