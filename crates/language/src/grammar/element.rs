//! What an element of the language is: a struct whose fields are its keys.
//!
//! `#[derive(Element)]` (crate `mbint-derive`) makes all of this from the struct: the reader, the schema, the
//! documentation, the formulas and references within, and whether it leaves the plane.

use schemars::{Schema, SchemaGenerator};
use serde::Serialize;
use symdiff::Formula;

use super::image::{Image, KeyImage};
use super::reader::Reader;
use super::report::Fields;
use super::requirement::{Quantity, Requirement};
use super::symbols::{Reference, SymbolTable};
use crate::syntax::diagnostic::Diagnostics;
use crate::syntax::source::Span;
use crate::syntax::yaml::{self, Node};

/// Keys of one mapping that are read together.
pub trait Group: Sized {
    /// Names of the keys, in the order in which they are suggested.
    fn key_names() -> Vec<&'static str>;

    /// The keys with all that is known of them.
    fn keys(generator: &mut SchemaGenerator) -> Vec<Key>;

    /// Reads the keys; `units` is the place of the unit that holds in those that have several. `None` where an error
    /// was reported.
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, units: usize) -> Option<Self>;

    /// The place of the unit that holds for the keys after these; `None` where these do not decide it.
    fn units(_read: Option<&Self>) -> Option<usize> {
        None
    }

    /// What the keys' values are to an instance that is mirrored or turned.
    fn images() -> Vec<KeyImage> {
        Vec::new()
    }

    /// Every formula within.
    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>);

    /// Every body, point and joint that is named within, formulas aside.
    fn references<'a>(&'a mut self, _found: &mut Vec<Reference<'a>>) {}

    /// The key that leaves the plane, by the text alone.
    fn leaves_plane(_mapping: &Node) -> Option<&'static str> {
        None
    }
}

/// A kind of effect or joint.
pub trait Element: Group {
    /// The word for it in a model file.
    const KEYWORD: &'static str;
    /// Noun for messages: `a drag`.
    const WHAT: &'static str;
    /// Summary in one line.
    const DESCRIPTION: &'static str;
    /// Equation, in the symbols of its file's head.
    const EQUATIONS: &'static [&'static str];
    /// Where that is from.
    const SOURCE: &'static str;
    /// Its keys in the mechanism that examples belong to.
    const EXAMPLE: &'static str;
    /// The key whose list may stand for the mapping.
    const SHORT: Option<&'static str>;

    /// Reads it; `at` is where to say that a key is missing.
    fn read_node<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, at: Span) -> Option<Self> {
        let fields = match (&node.value, Self::SHORT) {
            (yaml::Value::Sequence(_), Some(key)) => Fields::single(Self::WHAT, Self::key_names(), key, node, at),
            _ => reader.mapping(Self::WHAT, Self::key_names(), node, at)?,
        };
        Self::read(reader, &fields, 0)
    }

    /// Says in the schema which keys do not go together.
    fn constrain(_schema: &mut Schema) {}

    /// The schema of its mapping, with its example.
    fn object(generator: &mut SchemaGenerator) -> Schema {
        let keys = Self::keys(generator);
        let mut schema = object_schema(Self::DESCRIPTION, keys);
        schema.insert("examples".to_owned(), serde_json::Value::Array(vec![json_of(Self::EXAMPLE)]));
        Self::constrain(&mut schema);
        schema
    }
}

/// What else must hold of the keys of an element.
pub trait Checked: Sized {
    /// Reports keys that do not go together, and missing ones of which another would do.
    fn check_keys<S: SymbolTable>(_reader: &mut Reader<'_, S>, _fields: &Fields<'_>) {}

    /// Says in the schema what can be said there of the keys that do not go together.
    fn constrain(_schema: &mut Schema) {}

    /// Reports values that do not go together.
    fn check<S: SymbolTable>(&self, _reader: &mut Reader<'_, S>, _fields: &Fields<'_>) {}
}

/// What can stand behind a key: a formula, a point, a mapping.
pub trait Value: Sized {
    /// Its image in a mirror.
    const IMAGE: Image = Image::Same;

    /// Reads it; `at` is the key's place. `None` where an error was reported.
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, at: Span, quantity: &Quantity) -> Option<Self>;

    /// What a file may have there.
    fn schema(generator: &mut SchemaGenerator) -> Schema;

    /// Keys within it.
    fn keys() -> Vec<Key> {
        Vec::new()
    }

    /// As a file has it; `None` where it has no short form.
    fn to_json(&self) -> Option<serde_json::Value> {
        None
    }

    /// Every formula within.
    fn formulas<'a>(&'a self, _found: &mut Vec<&'a Formula>) {}

    /// Every body, point and joint that is named within, formulas aside.
    fn references<'a>(&'a mut self, _found: &mut Vec<Reference<'a>>) {}

    /// Whether it leaves the plane, by the text alone.
    fn leaves_plane(_node: &Node) -> bool {
        false
    }
}

/// A value that a plain number can stand for.
pub trait FromNumber {
    /// The number, in every component.
    fn from_number(value: f64) -> Self;
}

/// Reports where two keys are there and the second is not larger than the first.
pub fn ordered<S: SymbolTable>(
    reader: &mut Reader<'_, S>,
    fields: &Fields<'_>,
    low: &str,
    first: Option<&impl Value>,
    high: &str,
    second: Option<&impl Value>,
) {
    let (mut lower, mut upper) = (Vec::new(), Vec::new());
    if let (Some(first), Some(second), true, true) =
        (first, second, fields.get(low).is_some(), fields.get(high).is_some())
    {
        first.formulas(&mut lower);
        second.formulas(&mut upper);
    }
    if let ([lower], [upper]) = (lower.as_slice(), upper.as_slice()) {
        reader.ordered(fields, low, lower, high, upper);
    }
}

/// A key, for people and for the schema.
#[derive(Clone, Debug)]
pub struct Key {
    /// As it is written.
    pub name: &'static str,
    /// Summary.
    pub doc: &'static str,
    /// Its unit, or several divided by ` or `; empty where it is no quantity.
    pub unit: &'static str,
    /// Whether it must be there.
    pub required: bool,
    /// What holds where it is not there.
    pub default: Option<serde_json::Value>,
    /// The same in words, where it depends on other keys.
    pub default_in_words: Option<&'static str>,
    /// What may stand behind it.
    pub schema: Schema,
    /// What must hold of its number.
    pub requirement: Option<Requirement>,
    /// Keys within it.
    pub keys: Vec<Key>,
}

impl Key {
    /// Description with unit and default, in one line.
    pub fn description(&self) -> String {
        let mut text = self.doc.trim_end_matches('.').to_owned();
        if !self.unit.is_empty() && self.unit != "1" {
            text += &format!(", {}", self.unit);
        }
        let default = self.default.as_ref().map(|default| default.to_string().replace('"', ""));
        if let Some(default) = default.or_else(|| self.default_in_words.map(str::to_owned)) {
            text += &format!("; by default {default}");
        }
        text + "."
    }
}

/// A mapping with these keys alone.
pub fn object_schema(description: &str, keys: Vec<Key>) -> Schema {
    let required: Vec<&str> = keys.iter().filter(|key| key.required).map(|key| key.name).collect();
    let mut schema = schemars::json_schema!({ "description": description, "type": "object" });
    let mut properties = serde_json::Map::new();
    for key in &keys {
        let mut property = key.schema.clone();
        property.insert("description".to_owned(), key.description().into());
        if let Some(default) = &key.default {
            property.insert("default".to_owned(), default.clone());
        }
        let is_number = property.get("$ref").and_then(serde_json::Value::as_str) == Some("#/$defs/Number");
        if let Some(limit) = key.requirement.and_then(|requirement| requirement.limit()).filter(|_| is_number) {
            not_negative(&mut property, limit);
        }
        properties.insert(key.name.to_owned(), property.to_value());
    }
    schema.insert("properties".to_owned(), properties.into());
    schema.insert("additionalProperties".to_owned(), false.into());
    if !required.is_empty() {
        schema.insert("required".to_owned(), required.into());
    }
    schema
}

/// Refuses numbers below the limit 0, and quantities with a minus. Formulas are for the reader.
pub fn not_negative(property: &mut Schema, limit: &str) {
    property.insert(limit.to_owned(), 0.into());
    property
        .insert("pattern".to_owned(), r"^(?!\s*-\s*[0-9.]+([eE][+-]?[0-9]+)?\s*([A-Za-zµ°%][^\s+(-]*)?\s*$)".into());
}

/// Exactly one of these keys is there.
pub fn one_of(schema: &mut Schema, keys: &[&str]) {
    let required: Vec<serde_json::Value> = keys.iter().map(|key| serde_json::json!({ "required": [key] })).collect();
    schema.insert("oneOf".to_owned(), required.into());
}

/// One of several kinds, each by its word, its description and its schema.
pub fn kinds_schema(description: &str, kinds: Vec<(&'static str, &'static str, Schema)>) -> Schema {
    let mut properties = serde_json::Map::new();
    for (word, description, mut schema) in kinds {
        schema.insert("description".to_owned(), description.into());
        properties.insert(word.to_owned(), schema.to_value());
    }
    schemars::json_schema!({
        "description": description,
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
        "minProperties": 1,
        "maxProperties": 1
    })
}

/// Word, description and schema of an element, for [`kinds_schema`].
pub fn kind_schema<E: Element + schemars::JsonSchema>(
    generator: &mut SchemaGenerator,
) -> (&'static str, &'static str, Schema) {
    (E::KEYWORD, E::DESCRIPTION, short_or_full::<E>(generator))
}

/// The mapping of an element, or the list that may stand for it.
fn short_or_full<E: Element + schemars::JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let full = generator.subschema_for::<E>();
    let Some(short) = E::SHORT else { return full };
    let keys = E::keys(generator);
    let Some(key) = keys.into_iter().find(|key| key.name == short) else { return full };
    let mut list = key.schema;
    list.insert("description".to_owned(), format!("Short for `{{ {short}: … }}`.").into());
    schemars::json_schema!({ "anyOf": [list, full] })
}

/// An example as JSON.
fn json_of(yaml: &str) -> serde_json::Value {
    fn value(node: &Node) -> serde_json::Value {
        match &node.value {
            yaml::Value::Mapping(entries) => {
                entries.iter().map(|entry| (entry.key.clone(), value(&entry.value))).collect()
            }
            yaml::Value::Sequence(items) => items.iter().map(value).collect(),
            yaml::Value::Scalar(scalar) => match scalar.text.parse::<f64>() {
                Ok(number) => number_as_json(number),
                Err(_) => scalar.text.clone().into(),
            },
        }
    }
    let mut diagnostics = Diagnostics::new("example".to_owned(), yaml);
    yaml::parse(yaml, &mut diagnostics).as_ref().map_or(serde_json::Value::Null, value)
}

/// A number; a whole one without decimals.
pub fn number_as_json(number: f64) -> serde_json::Value {
    let whole = number as i64;
    if whole as f64 == number { whole.into() } else { number.into() }
}

/// An element of the language, for people.
#[derive(Debug, Serialize)]
pub struct ElementDocs {
    /// The word for it in a model file.
    pub keyword: &'static str,
    /// Summary.
    pub description: &'static str,
    /// Equation.
    pub formulas: &'static [&'static str],
    /// Where that is from.
    pub source: &'static str,
    /// Its keys in the mechanism of examples.
    pub example: &'static str,
    /// Its keys.
    pub keys: Vec<KeyDocs>,
    /// Sensors for outputs, with units.
    pub sensors: Vec<(&'static str, String)>,
}

/// A key of an element, for people.
#[derive(Clone, Debug, Serialize)]
pub struct KeyDocs {
    /// As it is written.
    pub name: &'static str,
    /// Whether it must be there.
    pub required: bool,
    /// Description with unit and default.
    pub description: String,
    /// Keys within it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keys: Vec<KeyDocs>,
}

impl ElementDocs {
    /// Of a kind of element.
    pub fn of<E: Element>() -> Self {
        fn docs(key: &Key) -> KeyDocs {
            let keys = key.keys.iter().map(docs).collect();
            KeyDocs { name: key.name, required: key.required, description: key.description(), keys }
        }
        let keys = E::keys(&mut SchemaGenerator::default());
        Self {
            keyword: E::KEYWORD,
            description: E::DESCRIPTION,
            formulas: E::EQUATIONS,
            source: E::SOURCE,
            example: E::EXAMPLE,
            keys: keys.iter().map(docs).collect(),
            sensors: Vec::new(),
        }
    }
}
