//! The grammar's effects and their keys, for people: what `mbint explain --effects` shows.

use serde::Serialize;

use super::file;
use crate::grammar::mapping::Grammar;

/// A key of the grammar, for people.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct Key {
    pub name: String,
    pub required: bool,
    /// What it is, with its unit.
    pub description: String,
    /// Keys within it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keys: Vec<Key>,
}

/// The words for effects, in the order of the grammar.
pub fn effect_keywords() -> &'static [&'static str] {
    file::Effect::KEYS
}

/// What an effect is, and its keys; `None` where there is no such effect.
pub fn effect_grammar(keyword: &str) -> Option<(String, Vec<Key>)> {
    let schema = serde_json::to_value(schemars::schema_for!(file::File)).ok()?;
    let effect = schema.get("$defs")?.get("Effect")?.get("properties")?.get(keyword)?;
    let keys = keys_of(&schema, effect);
    Some((description_of(effect), keys))
}

fn description_of(schema: &serde_json::Value) -> String {
    schema.get("description").and_then(serde_json::Value::as_str).unwrap_or_default().replace('\n', " ")
}

/// The keys of the mapping that a property refers to; none where it is a value.
fn keys_of(schema: &serde_json::Value, property: &serde_json::Value) -> Vec<Key> {
    let choices = property.get("anyOf").and_then(serde_json::Value::as_array);
    let refers = |value: &serde_json::Value| value.get("$ref").and_then(serde_json::Value::as_str).map(str::to_owned);
    let target = refers(property).or_else(|| choices?.iter().find_map(refers));
    let name = target.as_deref().and_then(|target| target.rsplit('/').next()).unwrap_or_default();
    let Some(definition) = schema.get("$defs").and_then(|definitions| definitions.get(name)) else { return Vec::new() };
    let Some(properties) = definition.get("properties").and_then(serde_json::Value::as_object) else {
        return Vec::new();
    };
    let required = definition.get("required").and_then(serde_json::Value::as_array);
    let is_required = |name: &str| required.is_some_and(|list| list.iter().any(|known| known.as_str() == Some(name)));
    let key = |(name, property): (&String, &serde_json::Value)| Key {
        name: name.clone(),
        required: is_required(name),
        description: description_of(property),
        keys: keys_of(schema, property),
    };
    properties.iter().map(key).collect()
}
