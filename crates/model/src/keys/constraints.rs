//! Constraints of the schema beyond keys and types: ranges of numbers, keys that exclude or need each other, defaults
//! and examples.
//!
//! The schema refuses only values that the reader refuses for certain: formulas, and values that depend on names, are
//! the reader's.

use schemars::Schema;
use serde_json::{Map, Value, json};

use super::repetition;
use crate::grammar::not_negative;

/// Adds the constraints to the schema of model files.
pub fn constrain(schema: &mut Schema) {
    if let Some(root) = schema.as_object_mut() {
        of_model(root);
        repetition::allow(root);
    }
    let Some(definitions) = schema.get_mut("$defs").and_then(Value::as_object_mut) else { return };
    for name in ["Simulation", "SceneSimulation"] {
        of_simulation(&mut definitions[name]);
    }
    of_parameter(&mut definitions["Parameter"]);
    of_body(&mut definitions["Body"]);
    with_ground(&mut definitions["Assembly"]["properties"]["bodies"]);
    of_table(&mut definitions["Table"]);
    of_bounds(definitions);
    exactly_one(&mut definitions["BlackBoxFile"], &["command", "fmu"]);
    insert(&mut definitions["BlackBoxFile"], "dependentRequired", json!({ "command": ["outputs"] }));
    exactly_one(&mut definitions["Rotation"], &["rpy", "axis", "quaternion"]);
    insert(&mut definitions["Rotation"], "dependentRequired", json!({ "axis": ["angle"], "angle": ["axis"] }));
    insert(&mut definitions["FlexibleBeam"]["properties"]["elements"], "minimum", json!(1));
    for (key, limit) in [("length", POSITIVE), ("mass_per_length", POSITIVE), ("axial_stiffness", POSITIVE)] {
        limited(&mut definitions["FlexibleBeam"], key, limit);
    }
}

const POSITIVE: &str = "exclusiveMinimum";
const NONNEGATIVE: &str = "minimum";

/// A model stands alone, on a robot, or on a program.
fn of_model(root: &mut Map<String, Value>) {
    let without_time = json!({ "required": ["analysis"], "properties": { "analysis": { "enum": ["statics", "modes", "dimensions"] } } });
    let black_box = json!({ "required": ["black_box"] });
    // Formulas of parameters: nothing of a mechanism.
    let of_mechanisms = ["bodies", "joints", "effects", "instances", "urdf", "mjcf", "simulation", "black_box"];
    let of_mechanisms: Vec<Value> = of_mechanisms.iter().map(|key| json!({ "required": [key] })).collect();
    let stack = json!({
        "anyOf": [{ "required": ["dimensions"] }, { "required": ["parameters", "outputs"] }],
        "not": { "anyOf": of_mechanisms }
    });
    root.insert("anyOf".to_owned(), json!([{ "required": ["simulation"] }, without_time, black_box, stack]));
    let kinematics = json!({ "required": ["analysis"], "properties": { "analysis": { "const": "kinematics" } } });
    let massive = json!({ "bodies": massive(), "assemblies": { "additionalProperties": { "properties": { "bodies": massive() } } } });
    let moved_by_forces =
        |properties: Value| json!({ "if": { "not": kinematics }, "then": { "properties": properties } });
    let not_only_points = json!({ "properties": { "ground": true }, "additionalProperties": { "not": only_points() } });
    let alone = json!({
        "anyOf": [{ "required": ["bodies"] }, { "required": ["instances"] }],
        "properties": {
            "bodies": {
                "type": "object",
                "minProperties": 1
            },
            "outputs": { "type": "object", "minProperties": 1 }
        },
        "allOf": [
            moved_by_forces(json!({ "bodies": not_only_points })),
            { "anyOf": [{ "required": ["outputs"] }, { "required": ["dimensions"] }] }
        ]
    });
    root.insert("if".to_owned(), json!({ "not": { "anyOf": [{ "required": ["urdf"] }, { "required": ["mjcf"] }, { "required": ["black_box"] }, stack] } }));
    root.insert("then".to_owned(), alone);
    root.insert("allOf".to_owned(), json!([moved_by_forces(massive)]));
    root.insert("dependentRequired".to_owned(), json!({ "base": ["urdf"], "controls": ["mjcf"] }));
    let robot = json!({ "anyOf": [{ "required": ["urdf"] }, { "required": ["mjcf"] }] });
    root.insert("dependentSchemas".to_owned(), json!({ "limits": robot }));
    root.insert("examples".to_owned(), json!([example()]));
    let Some(properties) = root.get_mut("properties").and_then(Value::as_object_mut) else { return };
    insert(&mut properties["base"], "default", json!("fixed"));
    insert(&mut properties["model"], "pattern", json!(r"^[^\s./\\]+$"));
    insert(&mut properties["model"], "maxLength", json!(100));
    insert(&mut properties["model"], "examples", json!(["slider_crank"]));
    insert(
        &mut properties["initial"],
        "examples",
        json!([{ "crank.angle": "30 deg", "crank.angular_velocity": "60 rpm" }]),
    );
    insert(&mut properties["outputs"], "examples", json!([{ "height": "ball.y", "angle": "deg(crank.angle)" }]));
    insert(&mut properties["parameters"], "examples", json!([{ "length": "0.5 m ± 1%", "mass": "250 kg/m * length" }]));
    with_ground(&mut properties["bodies"]);
}

/// The ground has points and nothing else.
fn with_ground(bodies: &mut Value) {
    let points = json!({
        "description": "The body that does not move.",
        "type": ["object", "null"],
        "properties": { "points": { "$ref": "#/$defs/Body/properties/points" } },
        "additionalProperties": false
    });
    insert(bodies, "properties", json!({ "ground": points }));
}

fn example() -> Value {
    json!({
        "parameters": { "mass": 1.2, "length": "0.5 m ± 2%" },
        "bodies": { "rod": { "mass": "mass", "inertia": "mass*length^2/12", "points": { "A": ["-length/2", 0] } } },
        "joints": { "hinge": { "revolute": ["ground", "rod.A"] } },
        "effects": { "weight": { "gravity": { "acceleration": [0, -9.81] } } },
        "initial": { "rod.angle": "-60 deg" },
        "outputs": { "angle": "deg(rod.angle)" },
        "simulation": { "duration": "2 s" }
    })
}

fn of_simulation(simulation: &mut Value) {
    for key in ["duration", "step", "tolerance", "output_step"] {
        limited(simulation, key, POSITIVE);
    }
    let alpha = &mut simulation["properties"]["alpha"];
    // The end of the range is a third, which no decimal is exactly.
    insert(alpha, "minimum", json!(-0.333_333_334));
    insert(alpha, "exclusiveMaximum", json!(0));
    insert(alpha, "default", json!(-0.1));
    insert(&mut simulation["properties"]["formulation"], "default", json!("auto"));
    insert(&mut simulation["properties"]["scheme"], "default", json!("auto"));
    insert(&mut simulation["properties"]["extrapolation"], "minimum", json!(2));
    insert(&mut simulation["properties"]["extrapolation"], "maximum", json!(4));
    insert(&mut simulation["properties"]["extrapolation"], "examples", json!([3]));
    for (key, example) in [("duration", json!("2 s")), ("step", json!(1e-3)), ("tolerance", json!(1e-6))] {
        insert(&mut simulation["properties"][key], "examples", json!([example]));
    }
    insert(simulation, "not", json!({ "required": ["step", "tolerance"] }));
}

fn of_parameter(parameter: &mut Value) {
    let either =
        |keys: &[&str]| json!({ "anyOf": keys.iter().map(|key| json!({ "required": [key] })).collect::<Vec<_>>() });
    insert(
        parameter,
        "allOf",
        json!([
            { "not": { "required": ["tolerance", "interval"] } },
            { "not": { "allOf": [{ "required": ["tolerance"] }, either(&["plus", "minus"])] } },
            { "not": { "allOf": [{ "required": ["interval"] }, either(&["plus", "minus"])] } }
        ]),
    );
    for key in ["tolerance", "plus", "minus"] {
        limited(parameter, key, NONNEGATIVE);
    }
    // `+0.01 -0.02` and percentages begin and end otherwise than negative numbers.
    let examples = [("value", json!("0.5 m")), ("tolerance", json!("1%")), ("interval", json!(["0.49 m", "0.51 m"]))];
    for (key, example) in examples {
        insert(&mut parameter["properties"][key], "examples", json!([example]));
    }
}

/// Schema of a link of a robot, to which the model gives points only.
fn only_points() -> Value {
    json!({ "required": ["points"], "maxProperties": 1 })
}

/// Bodies have mass where they can move and inertia where they can turn, except where only the geometry of their motion
/// is asked for; a beam has its own, and a link of a robot.
fn massive() -> Value {
    let moves_by =
        |coordinates: Value| json!({ "properties": { "coordinates": { "contains": { "enum": coordinates } } } });
    json!({
        "properties": { "ground": true },
        "additionalProperties": {
            "if": { "anyOf": [{ "required": ["beam"] }, only_points()] },
            "else": { "allOf": [
                { "if": moves_by(json!(["x", "y", "z"])), "then": { "required": ["mass"] } },
                { "if": moves_by(json!(["angle", "orientation"])), "then": { "required": ["inertia"] } }
            ] }
        }
    })
}

fn of_body(body: &mut Value) {
    insert(body, "if", json!({ "required": ["beam"] }));
    // The other may be `repeat`.
    insert(body, "then", json!({ "maxProperties": 2 }));
    limited(body, "mass", NONNEGATIVE);
    let coordinates = &mut body["properties"]["coordinates"];
    insert(coordinates, "minItems", json!(1));
    insert(coordinates, "uniqueItems", json!(true));
    insert(coordinates, "examples", json!([["x", "y", "angle"]]));
}

fn of_table(table: &mut Value) {
    exactly_one(table, &["file", "points"]);
    insert(&mut table["properties"]["points"], "minItems", json!(2));
    insert(&mut table["properties"]["points"], "examples", json!([[[0, 0], [1, 2], [3, 0]]]));
    insert(&mut table["properties"]["periodic"], "default", json!(false));
}

/// Least and largest counts of every method.
fn of_bounds(definitions: &mut Map<String, Value>) {
    for (method, key, least, most) in crate::methods::COUNTS {
        let property = &mut definitions[method]["properties"][key];
        visit(property, &mut |schema| {
            if schema.get("type").and_then(Value::as_str) == Some("integer") {
                schema.insert("minimum".to_owned(), json!(least));
                schema.insert("maximum".to_owned(), json!(most));
            }
        });
    }
    limited(&mut definitions["Budget"], "seconds", POSITIVE);
    limited(&mut definitions["Bounds"], "tolerance", POSITIVE);
    insert(&mut definitions["Bounds"]["properties"]["tolerance"], "exclusiveMaximum", json!(1));
}

fn visit(schema: &mut Value, change: &mut impl FnMut(&mut Map<String, Value>)) {
    match schema {
        Value::Object(object) => {
            change(object);
            object.values_mut().for_each(|inner| visit(inner, change));
        }
        Value::Array(items) => items.iter_mut().for_each(|inner| visit(inner, change)),
        _ => {}
    }
}

/// Numbers of a key are above 0 (`exclusiveMinimum`), or not below (`minimum`).
fn limited(definition: &mut Value, key: &str, limit: &str) {
    let property = &mut definition["properties"][key];
    if let Ok(mut schema) = Schema::try_from(property.take()) {
        not_negative(&mut schema, limit);
        *property = schema.to_value();
    }
}

fn exactly_one(definition: &mut Value, keys: &[&str]) {
    let required: Vec<Value> = keys.iter().map(|key| json!({ "required": [key] })).collect();
    insert(definition, "oneOf", required.into());
}

fn insert(schema: &mut Value, keyword: &str, value: Value) {
    if let Some(schema) = schema.as_object_mut() {
        schema.insert(keyword.to_owned(), value);
    }
}
