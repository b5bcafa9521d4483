//! `docs/reference/keys.md`: every key of a model file, from the JSON Schema.

use std::collections::VecDeque;

use serde_json::Value;

const HEAD: &str = "# Keys of a model

Made from the JSON Schema, which `mbint schema` prints. Keys marked with * are required.
";

/// The page.
pub fn page(schema: &str) -> String {
    let schema: Value = serde_json::from_str(schema).unwrap();
    let mut page = HEAD.to_owned();
    let mut queue = VecDeque::from([("Model".to_owned(), &schema)]);
    let mut seen = vec!["Model".to_owned()];
    while let Some((name, definition)) = queue.pop_front() {
        page += &section(&name, definition);
        for reference in references(definition) {
            if !seen.contains(&reference) {
                seen.push(reference.clone());
                let target = &schema["$defs"][&reference];
                queue.push_back((reference, target));
            }
        }
    }
    page
}

fn section(name: &str, definition: &Value) -> String {
    let mut text = format!("\n## {name}\n\n{}\n", description(definition));
    let Some(properties) = definition["properties"].as_object() else {
        return text + &format!("\n{}\n", capital(&value(definition)));
    };
    text += "\n| key | value | |\n|---|---|---|\n";
    let required = definition["required"].as_array().into_iter().flatten().collect::<Vec<_>>();
    for (key, property) in properties {
        let mark = if required.iter().any(|required| *required == key) { " *" } else { "" };
        text += &format!("| `{key}`{mark} | {} | {} |\n", value(property), description(property));
    }
    let examples = definition["examples"].as_array().into_iter().flatten();
    text + &examples.map(|example| format!("\nExample: `{example}`\n")).collect::<String>()
}

/// Possible values, in words.
fn value(schema: &Value) -> String {
    if let Some(reference) = schema["$ref"].as_str() {
        let name = reference.rsplit('/').next().unwrap();
        return format!("[{name}](#{})", name.to_lowercase());
    }
    if let Some(constant) = schema.get("const") {
        return format!("`{}`", constant.as_str().map_or_else(|| constant.to_string(), str::to_owned));
    }
    for choice in ["anyOf", "oneOf"] {
        if let Some(choices) = schema[choice].as_array() {
            return either(choices.iter().map(value));
        }
    }
    if let Some(values) = schema["enum"].as_array() {
        return either(values.iter().map(|value| format!("`{}`", value.as_str().unwrap_or("null"))));
    }
    match &schema["type"] {
        Value::Array(types) => either(types.iter().map(|kind| typed(kind.as_str().unwrap(), schema))),
        Value::String(kind) => typed(kind, schema),
        _ => "anything".to_owned(),
    }
}

fn typed(kind: &str, schema: &Value) -> String {
    match (kind, &schema["items"], &schema["additionalProperties"]) {
        ("null", ..) => String::new(),
        ("array", items, _) if items.is_object() => format!("list of {}", value(items)),
        ("object", _, values) if values.is_object() => format!("names, each with {}", value(values)),
        ("string", ..) => "text".to_owned(),
        (kind, ..) => kind.to_owned(),
    }
}

fn either(choices: impl Iterator<Item = String>) -> String {
    let choices: Vec<String> = choices.filter(|choice| !choice.is_empty()).collect();
    choices.join(" or ")
}

fn description(schema: &Value) -> String {
    schema["description"].as_str().unwrap_or_default().replace('\n', " ").replace('|', "\\|")
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Definitions that a schema refers to, in its order.
fn references(schema: &Value) -> Vec<String> {
    match schema {
        Value::Object(members) => members
            .iter()
            .filter(|(key, _)| *key != "$defs")
            .flat_map(|(key, member)| match (key.as_str(), member) {
                ("$ref", Value::String(reference)) => vec![reference.rsplit('/').next().unwrap().to_owned()],
                _ => references(member),
            })
            .collect(),
        Value::Array(members) => members.iter().flat_map(references).collect(),
        _ => Vec::new(),
    }
}
