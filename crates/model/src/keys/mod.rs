//! The grammar of a model file: which keys stand where.
//!
//! One declaration serves the reader, which takes the known keys from it, and the JSON Schema for editors.

use schemars::Schema;
use schemars::transform::{RecursiveTransform, Transform};

mod black_box;
mod bodies;
mod constraints;
mod design;
mod dimensions;
mod model;
mod parts;
mod reduced;
mod repetition;
mod run;
mod statistics;
mod values;
mod zones;

pub use black_box::*;
pub use bodies::*;
pub use design::*;
pub use dimensions::*;
pub use model::*;
pub use parts::*;
pub use reduced::*;
pub use run::*;
pub use statistics::*;
use values::*;
pub use zones::*;

use crate::grammar::mapping::grammar;
use crate::grammar::values::{Components, Number, Rotation, UnitName};

/// Identifier of the schema, by which others refer to it.
const SCHEMA_ID: &str = "https://raw.githubusercontent.com/mbint/mbint/main/schemas/mbint.schema.json";

/// Version of the language of model files: the second number grows with every key that is added, the first one where a
/// model of before does not mean the same any more.
pub const SCHEMA_VERSION: &str = "1.0";

/// The JSON Schema of model files, as text that ends with a newline.
pub fn schema() -> String {
    let mut schema = schemars::schema_for!(File);
    schema.insert("$id".to_owned(), SCHEMA_ID.into());
    schema.insert("title".to_owned(), "mbint model".into());
    schema.insert("$comment".to_owned(), format!("version {SCHEMA_VERSION}").into());
    RecursiveTransform(without_null).transform(&mut schema);
    constraints::constrain(&mut schema);
    // A schema is a tree of JSON values: writing it out cannot fail.
    let mut text = serde_json::to_string_pretty(&schema).unwrap_or_default();
    text.push('\n');
    text
}

/// Removes null from the values of a key: it may be omitted, but only a mapping may be written as nothing (`taylor:`).
fn without_null(schema: &mut Schema) {
    let null = serde_json::json!({ "type": "null" });
    if let Some(serde_json::Value::Array(choices)) = schema.get_mut("anyOf") {
        let mapping = |choice: &serde_json::Value| {
            let target = choice.get("$ref").and_then(serde_json::Value::as_str);
            target.is_some_and(|target| !target.ends_with("/Number"))
        };
        if !choices.iter().any(mapping) {
            choices.retain(|choice| *choice != null);
        }
    }
    if let Some(serde_json::Value::Array(types)) = schema.get("type")
        && let [only, serde_json::Value::String(second)] = types.as_slice()
        && second == "null"
        && only != "object"
    {
        let only = only.clone();
        schema.insert("type".to_owned(), only);
    }
}

#[cfg(test)]
mod tests {
    use schemars::JsonSchema;

    use super::*;
    use crate::grammar::mapping::Grammar;

    fn same_keys<G: Grammar + JsonSchema>() {
        let schema = schemars::schema_for!(G);
        let properties = schema.get("properties").and_then(|properties| properties.as_object()).unwrap();
        let mut known: Vec<&str> = properties.keys().map(String::as_str).collect();
        let mut read = G::KEYS.to_vec();
        known.sort_unstable();
        read.sort_unstable();
        assert_eq!(known, read, "{}", G::WHAT);
        let described = |property: &serde_json::Value| property.get("description").is_some();
        assert!(properties.values().all(described), "{}", G::WHAT);
    }

    #[test]
    fn reader_and_schema_have_the_same_keys() {
        same_keys::<File>();
        same_keys::<BlackBoxFile>();
        same_keys::<RefineFile>();
        same_keys::<DimensionFile>();
        same_keys::<ObjectiveKinds>();
        same_keys::<ZoneFile>();
        same_keys::<Scene>();
        same_keys::<SceneSimulation>();
        same_keys::<Parameter>();
        same_keys::<Body>();
        same_keys::<Assembly>();
        same_keys::<InstanceFile>();
        same_keys::<PointPort>();
        same_keys::<PlaceFile>();
        same_keys::<Part>();
        same_keys::<Statistics>();
        same_keys::<CorrelationFile>();
        same_keys::<LawKinds>();
        same_keys::<CostKinds>();
        same_keys::<Held>();
        same_keys::<Rotation>();
        same_keys::<Simulation>();
        same_keys::<crate::methods::keys::Bounds>();
    }
}
