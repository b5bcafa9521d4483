//! Schema of `repeat`, which may stand in every entry that has a name.

use serde_json::{Map, Value, json};

/// Entries that are mappings of fixed keys.
const MAPPINGS: [&str; 7] =
    ["Body", "PointFrame", "PointPort", "OutputFormula", "Reduced", "Parameter", "InstanceFile"];

/// Entries that are mappings of one kind.
const KINDS: [&str; 2] = ["Joint", "Effect"];

/// Adds `repeat` to the definitions, and to the start values of the root.
pub(super) fn allow(root: &mut Map<String, Value>) {
    let repeat = json!({ "$ref": "#/$defs/Repeat", "description": "Once for each value of an index, which names have in braces." });
    start_values(root.get_mut("properties"));
    let Some(definitions) = root.get_mut("$defs").and_then(Value::as_object_mut) else { return };
    for name in MAPPINGS.into_iter().chain(KINDS) {
        definitions[name]["properties"]["repeat"] = repeat.clone();
    }
    for name in KINDS {
        definitions[name]["maxProperties"] = json!(2);
    }
    for name in ["Scene", "Assembly"] {
        start_values(definitions[name].get_mut("properties"));
    }
    definitions.insert(
        "Repeat".to_owned(),
        json!({
            "description": "Indices with their values; of several, the last runs fastest.",
            "type": "object",
            "additionalProperties": {
                "description": "A range with both ends, `1..6`, or a list of words or numbers.",
                "anyOf": [
                    { "type": "string", "pattern": r"\.\." },
                    { "type": "array", "items": { "type": ["string", "number"] }, "minItems": 1 }
                ]
            },
            "examples": [{ "i": "1..6" }, { "side": ["left", "right"] }]
        }),
    );
    definitions.insert(
        "Repeated".to_owned(),
        json!({
            "description": "The same for each value of an index.",
            "type": "object",
            "properties": {
                "repeat": repeat,
                "value": { "description": "Entries that are repeated for each value.", "anyOf": [
                    { "$ref": "#/$defs/Number" },
                    { "type": "array", "items": { "$ref": "#/$defs/Number" }, "minItems": 3, "maxItems": 3 },
                    { "$ref": "#/$defs/Rotation" }
                ] }
            },
            "required": ["repeat", "value"],
            "additionalProperties": false
        }),
    );
}

/// Allows repetition of start values.
fn start_values(properties: Option<&mut Value>) {
    let Some(properties) = properties else { return };
    for key in ["initial", "guess"] {
        add_choice(&mut properties[key]);
    }
}

/// Adds the repeated value to the choices of a mapping's values, wherever the mapping is.
fn add_choice(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            let values = object.get_mut("additionalProperties").and_then(|values| values.get_mut("anyOf"));
            match values.and_then(Value::as_array_mut) {
                Some(choices) => choices.push(json!({ "$ref": "#/$defs/Repeated" })),
                None => object.values_mut().for_each(add_choice),
            }
        }
        Value::Array(items) => items.iter_mut().for_each(add_choice),
        _ => {}
    }
}
