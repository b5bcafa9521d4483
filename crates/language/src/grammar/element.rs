//! Elements of the language: structs whose fields are their keys.
//!
//! `#[derive(Element)]` (crate `mbint-derive`) generates all of this from the struct: the reader, the schema, the
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

    /// The keys with all their properties.
    fn keys(generator: &mut SchemaGenerator) -> Vec<Key>;

    /// Reads the keys; `units` is the index of the applicable unit of those that have several. `None` if an error was
    /// reported.
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, units: usize) -> Option<Self>;

    /// Index of the applicable unit of the keys after these; `None` if these do not determine it.
    fn units(_read: Option<&Self>) -> Option<usize> {
        None
    }

    /// Images of the keys' values in a mirrored or turned instance.
    fn images() -> Vec<KeyImage> {
        Vec::new()
    }

    /// Every formula within.
    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>);

    /// Every body, point and joint that is named within, except in formulas.
    fn references<'a>(&'a mut self, _found: &mut Vec<Reference<'a>>) {}

    /// The key whose value leaves the plane, determined from the text alone.
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
    /// Source of the equation.
    const SOURCE: &'static str;
    /// Its keys in the mechanism that examples belong to.
    const EXAMPLE: &'static str;
    /// The key whose list may replace the mapping.
    const SHORT: Option<&'static str>;

    /// Reads it; missing keys are reported at `at`.
    fn read_node<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, at: Span) -> Option<Self> {
        let fields = match (&node.value, Self::SHORT) {
            (yaml::Value::Sequence(_), Some(key)) => Fields::single(Self::WHAT, Self::key_names(), key, node, at),
            _ => reader.mapping(Self::WHAT, Self::key_names(), node, at)?,
        };
        Self::read(reader, &fields, 0)
    }

    /// Adds to the schema which keys are incompatible.
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

/// Further checks of the keys of an element.
pub trait Checked: Sized {
    /// Reports incompatible keys, and alternatives of which none is given.
    fn check_keys<S: SymbolTable>(_reader: &mut Reader<'_, S>, _fields: &Fields<'_>) {}

    /// Adds to the schema which keys are incompatible, as far as it can express that.
    fn constrain(_schema: &mut Schema) {}

    /// Reports incompatible values.
    fn check<S: SymbolTable>(&self, _reader: &mut Reader<'_, S>, _fields: &Fields<'_>) {}
}

/// Value of a key: a formula, a point, a mapping.
pub trait Value: Sized {
    /// Its image in a mirror.
    const IMAGE: Image = Image::Same;

    /// Reads it; `at` is the key's location. `None` if an error was reported.
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, at: Span, quantity: &Quantity) -> Option<Self>;

    /// Schema of the value in a file.
    fn schema(generator: &mut SchemaGenerator) -> Schema;

    /// Keys within it.
    fn keys() -> Vec<Key> {
        Vec::new()
    }

    /// The value as a file has it; `None` if it has no short form.
    fn to_json(&self) -> Option<serde_json::Value> {
        None
    }

    /// Every formula within.
    fn formulas<'a>(&'a self, _found: &mut Vec<&'a Formula>) {}

    /// Every body, point and joint that is named within, except in formulas.
    fn references<'a>(&'a mut self, _found: &mut Vec<Reference<'a>>) {}

    /// Whether it leaves the plane, determined from the text alone.
    fn leaves_plane(_node: &Node) -> bool {
        false
    }
}

/// A value that may be given as a plain number.
pub trait FromNumber {
    /// The number, in every component.
    fn from_number(value: f64) -> Self;
}

/// Reports an error if two keys are given and the second is not larger than the first.
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
    /// Its unit, or several separated by ` or `; empty if it is no quantity.
    pub unit: &'static str,
    /// Whether it is required.
    pub required: bool,
    /// Its default.
    pub default: Option<serde_json::Value>,
    /// Its default in words, if that depends on other keys.
    pub default_in_words: Option<&'static str>,
    /// Schema of its value.
    pub schema: Schema,
    /// Requirement on its number.
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

/// Schema of a mapping with these keys alone.
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

/// Refuses numbers below the limit 0, and quantities with a minus sign. The reader checks formulas.
pub fn not_negative(property: &mut Schema, limit: &str) {
    property.insert(limit.to_owned(), 0.into());
    property
        .insert("pattern".to_owned(), r"^(?!\s*-\s*[0-9.]+([eE][+-]?[0-9]+)?\s*([A-Za-zµ°%][^\s+(-]*)?\s*$)".into());
}

/// Requires exactly one of these keys.
pub fn one_of(schema: &mut Schema, keys: &[&str]) {
    let required: Vec<serde_json::Value> = keys.iter().map(|key| serde_json::json!({ "required": [key] })).collect();
    schema.insert("oneOf".to_owned(), required.into());
}

/// Schema of one of several kinds, each by its word, its description and its schema.
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

/// Schema of an element's mapping, or of the list that may replace it.
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
    /// Source of the equation.
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
    /// Whether it is required.
    pub required: bool,
    /// Description with unit and default.
    pub description: String,
    /// Keys within it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keys: Vec<KeyDocs>,
}

impl ElementDocs {
    /// Documentation of a kind of element.
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
